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
#![doc = include_str!("keys.md")]

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
mod schema;
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
pub use schema::{SCHEMA_ID, schema};
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
