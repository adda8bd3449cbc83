//! The data section: header, metadata, attachments, chunks with their message indexes.

use std::collections::BTreeMap;

use mcap::parse_record;
use mcap::records::{ChunkHeader, ChunkIndex, MessageIndex, MessageIndexEntry, Record, Statistics, op};

use super::super::chunk::Chunk;
use super::super::frames::Frame;
use super::super::{Damage, Row, layout};
use super::{Fault, Meaning};

/// What was read of the data section, for the summary section to be compared with.
#[derive(Default)]
pub(super) struct Data {
    pub(super) chunks: u64,
    pub(super) messages: u64,
    pub(super) meaning: Meaning,
    /// Checksums of the schemas and channels, by opcode and number.
    pub(super) described: BTreeMap<(u8, u16), u32>,
    /// Where a chunk, an attachment or a metadata record begins, and the checksum of what the index must say of it; none when it is damaged.
    pub(super) indexed: Vec<(u64, Option<u32>)>,
    /// Chunks with their message indexes, from and to, of which every byte is accounted for.
    pub(super) sound: Vec<(u64, u64)>,
    /// What the statistics must say.
    pub(super) statistics: Statistics,
    topics: BTreeMap<u16, String>,
    chunk: Chunk,
    open: Option<OpenChunk>,
    first: bool,
}

/// A chunk whose message indexes are to follow.
struct OpenChunk {
    frame: Frame,
    /// Absent when the chunk is damaged: this is the fault.
    header: Result<ChunkHeader, usize>,
    /// What the indexes must say, by channel.
    expected: BTreeMap<u16, Vec<MessageIndexEntry>>,
    /// Where the indexes begin.
    offsets: BTreeMap<u16, u64>,
    /// The byte after the last of them.
    end: u64,
    is_sound: bool,
}

impl Data {
    /// Log time of the last message.
    pub(super) fn until_s(&self) -> Option<f64> {
        (self.messages > 0).then(|| seconds(self.statistics.message_end_time))
    }

    /// Takes one record.
    pub(super) fn take(
        &mut self,
        frame: &Frame,
        body: &[u8],
        faults: &mut Vec<Fault>,
        visit: &mut dyn FnMut(Row),
    ) {
        if frame.opcode == op::MESSAGE_INDEX {
            return self.take_index(frame, body, faults);
        }
        self.end_chunk(faults);
        let is_first = !std::mem::replace(&mut self.first, true);
        if (frame.opcode == op::HEADER) != is_first {
            faults.push(Fault::new(frame, Damage::Misplaced { kind: layout::name(frame.opcode) }));
        }
        match frame.opcode {
            op::HEADER => {
                if let Err(error) = parse_record(frame.opcode, body) {
                    faults.push(Fault::new(frame, error.into()));
                }
            }
            op::CHUNK => self.take_chunk(frame, body, faults, visit),
            op::METADATA | op::ATTACHMENT => match parse_record(frame.opcode, body) {
                Ok(Record::Metadata(metadata)) => {
                    self.statistics.metadata_count += 1;
                    let sum = of_metadata(frame.offset, frame.end - frame.offset, &metadata.name);
                    self.indexed.push((frame.offset, Some(sum)));
                    self.meaning.take_metadata(&metadata.name, metadata.metadata);
                }
                Ok(Record::Attachment { header, data, .. }) => {
                    self.statistics.attachment_count += 1;
                    let (length, size) = (frame.end - frame.offset, data.len() as u64);
                    let times = [header.log_time, header.create_time];
                    let sum =
                        of_attachment(frame.offset, length, times, size, &header.name, &header.media_type);
                    self.indexed.push((frame.offset, Some(sum)));
                    self.meaning.take_attachment(&header.name, &data);
                }
                Ok(_) => {}
                Err(error) => {
                    self.indexed.push((frame.offset, None));
                    faults.push(Fault::new(frame, error.into()));
                }
            },
            _ if is_first => {}
            _ => faults.push(Fault::new(frame, Damage::Misplaced { kind: layout::name(frame.opcode) })),
        }
    }

