//! The tap: what happens in a live run, for observers outside of it, whatever bus its AUVs use.
//!
//! Each [`LiveTopic`] has an iceoryx2 service of its own, and is encoded while somebody listens to it only; one more service
//! marks where windows begin and end, and tells how many rows each topic has had. Who takes part, [`Cast`], is told when the first
//! observer comes. An observer makes of it the same [`Row`]s that a record has.
//!
//! A tap never slows a run: a slow one misses rows, and knows how many.

mod publish;
mod subscribe;
mod topics;
mod wire;

use std::time::{Duration, SystemTime};

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::codec::CodecError;
use crate::message::Born;
use crate::record::{RecordHeader, Row, Topic};
use crate::summary::Summary;
use crate::time::SimTime;

pub use publish::TapPublisher;
pub use subscribe::TapSubscriber;
pub use topics::LiveTopic;

/// Observers that one run can have at the same time. Those that were killed leave when the next one comes.
pub const TAPS_MAX: usize = 16;

/// Samples of one topic that a tap may lag behind before it misses rows.
pub const LAG_MAX: usize = 512;

/// Rows of a topic are published in samples of about this size, so that what a slow tap holds back is bounded.
pub const SAMPLE_BYTES: usize = 32 << 10;

/// How often a waiting tap looks.
const LOOK_AGAIN: Duration = Duration::from_millis(5);

/// How long the end of a run waits for its taps to have read it.
const FAREWELL: Duration = Duration::from_millis(250);

/// Why a tap cannot be published or read.
#[derive(Debug, Error)]
pub enum TapError {
    /// The services cannot be created or opened.
    #[error("the tap could not be set up: {0}")]
    Setup(String),
    /// iceoryx2 failed.
    #[error("the tap failed: {0}")]
    Failed(String),
    /// What was published cannot be read.
    #[error("a message of the tap could not be read: {0}")]
    Codec(#[from] CodecError),
    /// Who takes part cannot be told or read.
    #[error("who takes part in the run could not be told: {0}")]
    Cast(#[source] std::io::Error),
    /// A live run does not publish this.
    #[error("{} is in records only: it is made after a run", .0.name())]
    NotLive(Topic),
}

/// Who takes part in a run: what stands at the beginning of its record.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cast {
    /// Scenario, seed and AUVs.
    pub header: RecordHeader,
    /// What every AUV was told at birth.
    pub born: Vec<Born>,
}

/// How many rows each topic has had since the run began.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counts([u64; LiveTopic::ALL.len()]);

impl Counts {
    /// Those of one topic.
    pub fn of(&self, topic: LiveTopic) -> u64 {
        self.0.get(topic as usize).copied().unwrap_or_default()
    }

    fn add(&mut self, topic: LiveTopic, rows: u64) {
        if let Some(count) = self.0.get_mut(topic as usize) {
            *count += rows;
        }
    }
}

/// What a tap sees.
#[derive(Clone, Debug, PartialEq)]
pub enum TapItem {
    /// One window, or several when the tap was slow.
    Window(TapWindow),
    /// The run is over.
    End {
        /// Rows of the whole run.
        counts: Counts,
        /// The outcome, without facts of the machine; absent when the run could not tell it.
        summary: Option<Box<Summary>>,
    },
}

/// What happened in one window.
#[derive(Clone, Debug, PartialEq)]
pub struct TapWindow {
    /// All that happened before this has been told.
    pub to: SimTime,
    /// Rows since the run's beginning, also of topics that this tap does not listen to.
    pub counts: Counts,
    /// When it was published, by the wall clock of this host.
    pub published: SystemTime,
    /// The rows of the topics listened to, sorted by time.
    pub rows: Vec<Row>,
}

#[cfg(test)]
mod tests;
