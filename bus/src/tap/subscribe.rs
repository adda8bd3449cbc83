//! An observer's end of the tap.

use std::collections::VecDeque;
use std::fmt::Display;
use std::time::{Duration, Instant, SystemTime};

use super::wire::{CAST, MARKS, Mark, Sample, SampleRow};
use super::{Cast, Counts, LOOK_AGAIN, LiveTopic, TapError, TapItem, TapWindow};
use crate::chronicle::What;
use crate::codec;
use crate::iceoryx::{self, BytesSubscriber};
use crate::record::rows::{FlockRow, LogRow, PingRow, ReportRow, TruthRow};
use crate::record::{PoseBatches, Row, Topic};
use crate::run_dir::RunDir;
use crate::time::SimTime;

/// Listens to some topics of a live run, from the next window on.
///
/// What happened before is not told, but how many rows of each topic that was, and who takes part.
pub struct TapSubscriber {
    run: RunDir,
    marks: BytesSubscriber,
    feeds: Vec<Feed>,
    /// Makes `/truth` of `/ticks`, if it is asked for.
    poses: Option<PoseBatches>,
    is_asked_for_ticks: bool,
    /// Who takes part, once the first mark was seen.
    cast: Option<Cast>,
    /// The first and the last mark.
    since: Option<(SimTime, Counts)>,
    seen: Option<(SimTime, Counts)>,
}

impl TapSubscriber {
    /// Attaches to `run`. No topics at all will do: windows and counts are told anyway.
    ///
    /// `/auvs` and `/born` are [`cast`](Self::cast), and `/summary` comes with [`TapItem::End`]: they have no rows.
    ///
    /// # Errors
    /// When the run is not ready to be tapped, has too many taps, or never publishes one of `topics` ([`TapError::NotLive`]).
    pub fn attach(run: &RunDir, topics: &[Topic]) -> Result<Self, TapError> {
        if topics.contains(&Topic::Offline) {
            return Err(TapError::NotLive(Topic::Offline));
        }
        Self::try_attach(run, topics).map_err(TapError::Setup)
    }

    fn try_attach(run: &RunDir, topics: &[Topic]) -> Result<Self, String> {
        let node = iceoryx::node(run)?;
        let mut sources: Vec<LiveTopic> =
            topics.iter().filter_map(|topic| LiveTopic::source_of(*topic)).collect();
        sources.sort();
        sources.dedup();
        let open = |name| iceoryx::subscriber(&iceoryx::open(&node, name)?);
        let feed = |topic: LiveTopic| Ok(Feed::new(topic, open(topic.service())?));
        let feeds = sources.into_iter().map(feed).collect::<Result<_, String>>()?;
        Ok(Self {
            run: run.clone(),
            // Last: whoever sees a mark listens to all else by then.
            marks: open(MARKS)?,
            feeds,
            poses: topics.contains(&Topic::Poses).then(PoseBatches::default),
            is_asked_for_ticks: topics.contains(&Topic::Ticks),
            cast: None,
            since: None,
            seen: None,
        })
    }

    /// The next window; `None` when there is none within `timeout`. After the end there are no more.
    ///
    /// # Errors
    /// When shared memory cannot be read, or holds what this version does not understand.
    pub fn next(&mut self, timeout: Duration) -> Result<Option<TapItem>, TapError> {
        let since = Instant::now();
        loop {
            while let Some(mark) = self.next_mark()? {
                if let Some(item) = self.take(mark)? {
                    return Ok(Some(item));
                }
            }
            let left = timeout.saturating_sub(since.elapsed());
            if left.is_zero() {
                return Ok(None);
            }
            std::thread::sleep(left.min(LOOK_AGAIN));
        }
    }

    /// Who takes part; known once [`next`](Self::next) has returned an item, and often before.
    pub fn cast(&self) -> Option<&Cast> {
        self.cast.as_ref()
    }

    /// The run.
    pub fn run(&self) -> &RunDir {
        &self.run
    }

    /// How far the run was when this tap began to listen; `None` before it did.
    pub fn since(&self) -> Option<(SimTime, Counts)> {
        self.since
    }

    /// How many rows of each topic listened to were missed since it attached.
    pub fn missed_of(&self) -> impl Iterator<Item = (Topic, u64)> {
        self.feeds.iter().map(|feed| (feed.topic.topic(), feed.missed))
    }

    /// How many rows were missed since it attached.
    pub fn missed(&self) -> u64 {
        self.feeds.iter().map(|feed| feed.missed).sum()
    }

    fn next_mark(&mut self) -> Result<Option<Mark>, TapError> {
        match self.marks.receive().map_err(failed)? {
            Some(sample) => Ok(Some(codec::decode(sample.payload())?)),
            None => Ok(None),
        }
    }