    fn take_chunk(
        &mut self,
        frame: &Frame,
        body: &[u8],
        faults: &mut Vec<Fault>,
        visit: &mut dyn FnMut(Row),
    ) {
        let mut expected = BTreeMap::new();
        let opened = self.chunk.open(body).and_then(|header| {
            let times = self.take_messages(frame, &mut expected, visit)?;
            Ok((header, times))
        });
        let mut are_true = true;
        let header = match opened {
            Ok((header, times)) => {
                self.chunks += 1;
                self.statistics.chunk_count += 1;
                if (header.message_start_time, header.message_end_time) != times {
                    let damage =
                        Damage::Untrue { what: "times of a chunk", says: "are not those of its messages" };
                    faults.push(Fault::new(frame, damage));
                    are_true = false;
                }
                Ok(header)
            }
            Err(damage) => {
                let mut fault = Fault::new(frame, damage);
                if let Ok(Record::Chunk { header, .. }) = parse_record(op::CHUNK, body) {
                    fault.time_s =
                        Some([seconds(header.message_start_time), seconds(header.message_end_time)]);
                }
                faults.push(fault);
                Err(faults.len() - 1)
            }
        };
        let (offsets, end) = (BTreeMap::new(), frame.end);
        let is_sound = header.is_ok() && are_true && !frame.is_bent;
        self.open = Some(OpenChunk { frame: *frame, header, expected, offsets, end, is_sound });
    }

    /// Takes the records of the open chunk. First and last log time, zeros without messages.
    fn take_messages(
        &mut self,
        frame: &Frame,
        expected: &mut BTreeMap<u16, Vec<MessageIndexEntry>>,
        visit: &mut dyn FnMut(Row),
    ) -> Result<(u64, u64), Damage> {
        let mut times: Option<(u64, u64)> = None;
        let mut at = 0;
        while let Some(within) = self.chunk.record_at(at)? {
            at = within.end;
            match within.record {
                Record::Message { header, data } => {
                    let id = header.channel_id;
                    let topic = self.topics.get(&id).ok_or(Damage::UnknownChannel(id))?;
                    self.messages += 1;
                    let (time, offset) = (header.log_time, within.offset as u64);
                    times =
                        Some(times.map_or((time, time), |(first, last)| (first.min(time), last.max(time))));
                    expected.entry(id).or_default().push(MessageIndexEntry { log_time: time, offset });
                    *self.statistics.channel_message_counts.entry(id).or_default() += 1;
                    let stated = &mut self.statistics;
                    stated.message_start_time =
                        if stated.message_count == 0 { time } else { stated.message_start_time.min(time) };
                    stated.message_end_time = stated.message_end_time.max(time);
                    stated.message_count += 1;
                    self.meaning.take_message(topic, &header, &data, frame, visit)?;
                }
                Record::Schema { header, data } => {
                    let sum = of_schema(&header.name, &header.encoding, &data);
                    let is_new = self.described.insert((op::SCHEMA, header.id), sum).is_none();
                    self.statistics.schema_count += u16::from(is_new);
                }
                Record::Channel(channel) => {
                    if self.described.insert((op::CHANNEL, channel.id), of_channel(&channel)).is_none() {
                        self.statistics.channel_count += 1;
                    }
                    self.topics.insert(channel.id, channel.topic);
                }
                _ => {}
            }
        }
        Ok(times.unwrap_or_default())
    }

    /// Takes an index of the messages of the chunk before it.
    fn take_index(&mut self, frame: &Frame, body: &[u8], faults: &mut Vec<Fault>) {
        let untrue = Damage::Untrue { what: "index of a chunk's messages", says: "does not lead to them" };
        let Some(open) = &mut self.open else {
            faults.push(Fault::new(frame, Damage::Misplaced { kind: layout::name(frame.opcode) }));
            return;
        };
        open.end = frame.end;
        let index = match parse_record(frame.opcode, body) {
            Ok(Record::MessageIndex(index)) => index,
            Ok(_) => return,
            Err(error) => {
                open.is_sound = false;
                faults.push(Fault::new(frame, error.into()));
                return;
            }
        };
        let MessageIndex { channel_id, records } = index;
        open.offsets.insert(channel_id, frame.offset);
        match open.header {
            // All that can be said of the messages of a damaged chunk.
            Err(fault) => {
                if let (Some(fault), Some(topic)) = (faults.get_mut(fault), self.topics.get(&channel_id)) {
                    fault.topics.push(topic.clone());
                }
            }
            Ok(_) if open.expected.remove(&channel_id).is_some_and(|expected| expected == records) => {}
            Ok(_) => {
                open.is_sound = false;
                faults.push(Fault::new(frame, untrue));
            }
        }
    }

