//! What a run amounts to: the line that `shoal run --json` prints and the last message of a record.

mod free_run;
mod timings;

use serde::{Deserialize, Serialize};

pub use free_run::{FreeRun, LateAuv};
pub use timings::{Cpu, Phase, PhaseLine, Stretch, Timings};

/// Format tag of [`Summary`].
pub const SUMMARY_FORMAT: &str = "shoal.summary/1";

/// The outcome of one run. Facts of the machine (`bus`, `processes`, wall time, memory) are absent from a record, which must
/// be the same wherever a run took place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// [`SUMMARY_FORMAT`].
    pub format: String,
    /// Name of the scenario.
    pub scenario: String,
    /// Seed of every random draw.
    pub seed: u64,
    /// Transport that carried the run.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub bus: Option<String>,
    /// Whether scenario and seed determine the digest: not when a process died, the run was interrupted, or AUVs ran freely.
    pub reproducible: bool,
    /// Number of AUVs.
    pub auvs: u32,
    /// Processes that took part: AUVs and channel.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub processes: Option<u32>,
    /// Simulated seconds.
    pub sim_s: f64,
    /// Wall-clock seconds of the simulation, start-up excluded.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub wall_s: Option<f64>,
    /// Wall-clock seconds from the first process to the first window.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub startup_s: Option<f64>,
    /// `sim_s / wall_s`.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub real_time_factor: Option<f64>,
    /// Control ticks answered.
    pub wakes: u64,
    /// Hash of everything that happened.
    pub digest: String,
    /// Whether every enclosure held the truth.
    pub containment: Containment,
    /// How good the estimates of each group are, in the order of the scenario.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub estimators: Vec<EstimatorLine>,
    /// Width of the reported position boxes, in metres.
    pub position_width_m: Widths,
    /// Width of the reported clock intervals, in seconds.
    pub clock_width_s: Widths,
    /// How far AUVs with a station to keep really are from it, in metres, at their first and their last tick. Absent where none has one.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub off_station_m: Option<Widths>,
    /// What became of the pings.
    pub pings: Pings,
    /// How the swarm moved at the end.
    pub flock: Flock,
    /// AUVs that did not make it.
    pub agents: Agents,
    /// Memory of the processes.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub memory: Option<Memory>,
    /// Where the time went, if that was asked for.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub timings: Option<Timings>,
    /// Deadlines and who missed them, where AUVs ran freely.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub free_run: Option<FreeRun>,
}

impl Summary {
    /// Itself without the facts of the machine: what a record holds.
    #[must_use]
    pub fn simulated(&self) -> Self {
        Self {
            bus: None,
            processes: None,
            wall_s: None,
            startup_s: None,
            real_time_factor: None,
            memory: None,
            timings: None,
            ..self.clone()
        }
    }
}

/// The proof.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Containment {
    /// Enclosures compared with the truth: all but those of Kalman filters, which promise nothing.
    pub checks: u64,
    /// Those that did not hold it, though the AUV had been told no more that is false than it assumes.
    pub violations: u64,
    /// The first ten of them.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub first: Vec<ViolationLine>,
    /// AUVs that lost the truth after they had heard more that is false than they were to expect: counted apart.
    #[serde(default)]
    pub misled: Misled,
    /// What kidnapped AUVs stated before they noticed: counted apart. Absent where the scenario kidnaps nobody.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub kidnapped: Option<Kidnapped>,
    /// What the assumptions about wrong pings are worth, for the groups that say how likely a ping is right.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub assumptions: Vec<Assumption>,
}

/// Bodies carried elsewhere without their minds being told.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Kidnapped {
    /// How many the scenario declares.
    pub kidnappings: u32,
    /// How many were noticed: the AUV said that nothing was left of its set.
    pub noticed: u32,
    /// The longest time until then, in seconds; absent when none was noticed.
    pub noticed_after_s: Option<f64>,
    /// Enclosures that did not hold the truth until then; not among [`Containment::violations`]. Later ones are.
    pub violations: u64,
}

/// What it is worth to assume that at most `tolerated` of any `window` pings in a row are wrong: seed 004, section 3.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Assumption {
    /// Name of the group.
    pub group: String,
    /// m.
    pub window: u16,
    /// q.
    pub tolerated: u16,
    /// How likely a ping is right, as the scenario says.
    pub inlier_probability: f64,
    /// The probability that any one window keeps to the assumption.
    pub window_holds: f64,
    /// The most pings that an AUV of the group heard.
    pub pings: u64,
    /// Its set then holds the truth with at least this probability, whatever happened before.
    pub holds: f64,
    /// Beside `window_holds`: the part of all windows of the group that really kept to the assumption (to the margin, where the
    /// number is searched for).
    pub windows_kept_fraction: f64,
    /// Beside `holds`: the part of all reports of the group that really held the truth.
    pub contained_fraction: f64,
}

/// What AUVs stated that had heard something false before: a ping that came the long way round (an outlier), or one whose
/// payload did not hold the truth. No promise covers that. Of AUVs that assume at most q of any m pings to be wrong, only those count
/// that had heard more.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Misled {
    /// How many AUVs.
    pub auvs: u32,
    /// Enclosures of theirs that did not hold the truth, or emptied; not among [`Containment::violations`].
    pub violations: u64,
}

