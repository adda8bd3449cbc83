//! What happened, in order: the entries that the digest hashes and the record keeps.

use serde::{Deserialize, Serialize};

use crate::message::{Acted, AuvId, Sensed};
use crate::summary::Flock;
use crate::time::{LocalTime, SimTime};
use crate::traffic::Traffic;

/// One thing that happened. A run's entries are sorted by (true time, vehicle, kind, index) and do not depend on windows,
/// bus, hosts or pace.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// When, in true time.
    pub at: SimTime,
    /// To whom; for traffic, the emitter of what was emitted or never left, the receiver of what was heard or lost; for the swarm as a
    /// whole, the first AUV.
    pub auv: AuvId,
    /// What.
    pub what: What,
}

/// The kinds of things that happen, in the order in which simultaneous ones of one AUV are told.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum What {
    /// Where the AUV really is at one of its ticks.
    Truth(Truth),
    /// What it was told at that tick.
    Sensed(Sensed),
    /// What it answered. In a box, because most entries are traffic, and all are as large as the largest.
    Acted(Box<Acted>),
    /// What crossed the water.
    Traffic(Traffic),
    /// The check failed.
    Violation(Violation),
    /// The AUV is gone; the reason is a clause.
    Ended(String),
    /// How the swarm moves and holds together at this whole second, its least separation since the one before; no part of the digest.
    Flock(Flock),
}

impl What {
    /// Rank among simultaneous entries of one AUV.
    pub fn rank(&self) -> u8 {
        match self {
            Self::Truth(_) => 0,
            Self::Sensed(_) => 1,
            Self::Acted(_) => 2,
            Self::Traffic(_) => 3,
            Self::Violation(_) => 4,
            Self::Ended(_) => 5,
            Self::Flock(_) => 6,
        }
    }
}

/// The truth about one AUV at one of its ticks.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Truth {
    /// Index of the tick.
    pub tick: u64,
    /// What its clock reads.
    pub local: LocalTime,
    /// Position in metres.
    pub position_m: [f64; 3],
    /// Velocity through the water in m/s.
    pub velocity_m_s: [f64; 3],
    /// Heading in rad.
    pub heading_rad: f64,
    /// Pitch in rad.
    pub pitch_rad: f64,
}

/// An enclosure that does not hold the truth.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Violation {
    /// Which enclosure.
    pub enclosure: Enclosure,
    /// Which coordinate of it.
    pub coordinate: Coordinate,
    /// By how much the truth lies outside, in the coordinate's unit; infinite for an empty or invalid set.
    pub margin: f64,
}

/// The enclosures that the channel checks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Enclosure {
    /// A report, at its tick.
    Report,
    /// A report's slice, at a moment between two ticks.
    Slice,
    /// A ping's payload, at its emission.
    Ping,
    /// A neighbour in a report, at its tick.
    Around,
    /// An enclosure that was reported empty where no fault was declared.
    Emptied,
}

/// Coordinates of an enclosure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Coordinate {
    /// Position east, in metres.
    X,
    /// Position north, in metres.
    Y,
    /// Position up, in metres.
    Z,
    /// True time, in seconds.
    Time,
    /// Velocity over ground east, in m/s.
    VelocityX,
    /// Velocity over ground north, in m/s.
    VelocityY,
    /// Velocity over ground up, in m/s.
    VelocityZ,
    /// All of them.
    All,
}

impl Coordinate {
    /// Unit of a margin in this coordinate.
    pub fn unit(self) -> &'static str {
        match self {
            Self::X | Self::Y | Self::Z => "m",
            Self::Time => "s",
            Self::VelocityX | Self::VelocityY | Self::VelocityZ => "m/s",
            Self::All => "",
        }
    }

    /// The coordinate's name as it stands in summaries.
    pub fn name(self) -> &'static str {
        match self {
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
            Self::Time => "time",
            Self::VelocityX => "velocity_x",
            Self::VelocityY => "velocity_y",
            Self::VelocityZ => "velocity_z",
            Self::All => "all",
        }
    }
}

impl Enclosure {
    /// The enclosure's name as it stands in summaries.
    pub fn name(self) -> &'static str {
        match self {
            Self::Report => "report",
            Self::Slice => "slice",
            Self::Ping => "ping",
            Self::Around => "neighbour",
            Self::Emptied => "emptied",
        }
    }
}
