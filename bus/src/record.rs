//! The run's record: one MCAP file with the truth, what every AUV was told and believed, every ping, and the summary.
//!
//! | topic | schema | encoding | one message holds |
//! |---|---|---|---|
//! | `/auvs` | `shoal.Auvs/1` | JSON | who takes part; once, at time zero |
//! | `/truth` | `foxglove.PosesInFrame` | JSON | for viewers: every AUV's latest true pose, to the millimetre |
//! | `/log` | `foxglove.Log` | JSON | a violated enclosure (error) or a lost AUV (warning) |
//! | `/ticks` | `shoal.Truth/1` | JSON | exact truth at the ticks of one batch |
//! | `/reports` | `shoal.Reports/1` | JSON | what the AUVs answered and believed in one batch |
//! | `/pings` | `shoal.Pings/1` | JSON | what crossed the water in one batch, with its fate |
//! | `/sensed` | `shoal.Sensed/1` | [`SENSED_ENCODING`] | what the AUVs were told in one batch |
//! | `/summary` | `shoal.Summary/1` | JSON | the outcome, without facts of the machine; once, at the end |
//! | `/born` | `shoal.Born/1` | [`SENSED_ENCODING`] | what every AUV was told at birth; once, at time zero |
//! | `/offline` | `shoal.Offline/1` | JSON | trajectories reconstructed after the run in one batch; see [`append_offline`] |
//! | `/flock` | `shoal.Flock/1` | JSON | how the swarm moves and holds together at one whole second |
//!
//! The schemas in `bus/schemas/` describe every field with its unit. A **batch** holds what happened in
//! `(end - 100 ms, end]` of true time; `end` is a multiple of 100 ms and the `log_time` of its messages (nanoseconds of true
//! time). A **chunk** (zstd) holds the batches that end in one simulated second `(k - 1, k]`, less when they exceed 8 MiB,
//! and has reached the operating system before the next second's first batch is written. So the bytes depend on what
//! happened alone: not on windows, wall time, bus or host.
//!
//! The attachment `scenario.toml` is the scenario as it was run; the metadata record `shoal` has `scenario`, `seed`,
//! `auvs` and `format`, and `shoal.outcome`, written at the end, has `digest`, `reproducible`, `checks` and `violations`.

mod batch;
mod channels;
mod chunk;
mod error;
mod foxglove;
mod frames;
mod header;
mod info;
mod layout;
mod read;
mod reader;
mod recover;
mod render;
pub mod rows;
mod scan;
mod topics;
mod verify;
mod write;

pub use error::{Damage, RecordFileError, RecordReadError, RecordWriteError};
pub(crate) use foxglove::PoseBatches;
pub use header::{RecordHeader, RecordedAuv};
pub use info::{Chunks, Containment, RECORD_INFO_FORMAT, RecordInfo, StoredFile, TopicInfo, Truncation};
pub use read::{Row, auvs_of, read_rows, rows_of};
pub use reader::{Found, Message, RecordReader, Wound};
pub use recover::{RecoverError, Recovery, recover};
pub use scan::{Ending, Item, RECORD_LIMIT_BYTES, Source, scan};
pub use topics::{SENSED_ENCODING, Topic};
pub use verify::{Fault, Flip, Verification, verify};
pub use write::{AppendError, RecordWriter, append_offline};

/// Version of the layout of records: the `format` of the metadata record `shoal`.
pub const RECORD_FORMAT: u32 = 1;

/// Simulated nanoseconds that one batch covers.
pub const BATCH_NS: i64 = 100_000_000;

/// Name of the metadata record that names scenario and seed, written first.
const METADATA_RUN: &str = "shoal";

/// Name of the metadata record that holds the digest, written last.
const METADATA_OUTCOME: &str = "shoal.outcome";

/// Name of the metadata record that says what a recovered record has lost.
const METADATA_RECOVERED: &str = "shoal.recovered";

#[cfg(test)]
pub(crate) mod tests;
