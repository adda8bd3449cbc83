//! What crosses the water, as an observer sees it: every ping emitted, heard, or lost with its reason.

use serde::{Deserialize, Serialize};

use crate::message::AuvId;
use crate::time::SimTime;

/// One event of the water, for record, digest and tap; AUVs never see it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Traffic {
    /// True time of the event.
    pub at: SimTime,
    /// Who emitted the ping.
    pub from: AuvId,
    /// The emitter's sequence number of the ping.
    pub sequence: u32,
    /// What became of it.
    pub fate: Fate,
}

/// What happened to a ping.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Fate {
    /// It left the emitter's modem.
    Emitted {
        /// True position of the emitter, in metres.
        position_m: [f64; 3],
        /// Length of the frame.
        bytes: u16,
        /// Width of the position box that it carries, in metres.
        box_width_m: f64,
        /// AUVs that are too far away to ever hear it: each counts as lost for `range`.
        beyond_range: u32,
    },
    /// It was decoded.
    Heard {
        /// By whom.
        to: AuvId,
        /// Distance between the emitter at emission and the receiver at reception, in metres.
        range_m: f64,
        /// True travel time, in seconds.
        travel_s: f64,
        /// Width of the position box that it carries, in metres.
        box_width_m: f64,
    },
    /// It was not decoded, or never left.
    Lost {
        /// By whom it would have been heard; `None` for one that never left.
        to: Option<AuvId>,
        /// Why.
        reason: LossReason,
        /// Distance as for `Heard`, in metres; zero for one that never left.
        range_m: f64,
    },
}

/// Why a ping was not heard.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LossReason {
    /// Too far away.
    Range,
    /// Drowned in ambient noise.
    Noise,
    /// Overlapped with other packets.
    Collision,
    /// The receiver was emitting.
    HalfDuplex,
    /// Booked for a moment that had passed, so it never left.
    Late,
    /// The receiver's process had ended.
    Dead,
}

impl LossReason {
    /// The reason as it stands in summaries and on the tap.
    pub fn name(self) -> &'static str {
        match self {
            Self::Range => "range",
            Self::Noise => "noise",
            Self::Collision => "collision",
            Self::HalfDuplex => "half_duplex",
            Self::Late => "late",
            Self::Dead => "dead",
        }
    }
}
