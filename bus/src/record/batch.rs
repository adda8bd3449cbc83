//! One batch: 100 simulated milliseconds of entries, encoded as they come.

use serde::Serialize;

use super::rows::{FlockRow, LogRow, OfflineRow, PingRow, ReportRow, TruthRow};
use super::{BATCH_NS, RecordWriteError, Row, Topic};
use crate::chronicle::Truth;
use crate::codec;
use crate::message::{Acted, AuvId, Sensed};
use crate::summary::Flock;
use crate::time::{LocalTime, SimTime};
use crate::traffic::Traffic;

/// End of the batch that holds `at`: the next multiple of [`BATCH_NS`], `at` itself when it is one; never negative.
pub(super) fn batch_end(at: SimTime) -> SimTime {
    let batches = at.ns().max(0) as u64;
    // The quotient of an `i64` by more than one fits; the product saturates in the year 2262.
    SimTime::from_ns((batches.div_ceil(BATCH_NS as u64) as i64).saturating_mul(BATCH_NS))
}

/// The messages of one batch, ready to be written.
pub(super) struct Batch {
    /// The batch holds what happened in `(end - BATCH_NS, end]`.
    pub(super) end: SimTime,
    ticks: Rows,
    reports: Rows,
    pings: Rows,
    sensed: Told,
    logs: Vec<Vec<u8>>,
    flocks: Vec<Vec<u8>>,
}

impl Batch {
    pub(super) fn new(end: SimTime) -> Self {
        Self {
            end,
            ticks: Rows::new("ticks", end),
            reports: Rows::new("reports", end),
            pings: Rows::new("pings", end),
            sensed: Told::new(),
            logs: Vec::new(),
            flocks: Vec::new(),
        }
    }

    pub(super) fn truth(&mut self, at: SimTime, auv: AuvId, truth: &Truth) -> Result<(), RecordWriteError> {
        self.ticks.push(&TruthRow::new(at, auv, truth))
    }

    pub(super) fn acted(
        &mut self,
        at: SimTime,
        auv: AuvId,
        local: Option<LocalTime>,
        acted: &Acted,
    ) -> Result<(), RecordWriteError> {
        self.reports.push(&ReportRow::new(at, auv, local, acted))
    }

    pub(super) fn traffic(&mut self, traffic: &Traffic) -> Result<(), RecordWriteError> {
        self.pings.push(&PingRow::new(traffic))
    }

    pub(super) fn sensed(
        &mut self,
        at: SimTime,
        auv: AuvId,
        sensed: &Sensed,
    ) -> Result<(), RecordWriteError> {
        self.sensed.push(at, auv, sensed).map_err(|source| RecordWriteError::Encode { auv, source })
    }

    pub(super) fn flock(&mut self, at: SimTime, flock: &Flock) -> Result<(), RecordWriteError> {
        self.flocks.push(serde_json::to_vec(&FlockRow { t_ns: at, flock: *flock })?);
        Ok(())
    }

    pub(super) fn log(&mut self, log: &LogRow) -> Result<(), RecordWriteError> {
        self.logs.push(serde_json::to_vec(log)?);
        Ok(())
    }

    /// A row as it was read. Those that follow from others are not written.
    pub(super) fn row(&mut self, row: &Row) -> Result<(), RecordWriteError> {
        match row {
            Row::Truth(row) => self.ticks.push(row),
            Row::Report(row) => self.reports.push(row),
            Row::Ping(row) => self.pings.push(row),
            Row::Sensed { at, auv, sensed } => self.sensed(*at, *auv, sensed),
            Row::Log(row) => self.log(row),
            Row::Flock(row) => self.flock(row.t_ns, &row.flock),
            Row::Header(_) | Row::Poses(_) | Row::Born(_) | Row::Offline(_) | Row::Summary(_) => Ok(()),
        }
    }

    /// Whether any AUV ticked, so that poses have changed.
    pub(super) fn moved(&self) -> bool {
        self.ticks.rows > 0
    }

