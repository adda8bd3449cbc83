//! Intervals, boxes and contractors that never lose the truth to rounding.
//!
//! An [`Interval`] is a closed set of real numbers, an [`IntervalBox`] a product of them. Whatever is computed from sets that
//! hold the truth gives a set that holds the truth: every bound is rounded outwards, by the sign of its own exact
//! rounding error, so results that are exact in `f64` are not widened. The rounding mode of the processor is never
//! touched, and every result has the same bits on every machine.
//!
//! A *contractor* takes sets that are linked by an equation and removes only what cannot satisfy it:
//! [`contract_distance`](contractor::contract_distance) for `‖a - b‖ = r`,
//! [`contract_range`](contractor::contract_range) for a ping, `‖p - e‖ = c (t - a)`. When nothing
//! satisfies the equation the answer is the empty set, which is a value like any other.
//!
//! ```
//! use shoal_interval::Interval;
//!
//! let x = Interval::new(-1.0, 3.0)?;
//! let y = Interval::new(2.0, 7.0)?;
//! assert_eq!(x + y, Interval::new(1.0, 10.0)?);
//! assert_eq!(x - y, Interval::new(-8.0, 1.0)?);
//! assert_eq!(x * y, Interval::new(-7.0, 21.0)?);
//! assert_eq!(x / y, Interval::new(-0.5, 1.5)?);
//! # Ok::<(), shoal_interval::IntervalError>(())
//! ```
//!
//! Source: seed 001, chapter 2.3.

mod arithmetic;
mod bisection;
mod comparison;
pub mod contractor;
mod elementary;
mod error;
pub mod expression;
pub mod figure;
pub mod fuzzy;
mod interval;
mod interval_box;
mod interval_matrix;
mod membership;
pub mod paving;
mod reverse;
mod rounding;
pub mod separator;
#[cfg(feature = "serde")]
mod serialization;
mod set;
#[cfg(test)]
mod strategies;
mod text;

pub use comparison::Overlap;
pub use error::IntervalError;
pub use interval::Interval;
pub use interval_box::{Difference, IntervalBox};
pub use interval_matrix::IntervalMatrix;
pub use membership::Membership;
pub use text::ParseIntervalError;
