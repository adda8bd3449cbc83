//! Writes a record: batches by simulated time, a flush every simulated second.

mod append;

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::Write;

use mcap::records::{MessageHeader, Metadata};
use mcap::write::NoSeek;
use mcap::{Attachment, Compression, WriteOptions};

pub use append::{AppendError, append_offline};

use super::batch::{Batch, batch_end};
use super::foxglove::{Pose, PosesInFrame};
use super::header::Auvs;
use super::rows::LogRow;
use super::{METADATA_OUTCOME, METADATA_RUN, RECORD_FORMAT, RecordHeader, RecordWriteError, Row, Topic};
use crate::chronicle::{Entry, Truth, What};
use crate::codec;
use crate::message::{AuvId, Born};
use crate::summary::Summary;
use crate::time::{NS_PER_S, SimTime};

/// A chunk that exceeds this ends before its second does: a reader holds one chunk in memory.
const CHUNK_LIMIT_BYTES: u64 = 8 << 20;

/// Level of zstd: the default, 3, takes twice as long and makes no smaller files of digits.
const ZSTD_LEVEL: u32 = 1;

/// Writes one record. Give it the entries of every window, tell it how far time has come, and finish it.
///
/// The bytes depend on header, entries and summary alone, not on how the entries were cut into windows. All of a simulated
/// second has been passed to `W` and flushed once [`advance`](Self::advance) has gone beyond it. Dropped without
/// [`finish`](Self::finish), it closes the file properly but without a summary.
///
/// ```
/// use shoal_bus::record::{RecordHeader, RecordInfo, RecordWriter};
/// use shoal_bus::time::SimTime;
/// let header = RecordHeader {
///     scenario_name: "empty".into(), seed: 7, scenario_text: "name = \"empty\"\n".into(), auvs: vec![],
/// };
/// let mut file = Vec::new();
/// let mut writer = RecordWriter::create(&mut file, &header)?;
/// writer.append(&[])?;
/// writer.advance(SimTime::from_ns(1_000_000_000))?;
/// drop(writer);
/// assert_eq!(RecordInfo::read(std::io::Cursor::new(&file)).unwrap().seed, Some(7));
/// # Ok::<(), shoal_bus::record::RecordWriteError>(())
/// ```
pub struct RecordWriter<W: Write> {
    mcap: mcap::Writer<NoSeek<W>>,
    names: Vec<String>,
    latest: Vec<Option<Truth>>,
    batch: Option<Batch>,
    /// No entry may come before this.
    reached: SimTime,
    /// Log time of the last message.
    written: SimTime,
    sequence: u32,
}

impl<W: Write> RecordWriter<W> {
    /// Begins a record. `writer` should buffer: it is flushed when a simulated second is complete.
    ///
    /// # Errors
    /// When `writer` does not take the bytes.
    pub fn create(writer: W, header: &RecordHeader) -> Result<Self, RecordWriteError> {
        let mut mcap = options(Some(CHUNK_LIMIT_BYTES)).create(NoSeek::new(writer))?;
        mcap.write_metadata(&metadata(
            METADATA_RUN,
            [
                ("scenario", header.scenario_name.clone()),
                ("seed", header.seed.to_string()),
                ("auvs", header.auvs.len().to_string()),
                ("format", RECORD_FORMAT.to_string()),
            ],
        ))?;
        mcap.attach(&Attachment {
            log_time: 0,
            create_time: 0,
            name: "scenario.toml".to_owned(),
            media_type: "application/toml".to_owned(),
            data: Cow::Borrowed(header.scenario_text.as_bytes()),
        })?;
        for topic in Topic::ALL {
            let (name, encoding) = (topic.schema_name(), topic.schema_encoding());
            let schema = mcap.add_schema(name, encoding, topic.schema_text().as_bytes())?;
            mcap.add_channel(schema, topic.name(), topic.message_encoding(), &BTreeMap::new())?;
        }
        let mut record = Self {
            mcap,
            names: header.auvs.iter().map(|auv| auv.name.clone()).collect(),
            latest: vec![None; header.auvs.len()],
            batch: None,
            reached: SimTime::from_ns(i64::MIN),
            written: SimTime::ZERO,
            sequence: 0,
        };
        record.write(Topic::Auvs, SimTime::ZERO, &serde_json::to_vec(&Auvs { auvs: &header.auvs })?)?;
        record.mcap.flush()?;
        Ok(record)
    }

