//! The tap: what crosses the water, for observers outside the run, whatever bus its AUVs use.
//!
//! A tap never slows a run: a slow one misses batches, and knows how many events were in them.

use std::fmt::Display;
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::codec;
use crate::iceoryx::{self, Bytes, BytesPublisher, BytesSubscriber, Limits};
use crate::os::keep_descriptors_from_children;
use crate::run_dir::RunDir;
use crate::traffic::Traffic;

const SERVICE: &str = "tap";

/// Observers that one run can have at the same time. Those that were killed leave when the next one comes.
pub const TAPS_MAX: usize = 16;

/// Batches that a tap may lag behind before it misses some.
pub const LAG_MAX: usize = 256;

const EXPECTED_BATCH_BYTES: usize = 4096;

/// How often a waiting tap looks.
const LOOK_AGAIN: Duration = Duration::from_millis(5);

/// How long the end of a run waits for its taps to have read it.
const FAREWELL: Duration = Duration::from_millis(250);

/// Why a tap cannot be published or read.
#[derive(Debug, Error)]
pub enum TapError {
    /// The service cannot be created or opened.
    #[error("the tap could not be set up: {0}")]
    Setup(String),
    /// iceoryx2 failed.
    #[error("the tap failed: {0}")]
    Failed(String),
    /// What was published cannot be read.
    #[error("a batch of the tap could not be read: {0}")]
    Codec(#[from] codec::CodecError),
}

/// The traffic of one window.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TapBatch {
    /// Counts batches from 0; those that nobody was there to read count as well.
    pub sequence: u64,
    /// Index in the run of the first event.
    pub first: u64,
    /// The events.
    pub traffic: Vec<Traffic>,
}

/// What a tap sees.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum TapItem {
    /// The traffic of one window.
    Batch(TapBatch),
    /// The run is over.
    End {
        /// Events in the whole run.
        events: u64,
    },
}

#[derive(Serialize)]
enum TapItemRef<'a> {
    Batch(TapBatchRef<'a>),
    End { events: u64 },
}

#[derive(Serialize)]
struct TapBatchRef<'a> {
    sequence: u64,
    first: u64,
    traffic: &'a [Traffic],
}

/// The run's end of the tap.
pub struct TapPublisher {
    publisher: BytesPublisher,
    service: Bytes,
    batches: u64,
    events: u64,
}

impl TapPublisher {
    /// Makes the tap of `run`.
    pub fn create(run: &RunDir) -> Result<Self, TapError> {
        Self::try_create(run).map_err(TapError::Setup)
    }

    fn try_create(run: &RunDir) -> Result<Self, String> {
        let limits = Limits { publishers: 1, subscribers: TAPS_MAX, buffer: LAG_MAX, overflow: true };
        let service = iceoryx::create(&iceoryx::node(run)?, SERVICE, limits)?;
        let publisher = iceoryx::publisher(&service, EXPECTED_BATCH_BYTES)?;
        keep_descriptors_from_children().map_err(|error| format!("descriptors: {error}"))?;
        Ok(Self { publisher, service, batches: 0, events: 0 })
    }

    /// Publishes one window's events, if there are any. Costs next to nothing while nobody listens.
    pub fn publish(&mut self, traffic: &[Traffic]) -> Result<(), TapError> {
        if traffic.is_empty() {
            return Ok(());
        }
        if self.listeners() > 0 {
            let batch = TapBatchRef { sequence: self.batches, first: self.events, traffic };
            self.send(&TapItemRef::Batch(batch))?;
        }
        self.batches += 1;
        self.events += traffic.len() as u64;
        Ok(())
    }

    /// Tells the taps that the run is over, and gives those that keep up a moment to read it.
    pub fn end(self) -> Result<(), TapError> {
        if self.listeners() > 0 {
            self.send(&TapItemRef::End { events: self.events })?;
            let since = Instant::now();
            while self.listeners() > 0 && since.elapsed() < FAREWELL {
                std::thread::sleep(LOOK_AGAIN);
            }
        }
        Ok(())
    }

    /// How many taps are attached.
    pub fn listeners(&self) -> usize {
        use iceoryx2::prelude::PortFactory;
        self.service.dynamic_config().number_of_subscribers()
    }

    fn send(&self, item: &TapItemRef<'_>) -> Result<(), TapError> {
        iceoryx::send(&self.publisher, &codec::encode(item)?).map_err(TapError::Failed)?;
        Ok(())
    }
}

/// An observer's end of the tap.
pub struct TapSubscriber {
    subscriber: BytesSubscriber,
    /// Index of the event that comes next; unknown before the first batch.
    next: Option<u64>,
    missed: u64,
}

impl TapSubscriber {
    /// Attaches to the tap of `run`: sees what is published from now on.
    pub fn attach(run: &RunDir) -> Result<Self, TapError> {
        let attached = || iceoryx::subscriber(&iceoryx::open(&iceoryx::node(run)?, SERVICE)?);
        Ok(Self { subscriber: attached().map_err(TapError::Setup)?, next: None, missed: 0 })
    }

    /// The next item; `None` when there is none within `timeout`. After the end there are no more.
    pub fn next(&mut self, timeout: Duration) -> Result<Option<TapItem>, TapError> {
        let since = Instant::now();
        loop {
            if let Some(sample) = self.subscriber.receive().map_err(failed)? {
                let item = codec::decode(sample.payload())?;
                self.count(&item);
                return Ok(Some(item));
            }
            let left = timeout.saturating_sub(since.elapsed());
            if left.is_zero() {
                return Ok(None);
            }
            std::thread::sleep(left.min(LOOK_AGAIN));
        }
    }

    /// How many events were missed since it attached.
    pub fn missed(&self) -> u64 {
        self.missed
    }

    fn count(&mut self, item: &TapItem) {
        let (first, after) = match item {
            TapItem::Batch(batch) => (batch.first, batch.first + batch.traffic.len() as u64),
            TapItem::End { events } => (*events, *events),
        };
        self.missed += first.saturating_sub(self.next.unwrap_or(first));
        self.next = Some(after);
    }
}

fn failed(cause: impl Display) -> TapError {
    TapError::Failed(cause.to_string())
}
