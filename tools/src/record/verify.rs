//! `shoal record verify`: whether a record is what was written.

use std::fmt::Write as _;
use std::fs::File;
use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use serde_json::{Value, json};
use shoal_bus::record::{Ending, Fault, Verification, verify as check};

use super::digest::{Fit, Recount};
use super::source::wrong;
use crate::exit::Exit;
use crate::failure::Failure;
use crate::summary_text::grouped;

/// So many faults are told; the rest is counted.
const FAULTS_MAX: usize = 50;

/// Which record.
#[derive(Debug, Args)]
pub struct VerifyArgs {
    /// The record
    file: PathBuf,
    /// One JSON line
    #[arg(long)]
    json: bool,
}

/// Verifies it, and says what is damaged.
pub fn verify(args: &VerifyArgs) -> Result<Exit, Failure> {
    let file = File::open(&args.file).map_err(|error| wrong(&args.file, &error))?;
    let mut recount = Recount::default();
    let found = check(file, &mut |row| recount.take(row)).map_err(|error| wrong(&args.file, &error))?;
    let is_complete = found.is_whole() && found.recovered.is_none();
    let fit = if is_complete {
        recount.finish(found.digest.clone())
    } else {
        Fit::Unknown("some of them are missing")
    };
    let text = if args.json { line(&found, &fit) } else { text(args, &found, &fit) };
    // Whoever closed our output does not want it; the exit code still tells.
    let _closed = std::io::stdout().lock().write_all(text.as_bytes());
    Ok(match (&found.faults[..], &fit, found.ending) {
        ([_, ..], _, _) | (_, Fit::Differs { .. }, _) => Exit::Damaged,
        (_, _, Ending::Truncated { .. }) => Exit::Loss,
        _ if found.recovered.is_some() => Exit::Loss,
        _ => Exit::Good,
    })
}

fn line(found: &Verification, fit: &Fit) -> String {
    let cut = match found.ending {
        Ending::Truncated { readable_bytes } => Some(readable_bytes),
        Ending::Complete => None,
    };
    let fault = |fault: &Fault| {
        json!({
            "from": fault.from,
            "to": fault.to,
            "part": fault.part,
            "topics": fault.topics,
            "time_s": fault.time_s,
            "damage": fault.damage.to_string(),
            "changed": fault.flip.map(|flip| json!({"byte": flip.at, "bits": flip.bits})),
        })
    };
    let (digest, why): (&str, Value) = match fit {
        Fit::Fits => ("fits", Value::Null),
        Fit::Differs { found } => ("differs", json!(found)),
        Fit::Unknown(why) => ("unknown", json!(why)),
    };
    let line = json!({
        "format": "shoal.record_verification/1",
        "whole": found.is_whole(),
        "file_bytes": found.file_bytes,
        "cut_behind_byte": cut,
        "recovered": found.recovered,
        "chunks": found.chunks,
        "messages": found.messages,
        "until_s": found.until_s,
        "digest": digest,
        "digest_found": why,
        "faults": found.faults.iter().map(fault).collect::<Vec<_>>(),
    });
    format!("{line}\n")
}

fn text(args: &VerifyArgs, found: &Verification, fit: &Fit) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _infallible = write(&mut text, args, found, fit);
    text
}

fn write(text: &mut String, args: &VerifyArgs, found: &Verification, fit: &Fit) -> std::fmt::Result {
    for fault in found.faults.iter().take(FAULTS_MAX) {
        write!(text, "damaged: bytes {} to {} ({}", fault.from, fault.to, fault.part)?;
        if let Some([from, to]) = fault.time_s {
            write!(text, ", {from:.3} s to {to:.3} s")?;
        }
        if !fault.topics.is_empty() {
            write!(text, ", {}", fault.topics.join(" "))?;
        }
        writeln!(text, "): {}", fault.damage)?;
        if let Some(flip) = fault.flip {
            writeln!(
                text,
                "  byte {} was changed, its bits {:#04x}; `shoal record recover` puts it right",
                flip.at, flip.bits
            )?;
        }
    }
    if let Some(more @ 1..) = found.faults.len().checked_sub(FAULTS_MAX) {
        writeln!(text, "and {} more", grouped(more as u64))?;
    }
    let until = found.until_s.map_or_else(String::new, |until| format!(" up to {until:.3} s"));
    let file = args.file.display();
    let content = format!("{} messages in {} chunks{until}", grouped(found.messages), grouped(found.chunks));
    match found.ending {
        _ if !found.faults.is_empty() => writeln!(text, "{file}: damaged; {content} are whole")?,
        Ending::Truncated { readable_bytes } => {
            writeln!(text, "{file}: cut behind byte {readable_bytes}; {content} are whole")?;
        }
        Ending::Complete => {
            writeln!(text, "{file}: whole, all {} bytes; {content}", grouped(found.file_bytes))?;
        }
    }
    if let Some(lost) = &found.recovered {
        writeln!(text, "recovered from a record that lost {lost}")?;
    }
    match fit {
        Fit::Fits => writeln!(text, "digest: that of the events in it"),
        Fit::Differs { found } => {
            writeln!(text, "damaged: the digest is not that of the events in it, which is {found}")
        }
        Fit::Unknown(why) => writeln!(text, "digest: not compared with the events, as {why}"),
    }
}
