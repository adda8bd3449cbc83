//! What a record holds, for `shoal record info`.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::scan::{Ending, Item, scan};
use super::{Damage, METADATA_RUN, RecordFileError, RecordReadError, Topic};

/// Format tag of [`RecordInfo`].
pub const RECORD_INFO_FORMAT: &str = "shoal.record_info/1";

/// What a record holds; `None` stands for what the file does not say. Prints as a table for people.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RecordInfo {
    /// [`RECORD_INFO_FORMAT`].
    pub format: String,
    /// Length of the file.
    pub file_bytes: u64,
    /// What wrote the file.
    pub library: String,
    /// Version of the record's layout, see [`RECORD_FORMAT`](super::RECORD_FORMAT); `None` for an MCAP file that is no record.
    pub record_format: Option<u32>,
    /// Name of the scenario.
    pub scenario: Option<String>,
    /// Seed of every random draw.
    pub seed: Option<u64>,
    /// Number of AUVs.
    pub auvs: Option<u32>,
    /// Log time of the earliest message, in simulated seconds.
    pub first_s: Option<f64>,
    /// Log time of the latest message, in simulated seconds.
    pub last_s: Option<f64>,
    /// The topics, by name; those without messages too.
    pub topics: Vec<TopicInfo>,
    /// The chunks.
    pub chunks: Chunks,
    /// The attached files, in the order of the file.
    pub attachments: Vec<StoredFile>,
    /// Hash of everything that happened; `None` without a summary.
    pub digest: Option<String>,
    /// Whether scenario and seed determine the digest; `None` without a summary.
    pub reproducible: Option<bool>,
    /// Whether every enclosure held the truth; `None` without a summary.
    pub containment: Option<Containment>,
    /// How far a file without footer can be read; `None` for a complete file.
    pub truncated: Option<Truncation>,
}

/// One topic of a record.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TopicInfo {
    /// Its name.
    pub topic: String,
    /// Name of its schema.
    pub schema: String,
    /// Encoding of its messages.
    pub encoding: String,
    /// Number of messages.
    pub messages: u64,
    /// Bytes of the messages, uncompressed.
    pub bytes: u64,
}

/// The chunks of a record.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Chunks {
    /// How many.
    pub count: u64,
    /// Their bytes as stored.
    pub compressed_bytes: u64,
    /// Their bytes as they were.
    pub uncompressed_bytes: u64,
    /// `uncompressed_bytes / compressed_bytes`; `None` without chunks.
    pub compression_ratio: Option<f64>,
}

/// A file attached to a record.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct StoredFile {
    /// Its name.
    pub name: String,
    /// Its media type.
    pub media_type: String,
    /// Its length.
    pub bytes: u64,
}

/// The proof, in two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Containment {
    /// Enclosures compared with the truth.
    pub checks: u64,
    /// Those that did not hold it.
    pub violations: u64,
}

/// How far a file without footer can be read.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Truncation {
    /// Whole records reach up to this byte.
    pub readable_bytes: u64,
    /// Log time of the last message in them, in simulated seconds; `None` without messages.
    pub readable_until_s: Option<f64>,
}

impl RecordInfo {
    /// Reads the record at `path`.
    ///
    /// # Errors
    /// As [`read`](Self::read), with the path.
    pub fn open(path: &Path) -> Result<Self, RecordFileError> {
        File::open(path)
            .map_err(|source| RecordReadError::Io { offset: 0, source })
            .and_then(Self::read)
            .map_err(|source| RecordFileError { path: path.to_owned(), source })
    }

