//! Tubes: intervals of trajectories, with rigorous queries and contractors.
//!
//! A [`Tube`] encloses an unknown continuous trajectory. Time is cut into slices; over each slice the tube says in which
//! set the trajectory stays, and at each border, a *gate*, in which set it is at that instant. The values are
//! [`Interval`](shoal_interval::Interval)s or [`IntervalBox`](shoal_interval::IntervalBox)es.
//!
//! Whatever is asked of a tube, and however it is contracted, a trajectory that was inside and obeys the constraint is
//! still inside: rounding is outwards, and a slice holds the trajectory over all of its time, not only at samples.
//!
//! ```
//! use shoal_interval::Interval;
//! use shoal_tube::{TimeDomain, Tube};
//!
//! // A vehicle starts at x = 5 m and moves at 1 to 2 m/s for 10 s.
//! let time = TimeDomain::uniform(0.0, 0.5, 20)?;
//! let speed_m_s = Tube::constant(time, Interval::new(1.0, 2.0)?);
//! let x_m = Tube::primitive(&speed_m_s, Interval::point(5.0)?);
//! assert_eq!(x_m.at(10.0)?, Interval::new(15.0, 25.0)?);
//! // It passes x = 15 m between 5 s and 10 s.
//! assert_eq!(x_m.invert(Interval::point(15.0)?), Interval::new(4.5, 10.0)?);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Source: seed 001, chapter 4.2.

mod arithmetic;
mod components;
mod contraction;
pub mod contractor;
mod derivative;
mod enclosure;
mod error;
pub mod figure;
mod integral;
mod inversion;
mod online;
mod query;
mod relation;
#[cfg(feature = "serde")]
mod serialization;
mod storage;
mod summary;
mod time_domain;
mod transformation;
mod tube;

pub use derivative::Direction;
pub use enclosure::{Enclosure, InnerBounds};
pub use error::{Constraint, Emptied, TubeError};
pub use shoal_interval::contractor::Contracted;
pub use time_domain::{Place, TimeDomain};
pub use tube::Tube;
