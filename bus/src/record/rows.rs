//! The rows of the JSON topics, as Rust types: what `bus/schemas/` describes for everyone else.
//!
//! A number that is not finite is `null` in JSON and reads back as NaN; every finite number reads back with the same bits.

use serde::{Deserialize, Deserializer, Serialize};

pub use super::foxglove::{Pose, PosesInFrame, Time};
use crate::chronicle::{Truth, Violation};
use crate::message::{Acted, AuvId, Bounds, BoundsBox, Culprit, Emptied};
use crate::summary::Flock;
use crate::time::{LocalTime, SimTime};
use crate::traffic::{Fate, LossReason, Reception, Traffic};

/// A number that may be other than finite: `null` in JSON, then.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[serde(transparent)]
pub struct Real(pub f64);

impl<'de> Deserialize<'de> for Real {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Ok(Self(Option::deserialize(deserializer)?.unwrap_or(f64::NAN)))
    }
}

/// Three coordinates: x east, y north, z up.
pub type Vector = [Real; 3];

/// `[lower, upper]`.
pub type Pair = [Real; 2];

fn vector(of: [f64; 3]) -> Vector {
    of.map(Real)
}

/// `[lower, upper]` of `of`.
pub fn pair(of: Bounds) -> Pair {
    [Real(of.lower), Real(of.upper)]
}

/// `[lower, upper]` of each side.
pub fn sides(of: BoundsBox) -> [Pair; 3] {
    of.map(pair)
}

/// One AUV's true state at one of its ticks: an element of `ticks` in `shoal.Truth/1`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TruthRow {
    /// Which AUV.
    pub auv: AuvId,
    /// Index of its tick.
    pub tick: u64,
    /// True time, in nanoseconds.
    pub t_ns: SimTime,
    /// What its clock reads, in nanoseconds.
    pub local_ns: LocalTime,
    /// Position, in metres.
    pub position_m: Vector,
    /// Velocity through the water, in m/s.
    pub velocity_m_s: Vector,
    /// Heading, in rad.
    pub heading_rad: Real,
    /// Pitch, in rad.
    pub pitch_rad: Real,
}

impl TruthRow {
    /// The truth that it tells.
    pub(crate) fn truth(&self) -> Truth {
        Truth {
            tick: self.tick,
            local: self.local_ns,
            position_m: self.position_m.map(|Real(metres)| metres),
            velocity_m_s: self.velocity_m_s.map(|Real(m_s)| m_s),
            heading_rad: self.heading_rad.0,
            pitch_rad: self.pitch_rad.0,
        }
    }

    /// The row of `truth` about `auv` at `t_ns`.
    pub fn new(t_ns: SimTime, auv: AuvId, truth: &Truth) -> Self {
        Self {
            auv,
            tick: truth.tick,
            t_ns,
            local_ns: truth.local,
            position_m: vector(truth.position_m),
            velocity_m_s: vector(truth.velocity_m_s),
            heading_rad: Real(truth.heading_rad),
            pitch_rad: Real(truth.pitch_rad),
        }
    }
}

/// What one AUV answered and believed at one of its ticks: an element of `reports` in `shoal.Reports/1`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReportRow {
    /// Which AUV.
    pub auv: AuvId,
    /// Index of its tick.
    pub tick: u64,
    /// True time, in nanoseconds.
    pub t_ns: SimTime,
    /// What its clock reads, in nanoseconds; `None` when the truth at this tick was not recorded before it.
    pub local_ns: Option<LocalTime>,
    /// Encloses its position at the tick, in metres.
    pub position_m: [Pair; 3],
    /// Encloses true time minus local time at the tick, in seconds.
    pub clock_offset_s: Pair,
    /// Encloses its position since the tick before, in metres.
    pub slice_position_m: [Pair; 3],
    /// Encloses true time minus local time since the tick before, in seconds.
    pub slice_clock_offset_s: Pair,
    /// Why the enclosure emptied, if it did.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub emptied: Option<EmptiedRow>,
    /// Neighbours that the controller heeds.
    pub neighbours: u16,
    /// Measurements that made the enclosure smaller since the tick before.
    pub contractions: u16,
    /// Pings told at this tick that the estimator took for outliers, or dropped.
    pub rejected: u16,
    /// Separate parts of the set.
    pub components: u16,
    /// The neighbours that it follows in its own frame.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub around: Vec<AroundRow>,
    /// What a Kalman filter believes.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub gaussian: Option<GaussianRow>,
    /// Desired velocity through the water, in m/s.
    pub setpoint_m_s: Vector,
    /// Pings booked at this tick.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub booked: Vec<BookedRow>,
}