    /// All indexes of the open chunk, if there is one, have come.
    pub(super) fn end_chunk(&mut self, faults: &mut Vec<Fault>) {
        let Some(open) = self.open.take() else { return };
        let OpenChunk { frame, header, expected, offsets, end, is_sound } = open;
        let expected_sum = header.ok().filter(|_| is_sound).map(|header| {
            of_chunk(&ChunkIndex {
                message_start_time: header.message_start_time,
                message_end_time: header.message_end_time,
                chunk_start_offset: frame.offset,
                chunk_length: frame.end - frame.offset,
                message_index_offsets: offsets,
                message_index_length: end - frame.end,
                compression: header.compression,
                compressed_size: header.compressed_size,
                uncompressed_size: header.uncompressed_size,
            })
        });
        self.indexed.push((frame.offset, expected_sum));
        if is_sound && expected.is_empty() {
            match self.sound.last_mut() {
                Some((_, to)) if *to == frame.offset => *to = end,
                _ => self.sound.push((frame.offset, end)),
            }
        }
        // In a file that was cut, or where something is known to be wrong, that is why.
        if is_sound && !expected.is_empty() {
            let damage = Damage::Untrue { what: "index of a chunk's messages", says: "is missing" };
            faults.push(Fault::at(frame.offset, end, "message index", damage));
        }
    }
}

/// Simulated seconds of a log time.
fn seconds(log_time: u64) -> f64 {
    log_time as f64 * 1e-9
}

/// A checksum over parts, each with its length.
fn sum(parts: &[&[u8]]) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    for part in parts {
        hasher.update(&(part.len() as u64).to_le_bytes());
        hasher.update(part);
    }
    hasher.finalize()
}

/// What an index says of a chunk.
pub(super) fn of_chunk(index: &ChunkIndex) -> u32 {
    let mut numbers = vec![
        index.message_start_time,
        index.message_end_time,
        index.chunk_start_offset,
        index.chunk_length,
        index.message_index_length,
        index.compressed_size,
        index.uncompressed_size,
    ];
    numbers.extend(index.message_index_offsets.iter().flat_map(|(id, at)| [u64::from(*id), *at]));
    sum(&[&bytes(&numbers), index.compression.as_bytes()])
}

/// What an index says of a metadata record.
pub(super) fn of_metadata(offset: u64, length: u64, name: &str) -> u32 {
    sum(&[&bytes(&[offset, length]), name.as_bytes()])
}

/// What an index says of an attachment.
pub(super) fn of_attachment(
    offset: u64,
    length: u64,
    [log_time, create_time]: [u64; 2],
    size: u64,
    name: &str,
    media_type: &str,
) -> u32 {
    let numbers = bytes(&[offset, length, log_time, create_time, size]);
    sum(&[&numbers, name.as_bytes(), media_type.as_bytes()])
}

/// A schema.
pub(super) fn of_schema(name: &str, encoding: &str, data: &[u8]) -> u32 {
    sum(&[name.as_bytes(), encoding.as_bytes(), data])
}

/// A channel.
pub(super) fn of_channel(channel: &mcap::records::Channel) -> u32 {
    let schema = channel.schema_id.to_le_bytes();
    let mut parts: Vec<&[u8]> = vec![&schema, channel.topic.as_bytes(), channel.message_encoding.as_bytes()];
    parts.extend(channel.metadata.iter().flat_map(|(key, value)| [key.as_bytes(), value.as_bytes()]));
    sum(&parts)
}

fn bytes(numbers: &[u64]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}
