//! The messages between the water and a mind: [`Born`] once, then [`Sensed`] in and [`Acted`] out, tick by tick.
//!
//! Frames: local tangent plane, x east, y north, z **up** (the surface is z = 0); heading counter-clockwise from x,
//! pitch positive upwards. SI units, named in every field. Every measured value carries its stated error bound.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::ping::Frame;
use crate::time::LocalTime;

/// Which AUV: its index in the scenario, from 0, groups in the order of the file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct AuvId(pub u32);

impl fmt::Display for AuvId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// A closed interval of reals as it crosses the bus: `lower <= upper`, both finite unless a field says otherwise.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bounds {
    /// Least value.
    pub lower: f64,
    /// Greatest value.
    pub upper: f64,
}

impl Bounds {
    /// The interval `[lower, upper]`.
    pub const fn new(lower: f64, upper: f64) -> Self {
        Self { lower, upper }
    }

    /// `upper - lower`.
    pub fn width(&self) -> f64 {
        self.upper - self.lower
    }

    /// The middle of the interval.
    pub fn mid(&self) -> f64 {
        0.5 * self.lower + 0.5 * self.upper
    }

    /// Whether `value` lies inside, bounds included.
    pub fn contains(&self, value: f64) -> bool {
        self.lower <= value && value <= self.upper
    }

    /// Whether both bounds are numbers in the right order (infinities allowed).
    pub fn is_valid(&self) -> bool {
        self.lower <= self.upper
    }
}

/// A box of positions \[m\] or velocities \[m/s\]: x, y, z.
pub type BoundsBox = [Bounds; 3];

/// The width of a box is the width of its widest side.
pub fn box_width(of: &BoundsBox) -> f64 {
    of.iter().fold(0.0, |widest, side| side.width().max(widest))
}

/// A measured value with its stated error bound: the true value lies in `value ± error`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// What the sensor says.
    pub value: f64,
    /// How far the truth may be from it, at most; never negative.
    pub error: f64,
}

/// All that an AUV is ever told about itself and its world, once, at birth or rebirth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Born {
    /// Own id: what its pings carry as sender.
    pub auv: AuvId,
    /// Index of the own group.
    pub group: u16,
    /// Display name, such as `green-17`.
    pub name: String,
    /// When it wakes and how fast it acts.
    pub wake: Wake,
    /// What is certain about its clock.
    pub clock: ClockBounds,
    /// Local time of the birth, before the first tick.
    pub birth: LocalTime,
    /// A box that holds its position at birth, in metres.
    pub prior_position_m: BoundsBox,
    /// What is certain about its body and the water around it.
    pub body: BodyBounds,
    /// What is certain about its modem and about sound.
    pub modem: ModemBounds,
    /// What it is to do.
    pub orders: Orders,
}

/// An AUV's control ticks `s_k = first_tick + k * period_ns`, in its local time, and its reaction time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Wake {
    /// Local time of the first tick, `s_0`, less than one period after birth.
    pub first_tick: LocalTime,
    /// Local nanoseconds between ticks.
    pub period_ns: i64,
    /// Local nanoseconds from a tick to the moment its answer takes effect (R).
    pub reaction_ns: i64,
}

/// Bounds of an AUV's clock `h`: `dh/dt` in `[1 - drift, 1 + drift]`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ClockBounds {
    /// Bound of the drift, 0 <= drift < 1, without unit.
    pub drift: f64,
    /// True time minus local time at birth, in seconds.
    pub offset_s: Bounds,
    /// Every stamp `s` of an event at true time t obeys `h(t) in [s - stamp_ns, s + stamp_ns]` nanoseconds, and so does
    /// every action named for local time `s`.
    pub stamp_ns: i64,
}

