//! `-w FILE`: writes what is heard as a record, as `shoal run --record` does.

use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use shoal_bus::record::{RecordWriter, Row, Topic};

use super::args::TapArgs;
use super::choice::Choice;
use super::source::{Heard, Source};
use super::warn;
use crate::exit::Exit;
use crate::failure::Failure;

/// What a record has of a run while it is live. Poses follow from ticks.
const ALL: [Topic; 7] =
    [Topic::Ticks, Topic::Reports, Topic::Pings, Topic::Sensed, Topic::Log, Topic::Flock, Topic::Summary];

/// Writes the messages of `topic`, or of all topics, to the record at `path` until the run ends.
pub fn capture(args: &TapArgs, topic: Option<Topic>, path: &Path) -> Result<Exit, Failure> {
    if args.origin.read.as_deref().is_some_and(|read| is_same(read, path)) {
        return Err(Failure::usage(format!("{}: cannot be read and written at once", path.display())));
    }
    let chosen = topic.unwrap_or(Topic::Pings);
    if topic.is_some() && !ALL.contains(&chosen) {
        return Err(Failure::usage(format!(
            "{} follows from other topics and is not written alone",
            chosen.name()
        )));
    }
    let choice = Choice::new(&args.choice, chosen)?;
    // Pings are what --kind and --lost choose among; a filter knows the fields of one topic.
    let of_one = topic.or((!choice.is_all()).then_some(Topic::Pings));
    let topics = of_one.map_or(ALL.to_vec(), |topic| vec![topic]);
    let mut source = Source::open(&args.origin, &topics)?;
    let failed = |error: &dyn std::fmt::Display| {
        Failure::failed(format!("{}: {error}; choose another place with -w", path.display()))
    };
    let mut file = Some(File::create(path).map_err(|error| failed(&error))?);
    let mut writer = None;
    let (mut written, mut left) = (0_u64, args.choice.limit());
    let is_whole = loop {
        let window = match source.next()? {
            Heard::Window(window) => window,
            Heard::Nothing => continue,
            Heard::End => break of_one.is_none() && source.summary().is_some(),
        };
        if let (None, Some(cast), Some(file)) = (&writer, source.cast(), file.take()) {
            let mut begun =
                RecordWriter::create(BufWriter::new(file), &cast.header).map_err(|error| failed(&error))?;
            begun.born(&cast.born).map_err(|error| failed(&error))?;
            writer = Some(begun);
        }
        let Some(writer) = &mut writer else { continue };
        let mut rows = window.rows;
        if !choice.is_all() {
            rows.retain(|row| choice.takes(row).is_some());
        }
        rows.retain(|row| !matches!(row, Row::Summary(_)));
        rows.truncate(usize::try_from(left).unwrap_or(usize::MAX));
        writer.append_rows(&rows).and_then(|()| writer.advance(window.to)).map_err(|error| failed(&error))?;
        if !rows.is_empty() {
            source.taken();
        }
        written += rows.len() as u64;
        left = left.saturating_sub(rows.len() as u64);
        if left == 0 {
            break false;
        }
    };
    let Some(writer) = writer else {
        // An empty file would be no record.
        let _gone = std::fs::remove_file(path);
        return Err(Failure::failed("nothing was heard, so nothing was written"));
    };
    let is_whole = is_whole && source.gaps().is_empty() && source.is_from_beginning();
    match source.summary().filter(|_| is_whole) {
        // A record with a summary says that it is complete.
        Some(summary) => writer.finish(summary),
        None => writer.close(),
    }
    .map_err(|error| failed(&error))?;
    eprintln!("{written} messages written to {}", path.display());
    Ok(warn(&source))
}

fn is_same(one: &Path, other: &Path) -> bool {
    one == other || one.canonicalize().is_ok_and(|one| other.canonicalize().is_ok_and(|other| one == other))
}
