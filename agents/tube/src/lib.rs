//! Tubes: intervals of trajectories, with rigorous queries and contractors.
//!
//! A vehicle under water does not know where it is; it knows where it *may* be, at each time. A [`Tube`] is that: a set of
//! trajectories, from which contractors take what contradicts motion, clocks and sounds. What remains is a proof.
//!
//! # What a tube is
//!
//! Time is cut into slices by a [`TimeDomain`]. Over slice `i`, from border `t[i]` to border `t[i + 1]`, the tube holds a set `[x][i]`, and
//! at border `t[i]`, an instant, a *gate* `[g][i]`. It stands for the continuous trajectories
//!
//! ```text
//! { x | x(t) in [x][i] for all t in [t[i], t[i + 1]], x(t[i]) in [g][i], for all i },   [g][i] ⊂ [x][i - 1] ∩ [x][i]
//! ```
//!
//! The sets are [`Interval`](shoal_interval::Interval)s, or [`IntervalBox`](shoal_interval::IntervalBox)es for vectors.
//!
//! The guarantee: whatever is asked of a tube, and however it is contracted, a trajectory that was inside and obeys the
//! constraint is still inside. Bounds are rounded outwards, a slice holds the trajectory over *all* of its time and not
//! at samples, and the same program gives the same bits on every machine.
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
//! The last answer begins at 4.5 s and not at 5 s because of slices: over the one from 4.5 s to 5 s the tube says no more
//! than one set. Gates are sharper, shorter slices too, and [with the derivative](Tube::invert_with_derivative) a slice is as
//! sharp as a gate.
//!
//! # Making one
//!
//! | from | with |
//! |---|---|
//! | nothing known, or one set at all times | [`Tube::constant`] |
//! | a formula, as an inclusion function | [`Tube::from_function`] |
//! | a derivative and a start | [`Tube::primitive`] |
//! | a state equation and a start | [`Tube::solution`] |
//! | slices and gates, or tubes of each axis | [`Tube::from_parts`], [`Tube::from_components`] |
//! | the present, as it comes | [`Tube::starting_at`] and [`Tube::append`] |
//!
//! Tubes that are taken together must be cut at the same times; clones of a domain share their memory, and slices of one
//! length take none. No contractor changes the times: only [`append`](Tube::append), [`drop_front`](Tube::drop_front) and
//! [`refine`](Tube::refine) do, because they are asked to.
//!
//! # Asking
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
//! | is anything left | [`is_empty`](Tube::is_empty) | O(1) |
//! | if not, what emptied it, where and when | [`emptied`](Tube::emptied) | O(1) |
//!
//! ```
//! use shoal_interval::{Interval, Membership};
//! use shoal_tube::{TimeDomain, Tube};
//!
//! let depth_m = Tube::from_function(TimeDomain::uniform(0.0, 0.25, 400)?, |t| (t * 0.25).sin().sqr() * 10.0);
//! assert!(depth_m.at(6.25)?.contains(10.0 * pxfm::f_sin(6.25 / 4.0).powi(2)));
//! assert!(depth_m.over(Interval::new(10.0, 15.0)?)?.is_subset_of(Interval::new(0.0, 4.0)?));
//! // It is deeper than nine metres near odd multiples of 2 pi seconds: eight times.
//! assert_eq!(depth_m.invert_components(Interval::new(9.0, 10.0)?).len(), 8);
//! // Metres times seconds: half of 10 m for 100 s, more or less.
//! assert!(depth_m.integral(0.0, 100.0)?.contains(500.0 + 10.0 * pxfm::f_sin(50.0)));
//! assert_eq!(depth_m.contains(|t| (t * 0.25).sin().sqr() * 10.0), Membership::Inside);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Arithmetic
//!
//! Tubes that share a domain are added, multiplied and put into functions like numbers, slice by slice and gate by gate;
//! anything else is a [`map`](Tube::map) or a [`zip`](Tube::zip).
//!
//! ```
//! use shoal_interval::Interval;
//! use shoal_tube::{TimeDomain, Tube};
//!
//! let time = TimeDomain::uniform(0.0, 0.1, 100)?;
//! let heading_rad = Tube::from_function(time.clone(), |t| t * 0.5);
//! let speed_m_s = Tube::constant(time, Interval::new(1.4, 1.6)?);
//! let east_m_s = speed_m_s.product(&heading_rad.cos())?;
//! let x_m = Tube::primitive(&east_m_s, Interval::ZERO);
//! assert!(x_m.holds(4.0, &(1.5 * pxfm::f_sin(2.0) / 0.5))?);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Contractors
//!
//! A contractor takes away what cannot be. The derivative carries knowledge through time, both ways; module
//! [`contractor`] has the others: order, delays, symmetry, clocks, pings.
//!
//! ```
//! use shoal_interval::Interval;
//! use shoal_tube::{Direction, TimeDomain, Tube};
//!
//! // Lost for 100 s but for one fix in the middle.
//! let time = TimeDomain::uniform(0.0, 1.0, 100)?;
//! let speed_m_s = Tube::constant(time.clone(), Interval::new(0.9, 1.1)?);
//! let mut x_m = Tube::constant(time, Interval::ENTIRE);
//! x_m.contract_gate(50, &Interval::new(-2.0, 2.0)?)?;
//! x_m.contract_derivative(&speed_m_s, Direction::Both)?;
//! assert!(x_m.at(60.0)?.is_subset_of(Interval::new(6.9, 13.1)?));
//! assert!(x_m.at(40.0)?.is_subset_of(Interval::new(-13.1, -6.9)?));
//!
//! // When did it pass a wreck that is at 20 m, to a metre?
//! let (mut time_s, mut wreck_m) = (x_m.domain().span(), Interval::new(19.0, 21.0)?);
//! x_m.contract_evaluation_with_derivative(&speed_m_s, &mut time_s, &mut wreck_m)?;
//! assert!(time_s.is_subset_of(Interval::new(65.0, 76.0)?));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Integration and estimation
//!
//! Module [`integration`] encloses all solutions of a state equation, with a proof for each slice that none leaves it, and carries sets through
//! it without wrapping them into larger ones. Where not even the start is known, a box of states is cut into parts, each part is
//! carried both ways and thrown away when its tube empties: CONTRACT, STRANGLE, TubeCSIVIA, in module [`estimation`].
//!
//! # Online
//!
//! A tube grows at one end and forgets at the other. Its memory is bounded by the horizon, below 64 bytes a slice.
//!
//! ```
//! use shoal_interval::Interval;
//! use shoal_tube::{Direction, Tube};
//!
//! let mut x_m = Tube::starting_at(0.0, Interval::ZERO)?;
//! for step in 1..=10_000_u32 {
//!     x_m.append(f64::from(step) * 0.1, Interval::ENTIRE, Interval::ENTIRE)?;
//!     let speed_m_s = Interval::new(-0.1, 0.1)?;
//!     x_m.contract_slice_derivative(x_m.slice_count() - 1, speed_m_s, Direction::Forward)?;
//!     x_m.drop_before(x_m.domain().end_s() - 60.0);
//! }
//! assert!(x_m.slice_count() <= 601 && x_m.memory_bytes() < 601 * 64 + 1_000);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Bad input, and models that are wrong
//!
//! What cannot be answered is a [`TubeError`]: times outside of the domain, unsorted times, tubes that are cut at
//! different times. A measurement of NaN says nothing and removes nothing. A measurement that *contradicts* is no error: it
//! empties the tube, and the tube remembers [where, when and by which constraint](Tube::emptied).
//!
//! ```
//! use shoal_interval::Interval;
//! use shoal_tube::{Direction, TimeDomain, Tube, TubeError};
//!
//! assert!(matches!(TimeDomain::new([0.0, 2.0, 1.0]), Err(TubeError::Unsorted { .. })));
//! let speed_m_s = Tube::constant(TimeDomain::uniform(0.0, 1.0, 10)?, Interval::new(0.0, 1.5)?);
//! let mut x_m = Tube::primitive(&speed_m_s, Interval::ZERO);
//! assert!(matches!(x_m.at(11.0), Err(TubeError::OutsideDomain { .. })));
//! // A fix that no vehicle of this speed can have.
//! x_m.contract_gate(6, &Interval::new(40.0, 41.0)?)?;
//! x_m.contract_derivative(&speed_m_s, Direction::Both)?;
//! let emptied = x_m.emptied().expect("40 m in 6 s");
//! assert!(emptied.to_string().starts_with("gate 6, at 6 s, is empty"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Seeing
//!
//! Module [`figure`] draws tubes beside the truth. The examples leave theirs in `target/figures`: `unknown_sinusoid`,
//! `uncertain_delay`, `two_circles`, `six_vehicles`, `mass_spring_sonar`.
//!
//! Source: seed 001, chapters 4 and 5; slices and gates as in Codac.

mod arithmetic;
mod components;
mod contraction;
pub mod contractor;
mod derivative;
mod enclosure;
mod error;
pub mod estimation;
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
