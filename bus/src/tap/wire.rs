//! What crosses shared memory between a run and its taps.

use std::time::SystemTime;

use serde::{Deserialize, Serialize};

use super::Counts;
use crate::chronicle::Entry;
use crate::codec::{self, CodecError};
use crate::time::{LocalTime, SimTime};

/// Name of the service that carries [`Mark`]s.
pub(super) const MARKS: &str = "marks";

/// Name of the file in the run's folder that holds the [`Cast`](super::Cast).
pub(super) const CAST: &str = "cast";

/// Where one window ends and the next begins. Published before the rows of a window as well as behind them: an observer that has
/// seen one has been listening to all its topics since.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) enum Mark {
    /// All rows before `to` have been published, when the wall clock was at `published`.
    Here { to: SimTime, counts: Counts, published: SystemTime },
    /// The run is over. The summary is JSON: it is not made for the codec.
    End { counts: Counts, summary: Option<String> },
}

/// Some rows of one topic.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Sample {
    /// Index in the run of the first row of the topic.
    pub(super) first: u64,
    /// The rows.
    pub(super) rows: Vec<SampleRow>,
}

/// An entry of the chronicle; with what its clock read, for an AUV's answer.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct SampleRow {
    pub(super) local: Option<LocalTime>,
    pub(super) entry: Entry,
}

#[derive(Serialize)]
struct SampleRowRef<'a> {
    local: Option<LocalTime>,
    entry: &'a Entry,
}

/// Builds the bytes of one [`Sample`] row by row, as the codec would write it.
#[derive(Default)]
pub(super) struct SampleBuilder {
    bytes: Vec<u8>,
    rows: u64,
}

/// Where the number of rows stands: behind the codec's version and the first index.
const LENGTH_AT: std::ops::Range<usize> = 10..18;

impl SampleBuilder {
    /// Appends a row; `index` is its index in the run.
    pub(super) fn push(
        &mut self,
        index: u64,
        local: Option<LocalTime>,
        entry: &Entry,
    ) -> Result<(), CodecError> {
        if self.rows == 0 {
            self.bytes.clear();
            self.bytes.extend(codec::FORMAT.to_le_bytes());
            self.bytes.extend(index.to_le_bytes());
            self.bytes.resize(LENGTH_AT.end, 0);
        }
        self.rows += 1;
        codec::encode_bare_into(&SampleRowRef { local, entry }, &mut self.bytes)
    }

    /// How long it is by now.
    pub(super) fn len(&self) -> usize {
        self.bytes.len()
    }

    /// The bytes, if there is any row; the next row begins anew.
    pub(super) fn take(&mut self) -> Option<&[u8]> {
        let rows = std::mem::take(&mut self.rows);
        if rows == 0 {
            return None;
        }
        self.bytes[LENGTH_AT].copy_from_slice(&rows.to_le_bytes());
        Some(&self.bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chronicle::What;
    use crate::message::AuvId;

    #[test]
    fn samples_are_what_the_codec_writes() {
        let entry = |ns| Entry { at: SimTime::from_ns(ns), auv: AuvId(3), what: What::Ended("lost".into()) };
        let mut builder = SampleBuilder::default();
        assert_eq!(builder.take(), None);
        for first in [5, 70] {
            let rows: Vec<SampleRow> = [None, Some(LocalTime::from_ns(-4))]
                .into_iter()
                .map(|local| SampleRow { local, entry: entry(9) })
                .collect();
            for (index, row) in (first..).zip(&rows) {
                builder.push(index, row.local, &row.entry).unwrap();
            }
            assert_eq!(builder.take(), Some(codec::encode(&Sample { first, rows }).unwrap().as_slice()));
        }
    }
}