    /// Keeps what every AUV was told at birth. Call it before any [`append`](Self::append).
    ///
    /// # Errors
    /// When the destination does not take the bytes.
    pub fn born(&mut self, born: &[Born]) -> Result<(), RecordWriteError> {
        let auv = born.first().map_or(AuvId(0), |born| born.auv);
        let bytes = codec::encode(&born).map_err(|source| RecordWriteError::Encode { auv, source })?;
        self.write(Topic::Born, SimTime::ZERO, &bytes)?;
        Ok(self.mcap.flush()?)
    }

    /// Appends the entries of one window, sorted by time as the chronicle sorts them.
    ///
    /// # Errors
    /// When the destination does not take the bytes, when an entry comes before one already given or before the time of
    /// [`advance`](Self::advance), or is about an AUV that the header does not name.
    pub fn append(&mut self, entries: &[Entry]) -> Result<(), RecordWriteError> {
        entries.iter().try_for_each(|entry| self.push(entry))
    }

    /// As [`append`](Self::append), for rows that were read from a record or a live run. Topics that follow from others - header,
    /// poses, what was told at birth - are left out, as is what is known after the run only.
    ///
    /// # Errors
    /// As [`append`](Self::append).
    pub fn append_rows(&mut self, rows: &[Row]) -> Result<(), RecordWriteError> {
        rows.iter().try_for_each(|row| self.push_row(row))
    }

    fn push_row(&mut self, row: &Row) -> Result<(), RecordWriteError> {
        let at = row.at();
        self.batch_at(at)?;
        if let Row::Truth(row) = row {
            let auvs = self.latest.len();
            let unknown = RecordWriteError::UnknownAuv { auv: row.auv, auvs };
            *self.latest.get_mut(row.auv.0 as usize).ok_or(unknown)? = Some(row.truth());
        }
        self.batch_at(at)?.row(row)
    }

    /// The batch that holds `at`, once those before it are closed.
    fn batch_at(&mut self, at: SimTime) -> Result<&mut Batch, RecordWriteError> {
        if at < self.reached {
            return Err(RecordWriteError::OutOfOrder { at, reached: self.reached });
        }
        self.reached = at;
        let end = batch_end(at);
        if self.batch.as_ref().is_some_and(|batch| batch.end != end) {
            self.close_batch()?;
        }
        Ok(self.batch.get_or_insert_with(|| Batch::new(end)))
    }

    /// Tells that all entries before `to` have been given; one at `to` itself may still come.
    ///
    /// # Errors
    /// When the destination does not take the bytes.
    pub fn advance(&mut self, to: SimTime) -> Result<(), RecordWriteError> {
        self.reached = self.reached.max(to);
        if self.batch.as_ref().is_some_and(|batch| batch.end < to) {
            self.close_batch()?;
        }
        if second_end(self.written) < to {
            self.mcap.flush()?;
        }
        Ok(())
    }

    /// Ends the record of a part of a run, without a summary, and hands back the flushed destination.
    ///
    /// # Errors
    /// When the destination does not take the bytes.
    pub fn close(mut self) -> Result<W, RecordWriteError> {
        self.close_batch()?;
        self.mcap.finish()?;
        let mut writer = self.mcap.into_inner().into_inner();
        writer.flush()?;
        Ok(writer)
    }

    /// Ends the record with `summary`, facts of the machine removed, and hands back the flushed destination.
    ///
    /// # Errors
    /// When the destination does not take the bytes.
    pub fn finish(mut self, summary: &Summary) -> Result<W, RecordWriteError> {
        self.close_batch()?;
        let stored = summary.simulated();
        self.write(Topic::Summary, self.written, &serde_json::to_vec(&stored)?)?;
        self.mcap.write_metadata(&metadata(
            METADATA_OUTCOME,
            [
                ("digest", stored.digest),
                ("reproducible", stored.reproducible.to_string()),
                ("checks", stored.containment.checks.to_string()),
                ("violations", stored.containment.violations.to_string()),
            ],
        ))?;
        self.mcap.finish()?;
        let mut writer = self.mcap.into_inner().into_inner();
        writer.flush()?;
        Ok(writer)
    }

