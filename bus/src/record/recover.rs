//! Makes a good record of one that was cut or damaged.

mod patched;

use std::io::{Read, Seek, Write};

use mcap::records::{Metadata, Record, op};
use mcap::write::NoSeek;
use mcap::{Attachment, parse_record};
use thiserror::Error;

use super::chunk::Chunk;
use super::frames::{Frames, Step};
use super::write::options;
use super::{
    Damage, Ending, Flip, METADATA_RECOVERED, METADATA_RUN, RecordReadError, RecordWriteError, Topic, Wound,
    verify,
};
use crate::time::SimTime;
use patched::Patched;

/// What became of a record.
#[derive(Debug)]
pub struct Recovery {
    /// How the source ends.
    pub ending: Ending,
    /// Length of the source.
    pub source_bytes: u64,
    /// The one byte that was changed in it, when that could be told and undone: then nothing is lost.
    pub repaired: Option<Flip>,
    /// What could not be read of it, in the order of the file. What a cut took away is not among it.
    pub lost: Vec<Wound>,
    /// Chunks that were copied.
    pub chunks: u64,
    /// Messages that were copied.
    pub messages: u64,
    /// Log time of the last of them.
    pub until: Option<SimTime>,
    /// Whether the copy says how the run ended.
    pub has_outcome: bool,
}

impl Recovery {
    /// Whether the copy holds everything that the source did when it was written.
    pub fn is_complete(&self) -> bool {
        self.lost.is_empty() && self.ending == Ending::Complete
    }
}

