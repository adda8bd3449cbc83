//! Why two numbers are not an interval.

use thiserror::Error;

/// Why [`Interval::new`](crate::Interval::new) or [`Interval::point`](crate::Interval::point) refused its bounds.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum IntervalError {
    /// A bound is not a number.
    #[error("an interval cannot have a bound that is not a number: [{lower:?}, {upper:?}]")]
    NotANumber {
        /// The lower bound that was asked for.
        lower: f64,
        /// The upper bound that was asked for.
        upper: f64,
    },
    /// The lower bound is above the upper one. The empty set is [`Interval::EMPTY`](crate::Interval::EMPTY).
    #[error("the lower bound of an interval cannot be above its upper bound: [{lower:?}, {upper:?}]")]
    Inverted {
        /// The lower bound that was asked for.
        lower: f64,
        /// The upper bound that was asked for.
        upper: f64,
    },
    /// Both bounds are the same infinity, so there is no real number between them.
    #[error("an interval must hold a real number, [{bound:?}, {bound:?}] holds none")]
    BeyondReals {
        /// The infinity that was asked for as both bounds.
        bound: f64,
    },
}