/// Bounds of the body's motion: `dp/dt = v + current + disturbance`, where `v` is the velocity through the water.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BodyBounds {
    /// Bound of `|v|` in m/s.
    pub speed_m_s: f64,
    /// Bound of `|dv/dt|` in m/s², turning included.
    pub acceleration_m_s2: f64,
    /// The current, wherever the body is, in m/s.
    pub current_m_s: BoundsBox,
    /// How fast the current that the moving body meets changes, in m/s², per axis: at two moments `dt` true seconds apart its
    /// components differ by at most `current_change_m_s2 * dt + current_step_m_s`. Zero where the current is uniform.
    pub current_change_m_s2: [f64; 3],
    /// The part of that change which may come at once, in m/s, per axis: the current that acts on a body is constant between
    /// knots of true time and jumps at each to what it is at the body's place. Zero where the current is uniform.
    pub current_step_m_s: [f64; 3],
    /// The state noise of seed 001, equation (5.1), in m/s, with the rounding of the simulator's integrator inside.
    pub disturbance_m_s: BoundsBox,
}

/// Bounds of the modem and of sound.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ModemBounds {
    /// Up to this range others hear it, in metres.
    pub range_m: f64,
    /// What is heard comes from no farther than this, in metres, whoever sent it; infinite when unknown.
    pub hearing_range_m: f64,
    /// Effective speed of sound, in m/s.
    pub sound_speed_m_s: Bounds,
    /// Whether that is one number, the same everywhere and always, that is worth finding out.
    pub sound_speed_is_constant: bool,
    /// Error of an arrival's stamp against the true arrival, in seconds, solver and modem together.
    pub timestamp_s: f64,
    /// Bytes one ping may have.
    pub frame_bytes: u16,
}

/// What the AUV is to do: how it estimates, how it steers, when it pings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Orders {
    /// How it finds out where it is.
    pub estimator: Estimator,
    /// How it steers.
    pub controller: Controller,
    /// When it pings.
    pub access: MediumAccess,
    /// The part of the water it must not leave, in metres.
    pub area_m: BoundsBox,
    /// A promise to break, so that the channel's check can be seen to catch it.
    pub sabotage: Option<Sabotage>,
    /// How it encloses its neighbours in its own frame, if it does.
    pub relative: Option<Relative>,
}

/// How an AUV encloses its neighbours in its own frame (seed 002, chapter 5).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Relative {
    /// What it takes from a ping.
    pub measures: Measures,
    /// Whether it believes the velocity that a ping tells; else it knows of its neighbours' motion only what `fellows` says.
    pub exchanged: bool,
    /// So many of a neighbour's last pings count together; one for the last alone.
    pub remembered: u16,
    /// Bounds that the body of every neighbour keeps.
    pub fellows: BodyBounds,
}

/// What a ping tells of where it comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Measures {
    /// The range, by the clocks at both ends, and the bearing, by an array.
    RangeAndBearing,
    /// The bearing alone.
    Bearing,
    /// The range alone.
    Range,
}

/// How an AUV encloses its position and clock.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Estimator {
    /// The state tube: guaranteed, contracted by every measurement.
    Tube(TubeSettings),
    /// An extended Kalman filter: a Gaussian, without guarantee.
    Ekf(EkfSettings),
    /// Log, attitude and clock alone, from the prior on.
    DeadReckoning,
}

/// How a tube estimator works.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TubeSettings {
    /// Local nanoseconds of the past that are kept. What is told later than that is ignored, so no packet may take longer.
    pub horizon_ns: i64,
    /// So many pings are kept as rings around the present position, carried along by odometry: the last that told something of position
    /// and clock together; 0 for none.
    pub rings: u16,
    /// The rings are contracted together once more as long as that makes a side smaller by this part of its width.
    pub stopping_ratio: f64,
    /// What may be wrong of what is heard; nothing when `None`.
    pub outliers: Option<Outliers>,
    /// What to do when nothing is left.
    pub on_empty: Recovery,
}

impl TubeSettings {
    /// The plainest tube: forward only, box by box, and all that is heard is believed.
    pub const fn forward(horizon_ns: i64) -> Self {
        let on_empty = Recovery::Drop;
        Self { horizon_ns, rings: 0, stopping_ratio: 0.05, outliers: None, on_empty }
    }
}

