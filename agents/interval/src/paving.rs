//! Pavings: a set between two unions of boxes, found by bisection.
//!
//! A set `S` inside an initial box is enclosed by boxes of three kinds: *inner* ones, proved to be in `S`; *outside* ones,
//! proved not to be; and *boundary* ones, of which nothing is known. The inner boxes are the inner approximation of
//! `S`, inner and boundary together the outer one: `inner ⊂ S ⊂ inner ∪ boundary`. An inner box proves that `S` is not
//! empty; a paving without inner and boundary boxes proves that it is.
//!
//! | algorithm | decides with | source |
//! |---|---|---|
//! | [`sivia`] | an [`InclusionTest`] | seed 001, table 2.2; seed 002, algorithm 3.2 |
//! | [`csivia`] | a contractor, then an inclusion test | seed 001, table 2.3 |
//! | [`pave`] | a [`Separator`](crate::separator::Separator) | seed 002, algorithm 3.3; seed 000, section 2.3.3 |
//! | [`rsivia`] | inclusion tests, of which some may be wrong | seed 001, table 2.4 |
//! | [`gomne`] | separators, of which as few as possible are wrong | seed 001, table 2.5 |
//!
//! [`SubPaving`] keeps regular sub-pavings as binary trees, for unions, intersections and inclusions.
//!
//! All go through the boxes level by level. Several threads share a level, and the result has the same boxes in the same
//! order as with one. All end: a box as narrow as the precision is not bisected, nor is one between whose bounds there
//! is no other number, and a budget limits how many boxes are looked at.
//!
//! ```
//! use nalgebra::Vector2;
//! use shoal_interval::paving::{Options, sivia};
//! use shoal_interval::separator::Ring;
//! use shoal_interval::{Interval, IntervalBox};
//!
//! let ring = Ring::new(Vector2::new(3.0, 3.0), Interval::new(3.0, 4.0)?);
//! let initial = IntervalBox::from([Interval::new(-10.0, 10.0)?; 2]);
//! let paving = sivia(&ring, initial, &Options::new(0.1))?;
//! let area = 7.0 * std::f64::consts::PI;
//! assert!(paving.inner_volume().upper() <= area && area <= paving.outer_volume().lower());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod engine;
mod error;
mod inclusion_test;
mod options;
mod outliers;
mod regular;
mod result;
mod sivia;

pub use error::PavingError;
pub use inclusion_test::{
    FromTestFn, InclusionTest, Relaxed, SetInversion, from_test_fn, relaxed, set_inversion,
};
pub use options::Options;
pub use outliers::{Outliers, gomne};
pub use regular::{SubPaving, SubPavingError};
pub use result::{Paving, Statistics, Stopped};
pub use sivia::{csivia, pave, rsivia, sivia};

#[cfg(test)]
mod tests;
