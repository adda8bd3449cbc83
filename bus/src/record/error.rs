//! Why a record cannot be written or read.

use std::io;
use std::path::PathBuf;

use mcap::McapError;
use thiserror::Error;

use crate::codec::CodecError;
use crate::message::AuvId;
use crate::time::SimTime;

/// Why a record cannot be written.
#[derive(Debug, Error)]
pub enum RecordWriteError {
    /// The destination does not take the bytes.
    #[error("the record cannot be written: {0}")]
    Io(#[from] io::Error),
    /// The container refuses a message.
    #[error("the record cannot be written: {0}")]
    Mcap(McapError),
    /// A message cannot be encoded.
    #[error("the record cannot hold what AUV {auv} was told: {source}")]
    Encode {
        /// Who was told.
        auv: AuvId,
        /// What is wrong with it.
        source: CodecError,
    },
    /// A message cannot be put into JSON.
    #[error("the record cannot hold a message: {0}")]
    Json(#[from] serde_json::Error),
    /// An entry came too late: a fault of the caller.
    #[error(
        "an entry at {at} s came after the record had reached {reached} s: entries must be sorted by time"
    )]
    OutOfOrder {
        /// True time of the entry.
        at: SimTime,
        /// Time that the record had reached.
        reached: SimTime,
    },
    /// An entry of an AUV that the header does not name: a fault of the caller.
    #[error("an entry is about AUV {auv}, but the record's header names {auvs} AUVs, counted from 0")]
    UnknownAuv {
        /// Who is unknown.
        auv: AuvId,
        /// How many AUVs the header names.
        auvs: usize,
    },
}

impl From<McapError> for RecordWriteError {
    /// An I/O error inside the container is an I/O error.
    fn from(error: McapError) -> Self {
        match error {
            McapError::Io(source) => Self::Io(source),
            other => Self::Mcap(other),
        }
    }
}

/// Why a record cannot be read. A file that merely ends too early is no error, see [`Ending`](crate::record::Ending).
#[derive(Debug, Error)]
pub enum RecordReadError {
    /// The source does not give its bytes.
    #[error("cannot read at byte {offset}: {source}")]
    Io {
        /// Where.
        offset: u64,
        /// The operating system's reason.
        source: io::Error,
    },
    /// Some other kind of file.
    #[error("this is not an MCAP file: it does not begin with the MCAP magic bytes")]
    NotMcap,
    /// Some other MCAP file.
    #[error("this MCAP file is not the record of a run: it has no metadata record `{}`", super::METADATA_RUN)]
    NotARecord,
    /// A record of another version.
    #[error(
        "this record has format {found}, and this version of shoal reads format {}",
        super::RECORD_FORMAT
    )]
    UnknownFormat {
        /// Version of its layout.
        found: u32,
    },
    /// The bytes are not those that were written.
    #[error("damaged between bytes {from} and {to}: {damage}")]
    Damaged {
        /// First byte of the part that is damaged.
        from: u64,
        /// Byte after the part that is damaged.
        to: u64,
        /// How the damage shows.
        damage: Damage,
    },
}

/// How damage shows.
#[derive(Debug, Error)]
pub enum Damage {
    /// A checksum does not match.
    #[error("the checksum of the {part} does not match")]
    Checksum {
        /// What the checksum covers: a chunk, an attachment, the data section or the summary section.
        part: &'static str,
    },
    /// A record's stated length reaches beyond the end of a file that has its end mark.
    #[error("a record reaches beyond the end of the file")]
    Overlong,
    /// A record is longer than any honest one.
    #[error("a record claims to be longer than {} MiB", super::RECORD_LIMIT_BYTES >> 20)]
    TooLarge,
    /// A message belongs to no topic.
    #[error("a message names channel {0}, which the record does not describe")]
    UnknownChannel(u16),
    /// A record stands where its kind has no business.
    #[error("a record of the kind `{kind}` stands where none belongs")]
    Misplaced {
        /// Its kind.
        kind: &'static str,
    },
    /// The length before a record is not that of what follows.
    #[error("the length of a {kind} is not that of what is in it")]
    Length {
        /// The kind of the record.
        kind: &'static str,
    },
    /// Bytes that are no record.
    #[error("no record can be found here")]
    NoRecord,
    /// A chunk cannot be unpacked.
    #[error("a chunk cannot be unpacked: {0}")]
    Unpack(io::Error),
    /// A chunk is packed in a way that this version does not know.
    #[error("a chunk is packed with `{0}`, and this version of shoal unpacks `zstd`")]
    Compression(String),
    /// A chunk unpacks to another length than it says.
    #[error("a chunk says that it unpacks to {stated} bytes, and unpacks to {found} or more")]
    UnpackedLength {
        /// The length that it states.
        stated: u64,
        /// The length that was found.
        found: u64,
    },
    /// Something that says what stands elsewhere says it wrongly.
    #[error("the {what} {says}")]
    Untrue {
        /// What is wrong.
        what: &'static str,
        /// What it does not agree with, as a clause.
        says: &'static str,
    },
    /// A chunk holds a chunk.
    #[error("a chunk stands inside a chunk")]
    NestedChunk,
    /// The summary of the run is not one.
    #[error("the run's summary is malformed: {0}")]
    Summary(serde_json::Error),
    /// The rows of a message are not those that its schema describes.
    #[error("a message of {topic} is malformed: {source}")]
    Rows {
        /// The topic.
        topic: &'static str,
        /// What is wrong with it.
        source: serde_json::Error,
    },
    /// A message is not one that its schema describes.
    #[error("a message of {topic} is malformed: {source}")]
    Message {
        /// The topic.
        topic: &'static str,
        /// What is wrong with it.
        source: CodecError,
    },
    /// A record cannot be parsed.
    #[error("a record is malformed: {0}")]
    Structure(McapError),
}

impl From<McapError> for Damage {
    fn from(error: McapError) -> Self {
        match error {
            McapError::BadChunkCrc { .. } => Self::Checksum { part: "chunk" },
            McapError::BadAttachmentCrc { .. } => Self::Checksum { part: "attachment" },
            McapError::BadDataCrc { .. } => Self::Checksum { part: "data section" },
            McapError::BadSummaryCrc { .. } => Self::Checksum { part: "summary section" },
            McapError::UnexpectedEof => Self::Overlong,
            McapError::RecordTooLarge { .. } | McapError::ChunkTooLarge(_) => Self::TooLarge,
            other => Self::Structure(other),
        }
    }
}

/// Why the record at a path cannot be read.
#[derive(Debug, Error)]
#[error("{}: {source}", path.display())]
pub struct RecordFileError {
    /// Which file.
    pub path: PathBuf,
    /// What is wrong with it.
    pub source: RecordReadError,
}
