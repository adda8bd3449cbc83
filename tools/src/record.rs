//! `shoal record`: looks into records, checks, repairs and compares them.
//!
//! | file | idea |
//! |---|---|
//! | `info.rs` | what a record holds |
//! | `cat.rs` | its events, a line each |
//! | `export.rs`, `columns.rs` | its topics as tables |
//! | `verify.rs`, `digest.rs` | whether it is what was written |
//! | `recover.rs` | what is whole of one that is not |
//! | `diff.rs`, `batches.rs`, `compare.rs` | where two runs part |
//! | `events.rs` | the events of a message, as JSON |
//! | `select.rs` | which of them are wanted |
//! | `source.rs` | a record that is read, with its troubles |

pub mod batches;
mod cat;
mod columns;
pub mod compare;
pub mod diff;
mod digest;
pub mod events;
mod export;
mod info;
mod recover;
pub mod select;
pub mod source;
mod verify;

use std::path::PathBuf;

use clap::Subcommand;

use crate::exit::Exit;
use crate::failure::Failure;

/// What to do with records.
#[derive(Debug, Subcommand)]
pub enum RecordCommand {
    /// What a record holds; verifies every checksum
    #[command(after_help = "Example:\n  shoal record info flock.mcap")]
    Info {
        /// The record
        file: PathBuf,
        /// One JSON line
        #[arg(long)]
        json: bool,
    },
    /// The events of a record, a line of JSON each
    #[command(
        after_help = "A line is an event as the topic's schema describes it, behind the name of its topic.\n\nExamples:\n  \
        shoal record cat flock.mcap --topic /pings --auv 7 --from-s 10 --to-s 20\n  \
        shoal record cat flock.mcap --topic /pings --filter 'range_m>400'\n  \
        shoal record cat flock.mcap --topic /reports --count 1 | jq .position_m"
    )]
    Cat(cat::CatArgs),
    /// The topics of a record as tables: comma-separated values, or JSON lines
    #[command(
        after_help = "One file for each topic that has messages, `pings.csv` and so on; with --topic and no folder, that table goes to \
        standard output. --columns tells what every column is.\n\nExamples:\n  shoal record export flock.mcap -o tables\n  \
        shoal record export flock.mcap --topic /pings > pings.csv\n  shoal record export --columns"
    )]
    Export(export::ExportArgs),
    /// Whether every byte of a record is what was written: checksums, lengths, indexes, statistics, digest
    #[command(
        after_help = "Exits with 0 when it is, with 5 when something is damaged, with 3 when it is only cut.\n\nExample:\n  \
        shoal record verify flock.mcap"
    )]
    Verify(verify::VerifyArgs),
    /// A good record of what is whole in one that was cut or damaged
    #[command(
        after_help = "Everything that was flushed before a cut comes back: at most one simulated second is lost. Around damage, every chunk \
        whose checksum is right; where one changed byte is all, it is put right. The source is never changed.\n\nExits with 0 when nothing \
        is lost, with 3 when something is.\n\nExample:\n  shoal record recover broken.mcap -o good.mcap"
    )]
    Recover(recover::RecoverArgs),
    /// Where two runs part: the first event that differs, by AUV, time and field
    #[command(
        after_help = "Exits with 0 when the runs are equal, with 1 when they differ.\n\nExample:\n  shoal record diff before.mcap after.mcap"
    )]
    Diff(diff::DiffArgs),
}

/// Does it.
pub fn run(command: &RecordCommand) -> Result<Exit, Failure> {
    match command {
        RecordCommand::Info { file, json } => info::info(file, *json),
        RecordCommand::Cat(args) => cat::cat(args),
        RecordCommand::Export(args) => export::export(args),
        RecordCommand::Verify(args) => verify::verify(args),
        RecordCommand::Recover(args) => recover::recover(args),
        RecordCommand::Diff(args) => diff::diff(args),
    }
}
