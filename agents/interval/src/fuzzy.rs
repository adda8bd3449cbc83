//! Fuzzy sets: knowledge of unequal worth, combined by a score and cut at a grade.
//!
//! Several sets, the *granules*, say where a vector is: ranges, a room, a depth. A [`ScoreFunction`] says how much it is worth
//! to be in some of them and not in others, from 0 for none to 1 for all. The *alpha-cut* at a [`Grade`] is the set of the
//! vectors whose score reaches it: all that satisfy enough of what matters. [`AlphaCut`] is its separator, made from separators of
//! the granules, and [`AlphaCutContractor`] its contractor, made from contractors.
//!
//! Scores and grades are fractions, compared exactly. As numbers with rounding, 1/5 would not reach 0.2.
//!
//! ```
//! use shoal_interval::Interval;
//! use shoal_interval::fuzzy::{Grade, ScoreFunction, contract_interval};
//!
//! let granules = [(0.0, 3.0), (2.0, 5.0), (4.0, 7.0), (2.5, 2.75)].map(|(a, b)| Interval::new(a, b).unwrap());
//! let score = ScoreFunction::weighted_mean(&[1, 2, 1, 1])?;
//! let three_fifths = contract_interval(&score, Grade::new(3, 5)?, &granules, Interval::new(-10.0, 10.0)?);
//! assert_eq!(three_fifths, Interval::new(2.0, 5.0)?);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Source: seed 000, sections 2.4.2 and 5.2.

mod alpha_cut;
mod error;
mod grade;
mod score;
mod trapezium;

pub use alpha_cut::{AlphaCut, AlphaCutContractor, contract_box, contract_interval};
pub use error::FuzzyError;
pub use grade::Grade;
pub use score::{Score, ScoreFunction};
pub use trapezium::FuzzyRing;

#[cfg(test)]
mod tests;