/// How many pings may be wrong: at most `tolerated` of any `window` in a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Outliers {
    /// m, in pings heard.
    pub window: u16,
    /// q, the most that is ever assumed.
    pub tolerated: u16,
    /// Assume the fewest that leave something (GOMNE) and this margin r more, but never more than q; `None` to assume q.
    pub margin: Option<u16>,
}

/// What an estimator does when nothing is left of its set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Recovery {
    /// Ignores the measurement that left nothing.
    Drop,
    /// Ignores as few of the remembered pings as leave something.
    Relax,
    /// Begins again, from the whole area.
    Restart,
}

/// How a Kalman filter works.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct EkfSettings {
    /// An innovation of more than so many standard deviations is rejected; infinite to believe everything.
    pub gate_sigma: f64,
    /// How what others believe is taken in.
    pub fusion: Fusion,
}

/// How a Gaussian takes in what others believe.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Fusion {
    /// As if it were independent of what the AUV believes itself.
    Independent,
    /// By covariance intersection, which holds whatever they have in common.
    CovarianceIntersection,
}

/// When an AUV pings. Local times and local nanoseconds, unless said otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum MediumAccess {
    /// Never.
    Silent,
    /// At `first + k * period_ns`.
    Periodic {
        /// Local time of the first ping.
        first: LocalTime,
        /// Local nanoseconds between pings.
        period_ns: i64,
    },
    /// Pure ALOHA: gaps are drawn from the exponential distribution.
    Aloha {
        /// No ping before this.
        first: LocalTime,
        /// Mean of the gaps.
        mean_period_ns: i64,
        /// What the AUV's own draws begin with.
        entropy: u64,
    },
    /// In one slot of true time of each frame, kept by the own clock: the whole packet, and its sound up to the guard range, stay
    /// inside the slot wherever in its interval the clock's offset is; where they do not fit, the AUV keeps silent.
    Slotted {
        /// Length of a slot, in nanoseconds of true time.
        slot_ns: i64,
        /// Slots of a frame, which begins at true time zero and repeats.
        slots: u32,
        /// The own slot.
        slot: u32,
        /// Length of a packet, in nanoseconds of true time.
        packet_ns: i64,
        /// Sound needs so long to the guard range, in nanoseconds of true time.
        propagation_ns: i64,
    },
    /// Listen before talk: as periodic, but the modem holds a ping back when it hears something, and it is tried again later.
    Csma {
        /// Local time of the first ping.
        first: LocalTime,
        /// Local nanoseconds between pings.
        period_ns: i64,
        /// The medium must have been quiet for so long.
        listen_ns: i64,
        /// Mean of the exponential gap before a ping that was held back is tried again.
        backoff_ns: i64,
        /// What the AUV's own draws begin with.
        entropy: u64,
    },
}

/// How an AUV steers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Controller {
    /// Stay at the middle of the prior box.
    Hold,
    /// Follow `centre + (radius cos a, radius sin a, heave cos(a + heave_phase))` with `a = rate t + phase`,
    /// t the middle of the own clock interval.
    Circle {
        /// Centre in metres.
        centre_m: [f64; 3],
        /// Radius in metres.
        radius_m: f64,
        /// Angular rate in rad/s; negative turns clockwise.
        rate_rad_s: f64,
        /// Angle at true time zero, in rad.
        phase_rad: f64,
        /// Amplitude of the vertical motion in metres.
        heave_m: f64,
        /// Phase of the vertical motion against the angle, in rad.
        heave_phase_rad: f64,
    },
    /// Visit points in turn.
    Waypoints {
        /// The points, in metres.
        points_m: Vec<[f64; 3]>,
        /// Cruise speed in m/s.
        speed_m_s: f64,
        /// A point counts as reached within this distance, in metres.
        reach_m: f64,
        /// Whether the first point follows the last.
        repeat: bool,
    },
    /// Reynolds' separation, cohesion and alignment on the neighbours heard (seed 001, section 6.3).
    Reynolds {
        /// Cruise speed in m/s.
        speed_m_s: f64,
        /// Weight of separation.
        separation: f64,
        /// Weight of cohesion.
        cohesion: f64,
        /// Weight of alignment.
        alignment: f64,
        /// Added to the separation distance `(w_i + w_j) / 2`, in metres.
        margin_m: f64,
        /// A neighbour not heard for so many local nanoseconds is forgotten.
        forget_ns: i64,
        /// AUVs it follows in cohesion and alignment, as ranges of ids; separation heeds everyone.
        trusts: Vec<Fleetmates>,
    },
}