/// Why a record cannot be recovered.
#[derive(Debug, Error)]
pub enum RecoverError {
    /// The source cannot be read.
    #[error(transparent)]
    Read(#[from] RecordReadError),
    /// There is nothing in it.
    #[error("nothing can be recovered: the file ends, or is damaged, before it says of which run it is")]
    Nothing,
    /// The copy cannot be written.
    #[error(transparent)]
    Write(#[from] RecordWriteError),
}

/// Copies what is whole of the record in `source` to `writer`, as a complete file that verifies: everything that had been flushed before
/// a cut, and around damage every chunk whose checksum is right. When all that is wrong is one changed byte, and the checksums say
/// which, it is put right.
///
/// The copy of an undamaged record is that record, byte for byte. When something is missing from the copy, its metadata record
/// `shoal.recovered` says what.
///
/// Memory: one chunk, and what an index says of each.
///
/// ```
/// use shoal_bus::record::{RecordHeader, RecordWriter, recover, verify};
/// use std::io::Cursor;
/// let header = RecordHeader { scenario_name: "a".into(), seed: 1, scenario_text: "b".into(), auvs: vec![] };
/// let mut file = Vec::new();
/// drop(RecordWriter::create(&mut file, &header)?);
/// let mut copy = Vec::new();
/// recover(Cursor::new(&file[..file.len() / 2]), &mut copy).unwrap();
/// assert!(verify(Cursor::new(&copy), &mut |_| {}).unwrap().is_whole());
/// # Ok::<(), shoal_bus::record::RecordWriteError>(())
/// ```
///
/// # Errors
/// When the source cannot be read, is no MCAP file, or has no whole beginning of a record; when `writer` does not take the bytes.
pub fn recover<R: Read + Seek, W: Write>(mut source: R, writer: W) -> Result<Recovery, RecoverError> {
    let repaired = repairable(&mut source)?;
    match repaired {
        Some(flip) => copy(Patched::new(source, flip), writer, repaired),
        None => copy(source, writer, None),
    }
}

/// The byte that, changed back, makes a whole record of the source.
fn repairable<R: Read + Seek>(source: &mut R) -> Result<Option<Flip>, RecoverError> {
    let found = match verify(&mut *source, &mut |_| {}) {
        Ok(found) => found,
        Err(error @ RecordReadError::Io { .. }) => return Err(error.into()),
        // What it lacks, copying says.
        Err(_) => return Ok(None),
    };
    let Some(flip) = found.faults.iter().find_map(|fault| fault.flip) else { return Ok(None) };
    let patched = verify(Patched::new(source, flip), &mut |_| {});
    Ok(patched.is_ok_and(|patched| patched.is_whole()).then_some(flip))
}

fn copy<R: Read + Seek, W: Write>(
    source: R,
    writer: W,
    repaired: Option<Flip>,
) -> Result<Recovery, RecoverError> {
    let io = |source| RecordReadError::Io { offset: 0, source };
    let mut frames = Frames::new(source).map_err(io)?;
    if !frames.is_mcap().map_err(io)? {
        return Err(RecordReadError::NotMcap.into());
    }
    let mut copy = Copy::new(writer, frames.size(), repaired)?;
    let mut is_data = true;
    copy.recovery.ending = loop {
        match frames.next().map_err(io)? {
            Step::Frame(frame) => match frame.opcode {
                op::DATA_END | op::STATISTICS | op::CHUNK_INDEX | op::FOOTER => is_data = false,
                _ if is_data => {
                    if let Err(damage) = copy.take(frame.opcode, frames.body())? {
                        copy.recovery.lost.push(Wound { from: frame.offset, to: frame.end, damage });
                    }
                }
                _ => {}
            },
            // The magic is written anew, and so is the summary.
            Step::Gap { from, to } if is_data && from > 0 => {
                copy.recovery.lost.push(Wound { from, to, damage: Damage::NoRecord });
            }
            Step::Gap { .. } => {}
            Step::Cut { at } if is_data => break Ending::Truncated { readable_bytes: at },
            // All of the data is there.
            Step::Cut { .. } | Step::End => break Ending::Complete,
        }
    };
    copy.finish()
}

struct Copy<W: Write> {
    mcap: mcap::Writer<NoSeek<W>>,
    chunk: Chunk,
    is_record: bool,
    /// What the source says that it has lost itself.
    lost_before: Option<String>,
    recovery: Recovery,
}

impl<W: Write> Copy<W> {
    fn new(writer: W, source_bytes: u64, repaired: Option<Flip>) -> Result<Self, RecordWriteError> {
        let recovery = Recovery {
            ending: Ending::Complete,
            source_bytes,
            repaired,
            lost: Vec::new(),
            chunks: 0,
            messages: 0,
            until: None,
            has_outcome: false,
        };
        // Chunks end where those of the source do.
        let mcap = options(None).create(NoSeek::new(writer))?;
        Ok(Self { mcap, chunk: Chunk::default(), is_record: false, lost_before: None, recovery })
    }

    /// Copies one record of the data section, or tells why it cannot be.
    fn take(&mut self, opcode: u8, body: &[u8]) -> Result<Result<(), Damage>, RecordWriteError> {
        match opcode {
            op::CHUNK => return self.take_chunk(body),
            op::METADATA | op::ATTACHMENT => match parse_record(opcode, body) {
                Ok(Record::Metadata(metadata)) => self.take_metadata(metadata)?,
                Ok(Record::Attachment { header, data, .. }) => self.mcap.attach(&Attachment {
                    log_time: header.log_time,
                    create_time: header.create_time,
                    name: header.name,
                    media_type: header.media_type,
                    data,
                })?,
                Ok(_) => {}
                Err(error) => return Ok(Err(error.into())),
            },
            // Those are written anew.
            op::HEADER | op::MESSAGE_INDEX => {}
            other => return Ok(Err(Damage::Misplaced { kind: super::layout::name(other) })),
        }
        Ok(Ok(()))
    }

    fn take_metadata(&mut self, mut metadata: Metadata) -> Result<(), RecordWriteError> {
        match metadata.name.as_str() {
            METADATA_RECOVERED => {
                self.lost_before = metadata.metadata.remove("lost");
                return Ok(());
            }
            METADATA_RUN => self.is_record = true,
            super::METADATA_OUTCOME => self.recovery.has_outcome = true,
            _ => {}
        }
        Ok(self.mcap.write_metadata(&metadata)?)
    }

    fn take_chunk(&mut self, body: &[u8]) -> Result<Result<(), Damage>, RecordWriteError> {
        if let Err(damage) = self.chunk.open(body).and_then(|_| self.is_readable()) {
            return Ok(Err(damage));
        }
        let mut at = 0;
        // It has been read once: all of it is there.
        while let Ok(Some(within)) = self.chunk.record_at(at) {
            at = within.end;
            match within.record {
                Record::Schema { header, data } => {
                    self.mcap.add_schema_with_id(header.id, &header.name, &header.encoding, &data)?;
                }
                Record::Channel(channel) => {
                    let (topic, encoding) = (&channel.topic, &channel.message_encoding);
                    self.mcap.add_channel_with_id(
                        channel.id,
                        channel.schema_id,
                        topic,
                        encoding,
                        &channel.metadata,
                    )?;
                }
                Record::Message { header, data } => {
                    if self.mcap.write_to_known_channel(&header, &data).is_err() {
                        // The chunk that describes the channels is lost. Every record of ours has these.
                        describe(&mut self.mcap)?;
                        self.mcap.write_to_known_channel(&header, &data)?;
                    }
                    self.recovery.messages += 1;
                    let time = SimTime::from_ns(i64::try_from(header.log_time).unwrap_or(i64::MAX));
                    self.recovery.until = self.recovery.until.max(Some(time));
                }
                _ => {}
            }
        }
        self.recovery.chunks += 1;
        self.mcap.flush()?;
        Ok(Ok(()))
    }

    /// Whether all of the open chunk can be copied.
    fn is_readable(&self) -> Result<(), Damage> {
        let mut at = 0;
        let mut described = Vec::new();
        while let Some(within) = self.chunk.record_at(at)? {
            at = within.end;
            match within.record {
                Record::Channel(channel) => described.push(channel.id),
                Record::Message { header, .. } => {
                    let id = header.channel_id;
                    let is_ours = (1..=Topic::ALL.len() as u16).contains(&id);
                    if !is_ours && !described.contains(&id) {
                        return Err(Damage::UnknownChannel(id));
                    }
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn finish(mut self) -> Result<Recovery, RecoverError> {
        if !self.is_record {
            return Err(RecoverError::Nothing);
        }
        let lost = self.recovery.in_words().into_iter().chain(self.lost_before.take());
        let lost: Vec<String> = lost.collect();
        if !lost.is_empty() {
            let metadata = [("lost".to_owned(), lost.join("; "))].into();
            let metadata = Metadata { name: METADATA_RECOVERED.to_owned(), metadata };
            self.mcap.write_metadata(&metadata).map_err(RecordWriteError::from)?;
        }
        self.mcap.finish().map_err(RecordWriteError::from)?;
        self.mcap.into_inner().into_inner().flush().map_err(RecordWriteError::from)?;
        Ok(self.recovery)
    }
}

impl Recovery {
    /// What is missing from the copy; `None` when nothing is.
    pub fn in_words(&self) -> Option<String> {
        let mut words: Vec<String> = self
            .lost
            .iter()
            .map(|Wound { from, to, damage }| format!("bytes {from} to {to} ({damage})"))
            .collect();
        if let Ending::Truncated { readable_bytes } = self.ending {
            words.push(format!("everything behind byte {readable_bytes}, where the file was cut"));
        }
        (!words.is_empty()).then(|| words.join("; "))
    }
}

/// Describes the topics as every record of ours does, where it is not done yet.
fn describe<W: Write>(mcap: &mut mcap::Writer<NoSeek<W>>) -> Result<(), RecordWriteError> {
    for topic in Topic::ALL {
        let id = topic as u16 + 1;
        let text = topic.schema_text().as_bytes();
        mcap.add_schema_with_id(id, topic.schema_name(), topic.schema_encoding(), text)?;
        mcap.add_channel_with_id(id, id, topic.name(), topic.message_encoding(), &Default::default())?;
    }
    Ok(())
}