    /// The messages, topic by topic.
    pub(super) fn into_messages(self) -> impl Iterator<Item = (Topic, Vec<u8>)> {
        let rows = [(Topic::Ticks, self.ticks), (Topic::Reports, self.reports), (Topic::Pings, self.pings)];
        self.logs
            .into_iter()
            .map(|log| (Topic::Log, log))
            .chain(rows.into_iter().filter_map(|(topic, rows)| Some((topic, rows.finish()?))))
            .chain(self.flocks.into_iter().map(|flock| (Topic::Flock, flock)))
            .chain(self.sensed.finish().map(|bytes| (Topic::Sensed, bytes)))
    }
}

/// The messages of `rows`, sorted by time: one for each batch.
pub(super) fn offline_messages(rows: &[OfflineRow]) -> Result<Vec<(SimTime, Vec<u8>)>, RecordWriteError> {
    let mut messages = Vec::new();
    for batch in rows.chunk_by(|one, next| batch_end(one.t_ns) == batch_end(next.t_ns)) {
        let Some(first) = batch.first() else { continue };
        let end = batch_end(first.t_ns);
        let mut message = Rows::new("offline", end);
        batch.iter().try_for_each(|row| message.push(row))?;
        messages.extend(message.finish().map(|text| (end, text)));
    }
    Ok(messages)
}

/// A JSON message that grows row by row: `{"from_ns":…,"to_ns":…,"NAME":[…]}`.
struct Rows {
    text: Vec<u8>,
    rows: usize,
}

impl Rows {
    fn new(name: &str, end: SimTime) -> Self {
        let (from_ns, to_ns) = (end.ns() - BATCH_NS, end.ns());
        Self { text: format!(r#"{{"from_ns":{from_ns},"to_ns":{to_ns},"{name}":["#).into_bytes(), rows: 0 }
    }

    fn push(&mut self, row: &impl Serialize) -> Result<(), RecordWriteError> {
        if self.rows > 0 {
            self.text.push(b',');
        }
        self.rows += 1;
        Ok(serde_json::to_writer(&mut self.text, row)?)
    }

    fn finish(mut self) -> Option<Vec<u8>> {
        self.text.extend(b"]}");
        (self.rows > 0).then_some(self.text)
    }
}

/// The bytes of `Vec<(SimTime, AuvId, Sensed)>` as [`codec::encode`] would write them, without the vector.
struct Told {
    bytes: Vec<u8>,
    count: u64,
}

/// Where the vector's length stands: behind the codec's version.
const LENGTH_AT: std::ops::Range<usize> = 2..10;

impl Told {
    fn new() -> Self {
        let mut bytes = codec::FORMAT.to_le_bytes().to_vec();
        bytes.resize(LENGTH_AT.end, 0);
        Self { bytes, count: 0 }
    }

    fn push(&mut self, at: SimTime, auv: AuvId, sensed: &Sensed) -> Result<(), codec::CodecError> {
        self.count += 1;
        codec::encode_bare_into(&(at, auv, sensed), &mut self.bytes)
    }

    fn finish(mut self) -> Option<Vec<u8>> {
        self.bytes[LENGTH_AT].copy_from_slice(&self.count.to_le_bytes());
        (self.count > 0).then_some(self.bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_batch_ends_at_the_next_multiple() {
        let end_ms = |ns| batch_end(SimTime::from_ns(ns)).ns() / 1_000_000;
        assert_eq!([-5, 0, 1, 100_000_000, 100_000_001].map(end_ms), [0, 0, 100, 100, 200]);
    }

    #[test]
    fn what_was_told_is_what_the_codec_writes() {
        let sensed = Sensed { tick: 3, stamp: LocalTime::from_ns(-7), events: Vec::new() };
        let row = (SimTime::from_ns(9), AuvId(2), sensed);
        let mut told = Told::new();
        told.push(row.0, row.1, &row.2).unwrap();
        assert_eq!(told.finish(), Some(codec::encode(&vec![row]).unwrap()));
    }
}