    /// What `mark` completes; `None` when nothing has happened since the one before.
    fn take(&mut self, mark: Mark) -> Result<Option<TapItem>, TapError> {
        let (to, counts, published, end) = match mark {
            Mark::Here { to, counts, published } => (to, counts, published, None),
            Mark::End { counts, summary } => {
                let to = self.seen.map_or(SimTime::ZERO, |(to, _)| to);
                (to, counts, SystemTime::UNIX_EPOCH, Some(summary))
            }
        };
        if self.cast.is_none() {
            let bytes = std::fs::read(self.run.path().join(CAST)).map_err(TapError::Cast)?;
            self.cast = Some(codec::decode(&bytes)?);
        }
        let before = self.seen.replace((to, counts));
        if before.is_none() {
            self.since = self.seen;
            self.feeds.iter_mut().for_each(|feed| feed.next = counts.of(feed.topic));
        }
        if let Some(summary) = end {
            // The mark before it has told all rows.
            let summary = summary.and_then(|text| serde_json::from_str(&text).ok());
            return Ok(Some(TapItem::End { counts, summary }));
        }
        if before.is_none() || before == self.seen {
            return Ok(None);
        }
        let rows = self.rows(to, &counts)?;
        Ok(Some(TapItem::Window(TapWindow { to, counts, published, rows })))
    }

    /// The rows up to `counts`, sorted by time.
    fn rows(&mut self, to: SimTime, counts: &Counts) -> Result<Vec<Row>, TapError> {
        let cast = self.cast.as_ref();
        let name = |index: u32| {
            let auv = cast.and_then(|cast| cast.header.auvs.get(index as usize));
            auv.map_or_else(|| index.to_string(), |auv| auv.name.clone())
        };
        let mut rows = Vec::new();
        for feed in &mut self.feeds {
            let end = counts.of(feed.topic);
            feed.receive(end)?;
            while let Some(row) = feed.pop(end) {
                let row = row_of(row, &name);
                if let (Some(poses), Row::Truth(truth)) = (&mut self.poses, &row) {
                    rows.extend(poses.push(truth).map(Row::Poses));
                    if !self.is_asked_for_ticks {
                        continue;
                    }
                }
                rows.push(row);
            }
        }
        if let Some(poses) = &mut self.poses {
            rows.extend(poses.advance(to).map(Row::Poses));
        }
        // Equal times keep the order of the topics.
        rows.sort_by_key(Row::at);
        Ok(rows)
    }
}

/// One topic.
struct Feed {
    topic: LiveTopic,
    subscriber: BytesSubscriber,
    pending: VecDeque<(u64, SampleRow)>,
    /// Index in the run of the row that comes next.
    next: u64,
    missed: u64,
}

impl Feed {
    fn new(topic: LiveTopic, subscriber: BytesSubscriber) -> Self {
        Self { topic, subscriber, pending: VecDeque::new(), next: 0, missed: 0 }
    }

    /// Takes in what has come before the row with index `end`. The rest stays in shared memory, whose room is bounded.
    fn receive(&mut self, end: u64) -> Result<(), TapError> {
        while self.pending.back().is_none_or(|(index, _)| index + 1 < end)
            && let Some(sample) = self.subscriber.receive().map_err(failed)?
        {
            let Sample { first, rows } = codec::decode(sample.payload())?;
            self.pending.extend((first..).zip(rows));
        }
        Ok(())
    }

    /// The next row before the one with index `end`; counts those that were skipped.
    fn pop(&mut self, end: u64) -> Option<SampleRow> {
        while let Some((index, row)) = self.pending.pop_front_if(|(index, _)| *index < end) {
            if index >= self.next {
                self.missed += index - self.next;
                self.next = index + 1;
                return Some(row);
            }
        }
        self.missed += end.saturating_sub(self.next);
        self.next = self.next.max(end);
        None
    }
}

fn row_of(SampleRow { local, entry }: SampleRow, name: &dyn Fn(u32) -> String) -> Row {
    let (at, auv) = (entry.at, entry.auv);
    match entry.what {
        What::Truth(truth) => Row::Truth(TruthRow::new(at, auv, &truth)),
        What::Sensed(sensed) => Row::Sensed { at, auv, sensed },
        What::Acted(acted) => Row::Report(Box::new(ReportRow::new(at, auv, local, &acted))),
        What::Traffic(traffic) => Row::Ping(PingRow::new(&traffic)),
        What::Violation(violation) => Row::Log(LogRow::violation(at, name(auv.0), &violation)),
        What::Ended(reason) => Row::Log(LogRow::ended(at, name(auv.0), &reason)),
        What::Flock(flock) => Row::Flock(FlockRow { t_ns: at, flock }),
    }
}

fn failed(cause: impl Display) -> TapError {
    TapError::Failed(cause.to_string())
}