/// AUVs with consecutive ids, such as those of one owner: `first .. first + count`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fleetmates {
    /// The first of them.
    pub first: AuvId,
    /// How many.
    pub count: u32,
}

impl Fleetmates {
    /// Whether `auv` is one of them.
    pub fn contains(&self, auv: AuvId) -> bool {
        auv.0.checked_sub(self.first.0).is_some_and(|index| index < self.count)
    }
}

/// A broken promise, for tests of the checker: a healthy run has none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Sabotage {
    /// The estimator believes half the stated clock drift.
    HalvedClock,
    /// Pings carry a position box ten metres and its own width east of where it should be.
    LyingPing,
    /// The AUV reports an emptied set at tick 10.
    EmptySet,
}

/// What an AUV senses up to one control tick: the events with stamps in `(s_{k-1}, s_k]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sensed {
    /// Index k of the tick.
    pub tick: u64,
    /// Local time `s_k` of the tick.
    pub stamp: LocalTime,
    /// The events, sorted by stamp, then kind, then index.
    pub events: Vec<Event>,
}

/// Something sensed, with the local time of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// Own clock's reading.
    pub stamp: LocalTime,
    /// What it was.
    pub sense: Sense,
}

/// The kinds of things an AUV senses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Sense {
    /// Attitude and log: velocity through the water is `R(heading, pitch) (speed, 0, 0)`.
    Inertial {
        /// Counter-clockwise from east, in rad.
        heading_rad: Measured,
        /// Positive nose up, in rad.
        pitch_rad: Measured,
        /// Along the nose, in m/s.
        speed_m_s: Measured,
    },
    /// Doppler velocity log: velocity over ground in the axes of the body, forward, to port, and up.
    Dvl {
        /// In m/s.
        velocity_m_s: [Measured; 3],
    },
    /// Pressure: depth = -z.
    Depth {
        /// In metres, positive down.
        depth_m: Measured,
    },
    /// A satellite fix near the surface: where and when, certain at the event's stamp.
    Gnss {
        /// Position box in metres.
        position_m: BoundsBox,
        /// True time, in seconds.
        time_s: Bounds,
    },
    /// A ping heard; the event's stamp is the arrival of its beginning, within the modem's stated timestamp error. A packet takes
    /// time, so this is told at the first tick after its end: the stamp may lie before the tick before.
    Heard {
        /// The bytes as the modem received them.
        frame: Frame,
    },
    /// The modem heard others at the stamp, so the ping that was booked for it was held back.
    Held,
    /// The direction from which a ping arrived, by an ultra-short baseline array in the nose; comes with the ping that was heard
    /// from `sender`, at the same stamp.
    ///
    /// From where the receiver is at the reception to where the emitter was at the emission. Where rays bend the azimuth still leads
    /// there, the elevation is the apparent one: that of the sound as it comes in, after its bounces.
    Bearing {
        /// Who emitted the ping.
        sender: AuvId,
        /// Counter-clockwise from the nose, in the horizontal plane, in rad; may leave (-pi, pi] by its error.
        azimuth_rad: Measured,
        /// Positive upwards from the horizontal plane, in rad, if the array has a vertical baseline.
        elevation_rad: Option<Measured>,
        /// The own heading at the arrival, by the array's own compass: what the azimuth is counted from, counter-clockwise from
        /// east, in rad.
        heading_rad: Measured,
    },
}

