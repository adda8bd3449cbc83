//! Where a product of two intervals is least and greatest.

use crate::interval::Interval;

/// The bounds of `x` and `y` among which `g(x) * y` is least, where `g` grows and is zero at `zero`: one pair, given
/// twice, unless both factors change sign.
#[inline]
pub(super) fn lowest_corners(x: Interval, zero: f64, y: Interval) -> [(f64, f64); 2] {
    let (a, b) = (x.lower(), x.upper());
    let (c, d) = (y.lower(), y.upper());
    if a >= zero {
        [if c >= 0.0 { (a, c) } else { (b, c) }; 2]
    } else if b <= zero {
        [if d <= 0.0 { (b, d) } else { (a, d) }; 2]
    } else if c >= 0.0 {
        [(a, d); 2]
    } else if d <= 0.0 {
        [(b, c); 2]
    } else {
        [(a, d), (b, c)]
    }
}

/// As [`lowest_corners`], where the product is greatest.
#[inline]
pub(super) fn highest_corners(x: Interval, zero: f64, y: Interval) -> [(f64, f64); 2] {
    let (a, b) = (x.lower(), x.upper());
    let (c, d) = (y.lower(), y.upper());
    if a >= zero {
        [if d <= 0.0 { (a, d) } else { (b, d) }; 2]
    } else if b <= zero {
        [if c >= 0.0 { (b, c) } else { (a, c) }; 2]
    } else if c >= 0.0 {
        [(b, d); 2]
    } else if d <= 0.0 {
        [(a, c); 2]
    } else {
        [(a, c), (b, d)]
    }
}
