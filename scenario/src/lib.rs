//! Scenario files: what they may say, how they are read, and those that come with Shoal.
//!
//! A scenario and a seed determine every event of a run. It is a TOML file with units in the names of its keys; [`parse`]
//! reads and validates it, and reports every error with its place, cause and fix. [`load`] finds one by its name in the
//! [`library`] or by its path, and [`Overrides`] are what the command line may change.
//!
//! ```
//! use shoal_scenario::{Overrides, load, parse};
//!
//! let (source_name, text) = load("swarm-1000")?;
//! let scenario = parse(&source_name, &text)?;
//! assert_eq!(scenario.auv_count(), 1000);
//!
//! // The same swarm with a tenth of its AUVs.
//! let smaller = Overrides { auvs: Some(100), ..Overrides::default() }.apply(scenario)?;
//! let counts: Vec<u32> = smaller.groups.iter().map(|group| group.count).collect();
//! assert_eq!(counts, [50, 30, 20]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # All keys
//!
//! Times are decimal and must be whole nanoseconds; vectors are `[east, north, up]`, and the surface is at 0. "Error" is a
//! bound: the true error is anywhere inside it, and 0 is a perfect sensor.
//!
//! | key | unit | default | meaning |
//! |---|---|---|---|
//! | `name` | | needed | name of the scenario: letters, digits, `-`, `_` |
//! | `summary` | | `""` | one line for `shoal scenarios` |
//! | `source` | | `""` | where it comes from |
//! | `seed` | | 1 | seed of every random draw |
//! | `duration_s` | s | needed | simulated time |
//! | `window_ms` | ms | 90, or the largest whole ms allowed | true time per lockstep window; never changes the result |
//! | `knot_ms` | ms | 10 | between knots of true trajectories and clocks; 0.1 at least |
//! | `noise` | | `"uniform"` | errors are drawn `"uniform"` inside their bounds, or `"adversarial"`: always at one |
//! | `on_crash` | | `"drift"` | when an AUV's process ends, its body will `"drift"` on, or the run will `"abort"` |
//! | **`[environment]`** | | needed | |
//! | `area_m` | m | needed | `[[west, east], [south, north], [bottom, top]]` of the mission |
//! | `level` | | `"ideal"` | `"ideal"`: constant speed of sound, sharp range limit; `"sea"`: sound as in water |
//! | `sound_speed_m_s` | m/s | 1500 | speed of sound, where no profile is given; more than twice that of the fastest body |
//! | `sound_speed_error_m_s` | m/s | 0 | error of the stated speed, the same everywhere |
//! | `current_m_s` | m/s | `[0, 0, 0]` | true current |
//! | `current_error_m_s` | m/s | `[0, 0, 0]` | error of the stated current, per axis |
//! | `current_field` | | `"uniform"` | table with `name` `"shear"` or `"vortex"`, added to the current; see [`CurrentField`]: |
//! | `current_field.surface_m_s`, `.deep_m_s` | m/s | needed | shear: current at the surface, and at its depth and below |
//! | `current_field.depth_m` | m | needed | shear: depth down to which it changes |
//! | `current_field.centre_m` | m | needed | vortex: `[east, north]` of its vertical axis |
//! | `current_field.core_radius_m` | m | needed | vortex: radius of its core |
//! | `current_field.speed_m_s` | m/s | needed | vortex: speed at the rim of the core; negative turns clockwise |
//! | **`[environment.sea]`** | | | at level `"sea"` only |
//! | `bottom_depth_m` | m | bottom of the area | depth of the sea floor; the area must not be deeper |
//! | `sound_speed` | | `"uniform"` | `"mixed-layer"`, `"summer-thermocline"`, `"arctic"`, `"munk"`, or a table: |
//! | `sound_speed.depths_m` | m | needed | 2 to 1000 depths, increasing; speeds are linear in between, constant above and below |
//! | `sound_speed.speeds_m_s` | m/s | needed | one for each depth, 1300 to 1800; or instead of them: |
//! | `sound_speed.temperatures_c` | °C | needed | one for each depth, -3 to 45 |
//! | `sound_speed.salinities_psu` | PSU | needed | one for each depth, 0 to 45 |
//! | `sound_speed.formula` | | `"chen-millero"` | or `"mackenzie"` to 8,000 m, `"medwin"` to 1,000 m, `"del-grosso"` |
//! | `temperature_c`, `salinity_psu`, `ph` | °C, PSU | 10, 35, 8 | of the water that absorbs sound |
//! | `absorption` | | `"francois-garrison"` | or `"ainslie-mccolm"`, `"thorp-stojanovic"`, `"thorp-jkps"` |
//! | `spreading_exponent` | | 1.5 | 1 cylindrical, 1.5 practical, 2 spherical |
//! | `shipping` | | 0.5 | shipping noise, 0 to 1 |
//! | `wind_m_s` | m/s | 5 | noise, and roughness of the surface |
//! | `surface_loss_db` | dB | from the wind | loss at each bounce off the surface |
//! | `bottom` | | `"sand"` | one of [`presets::BOTTOMS`], or a table with the three: |
//! | `bottom.density_kg_m3` | kg/m³ | needed | |
//! | `bottom.sound_speed_m_s` | m/s | needed | |
//! | `bottom.attenuation_db_wavelength` | dB | needed | per wavelength |
//! | `bounces_max` | | 2 | paths with so many bounces are heard; 0 to 8 |
//! | `fading` | | `"rician"` | how levels fluctuate: `"gaussian"` (not at all), `"rayleigh"`, `"rician"`, or a table with `kind`: |
//! | `fading.k_db` | dB | 6 | rician: power of the steady part over that of the rest |
//! | `fading.per` | | `"packet"` | one draw for each `"packet"` and path, or averaged over each `"bit"` |
//! | **`[kind.NAME]`, `kind = {...}`** | | | a body of one's own, in full or beginning with `like` |
//! | `like` | | | preset or other kind that fills in what is not said |
//! | `speed_max_m_s` | m/s | needed | greatest speed through the water |
//! | `acceleration_max_m_s2` | m/s² | needed | greatest change of speed |
//! | `turn_rate_max_rad_s` | rad/s | needed | greatest rate of turn, in heading and in pitch |
//! | `pitch_max_rad` | rad | 0.5 | steepest climb or dive |
//! | `disturbance_m_s` | m/s | `[0, 0, 0]` | bound of the state noise, per axis |
//! | `length_m` | m | 2 | closer than this, two bodies collide |
//! | **`[clock.NAME]`, `clock = {...}`** | | | a clock of one's own |
//! | `like` | | | preset or other clock that fills in what is not said |
//! | `drift_bound` | | needed | bound of the rate error, a fraction below 1 |
//! | `wander_fraction` | | 0.5 | part of the bound within which the rate wanders; the rest is constant |
//! | `offset_bound_s` | s | 0 | bound of the unknown offset at the beginning |
//! | **`[[group]]`** | | one or more | like AUVs; [`TABLES_MAX`] groups at most |
//! | `name` | | needed | AUVs are called `NAME-0`, `NAME-1`, ... |
//! | `count` | | needed | how many; [`AUVS_MAX`] in all |
//! | `kind` | | `"lauv"` | body: one of [`presets::KINDS`], of one's own, or a table |
//! | `clock` | | `"tcxo"` | clock: one of [`presets::CLOCKS`], of one's own, or a table |
//! | `sensors` | | `"nominal"` | what it senses: one of [`presets::SENSORS`], of one's own, or a table |
//! | `control_period_s` | s | 0.1 | between control ticks, in local time; 0.001 to 1000 |
//! | `reaction_s` | s | 0.1 | from a tick to when its answer takes effect, in local time |
//! | `estimator` | | `"tube"` | `"tube"`, `"ekf"`, `"dead-reckoning"`, or a table with that `name` |
//! | `estimator.horizon_s` | s | 10 | `"tube"`: past that is kept, in local time |
//! | `estimator.rings` | | 6 | `"tube"`: so many of the last pings that told something are kept as rings around the present position; measured: more tell nothing new on the library |
//! | `estimator.stopping_ratio` | | 0.05 | `"tube"`: the rings are contracted together once more as long as a side loses this part of its width |
//! | `estimator.on_empty` | | `"drop"` | `"tube"`: when nothing is left, `"drop"` the culprit, `"relax"` over all rings, or `"restart"` from the area |
//! | `estimator.outliers` | | `false` | `"tube"`: a table for pings that may be wrong: |
//! | `outliers.window` | | 10 | of so many pings in a row |
//! | `outliers.tolerated` | | needed | at most so many are wrong |
//! | `outliers.margin` | | none | assume the fewest that leave something, and so many more |
//! | `outliers.inlier_probability` | | none | how likely a ping is right: the summary then says what the assumption is worth |
//! | `estimator.gate_sigma` | | 3 | `"ekf"`: an innovation of more standard deviations is rejected; `false` to believe everything |
//! | `estimator.fusion` | | `"independent"` | `"ekf"`: what others believe is `"independent"`, or taken in by `"covariance-intersection"` |
//! | `relative` | | `false` | follows its neighbours in its own frame, as a table: |
//! | `relative.measures` | | `"range-and-bearing"` | by what pings tell: that, `"bearing"` or `"range"`; bearings need `bearing_error_rad` |
//! | `relative.exchanged` | | `true` | whether it believes the velocities that pings tell; else a neighbour may do all that its bounds allow |
//! | `relative.remembered` | | 16 | so many of a neighbour's last pings count together |
//! | `controller` | | `"hold"` | name, or table with `name`; see below |
//! | `command` | | | each AUV of the group is a process started so, `["python3", "agent.py"]`, in the folder of the scenario file; it is told the controller, the estimator and the access, and does with them what it likes |
//! | `sabotage` | | | a test of the checker: `"halved-clock"`, `"lying-ping"` or `"empty-set"` breaks a promise |
//! | **`[sensors.NAME]`, `[group.sensors]`** | | | sensors of one's own |
//! | `like` | | `"nominal"` | preset or other sensors that fill in what is not said; defaults below are those of `"nominal"` |
//! | `heading_error_rad`, `pitch_error_rad` | rad | 0.01 | errors of the compass |
//! | `speed_error_m_s` | m/s | 0.02 | error of the log: speed through the water |
//! | `depth_error_m` | m | 0.1 | error of the depth; `false` for none |
//! | `dvl` | | `false` | Doppler velocity log: one of [`presets::DVLS`], or a table: |
//! | `dvl.altitude_max_m` | m | needed | sees the bottom up to this height above it |
//! | `dvl.velocity_error_m_s` | m/s | needed | error of the velocity over ground, per axis of the body |
//! | `gnss` | | `false` | satellite receiver: one of [`presets::GNSS`], or a table: |
//! | `gnss.depth_max_m` | m | 1 | works above this depth |
//! | `gnss.period_s` | s | 1 | between fixes, in local time |
//! | `gnss.position_error_m` | m | `[1, 1, 1]` | error per axis |
//! | `gnss.time_error_s` | s | 1e-6 | error of the time |
//! | **`[group.modem]`** | | | or `modem = "NAME"`: one of [`presets::MODEMS`] |
//! | `like` | | `"ideal"` | preset that fills in what is not said; the defaults below are those of `"ideal"` |
//! | `range_m` | m | 500 | others hear it so far; only at level `"ideal"` |
//! | `ping_period_s` | s | 1 | between pings, in local time; with `"aloha"` their mean; `false` for a silent AUV |
//! | `ping_phase_s` | s | drawn | local time of the first ping; only with `"periodic"` |
//! | `timestamp_error_s` | s | 1e-5 | error of an arrival's timestamp |
//! | `bearing_error_rad` | rad | `false` | error of the direction from which a ping arrives, up to pi: an ultra-short baseline array |
//! | `outlier_rate` | | 0 | the part of all pings heard that are stamped too late, as if an echo were the arrival; nobody is told |
//! | `outlier_delay_s` | s | 0.1 | by so much at most, up to 10; drawn evenly for each |
//! | `frame_bytes` | | 64 | bytes that one ping may have: [`PING_BYTES`] to [`FRAME_BYTES_MAX`] |
//! | `addresses` | | none | so many devices can be told apart: a run with more is warned of |
//! | `access` | | `"periodic"` | when it pings: `"periodic"`, `"aloha"`, `"slotted"`, `"csma"`, or a table with that `name` |
//! | `access.slot_s` | s | `ping_period_s` / `slots` | `"slotted"`: length of a slot, in true time; holds a packet and its way to the guard range |
//! | `access.slots` | | all AUVs | `"slotted"`: slots in a frame; AUV i has slot i modulo this |
//! | `access.guard_range_m` | m | diagonal of the area | `"slotted"`: slots do not overlap for receivers up to this far away |
//! | `access.listen_s` | s | one packet | `"csma"`: the medium must have been quiet for so long, in local time; 10 s at most |
//! | `access.backoff_s` | s | two packets | `"csma"`: mean time until a ping that was held back is tried again, in local time |
//! | `duty_cycle` | | always awake | when it listens, as a table: |
//! | `duty_cycle.period_s` | s | needed | it wakes so often, in local time |
//! | `duty_cycle.awake_s` | s | needed | and listens for so long; a packet at least |
//! | `source_level_db` | dB re 1 µPa at 1 m | needed | from here on, the physical layer: what level `"sea"` needs, and `"ideal"` ignores |
//! | `centre_hz` | Hz | needed | centre of the band |
//! | `bandwidth_hz` | Hz | needed | width of the band |
//! | `bit_rate_bit_s` | bit/s | needed | bits of a packet per second |
//! | `preamble_s` | s | 0 | what precedes the bits of a packet |
//! | `modulation` | | `"bpsk"` | `"bpsk"` or `"fsk"`, see [`Modulation`] |
//! | `coding_gain_db` | dB | 0 | what coding saves of Eb/N0 |
//! | `detection_threshold_db` | dB | 0 | a packet is noticed from this signal to noise and interference on |
//! | `capture_db` | dB | 6 | a later packet takes over when it is louder by so much |
//! | **`[group.start]`** | | | |
//! | `region_m` | m | the area | places are drawn in this region |
//! | `points_m` | m | | one place for each AUV, instead |
//! | `grid` | | | table, instead: a point for each AUV in columns, then rows, then layers; see [`Grid`]: |
//! | `grid.first_m`, `grid.spacing_m` | m | needed | its most westerly, southerly and deepest point; `[east, north, up]` between neighbours |
//! | `grid.columns`, `grid.rows`, `grid.layers` | | needed, 1, 1 | points in each direction: as many as AUVs or more |
//! | `grid.scatter_m` | m | 0 | an AUV begins at most so far east and north of its point |
//! | `place` | | | `"on-circle"`: spread evenly on the controller's circle, instead |
//! | `box_width_m` | m | 10 | width of the prior box, or `[least, greatest]` |
//! | `known` | | `true` | `false`: it is told no box, and may be anywhere in the area |
//! | `heading_rad` | rad | drawn | heading; on a circle, along it |
//! | `speed_m_s` | m/s | the controller's | speed through the water |
//! | **`controller`** `"hold"` | | | stays where the run begins |
//! | **`controller`** `"station"` | | | goes to its point of `grid` or `points_m`, and stays there |
//! | `speed_m_s` | m/s | 3/4 of the greatest | greatest speed over ground |
//! | **`controller`** `"circle"` | | | see [`Controller::Circle`] |
//! | `centre_m`, `radius_m`, `rate_rad_s` | m, m, rad/s | needed | the circle; a negative rate turns clockwise |
//! | `phase_rad` | rad | 0 | angle of the first AUV at time 0, counter-clockwise from east |
//! | `heave_m`, `heave_phase_rad` | m, rad | 0 | vertical motion and its phase against the angle |
//! | **`controller`** `"waypoints"` | | | |
//! | `points_m` | m | needed | visited in turn |
//! | `speed_m_s` | m/s | 3/4 of the greatest | cruise speed |
//! | `reach_m` | m | 5 | a point counts as reached within this distance |
//! | `repeat` | | `true` | the first point follows the last |
//! | **`controller`** `"reynolds"` | | | separation, cohesion, alignment |
//! | `speed_m_s` | m/s | 3/4 of the greatest | cruise speed |
//! | `separation`, `cohesion`, `alignment` | | 1 | weights |
//! | `margin_m` | m | 5 | added to the separation distance |
//! | `forget_s` | s | 5 | a neighbour not heard for so long is forgotten, in local time |
//! | `trusts` | | all | names of the groups heeded in cohesion and alignment |
//! | **`[[fault]]`** | | | what goes wrong beyond all that is stated, counted apart: |
//! | `kind` | | needed | `"kidnap"`: a body is carried elsewhere at once |
//! | `auv`, `at_s` | s | needed | whose, and when |
//! | `to_m` | m | needed | where it is left, inside the area |
//! | **`[sabotage]`** | | | a test of the checker: |
//! | `shifted_truth` | s | | `{ auv = 0, at_s = 5 }` moves that AUV's truth by a metre at that time |

