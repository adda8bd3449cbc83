//! What a scenario says, after validation: plain data with every default filled in.

use serde::Serialize;

/// Three coordinates: x east, y north, z up, in the unit that the field's name says.
pub type Vec3 = [f64; 3];
/// Three ranges `[least, greatest]`.
pub type Region = [[f64; 2]; 3];

/// A validated scenario: what it takes, with the seed of the run, to determine every event of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Scenario {
    /// Name, as in `shoal run NAME`.
    pub name: String,
    /// One line for `shoal scenarios`.
    pub summary: String,
    /// Where it comes from, such as `001 §5.4.2`; empty when nowhere.
    pub source: String,
    /// Seed of every random draw.
    pub seed: u64,
    /// Simulated nanoseconds.
    pub duration_ns: i64,
    /// Nanoseconds of true time per lockstep window: execution only, never the result.
    pub window_ns: i64,
    /// Nanoseconds between knots of the true trajectories and clocks.
    pub knot_ns: i64,
    /// How every error is drawn inside its bounds.
    pub noise: Noise,
    /// What happens when an AUV's process ends.
    pub on_crash: OnCrash,
    /// The water.
    pub environment: Environment,
    /// The AUVs, in the order of the file.
    pub groups: Vec<Group>,
    /// A truth shifted without telling the body: a test of the checker.
    pub sabotage: Option<WaterSabotage>,
}

/// How errors are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Noise {
    /// Uniformly inside the bounds.
    Uniform,
    /// Always at a bound: the worst case for an enclosure.
    Adversarial,
}

impl Noise {
    /// The moods by the names that scenario files and the command line use.
    pub const NAMES: &[(&str, Noise)] = &[("uniform", Noise::Uniform), ("adversarial", Noise::Adversarial)];
}

impl std::str::FromStr for Noise {
    type Err = UnknownNoise;

    fn from_str(name: &str) -> Result<Self, UnknownNoise> {
        let found = Self::NAMES.iter().find(|(known, _)| *known == name);
        found.map(|(_, noise)| *noise).ok_or_else(|| UnknownNoise { name: name.to_string() })
    }
}

/// A name that is none of [`Noise::NAMES`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("unknown noise `{name}`: write `uniform` or `adversarial`")]
pub struct UnknownNoise {
    /// What was written.
    pub name: String,
}

/// What happens when an AUV's process ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum OnCrash {
    /// It becomes a silent, drifting body and the run goes on.
    Drift,
    /// The run ends.
    Abort,
}

/// The water and the sound in it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Environment {
    /// The part of the water where the mission takes place, in metres.
    pub area_m: Region,
    /// Level of the acoustic channel.
    pub level: Level,
    /// Speed of sound in m/s.
    pub sound_speed_m_s: f64,
    /// How far the stated speed of sound may be from the true one, in m/s.
    pub sound_speed_error_m_s: f64,
    /// True current in m/s.
    pub current_m_s: Vec3,
    /// How far the stated current may be from the true one, per axis, in m/s.
    pub current_error_m_s: Vec3,
}

/// How real sound is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Level {
    /// Constant speed, sharp range limit.
    Ideal,
}

/// A group of like AUVs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Group {
    /// Name; AUVs are called `NAME-0`, `NAME-1`, ...
    pub name: String,
    /// How many.
    pub count: u32,
    /// Body.
    pub kind: Kind,
    /// Clock.
    pub clock: Clock,
    /// Sensors.
    pub sensors: Sensors,
    /// Modem.
    pub modem: Modem,
    /// Where they begin.
    pub start: Start,
    /// Local nanoseconds between control ticks; each AUV's phase in it is drawn.
    pub control_period_ns: i64,
    /// Local nanoseconds from a tick to the moment its answer takes effect.
    pub reaction_ns: i64,
    /// How they estimate.
    pub estimator: Estimator,
    /// How they steer.
    pub controller: Controller,
    /// A promise to break: a test of the checker.
    pub sabotage: Option<AuvSabotage>,
}

/// What a body can do, and what the water does to it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Kind {
    /// Greatest speed through the water in m/s.
    pub speed_max_m_s: f64,
    /// Greatest change of speed in m/s².
    pub acceleration_max_m_s2: f64,
    /// Greatest rate of turn in heading and, separately, in pitch, in rad/s.
    pub turn_rate_max_rad_s: f64,
    /// Steepest climb or dive, in rad.
    pub pitch_max_rad: f64,
    /// Bound of the state noise per axis, in m/s (n_x of seed 001).
    pub disturbance_m_s: Vec3,
    /// Two bodies of this kind collide when closer than this, in metres.
    pub length_m: f64,
}

/// How a clock behaves.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Clock {
    /// Bound d of the drift: dh/dt in [1-d, 1+d] (n_h of seed 001).
    pub drift_bound: f64,
    /// Part of the bound, 0 to 1, within which the rate wanders during a run; the rest is constant per clock.
    pub wander_fraction: f64,
    /// Bound of the unknown offset at time zero in seconds: the true offset is drawn inside it.
    pub offset_bound_s: f64,
}

