//! What can be wrong with a question to an estimator.

use crate::error::TubeError;
use thiserror::Error;

/// Why a state estimation was refused. That no state is possible is a result, not an error.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum EstimationError {
    /// No state is in the initial box.
    #[error("the initial box is empty")]
    EmptyBox,
    /// A box without bounds cannot be cut in two.
    #[error("the initial box is unbounded on axis {axis}")]
    UnboundedBox {
        /// The first axis without a bound.
        axis: usize,
    },
    /// A precision must be a positive number.
    #[error("the precision on axis {axis} is {precision}, not a positive number")]
    NotAPrecision {
        /// The axis.
        axis: usize,
        /// What was given.
        precision: f64,
    },
    /// The tube refused, for example because an observation is of a time outside its domain.
    #[error(transparent)]
    Tube(#[from] TubeError),
}