/// What an AUV answers to one [`Sensed`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Acted {
    /// Index of the tick that it answers.
    pub tick: u64,
    /// Desired velocity, from `s_k + R` on.
    pub setpoint: Setpoint,
    /// Pings to emit at exact local times, not before `s_k + R`.
    pub pings: Vec<PlannedPing>,
    /// Own beliefs at the tick: for the check and the record, never for another AUV.
    pub report: Report,
}

/// A desired velocity through the water.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Setpoint {
    /// x, y, z in m/s.
    pub velocity_m_s: [f64; 3],
}

/// A ping booked for one local time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlannedPing {
    /// Local time of the emission.
    pub at: LocalTime,
    /// The modem holds the ping back when it heard something within so many local nanoseconds before; zero to emit anyway.
    #[serde(default)]
    pub listen_ns: i64,
    /// The bytes to emit: the AUV's prediction for that time.
    pub frame: Frame,
}

/// What an AUV believes at a tick, all of it checked against the truth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Report {
    /// Encloses the position at the tick, in metres.
    pub position_m: BoundsBox,
    /// Encloses true time minus local time at the tick, in seconds.
    pub clock_offset_s: Bounds,
    /// Encloses position and clock over all of `[s_{k-1}, s_k]`.
    pub slice: Slice,
    /// Why the enclosure emptied at this tick, if it did.
    #[serde(default)]
    pub emptied: Option<Emptied>,
    /// How many neighbours the controller heeds.
    #[serde(default)]
    pub neighbours: u16,
    /// Measurements that made the enclosure smaller since the last tick.
    #[serde(default)]
    pub contractions: u16,
    /// Pings told at this tick that the estimator took for outliers, or dropped.
    #[serde(default)]
    pub rejected: u16,
    /// Where the neighbours are whom it follows, sorted by AUV; none unless its [orders](Orders::relative) say so.
    #[serde(default)]
    pub around: Vec<Around>,
    /// Separate parts of the set; one unless the AUV does not know which of several places it is at.
    #[serde(default = "one_component")]
    pub components: u16,
    /// What a Kalman filter believes; its boxes reach three standard deviations to either side. Nobody promises anything then.
    #[serde(default)]
    pub gaussian: Option<Gaussian>,
}

/// Of a report that says nothing else.
fn one_component() -> u16 {
    1
}

/// A neighbour as it is seen from an AUV.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Around {
    /// Who.
    pub auv: AuvId,
    /// Encloses its position less that of the AUV at the tick, in metres east and north.
    pub position_m: [Bounds; 2],
}

/// A Gaussian over position and clock: east, north, up in metres, and true minus local time in seconds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Gaussian {
    /// The mean.
    pub mean: [f64; 4],
    /// The upper triangle of the covariance, row by row.
    pub covariance: [f64; 10],
}

/// An enclosure over the whole interval between two ticks.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Slice {
    /// Encloses every position in between, in metres.
    pub position_m: BoundsBox,
    /// Encloses true time minus local time in between, in seconds.
    pub clock_offset_s: Bounds,
}

/// An enclosure that became empty: a model or a measurement broke its bounds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Emptied {
    /// Local time of the measurement that left nothing.
    pub stamp: LocalTime,
    /// Which kind of measurement.
    pub by: Culprit,
}

/// What emptied an enclosure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Culprit {
    /// Heading, pitch or speed against the velocity that was possible.
    Inertial,
    /// A velocity over ground against the current that was possible.
    Dvl,
    /// A depth.
    Depth,
    /// A satellite fix.
    Gnss,
    /// A ping from this AUV.
    Ping(AuvId),
    /// A deliberate emptying, see [`Sabotage::EmptySet`].
    Sabotage,
}
