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
    /// What goes wrong beyond all that is stated, in the order of the file.
    pub faults: Vec<Fault>,
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
    /// Speed of sound in m/s, where no profile says more.
    pub sound_speed_m_s: f64,
    /// How far the stated speed of sound may be from the true one, everywhere by the same amount, in m/s.
    pub sound_speed_error_m_s: f64,
    /// True current in m/s; what [`current_field`](Self::current_field) says is added.
    pub current_m_s: Vec3,
    /// How far the stated current may be from the true one, per axis, in m/s.
    pub current_error_m_s: Vec3,
    /// How the current differs from place to place.
    pub current_field: CurrentField,
}

/// How the current differs from place to place: added to the uniform current.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum CurrentField {
    /// It does not.
    Uniform,
    /// Linear in depth between the surface and a depth, constant below.
    Shear {
        /// At z = 0, in m/s.
        surface_m_s: Vec3,
        /// At `depth_m` and below, in m/s.
        deep_m_s: Vec3,
        /// In metres, positive down.
        depth_m: f64,
    },
    /// A Rankine vortex around a vertical axis: solid rotation in the core, falling as 1/r outside.
    Vortex {
        /// East and north of the axis, in metres.
        centre_m: [f64; 2],
        /// Radius of the core in metres.
        core_radius_m: f64,
        /// Speed at the rim of the core in m/s; negative turns clockwise.
        speed_m_s: f64,
    },
}

/// How real sound is.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[expect(clippy::large_enum_variant, reason = "a scenario has one")]
pub enum Level {
    /// Constant speed, sharp range limit, no noise and no packets.
    Ideal,
    /// Sound as in water: refracted, absorbed, noisy, reflected, colliding.
    Sea(Sea),
}

/// What sound meets at level `sea`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sea {
    /// Speed of sound over depth.
    pub sound_speed: SoundSpeed,
    /// Depth of the sea floor in metres, positive down; flat.
    pub bottom_depth_m: f64,
    /// Temperature for absorption (and for the speed of sound where nothing else says it), in degrees C.
    pub temperature_c: f64,
    /// Salinity for absorption, in PSU.
    pub salinity_psu: f64,
    /// Acidity for absorption.
    pub ph: f64,
    /// Formula of absorption.
    pub absorption: Absorption,
    /// Exponent of spreading: transmission loss is `10 * exponent * lg(length)`; 1 cylindrical, 1.5 practical, 2 spherical.
    pub spreading_exponent: f64,
    /// Shipping activity of the Wenz curves, 0 to 1.
    pub shipping: f64,
    /// Wind speed in m/s: noise, and roughness of the surface.
    pub wind_m_s: f64,
    /// Loss at each bounce off the surface in dB; from the wind when `None`.
    pub surface_loss_db: Option<f64>,
    /// The sea floor.
    pub bottom: Bottom,
    /// Paths with so many bounces off surface and bottom, and fewer, are heard; 0 for the direct one alone.
    pub bounces_max: u8,
    /// How the level fluctuates.
    pub fading: Fading,
}

/// Speed of sound over depth.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum SoundSpeed {
    /// The same everywhere: the environment's `sound_speed_m_s`.
    Uniform,
    /// A profile by name.
    Named(NamedProfile),
    /// Speeds at depths, linear in between.
    Speeds {
        /// Increasing, in metres, positive down.
        depths_m: Vec<f64>,
        /// In m/s, one for each depth.
        speeds_m_s: Vec<f64>,
    },
    /// Temperature and salinity at depths.
    Water {
        /// Increasing, in metres, positive down.
        depths_m: Vec<f64>,
        /// In degrees C, one for each depth.
        temperatures_c: Vec<f64>,
        /// In PSU, one for each depth.
        salinities_psu: Vec<f64>,
        /// How speed follows from them.
        formula: SoundSpeedFormula,
    },
}

/// Profiles of the speed of sound by name; what each is stands with the channel's acoustics.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum NamedProfile {
    /// A mixed surface layer above a thermocline.
    MixedLayer,
    /// Warm water on cold.
    SummerThermocline,
    /// Cold at the surface, faster with depth.
    Arctic,
    /// Munk's canonical deep-sea profile.
    Munk,
}

