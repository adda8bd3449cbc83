//! The angle of a point in the plane, rounded outwards.

use super::outward::{above, below};
use crate::interval::Interval;
use pxfm::f_atan2;

impl Interval {
    /// The angles of the points `(x, y)`, where `self` holds `y`, from the `x` axis and in radians, in `[-pi, pi]`.
    ///
    /// The origin has no angle: the result is empty when it is the only point. A negative `x` with `y = 0` has the angle pi;
    /// points on both sides of this cut give the whole of `[-pi, pi]`. Every bound is at most one unit in the last
    /// place from the tightest; the angle 0 is exact.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let (y, x) = (Interval::new(0.0, 2.0)?, Interval::new(0.0, 1.0)?);
    /// assert_eq!(y.atan2(x), Interval::new(0.0, Interval::HALF_PI.upper())?);
    /// assert_eq!((-y).atan2(-x), Interval::new(-Interval::PI.upper(), Interval::PI.upper())?);
    /// assert!(Interval::ZERO.atan2(Interval::ZERO).is_empty());
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: IEEE 1788-2015, table 9.1.
    #[inline]
    pub fn atan2(self, x: Interval) -> Interval {
        let y = self;
        if y.is_empty() || x.is_empty() {
            return Interval::EMPTY;
        }
        if y.lower() >= 0.0 {
            return angles_of_upper_half(y, x);
        }
        if x.lower() < 0.0 && y.upper() >= 0.0 {
            return Interval::HALF_TURNS;
        }
        if y.upper() <= 0.0 {
            return -angles_of_upper_half(-y, x);
        }
        // On both sides of the positive half of the axis.
        Interval::from_bounds(-angle_up(-y.lower(), x.lower()), angle_up(y.upper(), x.lower()))
    }
}

/// [`Interval::atan2`] where no `y` is negative: the angle grows to the left, and with `y` where `x` is positive.
#[inline]
fn angles_of_upper_half(y: Interval, x: Interval) -> Interval {
    let (left, right) = (x.lower(), x.upper());
    if y.upper() == 0.0 {
        return angles_of_axis(left, right);
    }
    let first = (if right > 0.0 { y.lower() } else { y.upper() }, right);
    let last = (if left < 0.0 { y.lower() } else { y.upper() }, left);
    Interval::from_bounds(angle_down(first.0, first.1), angle_up(last.0, last.1))
}

/// The angles of points on the `x` axis, without the origin.
fn angles_of_axis(left: f64, right: f64) -> Interval {
    match (left < 0.0, right > 0.0) {
        (false, false) => Interval::EMPTY,
        (false, true) => Interval::ZERO,
        (true, false) => Interval::PI,
        (true, true) => Interval::from_bounds(0.0, Interval::PI.upper()),
    }
}

/// The angle, rounded down, of one point with a `y` that is not negative, or its limit; not of the origin.
#[inline]
pub(crate) fn angle_down(y: f64, x: f64) -> f64 {
    match known_angle(y, x) {
        Some(angle) => angle.lower(),
        None => below(nearest_angle(y, x), 0.0),
    }
}

/// As [`angle_down`], rounded up.
#[inline]
pub(crate) fn angle_up(y: f64, x: f64) -> f64 {
    match known_angle(y, x) {
        Some(angle) => angle.upper(),
        None => above(nearest_angle(y, x), Interval::PI.upper()),
    }
}

/// The angle, less than one unit in the last place off.
#[inline]
fn nearest_angle(y: f64, x: f64) -> f64 {
    // A small angle is the quotient; `f_atan2` of `pxfm` 0.1 rounds one that is subnormal twice.
    let quotient = y / x;
    if (0.0..SMALL).contains(&quotient) && x > 0.0 { quotient } else { f_atan2(y, x) }
}

/// The cube of an angle below this size is far below half of its last bit.
const SMALL: f64 = f64::from_bits((1023 - 100) << 52);

#[inline]
fn known_angle(y: f64, x: f64) -> Option<Interval> {
    if y == 0.0 || x.is_infinite() {
        Some(if x > 0.0 { Interval::ZERO } else { Interval::PI })
    } else if x == 0.0 || y.is_infinite() {
        Some(Interval::HALF_PI)
    } else {
        None
    }
}

#[cfg(test)]
mod tests;