    fn push(&mut self, entry: &Entry) -> Result<(), RecordWriteError> {
        let Entry { at, auv, ref what } = *entry;
        if at < self.reached {
            return Err(RecordWriteError::OutOfOrder { at, reached: self.reached });
        }
        self.reached = at;
        let index = usize::try_from(auv.0).unwrap_or(usize::MAX);
        let auvs = self.names.len();
        let (Some(name), Some(latest)) = (self.names.get(index), self.latest.get_mut(index)) else {
            return Err(RecordWriteError::UnknownAuv { auv, auvs });
        };
        let end = batch_end(at);
        let batch = match &mut self.batch {
            Some(batch) if batch.end == end => batch,
            Some(_) => {
                self.close_batch()?;
                return self.push(entry);
            }
            none => none.insert(Batch::new(end)),
        };
        match what {
            What::Truth(truth) => {
                *latest = Some(*truth);
                batch.truth(at, auv, truth)
            }
            What::Sensed(sensed) => batch.sensed(at, auv, sensed),
            What::Acted(acted) => {
                let local = latest.filter(|truth| truth.tick == acted.tick).map(|truth| truth.local);
                batch.acted(at, auv, local, acted)
            }
            What::Traffic(traffic) => batch.traffic(traffic),
            What::Violation(violation) => batch.log(&LogRow::violation(at, name, violation)),
            What::Ended(reason) => batch.log(&LogRow::ended(at, name, reason)),
            What::Flock(flock) => batch.flock(at, flock),
        }
    }

    /// Writes the batch, if there is one, behind a flush when it begins another second.
    fn close_batch(&mut self) -> Result<(), RecordWriteError> {
        let Some(batch) = self.batch.take() else { return Ok(()) };
        let end = batch.end;
        self.flush_second(end)?;
        if batch.moved() {
            let poses = self.latest.iter().flatten().map(Pose::new).collect();
            self.write(Topic::Poses, end, &serde_json::to_vec(&PosesInFrame::new(end, poses))?)?;
        }
        batch.into_messages().try_for_each(|(topic, message)| self.write(topic, end, &message))
    }

    /// Ends the chunk when `at` begins another second than that of the last message.
    fn flush_second(&mut self, at: SimTime) -> Result<(), RecordWriteError> {
        if at > second_end(self.written) {
            self.mcap.flush()?;
        }
        Ok(())
    }

    fn write(&mut self, topic: Topic, at: SimTime, message: &[u8]) -> Result<(), RecordWriteError> {
        let time = u64::try_from(at.ns()).unwrap_or(0);
        // Channels are numbered from 1 in the order of `Topic::ALL`, which is the order of the variants.
        let channel_id = topic as u16 + 1;
        let header =
            MessageHeader { channel_id, sequence: self.sequence, log_time: time, publish_time: time };
        self.mcap.write_to_known_channel(&header, message)?;
        self.sequence = self.sequence.wrapping_add(1);
        self.written = at;
        Ok(())
    }
}

/// How every record is written.
pub(super) fn options(chunk_limit_bytes: Option<u64>) -> WriteOptions {
    WriteOptions::new()
        .library("shoal")
        .compression(Some(Compression::Zstd))
        .compression_level(ZSTD_LEVEL)
        .compression_threads(0)
        .chunk_size(chunk_limit_bytes)
        // A chunk is built in memory and written at once: a file that is cut ends with a whole chunk or a piece of one.
        .disable_seeking(true)
}

/// End of the simulated second `(k - 1, k]` that holds `at`.
fn second_end(at: SimTime) -> SimTime {
    SimTime::from_ns((at.ns().max(0) as u64).div_ceil(NS_PER_S as u64).saturating_mul(NS_PER_S as u64) as i64)
}

fn metadata<const N: usize>(name: &str, pairs: [(&str, String); N]) -> Metadata {
    metadata_of(name, pairs.into_iter().map(|(key, value)| (key.to_owned(), value)).collect())
}

fn metadata_of(name: &str, metadata: BTreeMap<String, String>) -> Metadata {
    Metadata { name: name.to_owned(), metadata }
}