/// Formulas for the speed of sound in sea water.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum SoundSpeedFormula {
    /// Mackenzie 1981.
    Mackenzie,
    /// Medwin 1975, to 1,000 m.
    Medwin,
    /// Chen and Millero 1977 (UNESCO) with the coefficients of Wong and Zhu 1995.
    ChenMillero,
    /// Del Grosso 1974.
    DelGrosso,
}

/// Formulas for the absorption of sound in sea water.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Absorption {
    /// Thorp, in the variant of Stojanovic.
    ThorpStojanovic,
    /// Thorp, in the variant of Jensen, Kuperman, Porter and Schmidt.
    ThorpJkps,
    /// Francois and Garrison 1982.
    FrancoisGarrison,
    /// Ainslie and McColm 1998.
    AinslieMcColm,
}

/// A fluid sea floor.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Bottom {
    /// In kg/m³.
    pub density_kg_m3: f64,
    /// In m/s.
    pub sound_speed_m_s: f64,
    /// Attenuation in dB per wavelength.
    pub attenuation_db_wavelength: f64,
}

/// How the level of a packet fluctuates around what distance makes of it.
///
/// A scenario that does not say it has Rician fading with a steady part of 6 dB, one draw for each packet: bounces off
/// surface and bottom are paths of their own, so that what is left to fade on each path is the little that is scattered
/// around it; and a packet is over before the waves that scatter it have changed much. Our own round figure.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Fading {
    /// With which distribution.
    pub kind: FadingKind,
    /// How fast.
    pub per: FadingPer,
}

/// Distributions of fading.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum FadingKind {
    /// None: additive Gaussian noise only.
    Gaussian,
    /// No steady part.
    Rayleigh,
    /// A steady part.
    Rician {
        /// Power of the steady part over that of the rest, in dB.
        k_db: f64,
    },
}

/// How fast fading is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum FadingPer {
    /// One draw for each packet and path: slow fading.
    Packet,
    /// Averaged over each bit: fast fading.
    Bit,
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
    /// How they enclose their neighbours in their own frames, if they do.
    pub relative: Option<Relative>,
    /// How they steer.
    pub controller: Controller,
    /// A promise to break: a test of the checker.
    pub sabotage: Option<AuvSabotage>,
    /// Program and arguments that start each of its AUVs, if they are not Shoal's own.
    pub command: Option<Vec<String>>,
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
    /// Doppler velocity log; `None` without one.
    pub dvl: Option<Dvl>,
    /// Satellite receiver; `None` without one.
    pub gnss: Option<Gnss>,
}

/// A Doppler velocity log: velocity over ground, while it sees the bottom.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Dvl {
    /// Sees the bottom up to this altitude above it, in metres.
    pub altitude_max_m: f64,
    /// Error per axis of the body, in m/s.
    pub velocity_error_m_s: f64,
}

/// How AUVs enclose their neighbours in their own frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Relative {
    /// What they take from a ping.
    pub measures: Measures,
    /// Whether they believe the velocities that pings tell.
    pub exchanged: bool,
    /// So many of a neighbour's last pings count together.
    pub remembered: u16,
}

/// What a ping tells of where it comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Measures {
    /// Range and bearing.
    RangeAndBearing,
    /// Bearing alone.
    Bearing,
    /// Range alone.
    Range,
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
    /// Name of the one of [`presets::MODEMS`](crate::presets::MODEMS) that it is, or is like.
    pub name: &'static str,
    /// Others hear it up to this range at level `ideal`, in metres.
    pub range_m: f64,
    /// When it emits.
    pub access: MediumAccess,
    /// Error of an arrival's timestamp in seconds.
    pub timestamp_error_s: f64,
    /// Error of the direction from which a ping arrives, in rad; `None` for a modem that measures none.
    pub bearing_error_rad: Option<f64>,
    /// What it takes for the arrival of a ping may be something later.
    pub outliers: FalseArrivals,
    /// Bytes one ping may have.
    pub frame_bytes: u16,
    /// What it does to sound at level `sea`; `None` for one that works at level `ideal` only.
    pub physical: Option<PhysicalLayer>,
    /// So many devices can be told apart; more are an extrapolation. `None` when nobody says.
    pub addresses: Option<u32>,
    /// When it listens; always when `None`.
    pub duty_cycle: Option<DutyCycle>,
}

