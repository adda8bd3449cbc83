//! Reads an MCAP file from front to back: one chunk in memory at a time, every checksum verified.

use std::collections::BTreeMap;
use std::io::{BufReader, ErrorKind, Read, Seek, SeekFrom};

use mcap::records::Record;
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{MAGIC, McapError, parse_record};

use super::channels::Channels;
use super::{Damage, RecordReadError};
use crate::time::SimTime;

/// No record of a file may be longer, compressed or not: a bound on what a damaged length can make the reader allocate.
pub const RECORD_LIMIT_BYTES: usize = 256 << 20;

/// Bytes asked of the source at a time.
const READ_BYTES: usize = 1 << 20;

/// Opcode and length before every record.
pub(super) const RECORD_HEAD_BYTES: u64 = 9;

/// The record that holds the checksum of the data section.
const DATA_END_BYTES: u64 = 4;

/// Where a message comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    /// Name of the topic.
    pub topic: String,
    /// Name of the schema, empty when there is none.
    pub schema: String,
    /// Encoding of the messages.
    pub encoding: String,
}

/// One thing that stands in a file.
#[derive(Clone, Debug)]
pub enum Item<'a> {
    /// The header of the file.
    Header {
        /// Which library wrote it.
        library: &'a str,
    },
    /// A metadata record.
    Metadata {
        /// Its name.
        name: &'a str,
        /// Its keys and values.
        entries: &'a BTreeMap<String, String>,
    },
    /// An attached file.
    Attachment {
        /// Its name.
        name: &'a str,
        /// Its media type.
        media_type: &'a str,
        /// Its bytes.
        data: &'a [u8],
    },
    /// A chunk begins: its checksum is right, its messages follow.
    Chunk {
        /// Length of its messages as stored.
        compressed_bytes: u64,
        /// Length of its messages as they were.
        uncompressed_bytes: u64,
    },
    /// A topic begins.
    Channel(&'a Source),
    /// A message.
    Message {
        /// Where it comes from.
        source: &'a Source,
        /// Its log time.
        at: SimTime,
        /// Its bytes.
        data: &'a [u8],
    },
}

/// How a file ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// With its footer.
    Complete,
    /// In the middle of a record: the writer died, or the file was cut.
    Truncated {
        /// Whole records reach up to this byte.
        readable_bytes: u64,
    },
}

/// Hands every item of `source` to `visit`, in the order of the file, and tells how the file ends.
///
/// Memory: one record, or one chunk with its decompressed messages, each at most [`RECORD_LIMIT_BYTES`].
///
/// ```
/// use shoal_bus::record::{Item, RecordHeader, RecordWriter, scan};
/// let header = RecordHeader { scenario_name: "a".into(), seed: 1, scenario_text: "b".into(), auvs: vec![] };
/// let mut file = Vec::new();
/// drop(RecordWriter::create(&mut file, &header)?);
/// let mut attached = Vec::new();
/// scan(std::io::Cursor::new(&file), &mut |item| {
///     if let Item::Attachment { name, .. } = item {
///         attached.push(name.to_owned());
///     }
///     Ok(())
/// }).unwrap();
/// assert_eq!(attached, ["scenario.toml"]);
/// # Ok::<(), shoal_bus::record::RecordWriteError>(())
/// ```
///
/// # Errors
/// When the source cannot be read, is no MCAP file, is damaged, or `visit` finds damage in an item. Items before the damage
/// have been handed over by then; those of a damaged chunk have not.
pub fn scan<R: Read + Seek>(
    source: R,
    visit: &mut dyn FnMut(Item<'_>) -> Result<(), Damage>,
) -> Result<Ending, RecordReadError> {
    let mut source = BufReader::with_capacity(64 << 10, source);
    let (size, has_end_mark) = measure(&mut source)?;
    let mut channels = Channels::default();
    let mut reader = LinearReader::new_with_options(
        LinearReaderOptions::default()
            .with_emit_chunks(true)
            .with_validate_data_section_crc(true)
            .with_validate_summary_section_crc(true)
            .with_check_finishes_after_end_magic(true)
            .with_record_length_limit(RECORD_LIMIT_BYTES),
    );
    // Where the record that is being read begins, and how much of the source has been taken.
    let (mut offset, mut taken) = (0, 0);
    // All up to here is framed as it was written: damage that shows later lies behind it.
    let mut sound = 0;
    let mut in_data = true;
    while let Some(event) = reader.next_event() {
        match event {
            Ok(LinearReadEvent::ReadRequest(wanted)) => {
                let read = match source.read(reader.insert(wanted.min(READ_BYTES))) {
                    Ok(read) => read,
                    Err(error) if error.kind() == ErrorKind::Interrupted => continue,
                    Err(source) => return Err(RecordReadError::Io { offset: taken, source }),
                };
                reader.notify_read(read);
                taken += read as u64;
            }
            Ok(LinearReadEvent::Record { opcode, data }) => {
                offset = offset.max(MAGIC.len() as u64);
                let end = offset + RECORD_HEAD_BYTES + data.len() as u64;
                let found = parse_record(opcode, data).map_err(Damage::from);
                in_data &= !matches!(found, Ok(Record::DataEnd(_)));
                let is_snug = matches!(&found, Ok(Record::Chunk { header, data: stored })
                    if stored.len() + chunk_head_bytes(&header.compression) == data.len());
                found
                    .and_then(
                        |record| if in_data { channels.take(record, opcode, data, visit) } else { Ok(()) },
                    )
                    .map_err(|damage| RecordReadError::Damaged { from: sound, to: end, damage })?;
                offset = end;
                if is_snug {
                    sound = end;
                }
            }
            Err(McapError::BadMagic) if offset == 0 => return Err(RecordReadError::NotMcap),
            Err(McapError::UnexpectedEof) if taken < MAGIC.len() as u64 => {
                return Err(RecordReadError::NotMcap);
            }
            Err(McapError::UnexpectedEof) if !has_end_mark => {
                return Ok(Ending::Truncated { readable_bytes: offset.max(MAGIC.len() as u64) });
            }
            Err(error) => {
                // The checksum of the data section covers all that came before it; elsewhere the rest is suspect.
                let (from, to) = match error {
                    McapError::BadDataCrc { .. } => {
                        (0, (offset + RECORD_HEAD_BYTES + DATA_END_BYTES).min(size))
                    }
                    _ => (sound, size),
                };
                return Err(RecordReadError::Damaged { from, to, damage: error.into() });
            }
        }
    }
    Ok(Ending::Complete)
}

/// Length of a chunk record before its messages.
fn chunk_head_bytes(compression: &str) -> usize {
    8 + 8 + 8 + 4 + 4 + compression.len() + 8
}

/// Length of the source, and whether it ends as a complete file does.
fn measure<R: Read + Seek>(source: &mut R) -> Result<(u64, bool), RecordReadError> {
    let mut measure = || {
        let size = source.seek(SeekFrom::End(0))?;
        let mut tail = [0; MAGIC.len()];
        let tail_at = size.saturating_sub(tail.len() as u64);
        if tail_at >= tail.len() as u64 {
            source.seek(SeekFrom::Start(tail_at))?;
            source.read_exact(&mut tail)?;
        }
        source.seek(SeekFrom::Start(0))?;
        Ok((size, tail == MAGIC))
    };
    measure().map_err(|source| RecordReadError::Io { offset: 0, source })
}
