//! `shoal record cat`: the events of a record, a line each.

use std::io::{self, BufWriter, Write};
use std::path::PathBuf;

use clap::Args;
use serde_json::Value;
use shoal_bus::record::Topic;

use super::events::events;
use super::select::Selection;
use super::source::Record;
use crate::exit::Exit;
use crate::failure::Failure;

/// Which events of what record.
#[derive(Debug, Args)]
pub struct CatArgs {
    /// The record
    file: PathBuf,
    #[command(flatten)]
    selection: Selection,
}

/// Prints them.
pub fn cat(args: &CatArgs) -> Result<Exit, Failure> {
    args.selection.check()?;
    let mut record = Record::open(&args.file)?;
    let mut out = BufWriter::new(io::stdout().lock());
    let mut left = args.selection.count.unwrap_or(u64::MAX);
    let mut selected = None;
    while left > 0 {
        let Some(message) = record.next()? else { break };
        let Some(topic) = message.topic else { continue };
        if args.selection.is_past(message.at, topic) {
            // It may have been cut all the same: nobody asked for what comes later.
            return finish(&mut out, Exit::Good);
        }
        if !args.selection.wants(topic) {
            continue;
        }
        let found = match events(topic, message.at, message.data) {
            Ok(found) => found,
            Err(error) => return Err(record.wrong(&error)),
        };
        let selected = match &selected {
            Some(selected) => selected,
            None => selected.insert(args.selection.in_record(&record)?),
        };
        for event in found
            .iter()
            .filter(|event| selected.takes(topic, event))
            .take(usize::try_from(left).unwrap_or(usize::MAX))
        {
            left -= 1;
            if writeln!(out, "{}", line(topic, &event.value)).is_err() {
                // Whoever read us has enough.
                return Ok(Exit::Good);
            }
        }
    }
    let exit = if left == 0 { Exit::Good } else { record.end() };
    finish(&mut out, exit)
}

/// A reader that has gone is content.
fn finish(out: &mut impl Write, exit: Exit) -> Result<Exit, Failure> {
    Ok(if out.flush().is_err() { Exit::Good } else { exit })
}

/// An event behind the name of its topic.
fn line(topic: Topic, event: &Value) -> String {
    let text = event.to_string();
    // Every event is an object; one without members would be `{}`.
    let members = text.strip_prefix('{').unwrap_or(&text);
    let comma = if members == "}" { "" } else { "," };
    format!(r#"{{"topic":"{}"{comma}{members}"#, topic.name())
}