impl ReportRow {
    /// The row of `acted`, the answer of `auv` at `t_ns`.
    pub fn new(t_ns: SimTime, auv: AuvId, local_ns: Option<LocalTime>, acted: &Acted) -> Self {
        let report = &acted.report;
        Self {
            auv,
            tick: acted.tick,
            t_ns,
            local_ns,
            position_m: sides(report.position_m),
            clock_offset_s: pair(report.clock_offset_s),
            slice_position_m: sides(report.slice.position_m),
            slice_clock_offset_s: pair(report.slice.clock_offset_s),
            emptied: report.emptied.map(EmptiedRow::new),
            neighbours: report.neighbours,
            contractions: report.contractions,
            rejected: report.rejected,
            components: report.components,
            around: report
                .around
                .iter()
                .map(|around| AroundRow { auv: around.auv, position_m: around.position_m.map(pair) })
                .collect(),
            gaussian: report.gaussian.map(|gaussian| GaussianRow {
                mean: gaussian.mean.map(Real),
                covariance: gaussian.covariance.map(Real),
            }),
            setpoint_m_s: vector(acted.setpoint.velocity_m_s),
            booked: acted
                .pings
                .iter()
                .map(|ping| BookedRow { at_local_ns: ping.at, frame: hexadecimal(ping.frame.bytes()) })
                .collect(),
        }
    }
}

/// What is known of one AUV at one of its ticks after the run: an element of `offline` in `shoal.Offline/1`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OfflineRow {
    /// Which AUV.
    pub auv: AuvId,
    /// Index of its tick.
    pub tick: u64,
    /// True time, in nanoseconds.
    pub t_ns: SimTime,
    /// What its clock reads, in nanoseconds.
    pub local_ns: LocalTime,
    /// Encloses its position as it would know it at once without any ping, in metres.
    pub alone_position_m: [Pair; 3],
    /// Encloses true time minus local time likewise, in seconds.
    pub alone_clock_offset_s: Pair,
    /// Encloses its position as all records together tell it, in metres.
    pub position_m: [Pair; 3],
    /// Encloses true time minus local time likewise, in seconds.
    pub clock_offset_s: Pair,
}

/// How the swarm moves and holds together at one whole second: the message of `shoal.Flock/1`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FlockRow {
    /// True time, in nanoseconds.
    pub t_ns: SimTime,
    /// The figures; its least separation is that since the row before.
    #[serde(flatten)]
    pub flock: Flock,
}

/// Something to tell people: the message of `/log`, `foxglove.Log`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct LogRow {
    /// When, in true time.
    pub timestamp: Time,
    /// 3 for a warning, 4 for an error.
    pub level: u8,
    /// What.
    pub message: String,
    /// Display name of the AUV that it is about.
    pub name: String,
    file: String,
    line: u32,
}

const WARNING: u8 = 3;
const ERROR: u8 = 4;

impl LogRow {
    /// An enclosure of the AUV called `name` did not hold the truth.
    pub(crate) fn violation(at: SimTime, name: impl Into<String>, violation: &Violation) -> Self {
        let Violation { enclosure, coordinate, margin } = violation;
        let message = if margin.is_finite() {
            let (enclosure, coordinate, unit) = (enclosure.name(), coordinate.name(), coordinate.unit());
            format!(
                "containment violated: the {enclosure} misses the truth in {coordinate} by {margin} {unit}"
            )
        } else {
            format!("containment violated: the {} is empty or invalid", enclosure.name())
        };
        Self::new(at, ERROR, name.into(), message)
    }

    /// The AUV called `name` is lost.
    pub(crate) fn ended(at: SimTime, name: impl Into<String>, reason: &str) -> Self {
        Self::new(at, WARNING, name.into(), format!("the AUV is lost: {reason}"))
    }

    fn new(at: SimTime, level: u8, name: String, message: String) -> Self {
        Self { timestamp: Time::new(at), level, message, name, file: String::new(), line: 0 }
    }
}

/// A neighbour as it is seen from an AUV.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AroundRow {
    /// Which neighbour.
    pub auv: AuvId,
    /// Encloses its position less that of the AUV at the tick, in metres: east and north.
    pub position_m: [Pair; 2],
}

/// A Gaussian over position and clock.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GaussianRow {
    /// East, north, up in metres, and true minus local time in seconds.
    pub mean: [Real; 4],
    /// The upper triangle of the covariance, row by row.
    pub covariance: [Real; 10],
}

/// Why an enclosure emptied.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct EmptiedRow {
    /// Local time of the measurement that left nothing, in nanoseconds.
    pub at_local_ns: LocalTime,
    /// `inertial`, `dvl`, `depth`, `gnss`, `ping` or `sabotage`.
    pub by: String,
    /// Who sent the ping, for `ping`.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub sender: Option<AuvId>,
}

impl EmptiedRow {
    fn new(emptied: Emptied) -> Self {
        let (by, sender) = match emptied.by {
            Culprit::Inertial => ("inertial", None),
            Culprit::Dvl => ("dvl", None),
            Culprit::Depth => ("depth", None),
            Culprit::Gnss => ("gnss", None),
            Culprit::Ping(sender) => ("ping", Some(sender)),
            Culprit::Sabotage => ("sabotage", None),
        };
        Self { at_local_ns: emptied.stamp, by: by.to_owned(), sender }
    }
}

/// A ping booked for a local time.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct BookedRow {
    /// Local time of the emission, in nanoseconds.
    pub at_local_ns: LocalTime,
    /// The frame's bytes, two hexadecimal digits each.
    pub frame: String,
}

