//! Why a box cannot be paved.

use thiserror::Error;

/// Why a paving algorithm refused to begin.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum PavingError {
    /// A side of the initial box has no bound, so it has no middle to bisect at.
    #[error(
        "the initial box has no bound along axis {axis}, [{lower}, {upper}], and an unbounded side cannot be bisected: \
         give a box that is large enough, but bounded"
    )]
    Unbounded {
        /// Which axis, counted from zero.
        axis: usize,
        /// The lower bound of that side.
        lower: f64,
        /// The upper bound of that side.
        upper: f64,
    },
    /// A precision is zero, negative, infinite or NaN.
    #[error(
        "the precision along axis {axis} is {precision}, but boxes are bisected until they are narrower than it: \
         give a positive number, in the unit of the axis"
    )]
    Precision {
        /// Which axis, counted from zero.
        axis: usize,
        /// The precision that was asked for.
        precision: f64,
    },
}
