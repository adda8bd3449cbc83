//! Where the time of a run goes.

use serde::{Deserialize, Serialize};

/// What the channel's process does in a window, in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Phase {
    /// The water goes on to the end of the window: bodies, clocks, sensors, sound.
    Channel,
    /// The AUVs that are due are sent what they sensed, and woken.
    Wake,
    /// What happened in the window before is hashed, recorded and published, while the AUVs are at work.
    Record,
    /// Waiting for the AUVs.
    Agents,
    /// Their answers are read.
    Gather,
    /// Their answers are checked and take effect.
    Accept,
}

impl Phase {
    /// All of them, in order.
    pub const ALL: [Self; 6] =
        [Self::Channel, Self::Wake, Self::Record, Self::Agents, Self::Gather, Self::Accept];

    /// As in summaries.
    pub fn name(self) -> &'static str {
        match self {
            Self::Channel => "channel",
            Self::Wake => "wake",
            Self::Record => "record",
            Self::Agents => "agents",
            Self::Gather => "gather",
            Self::Accept => "accept",
        }
    }
}

/// Where the wall time of a run's windows went (`--timings`); waiting for `--pace` is no part of it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Timings {
    /// Number of windows.
    pub windows: u64,
    /// Their length, all phases together, in milliseconds.
    pub total_ms: f64,
    /// One line for each [`Phase`], in order.
    pub phases: Vec<PhaseLine>,
    /// The same over the run: at most twenty stretches of as many windows each.
    pub over_time: Vec<Stretch>,
    /// Processor time; absent where it cannot be read.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub cpu: Option<Cpu>,
}

/// One phase over all windows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PhaseLine {
    /// Which.
    pub phase: Phase,
    /// Median over the windows, in milliseconds.
    pub median_ms: f64,
    /// 95 of 100 windows took no longer, in milliseconds.
    pub p95_ms: f64,
    /// The longest, in milliseconds.
    pub max_ms: f64,
    /// Part of the time of all phases.
    pub share: f64,
}

/// Some windows in a row.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stretch {
    /// True time at the end of the first of them, in seconds.
    pub from_s: f64,
    /// Mean of each [`Phase`], in order, in milliseconds per window.
    pub mean_ms: [f64; 6],
}

/// Processor time of the windows, start-up excluded, user and system together, of the processes on the channel's host that were
/// there at the end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Cpu {
    /// Of channel and AUVs, in microseconds for each simulated second of each AUV.
    pub us_per_auv_s: f64,
    /// Of that, the channel's process. On the `local` bus that is all.
    pub channel_us_per_auv_s: f64,
    /// Context switches of channel and AUVs for each control tick answered.
    pub switches_per_wake: f64,
}