mod body;
mod command;
mod current;
mod diagnostics;
mod document;
mod environment;
mod estimating;
mod examples;
mod fault;
mod group;
mod library;
mod medium_access;
pub mod model;
mod modem;
mod number;
mod overrides;
mod packet;
pub mod presets;
mod reader;
mod relative;
mod sea;
mod sensing;
mod sound_speed;
mod start;
mod steering;
mod time;
mod warnings;

pub use diagnostics::{Diagnostic, SHOWN_ERRORS_MAX, ScenarioErrors};
pub use document::parse;
pub use library::{LibraryEntry, LoadError, library, load};
pub use medium_access::LISTEN_MAX_NS;
pub use model::*;
pub use overrides::{OverrideError, Overrides};
pub use packet::{FRAME_BYTES_MAX, PING_BYTES};
pub use warnings::Warning;

/// Most AUVs that a run can have.
pub const AUVS_MAX: u32 = 65_536;

/// Most groups, kinds, clocks and suites of sensors that one scenario can have, each.
pub const TABLES_MAX: usize = 1024;

/// Longest lockstep window in nanoseconds of true time: no AUV with this reaction time and clock can act on what happens
/// in a window before the window has ended.
///
/// `floor((reaction - 2 ns) / (1 + drift))`: a clock can run fast by the drift, and a stamp and a tick each give away one
/// nanosecond.
///
/// ```
/// assert_eq!(shoal_scenario::window_limit_ns(100_000_000, 0.1), 90_909_089);
/// ```
pub fn window_limit_ns(reaction_ns: i64, drift_bound: f64) -> i64 {
    (reaction_ns.saturating_sub(2) as f64 / (1.0 + drift_bound)).floor() as i64
}
