//! Reads a record once, from front to back, into the store.

use std::fs::File;
use std::path::Path;
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, OnceLock};
use std::thread::JoinHandle;

use shoal_bus::record::{Ending, RecordReadError, Row, Topic, read_rows};

use super::cast::Cast;
use super::chunk::Gatherer;
use super::store::Store;
use crate::failure::{Failure, While};

const TOPICS: [Topic; 4] = [Topic::Ticks, Topic::Reports, Topic::Pings, Topic::Flock];

/// A record that is being read.
pub struct Reading {
    /// Who takes part.
    pub cast: Arc<Cast>,
    /// Where it goes.
    pub store: Arc<Store>,
    /// Ends when all is read.
    pub thread: JoinHandle<()>,
}

/// Begins to read the record at `path` in a thread of its own; returns when it is known who takes part.
///
/// # Errors
/// When it cannot be opened, is no record, or was cut before anything happened.
pub fn start(path: &Path, store: Arc<Store>) -> Result<Reading, Failure> {
    let name = path.display().to_string();
    let file = File::open(path).map_err(|error| Failure::failed(format!("{name}: {error}")))?;
    let (tell, told) = channel();
    let kept = Arc::clone(&store);
    let read = move || {
        let tell_cast = tell.clone();
        match gather(file, &kept, tell_cast) {
            Ok(note) => kept.finish(note),
            Err(error) => {
                // Before the cast is known, the error is all there is; after it, the page shows what came before.
                let _gone = tell.send(Err(error.to_string()));
                kept.finish(format!("Only a part can be shown: {error}."));
            }
        }
    };
    let thread =
        std::thread::Builder::new().name("reader".to_owned()).spawn(read).while_doing("start a thread")?;
    match told.recv() {
        Ok(Ok(cast)) => Ok(Reading { cast: Arc::new(cast), store, thread }),
        Ok(Err(error)) => Err(Failure::failed(format!("{name}: {error}"))),
        Err(_) => Err(Failure::failed(format!("{name}: the record was cut before anything happened"))),
    }
}

/// Reads all of `file`; returns what the user must know.
fn gather(file: File, store: &Store, tell: Sender<Result<Cast, String>>) -> Result<String, RecordReadError> {
    let mut gatherer: Option<Gatherer> = None;
    // The first thing that went wrong with the store: nothing is put after it.
    let failed = OnceLock::new();
    let mut put = |chunk| {
        if failed.get().is_none()
            && let Err(error) = store.put(chunk)
        {
            failed.get_or_init(|| error.to_string());
        }
    };
    let ending = read_rows(file, &TOPICS, &mut |row| match row {
        Row::Header(header) => {
            let cast = Cast::new(&header, false);
            gatherer = Some(Gatherer::new(cast.auvs(), cast.needs_receptions()));
            // Nobody listens any more: then there is nobody to tell.
            let _gone = tell.send(Ok(cast));
        }
        row => {
            if let Some(gatherer) = &mut gatherer {
                gatherer.take(&row, &mut put);
            }
        }
    });
    if let Some(gatherer) = gatherer {
        gatherer.finish(&mut put);
    }
    let ending = ending?;
    if let Some(error) = failed.get() {
        return Ok(format!("Only a part can be shown: the temporary folder does not take more ({error})."));
    }
    Ok(match ending {
        Ending::Complete => String::new(),
        Ending::Truncated { .. } => "The record was cut: this is all that is in it.".to_owned(),
    })
}