    /// Reads a record from front to back and verifies every checksum. Memory does not grow with the file.
    ///
    /// Any MCAP file will do: what only a record says is `None` for others. A file that ends too early is read as far as it
    /// goes, see [`truncated`](Self::truncated).
    ///
    /// ```
    /// use shoal_bus::record::{RecordInfo, RecordReadError};
    /// let text = std::io::Cursor::new("some text");
    /// assert!(matches!(RecordInfo::read(text), Err(RecordReadError::NotMcap)));
    /// ```
    ///
    /// # Errors
    /// When `source` cannot be read, is no MCAP file, or is damaged.
    pub fn read<R: Read + Seek>(mut source: R) -> Result<Self, RecordReadError> {
        let file_bytes =
            source.seek(SeekFrom::End(0)).map_err(|source| RecordReadError::Io { offset: 0, source })?;
        let mut info = Self::empty(file_bytes);
        let mut topics = BTreeMap::new();
        let ending = scan(source, &mut |item| info.take(item, &mut topics))?;
        info.topics = topics.into_values().collect();
        let Chunks { compressed_bytes, uncompressed_bytes, .. } = info.chunks;
        info.chunks.compression_ratio =
            (compressed_bytes > 0).then(|| uncompressed_bytes as f64 / compressed_bytes as f64);
        if let Ending::Truncated { readable_bytes } = ending {
            info.truncated = Some(Truncation { readable_bytes, readable_until_s: info.last_s });
        }
        Ok(info)
    }

    fn empty(file_bytes: u64) -> Self {
        Self {
            format: RECORD_INFO_FORMAT.to_owned(),
            file_bytes,
            library: String::new(),
            record_format: None,
            scenario: None,
            seed: None,
            auvs: None,
            first_s: None,
            last_s: None,
            topics: Vec::new(),
            chunks: Chunks::default(),
            attachments: Vec::new(),
            digest: None,
            reproducible: None,
            containment: None,
            truncated: None,
        }
    }

    fn take(&mut self, item: Item<'_>, topics: &mut BTreeMap<String, TopicInfo>) -> Result<(), Damage> {
        match item {
            Item::Header { library } => self.library = library.to_owned(),
            Item::Metadata { name: METADATA_RUN, entries } => {
                let number = |key: &str| entries.get(key)?.parse::<u64>().ok();
                self.scenario = entries.get("scenario").cloned();
                self.seed = number("seed");
                self.auvs = number("auvs").and_then(|auvs| u32::try_from(auvs).ok());
                self.record_format = number("format").and_then(|format| u32::try_from(format).ok());
            }
            Item::Metadata { .. } => {}
            Item::Attachment { name, media_type, data } => self.attachments.push(StoredFile {
                name: name.to_owned(),
                media_type: media_type.to_owned(),
                bytes: data.len() as u64,
            }),
            Item::Chunk { compressed_bytes, uncompressed_bytes } => {
                self.chunks.count += 1;
                self.chunks.compressed_bytes = self.chunks.compressed_bytes.saturating_add(compressed_bytes);
                self.chunks.uncompressed_bytes =
                    self.chunks.uncompressed_bytes.saturating_add(uncompressed_bytes);
            }
            Item::Channel(source) => {
                topics.entry(source.topic.clone()).or_insert_with(|| TopicInfo {
                    topic: source.topic.clone(),
                    schema: source.schema.clone(),
                    encoding: source.encoding.clone(),
                    messages: 0,
                    bytes: 0,
                });
            }
            Item::Message { source, at, data } => {
                self.first_s = Some(self.first_s.map_or(at.as_s(), |first| first.min(at.as_s())));
                self.last_s = Some(self.last_s.map_or(at.as_s(), |last| last.max(at.as_s())));
                if let Some(topic) = topics.get_mut(&source.topic) {
                    topic.messages += 1;
                    topic.bytes += data.len() as u64;
                }
                if source.schema == Topic::Summary.schema_name() {
                    self.take_summary(serde_json::from_slice(data).map_err(Damage::Summary)?);
                }
            }
        }
        Ok(())
    }

    fn take_summary(&mut self, summary: Outcome) {
        self.containment = Some(summary.containment);
        self.reproducible = Some(summary.reproducible);
        self.digest = Some(summary.digest);
    }
}

/// What is told of a [`Summary`](crate::summary::Summary): its other numbers may be `null`.
#[derive(Deserialize)]
struct Outcome {
    digest: String,
    reproducible: bool,
    containment: Containment,
}