/// What is sensed, with stated error bounds. An error bound of zero is a perfect sensor.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sensors {
    /// Heading error in rad.
    pub heading_error_rad: f64,
    /// Pitch error in rad.
    pub pitch_error_rad: f64,
    /// Log (speed through water) error in m/s.
    pub speed_error_m_s: f64,
    /// Depth error in metres; `None` without a pressure sensor.
    pub depth_error_m: Option<f64>,
    /// Satellite receiver; `None` without one.
    pub gnss: Option<Gnss>,
}

/// A satellite receiver.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Gnss {
    /// Works when z > -`depth_max_m`.
    pub depth_max_m: f64,
    /// Local nanoseconds between fixes.
    pub period_ns: i64,
    /// Error per axis in metres.
    pub position_error_m: Vec3,
    /// Error of the time in seconds.
    pub time_error_s: f64,
}

/// The acoustic modem.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Modem {
    /// Others hear it up to this range, in metres.
    pub range_m: f64,
    /// Local nanoseconds between pings; `None` for a silent AUV. Each AUV's phase is drawn unless `ping_phase_ns` says it.
    pub ping_period_ns: Option<i64>,
    /// Local time of the first ping; drawn when `None`.
    pub ping_phase_ns: Option<i64>,
    /// Error of an arrival's timestamp in seconds.
    pub timestamp_error_s: f64,
    /// Bytes one ping may have.
    pub frame_bytes: u16,
}

/// Where the AUVs of a group begin. The true position is drawn inside the prior box, which is what the AUV is told.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Start {
    /// Where.
    pub place: Place,
    /// Least and greatest width of the prior box in metres; each AUV's is drawn in between.
    pub box_width_m: [f64; 2],
    /// Heading in rad; drawn when `None`.
    pub heading_rad: Option<f64>,
    /// Speed through the water in m/s.
    pub speed_m_s: f64,
}

/// Places to begin.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Place {
    /// Drawn uniformly.
    Region(Region),
    /// One point per AUV.
    Points(Vec<Vec3>),
    /// On the controller's circle, evenly spread from its phase on, heading along it.
    OnCircle,
}

/// How they estimate.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Estimator {
    /// The state tube.
    Tube {
        /// Local nanoseconds of the past that are kept.
        horizon_ns: i64,
    },
}

/// How they steer.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Controller {
    /// Stay where the run begins.
    Hold,
    /// Circle: `centre + (radius cos a, radius sin a, heave cos(a + heave_phase))`, `a = rate t + phase + spread k/count`
    /// for the k-th AUV of the group, spread = 2 pi.
    Circle {
        /// Centre in metres.
        centre_m: Vec3,
        /// Radius in metres.
        radius_m: f64,
        /// Angular rate in rad/s; negative turns clockwise.
        rate_rad_s: f64,
        /// Angle of the group's first AUV at time zero, in rad.
        phase_rad: f64,
        /// Amplitude of the vertical motion in metres.
        heave_m: f64,
        /// Phase of the vertical motion against the angle, in rad.
        heave_phase_rad: f64,
    },
    /// Visit points in turn.
    Waypoints {
        /// The points in metres.
        points_m: Vec<Vec3>,
        /// Cruise speed in m/s.
        speed_m_s: f64,
        /// A point counts as reached within this distance, in metres.
        reach_m: f64,
        /// Whether the first point follows the last.
        repeat: bool,
    },
    /// Reynolds' rules.
    Reynolds {
        /// Cruise speed in m/s.
        speed_m_s: f64,
        /// Weight of separation.
        separation: f64,
        /// Weight of cohesion.
        cohesion: f64,
        /// Weight of alignment.
        alignment: f64,
        /// Added to the separation distance, in metres.
        margin_m: f64,
        /// A neighbour not heard for so many local nanoseconds is forgotten.
        forget_ns: i64,
        /// Indices of the groups heeded in cohesion and alignment, sorted.
        trusts: Vec<u16>,
    },
}

/// A promise that an AUV breaks on purpose.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum AuvSabotage {
    /// The estimator believes half the clock's drift bound.
    HalvedClock,
    /// Pings carry a box that is not where the AUV is.
    LyingPing,
    /// The estimator empties its set without cause.
    EmptySet,
}

/// A promise that the water breaks on purpose.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum WaterSabotage {
    /// From `at_ns` on, this AUV's true x is one metre more than its motion accounts for.
    ShiftedTruth {
        /// Which AUV.
        auv: u32,
        /// True time in nanoseconds.
        at_ns: i64,
    },
}

impl Scenario {
    /// Number of AUVs of all groups.
    pub fn auv_count(&self) -> u32 {
        self.groups.iter().map(|group| group.count).sum()
    }
}
