//! The run's end of the tap.

use std::time::{Instant, SystemTime};

use iceoryx2::prelude::{Node, PortFactory, ipc};

use super::wire::{CAST, MARKS, Mark, SampleBuilder};
use super::{Cast, Counts, FAREWELL, LAG_MAX, LOOK_AGAIN, LiveTopic, SAMPLE_BYTES, TAPS_MAX, TapError};
use crate::chronicle::{Entry, What};
use crate::codec;
use crate::iceoryx::{self, Bytes, BytesPublisher, Limits};
use crate::os::keep_descriptors_from_children;
use crate::run_dir::RunDir;
use crate::summary::Summary;
use crate::time::{LocalTime, SimTime};

/// Room for the summary: a mark that outgrew its memory could not be read once the run is gone.
const MARK_BYTES: usize = 8 << 10;

/// Publishes a run for whoever taps. Costs next to nothing while nobody listens.
pub struct TapPublisher {
    run: RunDir,
    /// What is told to the first observer, until it is.
    cast: Option<Cast>,
    marks: Service,
    feeds: [Feed; LiveTopic::ALL.len()],
    counts: Counts,
    to: SimTime,
}

/// One topic.
struct Feed {
    topic: LiveTopic,
    service: Service,
    builder: SampleBuilder,
    /// For reports: the latest tick of each AUV, and what its clock read.
    latest: Vec<Option<(u64, LocalTime)>>,
}

impl TapPublisher {
    /// Makes the tap of `run`, in which `cast` takes part.
    ///
    /// # Errors
    /// When shared memory cannot be had.
    pub fn create(run: &RunDir, cast: Cast) -> Result<Self, TapError> {
        Self::try_create(run, cast).map_err(TapError::Setup)
    }

    fn try_create(run: &RunDir, cast: Cast) -> Result<Self, String> {
        let node = iceoryx::node(run)?;
        let feed = |topic: LiveTopic| {
            let service = Service::create(&node, topic.service(), SAMPLE_BYTES)?;
            let auvs = if topic == LiveTopic::Reports { cast.header.auvs.len() } else { 0 };
            Ok::<_, String>(Feed {
                topic,
                service,
                builder: SampleBuilder::default(),
                latest: vec![None; auvs],
            })
        };
        let [ticks, reports, pings, sensed, log, flock] = LiveTopic::ALL.map(feed);
        let feeds = [ticks?, reports?, pings?, sensed?, log?, flock?];
        // Last, so that an observer that finds it finds all others.
        let marks = Service::create(&node, MARKS, MARK_BYTES)?;
        keep_descriptors_from_children().map_err(|error| format!("descriptors: {error}"))?;
        let (run, cast) = (run.clone(), Some(cast));
        Ok(Self { run, cast, marks, feeds, counts: Counts::default(), to: SimTime::ZERO })
    }

    /// Publishes the entries of one window, up to `to`, on the topics that somebody listens to.
    ///
    /// # Errors
    /// When shared memory is exhausted, or the cast cannot be told.
    pub fn publish(&mut self, to: SimTime, entries: &[Entry]) -> Result<(), TapError> {
        let is_tapped = self.listeners() > 0;
        if is_tapped {
            self.tell_cast()?;
            self.mark()?;
        }
        for feed in self.feeds.iter_mut().filter(|feed| feed.service.listeners() > 0) {
            feed.publish(self.counts.of(feed.topic), entries)?;
        }
        for entry in entries {
            self.counts.add(LiveTopic::of(&entry.what), 1);
        }
        self.to = to;
        if is_tapped {
            self.mark()?;
        }
        Ok(())
    }

    /// Tells the taps that the run is over, and gives those that keep up a moment to read it.
    ///
    /// # Errors
    /// As [`publish`](Self::publish).
    pub fn end(mut self, summary: Option<&Summary>) -> Result<(), TapError> {
        if self.listeners() > 0 {
            self.tell_cast()?;
            self.mark()?;
            let summary = summary.and_then(|summary| serde_json::to_string(&summary.simulated()).ok());
            self.marks.send(&codec::encode(&Mark::End { counts: self.counts, summary })?)?;
            let since = Instant::now();
            while self.listeners() > 0 && since.elapsed() < FAREWELL {
                std::thread::sleep(LOOK_AGAIN);
            }
        }
        Ok(())
    }

    /// How many taps are attached.
    pub fn listeners(&self) -> usize {
        self.marks.listeners()
    }

    /// Whether somebody listens to `topic`.
    pub fn is_heard(&self, topic: LiveTopic) -> bool {
        self.feeds.iter().any(|feed| feed.topic == topic && feed.service.listeners() > 0)
    }

    fn mark(&mut self) -> Result<(), TapError> {
        self.marks.send(&codec::encode(&Mark::Here {
            to: self.to,
            counts: self.counts,
            published: SystemTime::now(),
        })?)
    }

    fn tell_cast(&mut self) -> Result<(), TapError> {
        let Some(cast) = self.cast.take() else { return Ok(()) };
        self.run.write_atomically(CAST, &codec::encode(&cast)?).map_err(TapError::Cast)
    }
}

impl Feed {
    /// Publishes its rows among `entries`, the first being the one at index `next` of the run.
    fn publish(&mut self, next: u64, entries: &[Entry]) -> Result<(), TapError> {
        let mut rows = 0;
        for entry in entries {
            if LiveTopic::of(&entry.what) == self.topic {
                let local = self.local(entry);
                self.builder.push(next + rows, local, entry)?;
                rows += 1;
                if self.builder.len() >= SAMPLE_BYTES {
                    self.flush()?;
                }
            } else if let What::Truth(truth) = &entry.what
                && let Some(latest) = self.latest.get_mut(entry.auv.0 as usize)
            {
                *latest = Some((truth.tick, truth.local));
            }
        }
        self.flush()
    }

    /// What the clock read at the tick that an answer is about.
    fn local(&self, entry: &Entry) -> Option<LocalTime> {
        let What::Acted(acted) = &entry.what else { return None };
        let (tick, local) = (*self.latest.get(entry.auv.0 as usize)?)?;
        (tick == acted.tick).then_some(local)
    }

    fn flush(&mut self) -> Result<(), TapError> {
        match self.builder.take() {
            Some(bytes) => self.service.send(bytes),
            None => Ok(()),
        }
    }
}

/// A service, and the memory to publish on it once somebody listens.
struct Service {
    factory: Bytes,
    publisher: Option<BytesPublisher>,
    expected_bytes: usize,
}

impl Service {
    fn create(node: &Node<ipc::Service>, name: &str, expected_bytes: usize) -> Result<Self, String> {
        let limits = Limits { publishers: 1, subscribers: TAPS_MAX, buffer: LAG_MAX, overflow: true };
        Ok(Self { factory: iceoryx::create(node, name, limits)?, publisher: None, expected_bytes })
    }

    fn listeners(&self) -> usize {
        self.factory.dynamic_config().number_of_subscribers()
    }

    fn send(&mut self, bytes: &[u8]) -> Result<(), TapError> {
        let publisher = match &mut self.publisher {
            Some(publisher) => publisher,
            none => {
                let made = iceoryx::publisher(&self.factory, self.expected_bytes);
                let publisher = none.insert(made.map_err(TapError::Setup)?);
                keep_descriptors_from_children().map_err(|error| TapError::Setup(error.to_string()))?;
                publisher
            }
        };
        iceoryx::send(publisher, bytes).map_err(TapError::Failed)?;
        Ok(())
    }
}
