//! `shoal record recover`: what is whole of a record that was cut or damaged.

use std::fs::{File, OpenOptions};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::json;
use shoal_bus::record::{Ending, Flip, Recovery, Wound, recover as copy};

use super::source::wrong;
use crate::exit::Exit;
use crate::failure::Failure;
use crate::summary_text::grouped;

/// Which record, and where to.
#[derive(Debug, Args)]
pub struct RecoverArgs {
    /// The record that was cut or damaged
    file: PathBuf,
    /// File to write, which must not be there yet; FILE.recovered.mcap beside it unless given
    #[arg(long, short, value_name = "FILE")]
    out: Option<PathBuf>,
    /// One JSON line
    #[arg(long)]
    json: bool,
}

/// Writes it, and says what is lost.
pub fn recover(args: &RecoverArgs) -> Result<Exit, Failure> {
    let out = args.out.clone().unwrap_or_else(|| args.file.with_extension("recovered.mcap"));
    let source = File::open(&args.file).map_err(|error| wrong(&args.file, &error))?;
    // Whatever is there, the source or something else, stays as it is.
    let file =
        OpenOptions::new().write(true).create_new(true).open(&out).map_err(|error| match error.kind() {
            std::io::ErrorKind::AlreadyExists => Failure::usage(format!(
                "{}: there is such a file already, and recover overwrites nothing: choose another with --out",
                out.display()
            )),
            _ => Failure::failed(format!("{}: {error}; choose another place with --out", out.display())),
        })?;
    let recovery = copy(source, BufWriter::new(file)).map_err(|error| {
        // Half a copy helps nobody.
        let _removed = std::fs::remove_file(&out);
        wrong(&args.file, &error)
    })?;
    let text = if args.json { line(&recovery, &out) } else { text(&recovery, &out) };
    // Whoever closed our output does not want it; the exit code still tells.
    let _closed = std::io::stdout().lock().write_all(text.as_bytes());
    Ok(if recovery.is_complete() { Exit::Good } else { Exit::Loss })
}

fn line(recovery: &Recovery, out: &Path) -> String {
    let lost =
        |Wound { from, to, damage }: &Wound| json!({"from": from, "to": to, "damage": damage.to_string()});
    let cut = match recovery.ending {
        Ending::Truncated { readable_bytes } => Some(readable_bytes),
        Ending::Complete => None,
    };
    let line = json!({
        "format": "shoal.record_recovery/1",
        "out": out.to_string_lossy(),
        "complete": recovery.is_complete(),
        "source_bytes": recovery.source_bytes,
        "cut_behind_byte": cut,
        "repaired": recovery.repaired.map(|Flip { at, bits }| json!({"byte": at, "bits": bits})),
        "lost": recovery.lost.iter().map(lost).collect::<Vec<_>>(),
        "chunks": recovery.chunks,
        "messages": recovery.messages,
        "until_s": recovery.until.map(|until| until.as_s()),
        "has_outcome": recovery.has_outcome,
    });
    format!("{line}\n")
}

fn text(recovery: &Recovery, out: &Path) -> String {
    let until = recovery.until.map_or_else(String::new, |until| format!(", up to {:.3} s", until.as_s()));
    let mut text = format!("{}: {} messages{until}\n", out.display(), grouped(recovery.messages));
    if let Some(Flip { at, bits }) = recovery.repaired {
        text += &format!("put right: byte {at}, of which the bits {bits:#04x} were the other way round\n");
    }
    for Wound { from, to, damage } in &recovery.lost {
        text += &format!("lost: bytes {from} to {to}: {damage}\n");
    }
    if let Ending::Truncated { readable_bytes } = recovery.ending {
        let behind = grouped(recovery.source_bytes - readable_bytes);
        text += &format!(
            "lost: all behind byte {readable_bytes}, where it was cut; {behind} bytes of a piece were there\n"
        );
    }
    if !recovery.has_outcome {
        text += "no summary and no digest: they are written when a run ends\n";
    }
    if recovery.is_complete() {
        text += "nothing is lost\n";
    }
    text
}