/// How often a modem stamps a ping too late, beyond its stated error: what it took for the arrival was an echo. Nobody is told.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct FalseArrivals {
    /// The part of all pings heard of which the stamp is wrong, 0 to 1.
    pub rate: f64,
    /// By so many seconds at most; drawn evenly for each.
    pub delay_s: f64,
}

/// What a modem does to sound.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PhysicalLayer {
    /// Source level in dB re 1 µPa at 1 m.
    pub source_level_db: f64,
    /// Centre of its band in Hz.
    pub centre_hz: f64,
    /// Width of its band in Hz.
    pub bandwidth_hz: f64,
    /// Bits of a packet per second, after coding.
    pub bit_rate_bit_s: f64,
    /// Length of what precedes the bits of a packet: detection signal, header, in seconds.
    pub preamble_s: f64,
    /// How bits become sound.
    pub modulation: Modulation,
    /// What coding saves, in dB of Eb/N0.
    pub coding_gain_db: f64,
    /// A packet is noticed from this ratio of signal to noise and interference in the band on, in dB.
    pub detection_threshold_db: f64,
    /// A packet that begins while another is being received takes over when it is louder by so many dB.
    pub capture_db: f64,
}

/// How bits become sound.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Modulation {
    /// Coherent binary phase-shift keying.
    Bpsk,
    /// Noncoherent binary frequency-shift keying.
    Fsk,
}

/// When a modem listens: for the first `awake_ns` of each `period_ns` of its local time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct DutyCycle {
    /// Local nanoseconds.
    pub period_ns: i64,
    /// Local nanoseconds.
    pub awake_ns: i64,
}

/// When a modem emits, as its AUV decides.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum MediumAccess {
    /// Never.
    Silent,
    /// Strictly periodic in local time (seed 001).
    Periodic {
        /// Local nanoseconds between pings.
        period_ns: i64,
        /// Local time of the first ping; drawn when `None`.
        phase_ns: Option<i64>,
    },
    /// Pure ALOHA: at random, with this mean.
    Aloha {
        /// Mean of the local nanoseconds between pings.
        mean_period_ns: i64,
    },
    /// A slot of true time for each AUV, kept by its own drifting clock.
    Slotted {
        /// Nanoseconds of true time.
        slot_ns: i64,
        /// How many slots make a frame; AUV i has slot i modulo this.
        slots: u32,
        /// Slots do not overlap for receivers up to this far away, in metres.
        guard_range_m: f64,
    },
    /// Listen before talk.
    Csma {
        /// Local nanoseconds between pings.
        period_ns: i64,
        /// The medium must have been quiet for so many local nanoseconds.
        listen_ns: i64,
        /// Mean of the local nanoseconds after which a ping that was held back is tried again.
        backoff_ns: i64,
    },
}

/// Where the AUVs of a group begin. The true position is drawn inside the prior box, which is what the AUV is told.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Start {
    /// Where.
    pub place: Place,
    /// Least and greatest width of the prior box in metres; each AUV's is drawn in between.
    pub box_width_m: [f64; 2],
    /// Whether it is told a box at all; if not, it may be anywhere in the area.
    pub known: bool,
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
    /// Near a point each of a grid.
    Grid(Grid),
}

impl Place {
    /// The point, in metres, to which the `index`-th AUV of the group belongs; `None` where places are drawn or on a circle.
    pub fn point_m(&self, index: u32) -> Option<Vec3> {
        match self {
            Self::Points(points) => points.get(index as usize).copied(),
            Self::Grid(grid) => Some(grid.point_m(index)),
            Self::Region(_) | Self::OnCircle => None,
        }
    }
}

/// Points in columns (eastwards), rows (northwards) and layers (upwards), counted in this order: the AUVs of a group stand row by row,
/// layer by layer.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Grid {
    /// The first point: the most westerly, southerly and deepest, in metres.
    pub first_m: Vec3,
    /// Metres between neighbours in each direction.
    pub spacing_m: Vec3,
    /// Points in each direction.
    pub counts: [u32; 3],
    /// How far from its point east and north an AUV begins at most, in metres.
    pub scatter_m: f64,
}