/// One violation, for people and programs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ViolationLine {
    /// Index of the AUV.
    pub auv: u32,
    /// Its name.
    pub name: String,
    /// True time in seconds.
    pub time_s: f64,
    /// `report`, `slice`, `ping` or `emptied`.
    pub enclosure: String,
    /// Which coordinate.
    pub coordinate: String,
    /// How far the truth lies outside, in the coordinate's unit; absent for an empty set.
    pub margin: Option<f64>,
    /// Unit of the margin.
    pub unit: String,
}

/// How good the estimates of one group are. A number without bound is the largest there is.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct EstimatorLine {
    /// Name of the group.
    pub group: String,
    /// `tube`, `ekf` or `dead-reckoning`.
    pub estimator: String,
    /// How an `ekf` takes in what others believe: `independent` or `covariance-intersection`.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub fusion: Option<String>,
    /// Number of AUVs.
    pub auvs: u32,
    /// Reports of all of them.
    pub reports: u64,
    /// Part of the reports whose box and clock interval hold the truth: 1 by promise for all but an `ekf`, whose reach three standard
    /// deviations to either side.
    pub contained_fraction: f64,
    /// Mean of the normalized estimation error squared over position and clock, four dimensions: 4 for an honest Gaussian, more for
    /// an overconfident one; absent where no Gaussian is reported.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub nees_mean: Option<f64>,
    /// Root of the mean square distance between the truth and the middle of the box, or the mean, in metres.
    pub centre_rms_m: f64,
    /// Median over the AUVs of each one's mean width of its position boxes, in metres.
    pub width_median_m: f64,
}

/// Widths of enclosures, or distances, over all AUVs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Widths {
    /// Median of each AUV's first report.
    pub start_median: f64,
    /// Median of each AUV's last report.
    pub end_median: f64,
    /// Widest of the last reports.
    pub end_max: f64,
}

/// What became of the pings: `emitted * (auvs - 1) = heard + sum of lost + in_flight`, where lost is without
/// `late`, `busy` and `unsent`, which never left.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Pings {
    /// Pings that left a modem.
    pub emitted: u64,
    /// Receptions.
    pub heard: u64,
    /// Receptions that failed, by reason, and pings that never left (`late`).
    pub lost: Lost,
    /// Heard the long way round, after bounces: their travel times break the bounds that the receivers are told.
    #[serde(default)]
    pub outliers: u64,
    /// Wavefronts that had not yet reached a receiver when the run ended.
    pub in_flight: u64,
}

/// Lost pings by reason.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Lost {
    /// Too far away.
    pub range: u64,
    /// Drowned in ambient noise.
    pub noise: u64,
    /// Overlapped with other packets.
    pub collision: u64,
    /// The receiver was emitting.
    pub half_duplex: u64,
    /// No path led there, and bounces were too faint.
    #[serde(default)]
    pub shadow: u64,
    /// The receiver's modem was not listening.
    #[serde(default)]
    pub asleep: u64,
    /// Sent in a band or with a modulation that the receiver's modem does not know.
    #[serde(default)]
    pub band: u64,
    /// Held back because the emitter's modem heard others: never left.
    #[serde(default)]
    pub busy: u64,
    /// Booked while the emitter's modem was still emitting another: never left.
    #[serde(default)]
    pub unsent: u64,
    /// Booked for a moment that had passed: never left.
    pub late: u64,
    /// The receiver's process had ended.
    pub dead: u64,
}

/// How the swarm moves and holds together: at the end of the run, and in a record at every second. AUVs that are lost are counted in
/// separation and collisions alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Flock {
    /// Length of the mean unit velocity: 1 when all move alike, near 0 when each goes its own way.
    pub polarization: f64,
    /// Least distance between two bodies over the whole run, in a record since the second before; in metres, looked at ten times a
    /// simulated second; absent for a single AUV.
    pub min_separation_m: Option<f64>,
    /// Pairs of bodies that came closer than their lengths allow.
    pub collisions: u64,
    /// Fraction of all ordered pairs whose second is in range of the first.
    pub connectivity: f64,
    /// Second smallest eigenvalue of the Laplacian of the graph whose links are the pairs in range of each other: zero when it has
    /// several components, and the more the harder it is to cut in two (Fiedler 1973). Absent with more than four million links.
    #[serde(default)]
    pub algebraic_connectivity: Option<f64>,
    /// Connected components of that graph: groups that no news leaves.
    #[serde(default)]
    pub components: u32,
    /// AUVs in the largest of them.
    #[serde(default)]
    pub largest_component: u32,
}

/// AUVs that did not make it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Agents {
    /// Those whose process ended, and each time that it did.
    pub lost: Vec<LostAgent>,
    /// Those that were born again, when, and how they had ended before.
    pub restarted: Vec<LostAgent>,
}

/// One AUV that did not make it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LostAgent {
    /// Index of the AUV.
    pub auv: u32,
    /// Its name.
    pub name: String,
    /// True time in seconds.
    pub time_s: f64,
    /// How it ended.
    pub reason: String,
}

/// Memory of the processes, read at the end of the run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Memory {
    /// Median proportional set size per AUV of a sample of their processes, in KiB.
    pub auv_pss_kib_median: u64,
    /// Resident set of the channel, in KiB.
    pub channel_rss_kib: u64,
}
