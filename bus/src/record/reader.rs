//! Reads a record piece by piece, when the caller asks, and over damage: what printing, comparing and replaying are made of.

use std::collections::BTreeMap;
use std::io::{Read, Seek};

use mcap::parse_record;
use mcap::records::{Record, op};

use super::chunk::Chunk;
use super::frames::{Frames, Step};
use super::{Damage, Ending, METADATA_RUN, RecordReadError, Source, Topic, layout};
use crate::time::SimTime;

/// What comes next in a record.
#[derive(Debug)]
pub enum Found<'a> {
    /// A metadata record.
    Metadata {
        /// Its name.
        name: String,
        /// Its keys and values.
        entries: BTreeMap<String, String>,
    },
    /// An attached file.
    Attachment {
        /// Its name.
        name: String,
        /// Its bytes.
        data: Vec<u8>,
    },
    /// A message.
    Message(Message<'a>),
    /// A part that cannot be read; what follows it may be.
    Damaged(Wound),
}

/// One message of a record.
#[derive(Clone, Copy, Debug)]
pub struct Message<'a> {
    /// Where it comes from.
    pub source: &'a Source,
    /// The topic, when it is one of a record's.
    pub topic: Option<Topic>,
    /// Its log time.
    pub at: SimTime,
    /// Its number, counted over all topics from 0.
    pub sequence: u32,
    /// Its bytes.
    pub data: &'a [u8],
}

/// A part of a file that cannot be read.
#[derive(Debug)]
pub struct Wound {
    /// The first byte of it.
    pub from: u64,
    /// The byte after it.
    pub to: u64,
    /// How the damage shows.
    pub damage: Damage,
}

/// Reads a record from front to back, one thing at a time.
///
/// A chunk is handed over only when its checksum is right. What is damaged is stepped over and told. The footer, the index and the
/// checksum of the whole are not looked at: that is what [`verify`](super::verify) does.
///
/// Memory: one chunk, packed and unpacked, each at most [`RECORD_LIMIT_BYTES`](super::RECORD_LIMIT_BYTES).
///
/// ```
/// use shoal_bus::record::{Ending, Found, RecordHeader, RecordReader, RecordWriter, Topic};
/// let header = RecordHeader { scenario_name: "a".into(), seed: 1, scenario_text: "b".into(), auvs: vec![] };
/// let mut file = Vec::new();
/// drop(RecordWriter::create(&mut file, &header)?);
/// let mut reader = RecordReader::new(std::io::Cursor::new(&file)).unwrap();
/// let mut topics = Vec::new();
/// while let Some(found) = reader.next().unwrap() {
///     if let Found::Message(message) = found {
///         topics.push(message.topic);
///     }
/// }
/// assert_eq!((topics, reader.ending()), (vec![Some(Topic::Auvs)], Ending::Complete));
/// # Ok::<(), shoal_bus::record::RecordWriteError>(())
/// ```
pub struct RecordReader<R> {
    frames: Frames<R>,
    chunk: Chunk,
    /// Where the next record of the open chunk begins, and where the chunk stands in the file.
    inside: Option<(usize, u64, u64)>,
    /// Where the message handed over last stands in it.
    last: Option<usize>,
    channels: Names,
    ending: Ending,
    is_over: bool,
}

/// Where the next thing stands.
enum Place {
    Metadata,
    Attachment,
    Message(usize),
    Damaged(Wound),
    End,
}

impl<R: Read + Seek> RecordReader<R> {
    /// Begins to read.
    ///
    /// # Errors
    /// When the source cannot be read, or is no MCAP file.
    pub fn new(source: R) -> Result<Self, RecordReadError> {
        let mut frames = Frames::new(source).map_err(|source| RecordReadError::Io { offset: 0, source })?;
        if !frames.is_mcap().map_err(|source| RecordReadError::Io { offset: 0, source })? {
            return Err(RecordReadError::NotMcap);
        }
        let ending = Ending::Truncated { readable_bytes: 0 };
        let (chunk, channels) = (Chunk::default(), Names::default());
        Ok(Self { frames, chunk, inside: None, last: None, channels, ending, is_over: false })
    }