impl Grid {
    /// The `index`-th point, in metres.
    ///
    /// ```
    /// use shoal_scenario::model::Grid;
    /// let grid = Grid {
    ///     first_m: [0.0, 0.0, -20.0], spacing_m: [100.0, 50.0, 0.0], counts: [10, 3, 1], scatter_m: 0.0,
    /// };
    /// assert_eq!(grid.point_m(9), [900.0, 0.0, -20.0]);
    /// assert_eq!(grid.point_m(12), [200.0, 50.0, -20.0]);
    /// assert_eq!(grid.points(), 30);
    /// ```
    pub fn point_m(&self, index: u32) -> Vec3 {
        let [columns, rows, _] = self.counts.map(|count| count.max(1));
        let at = [index % columns, index / columns % rows, index / columns / rows];
        std::array::from_fn(|axis| self.first_m[axis] + self.spacing_m[axis] * f64::from(at[axis]))
    }

    /// How many points there are.
    pub fn points(&self) -> u64 {
        self.counts.iter().fold(1, |points: u64, &count| points.saturating_mul(u64::from(count)))
    }
}

/// How they estimate.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Estimator {
    /// The state tube: guaranteed, contracted by every measurement.
    Tube(TubeSettings),
    /// An extended Kalman filter: a Gaussian, without guarantee.
    Ekf(EkfSettings),
    /// Log, attitude and clock alone, from the prior on.
    DeadReckoning,
}

/// How a tube estimator works.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
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

/// How many pings may be wrong: at most `tolerated` of any `window` in a row.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Outliers {
    /// m, in pings heard.
    pub window: u16,
    /// q, the most that is ever assumed.
    pub tolerated: u16,
    /// Assume the fewest that leave something (GOMNE) and this margin r more, but never more than q; `None` to assume q.
    pub margin: Option<u16>,
    /// How likely a ping is right, as far as anyone can say: what the assumption is worth, told in the summary.
    pub inlier_probability: Option<f64>,
}

/// What an estimator does when nothing is left of its set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Recovery {
    /// Ignores the measurement that left nothing.
    Drop,
    /// Ignores as few of the remembered pings as leave something.
    Relax,
    /// Begins again, from the whole area.
    Restart,
}

/// How a Kalman filter works.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct EkfSettings {
    /// An innovation of more than so many standard deviations is rejected; infinite to believe everything.
    pub gate_sigma: f64,
    /// How what others believe is taken in.
    pub fusion: Fusion,
}

/// How a Gaussian takes in what others believe.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Fusion {
    /// As if it were independent of what the AUV believes itself.
    Independent,
    /// By covariance intersection, which holds whatever they have in common.
    CovarianceIntersection,
}

/// How they steer.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Controller {
    /// Stay where the run begins, as far as the AUV knows: in the middle of its prior box.
    Hold,
    /// Go to the point of the start's grid, or of its points, to which the AUV belongs, and stay there against the current.
    Station {
        /// Greatest speed over ground in m/s.
        speed_m_s: f64,
    },
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

/// Something that goes wrong beyond all that is stated, declared so that it can be counted apart.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Fault {
    /// The body is carried elsewhere at once; its velocity stays, and what was on its way to its modem is not heard.
    Kidnap {
        /// Which AUV.
        auv: u32,
        /// True time in nanoseconds; it happens at the next knot.
        at_ns: i64,
        /// Where it is left, in metres.
        to_m: Vec3,
    },
}

impl Scenario {
    /// Depth of the sea floor in metres, positive down: at level `ideal`, the bottom of the area.
    pub fn bottom_depth_m(&self) -> f64 {
        match &self.environment.level {
            Level::Ideal => -self.environment.area_m[2][0],
            Level::Sea(sea) => sea.bottom_depth_m,
        }
    }

    /// Number of AUVs of all groups.
    pub fn auv_count(&self) -> u32 {
        self.groups.iter().map(|group| group.count).sum()
    }
}
