//! Localization of one vehicle in the plane from odometry and ranges to beacons, as data sets of real missions hold them.
//!
//! Time is a number of poses here: odometry leads from each pose to the next, and ranges belong to poses. All is known when an
//! estimator begins, so that [`TubeSettings::smoothed`] may look back from the end.
//!
//! | file | idea |
//! |---|---|
//! | `mission.rs` | what was measured, and what an estimator makes of it |
//! | `dead_reckoning.rs` | odometry alone |
//! | `ekf.rs` | an extended Kalman filter, with or without a gate |
//! | `course.rs` | odometry with its errors, as sets |
//! | `window.rs` | ranges as anchored rings around one pose, at most q of them wrong |
//! | `tube.rs` | the tube of poses: forward, and back and forth to a fixed point |
//! | `heading_search.rs` | an unknown heading, found by set inversion |

mod course;
mod dead_reckoning;
mod ekf;
mod heading_search;
mod mission;
mod tube;
mod window;

pub use course::OdometryBounds;
pub use dead_reckoning::dead_reckoning;
pub use ekf::{EkfSettings, ekf};
pub use heading_search::{HeadingSearch, search_heading};
pub use mission::{BeaconRange, Enclosed, Mission, MissionError, Start, Step, Track};
pub use tube::{TubeSettings, tube};

#[cfg(test)]
mod tests;
