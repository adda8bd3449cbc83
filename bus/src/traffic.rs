//! What crosses the water, as an observer sees it: every ping emitted, heard, or lost with its reason.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::message::AuvId;
use crate::time::SimTime;

/// One event of the water, for record, digest and tap; AUVs never see it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
        /// From the beginning of the packet to its end at the emitter, in seconds; zero at level `ideal`.
        packet_s: f64,
    },
    /// It was decoded.
    Heard {
        /// By whom.
        to: AuvId,
        /// Distance between the emitter at emission and the receiver at reception, in metres.
        range_m: f64,
        /// True travel time of the packet's beginning, in seconds. The event is told at the packet's end.
        travel_s: f64,
        /// Width of the position box that it carries, in metres.
        box_width_m: f64,
        /// How it was received; absent at level `ideal`.
        reception: Option<Reception>,
        /// Whether the travel time contradicts what the receiver is told about sound: it came the long way round.
        outlier: bool,
    },
    /// It was not decoded, or never left.
    Lost {
        /// By whom it would have been heard; `None` for one that never left.
        to: Option<AuvId>,
        /// Why.
        reason: LossReason,
        /// Distance as for `Heard`, in metres; zero for one that never left.
        range_m: f64,
        /// How it arrived; absent at level `ideal`, and where nothing arrived.
        reception: Option<Reception>,
        /// Whose packets it collided with, sorted.
        colliding: Vec<AuvId>,
    },
}

impl Fate {
    /// The fate of a ping that is lost without having been near a decoder.
    pub fn lost(to: Option<AuvId>, reason: LossReason, range_m: f64) -> Self {
        Self::Lost { to, reason, range_m, reception: None, colliding: Vec::new() }
    }
}

/// How a packet arrived at a receiver, by the path that decided its fate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Reception {
    /// Which way sound took.
    pub path: SoundPath,
    /// Received level in dB re 1 µPa.
    pub level_db: f64,
    /// Level over ambient noise and all overlapping packets together, averaged over the packet, in dB.
    pub sinr_db: f64,
    /// Frequencies arrive multiplied by this: above one, emitter and receiver approach.
    pub doppler: f64,
}

/// A way from emitter to receiver.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SoundPath {
    /// Through the water, refracted or straight.
    Direct,
    /// Off surface and bottom in turn.
    Bounced {
        /// Where it bounces first.
        first: Boundary,
        /// How often it bounces.
        bounces: u8,
    },
}

/// A boundary of the water that reflects sound.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Boundary {
    /// The sea surface.
    Surface,
    /// The sea floor.
    Bottom,
}

impl Boundary {
    /// The other one.
    pub fn other(self) -> Self {
        match self {
            Self::Surface => Self::Bottom,
            Self::Bottom => Self::Surface,
        }
    }
}

impl SoundPath {
    /// How often the path meets a boundary.
    ///
    /// ```
    /// use shoal_bus::traffic::{Boundary, SoundPath};
    ///
    /// let path = SoundPath::Bounced { first: Boundary::Bottom, bounces: 3 };
    /// assert_eq!((path.bounces_off(Boundary::Bottom), path.bounces_off(Boundary::Surface)), (2, 1));
    /// assert_eq!(path.to_string(), "bottom-surface-bottom");
    /// ```
    pub fn bounces_off(self, boundary: Boundary) -> u8 {
        match self {
            Self::Direct => 0,
            Self::Bounced { first, bounces } if first == boundary => bounces.div_ceil(2),
            Self::Bounced { bounces, .. } => bounces / 2,
        }
    }
}

impl fmt::Display for SoundPath {
    /// `direct`, `surface`, `bottom-surface` and so on.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self::Bounced { first, bounces } = *self else { return f.write_str("direct") };
        let mut boundary = first;
        for bounce in 0..bounces {
            let name = match boundary {
                Boundary::Surface => "surface",
                Boundary::Bottom => "bottom",
            };
            write!(f, "{}{name}", if bounce > 0 { "-" } else { "" })?;
            boundary = boundary.other();
        }
        Ok(())
    }
}

/// Why a ping was not heard.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LossReason {
    /// Too far away.
    Range,
    /// Drowned in ambient noise, or faded.
    Noise,
    /// Overlapped with other packets, without which it would have been decoded.
    Collision,
    /// The receiver was emitting; or, for one that never left, the emitter was still emitting another.
    HalfDuplex,
    /// No path through the water leads there, and bounces are too faint.
    Shadow,
    /// The receiver's modem was not listening.
    Asleep,
    /// Sent in a band or with a modulation that the receiver's modem does not know.
    Band,
    /// Held back by the emitter's modem because it heard others, so it never left.
    Busy,
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
            Self::Shadow => "shadow",
            Self::Asleep => "asleep",
            Self::Band => "band",
            Self::Busy => "busy",
            Self::Late => "late",
            Self::Dead => "dead",
        }
    }
}
