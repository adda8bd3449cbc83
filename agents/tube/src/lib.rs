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
//! # Time
//!
//! A [`TimeDomain`] is the times at which tubes are cut. Tubes that are taken together must be cut at the same times; clones
//! of a domain share their memory. Slices of one length take none. No contractor changes the times: only
//! [`append`](Tube::append), [`drop_front`](Tube::drop_front) and [`refine`](Tube::refine) do, because they are asked to.
//!
//! # Questions
//!
//! | question | method | time |
//! |---|---|---|
//! | where at `t` | [`at`](Tube::at) | O(1) for even slices |
//! | where over `[t]` | [`over`](Tube::over) | O(log n) |
//! | when in `[y]`, as a hull | [`invert`](Tube::invert), [`invert_within`](Tube::invert_within) | O(log n) |
//! | when in `[y]`, each time of its own | [`invert_components`](Tube::invert_components) | O(log n) for each |
//! | how far between `t1` and `t2` | [`integral`](Tube::integral), [`integral_between`](Tube::integral_between) | O(log n) |
//! | sharper, knowing the derivative | [`at_with_derivative`](Tube::at_with_derivative), [`over_with_derivative`](Tube::over_with_derivative), [`invert_with_derivative`](Tube::invert_with_derivative) | O(log n) |
//! | is a trajectory, or a tube, inside | [`contains`](Tube::contains), [`holds`](Tube::holds), [`is_subset_of`](Tube::is_subset_of) | O(n) |
//! | is anything left, and if not, where did it end | [`is_empty`](Tube::is_empty), [`first_empty`](Tube::first_empty) | O(1), O(n) |
//!
//! # What is learnt
//!
//! [`contract_gate`](Tube::contract_gate) and [`contract_slice`](Tube::contract_slice) take in a measurement,
//! [`contract_derivative`](Tube::contract_derivative) carries it on. A measurement that contradicts the model leaves an
//! empty tube: that is how a wrong model shows itself, and [`first_empty`](Tube::first_empty) says where.
//!
//! # Source
//!
//! Seed 001, chapter 4.2; seed 002, section 3.3.4.

mod arithmetic;
mod components;
mod contraction;
pub mod contractor;
mod derivative;
mod enclosure;
mod error;
pub mod figure;
mod integral;
pub mod integration;
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