impl BookedRow {
    /// The frame's bytes; `None` when they are not hexadecimal.
    pub fn bytes(&self) -> Option<Vec<u8>> {
        let digits: Option<Vec<u8>> = self
            .frame
            .chars()
            .map(|digit| digit.to_digit(16).and_then(|digit| u8::try_from(digit).ok()))
            .collect();
        digits?
            .chunks(2)
            .map(|pair| if let [high, low] = pair { Some(high << 4 | low) } else { None })
            .collect()
    }
}

fn hexadecimal(bytes: &[u8]) -> String {
    let digit = |nibble: u8| char::from(b"0123456789abcdef"[usize::from(nibble & 15)]);
    bytes.iter().flat_map(|byte| [digit(byte >> 4), digit(*byte)]).collect()
}

/// What happened to a ping: an element of `pings` in `shoal.Pings/1`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "fate", rename_all = "snake_case")]
pub enum PingRow {
    /// It left the emitter's modem.
    Emitted {
        /// True time, in nanoseconds.
        t_ns: SimTime,
        /// The emitter.
        from: AuvId,
        /// The emitter's sequence number.
        sequence: u32,
        /// True position of the emitter, in metres.
        position_m: Vector,
        /// Length of the frame, in bytes.
        bytes: u16,
        /// Width of the position box that it carries, in metres.
        box_width_m: Real,
        /// AUVs that are too far away to ever hear it.
        beyond_range: u32,
        /// Length of the packet, in seconds; 0 at level `ideal`.
        packet_s: Real,
    },
    /// It was decoded.
    Heard {
        /// True time, in nanoseconds.
        t_ns: SimTime,
        /// The emitter.
        from: AuvId,
        /// The emitter's sequence number.
        sequence: u32,
        /// The receiver.
        to: AuvId,
        /// Distance from emitter at emission to receiver at reception, in metres.
        range_m: Real,
        /// True travel time, in seconds.
        travel_s: Real,
        /// Width of the position box that it carries, in metres.
        box_width_m: Real,
        /// How it was received; absent at level `ideal`.
        #[serde(skip_serializing_if = "Option::is_none", default)]
        reception: Option<ReceptionRow>,
        /// Whether it came the long way round.
        #[serde(skip_serializing_if = "std::ops::Not::not", default)]
        outlier: bool,
    },
    /// It was not decoded, or never left.
    Lost {
        /// True time, in nanoseconds.
        t_ns: SimTime,
        /// The emitter.
        from: AuvId,
        /// The emitter's sequence number.
        sequence: u32,
        /// The receiver; `None` for a ping that never left.
        to: Option<AuvId>,
        /// Why.
        reason: LossReason,
        /// Distance as for `heard`, in metres; 0 for a ping that never left.
        range_m: Real,
        /// How it arrived; absent at level `ideal`, and where nothing arrived.
        #[serde(skip_serializing_if = "Option::is_none", default)]
        reception: Option<ReceptionRow>,
        /// Whose packets it collided with.
        #[serde(skip_serializing_if = "Vec::is_empty", default)]
        colliding: Vec<AuvId>,
    },
}

/// How a packet arrived.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReceptionRow {
    /// `direct`, or the boundaries it bounced off in order, such as `surface-bottom`.
    pub path: String,
    /// Received level in dB re 1 µPa.
    pub level_db: Real,
    /// Level over noise and interference in dB.
    pub sinr_db: Real,
    /// Factor of frequencies.
    pub doppler: Real,
}

impl ReceptionRow {
    fn new(of: &Reception) -> Self {
        let Reception { path, level_db, sinr_db, doppler } = *of;
        Self {
            path: path.to_string(),
            level_db: Real(level_db),
            sinr_db: Real(sinr_db),
            doppler: Real(doppler),
        }
    }
}

impl PingRow {
    /// True time of the event.
    pub fn at(&self) -> SimTime {
        match self {
            Self::Emitted { t_ns, .. } | Self::Heard { t_ns, .. } | Self::Lost { t_ns, .. } => *t_ns,
        }
    }

    /// The row of `traffic`.
    pub fn new(traffic: &Traffic) -> Self {
        let Traffic { at: t_ns, from, sequence, ref fate } = *traffic;
        match *fate {
            Fate::Emitted { position_m, bytes, box_width_m, beyond_range, packet_s } => Self::Emitted {
                t_ns,
                from,
                sequence,
                position_m: vector(position_m),
                bytes,
                box_width_m: Real(box_width_m),
                beyond_range,
                packet_s: Real(packet_s),
            },
            Fate::Heard { to, range_m, travel_s, box_width_m, reception, outlier } => Self::Heard {
                t_ns,
                from,
                sequence,
                to,
                range_m: Real(range_m),
                travel_s: Real(travel_s),
                box_width_m: Real(box_width_m),
                reception: reception.as_ref().map(ReceptionRow::new),
                outlier,
            },
            Fate::Lost { to, reason, range_m, ref reception, ref colliding } => Self::Lost {
                t_ns,
                from,
                sequence,
                to,
                reason,
                range_m: Real(range_m),
                reception: reception.as_ref().map(ReceptionRow::new),
                colliding: colliding.clone(),
            },
        }
    }
}