    /// The next thing; `None` at the end.
    ///
    /// # Errors
    /// When the source cannot be read.
    #[expect(clippy::should_implement_trait, reason = "what it hands over borrows from the reader")]
    pub fn next(&mut self) -> Result<Option<Found<'_>>, RecordReadError> {
        self.last = None;
        let place = match self.advance()? {
            Place::Damaged(wound) => return Ok(Some(Found::Damaged(wound))),
            Place::End => return Ok(None),
            place => place,
        };
        // What was found parses: that is how it was found.
        Ok(match place {
            Place::Message(at) => {
                self.last = Some(at);
                self.last_message().map(Found::Message)
            }
            Place::Metadata | Place::Attachment => {
                let opcode = if matches!(place, Place::Metadata) { op::METADATA } else { op::ATTACHMENT };
                match parse_record(opcode, self.frames.body()) {
                    Ok(Record::Metadata(metadata)) => {
                        Some(Found::Metadata { name: metadata.name, entries: metadata.metadata })
                    }
                    Ok(Record::Attachment { header, data, .. }) => {
                        Some(Found::Attachment { name: header.name, data: data.into_owned() })
                    }
                    _ => None,
                }
            }
            Place::Damaged(_) | Place::End => None,
        })
    }

    /// The message that [`next`](Self::next) handed over last; `None` once it was something else.
    pub fn last_message(&self) -> Option<Message<'_>> {
        match self.chunk.record_at(self.last?) {
            Ok(Some(within)) => self.channels.message(within.record),
            _ => None,
        }
    }

    /// How the file ends, once [`next`](Self::next) has come to its end.
    pub fn ending(&self) -> Ending {
        self.ending
    }

    fn advance(&mut self) -> Result<Place, RecordReadError> {
        loop {
            if self.is_over {
                return Ok(Place::End);
            }
            if let Some((at, from, to)) = self.inside {
                match self.within(at) {
                    Ok(Some((next, is_message))) => {
                        self.inside = Some((next, from, to));
                        if is_message {
                            return Ok(Place::Message(at));
                        }
                    }
                    Ok(None) => self.inside = None,
                    Err(damage) => {
                        self.inside = None;
                        return Ok(Place::Damaged(Wound { from, to, damage }));
                    }
                }
                continue;
            }
            match self
                .frames
                .next()
                .map_err(|source| RecordReadError::Io { offset: self.frames.size(), source })?
            {
                Step::Frame(frame) => {
                    if let Some(place) = self.open(frame.opcode, frame.offset, frame.end) {
                        return Ok(place);
                    }
                }
                Step::Gap { from, to } => {
                    return Ok(Place::Damaged(Wound { from, to, damage: Damage::NoRecord }));
                }
                Step::Cut { at } => {
                    (self.ending, self.is_over) = (Ending::Truncated { readable_bytes: at }, true);
                }
                Step::End => {
                    self.is_over = true;
                    // Bytes behind the footer, or none at all, are not the end that a writer leaves.
                    self.ending = Ending::Complete;
                }
            }
        }
    }

    /// Takes a record of the file; a place when there is something to hand over.
    fn open(&mut self, opcode: u8, from: u64, to: u64) -> Option<Place> {
        let wound = |damage| Some(Place::Damaged(Wound { from, to, damage }));
        match opcode {
            op::CHUNK => match self.chunk.open(self.frames.body()) {
                Ok(_) => {
                    self.inside = Some((0, from, to));
                    None
                }
                Err(damage) => wound(damage),
            },
            op::METADATA => match parse_record(opcode, self.frames.body()) {
                Ok(Record::Metadata(metadata)) => {
                    if metadata.name == METADATA_RUN {
                        // Its first chunk describes the channels, and may be damaged.
                        self.channels.expect_ours();
                    }
                    Some(Place::Metadata)
                }
                Ok(_) => None,
                Err(error) => wound(error.into()),
            },
            op::ATTACHMENT => match parse_record(opcode, self.frames.body()) {
                Ok(_) => Some(Place::Attachment),
                Err(error) => wound(error.into()),
            },
            // Of others: a file without chunks.
            op::MESSAGE => wound(Damage::Misplaced { kind: layout::name(opcode) }),
            _ => None,
        }
    }

    /// Takes the record at `at` of the open chunk: where the next one is, and whether it is a message.
    fn within(&mut self, at: usize) -> Result<Option<(usize, bool)>, Damage> {
        let Some(within) = self.chunk.record_at(at)? else { return Ok(None) };
        let is_message = match within.record {
            Record::Message { ref header, .. } => {
                self.channels
                    .sources
                    .get(&header.channel_id)
                    .ok_or(Damage::UnknownChannel(header.channel_id))?;
                true
            }
            other => {
                self.channels.take(other);
                false
            }
        };
        Ok(Some((within.end, is_message)))
    }
}

/// Schemas and channels by their numbers.
#[derive(Default)]
struct Names {
    schemas: BTreeMap<u16, String>,
    sources: BTreeMap<u16, (Source, Option<Topic>)>,
}

impl Names {
    /// The channels as every record of ours numbers them.
    fn expect_ours(&mut self) {
        for topic in Topic::ALL {
            let source = Source {
                topic: topic.name().to_owned(),
                schema: topic.schema_name().to_owned(),
                encoding: topic.message_encoding().to_owned(),
            };
            self.sources.entry(topic as u16 + 1).or_insert((source, Some(topic)));
        }
    }

    fn take(&mut self, record: Record<'_>) {
        match record {
            Record::Schema { header, .. } => {
                self.schemas.insert(header.id, header.name);
            }
            Record::Channel(channel) => {
                let schema = self.schemas.get(&channel.schema_id).cloned().unwrap_or_default();
                let source = Source { topic: channel.topic, schema, encoding: channel.message_encoding };
                let topic = Topic::of(&source);
                self.sources.insert(channel.id, (source, topic));
            }
            _ => {}
        }
    }

    fn message<'a>(&'a self, record: Record<'a>) -> Option<Message<'a>> {
        let Record::Message { header, data: std::borrow::Cow::Borrowed(data) } = record else { return None };
        let (source, topic) = self.sources.get(&header.channel_id)?;
        let at = SimTime::from_ns(i64::try_from(header.log_time).unwrap_or(i64::MAX));
        Some(Message { source, topic: *topic, at, sequence: header.sequence, data })
    }
}
