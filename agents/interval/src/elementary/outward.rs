//! One step outwards from a value that is the nearest `f64` to the exact one, but not past what the function can reach.

use crate::set::{larger, smaller};

/// The number below `nearest`, but at least `least`.
#[inline]
pub(super) fn below(nearest: f64, least: f64) -> f64 {
    larger(nearest.next_down(), least)
}

/// The number above `nearest`, but at most `most`.
#[inline]
pub(super) fn above(nearest: f64, most: f64) -> f64 {
    smaller(nearest.next_up(), most)
}
