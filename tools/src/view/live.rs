//! A run in progress, gathered into the store while it happens.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use shoal_bus::record::Topic;
use shoal_bus::tap::{TapError, TapItem, TapSubscriber};

use super::cast::Cast;
use super::chunk::Gatherer;
use super::store::Store;
use crate::exit::Exit;
use crate::failure::{Failure, While};
use crate::tap::live::chosen;

const TOPICS: [Topic; 4] = [Topic::Ticks, Topic::Reports, Topic::Pings, Topic::Flock];

/// How long to wait for news before looking whether the run is still there.
const LOOK_AGAIN: Duration = Duration::from_millis(200);

/// A run that is being watched.
pub struct Watching {
    /// Who takes part.
    pub cast: Arc<Cast>,
    /// Ends with the run, or when it is told to stop.
    pub thread: JoinHandle<()>,
}

/// Attaches to a live run and gathers it, in a thread of its own until `stop`; returns when it is known who takes part.
///
/// # Errors
/// When there is no such run within `wait`, or it ends before it has begun.
pub fn start(
    wanted: Option<&str>,
    wait: Duration,
    store: Arc<Store>,
    stop: Arc<AtomicBool>,
) -> Result<Watching, Failure> {
    let deadline = Instant::now() + wait;
    let wanted = wanted.map(str::to_owned);
    let (tell, told) = channel();
    // A subscriber stays in the thread that made it.
    let watch = move || {
        let tap = match attached(wanted.as_deref(), deadline, &stop) {
            Ok(tap) => tap,
            Err(failure) => {
                let _gone = tell.send(Err(failure));
                return;
            }
        };
        let note = match gather(tap, &store, &stop, &tell) {
            Ok(note) => note,
            Err(error) => format!("The run can no longer be watched: {error}."),
        };
        store.finish(note);
    };
    let thread = thread::Builder::new().name("tap".to_owned()).spawn(watch).while_doing("start a thread")?;
    let ended =
        |_| Failure::failed("the run ended before it could be watched; give --wait SECONDS for the next one");
    let cast = told.recv().map_err(ended)??;
    Ok(Watching { cast, thread })
}

fn attached(wanted: Option<&str>, deadline: Instant, stop: &AtomicBool) -> Result<TapSubscriber, Failure> {
    loop {
        let attempt = chosen(wanted).and_then(|run| {
            TapSubscriber::attach(&run, &TOPICS).map_err(|_| {
                Failure::failed(format!(
                    "run {} is just starting or ending and cannot be watched; give --wait SECONDS",
                    run.id()
                ))
            })
        });
        let is_over = Instant::now() >= deadline || stop.load(Ordering::Relaxed);
        match attempt {
            Err(failure) if is_over || failure.exit == Exit::Usage => return Err(failure),
            Err(_) => thread::sleep(Duration::from_millis(20)),
            Ok(tap) => return Ok(tap),
        }
    }
}

/// Gathers until the run ends; returns what the user must know.
fn gather(
    mut tap: TapSubscriber,
    store: &Store,
    stop: &AtomicBool,
    tell: &Sender<Result<Arc<Cast>, Failure>>,
) -> Result<String, TapError> {
    let mut gatherer: Option<Gatherer> = None;
    let mut missed = 0;
    // In memory there is always room: old seconds make way.
    let mut put = |chunk| drop(store.put(chunk));
    loop {
        let item = tap.next(LOOK_AGAIN)?;
        if gatherer.is_none()
            && let Some(told) = tap.cast()
        {
            let cast = Arc::new(Cast::new(&told.header, true));
            gatherer = Some(Gatherer::new(cast.auvs(), cast.needs_receptions()));
            // Nobody waits any longer: then there is nobody to tell.
            let _gone = tell.send(Ok(cast));
        }
        match item {
            Some(TapItem::Window(window)) => {
                if let Some(gatherer) = &mut gatherer {
                    window.rows.iter().for_each(|row| gatherer.take(row, &mut put));
                }
            }
            None if tap.run().is_live() => {}
            ended => {
                if let Some(gatherer) = gatherer {
                    gatherer.finish(&mut put);
                }
                let is_over = matches!(ended, Some(TapItem::End { .. }));
                return Ok(if is_over { "The run is over." } else { "The run was broken off." }.to_owned());
            }
        }
        if tap.missed() > missed {
            missed = tap.missed();
            store.warn(format!("This view was too slow for the run: {missed} rows are missing."));
        }
        if stop.load(Ordering::Relaxed) {
            return Ok(String::new());
        }
    }
}
