//! Powers with any exponent.

use super::corners::{highest_corners, lowest_corners};
use super::integer_powers::{power_down, power_up};
use super::outward::below;
use super::scaled::Scaled;
use crate::interval::Interval;
use crate::set::{larger, smaller};
use pxfm::f_pow;

impl Interval {
    /// The numbers in the set to the power of the numbers in `exponent`: `x^y` for positive `x`, and `0^y = 0` for positive
    /// `y`.
    ///
    /// Negative numbers have no real power in general and give nothing, also where `y` is whole: for that see
    /// [`Interval::powi`]. Every bound is at most one unit in the last place from the tightest.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let x = Interval::new(4.0, 9.0)?;
    /// assert_eq!(x.powf(Interval::new(0.5, 2.0)?), Interval::new(2.0, 81.0)?);
    /// assert!(Interval::ZERO.powf(-Interval::ONE).is_empty());
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: IEEE 1788-2015, table 9.1 (pow).
    pub fn powf(self, exponent: Interval) -> Interval {
        let base = self.intersection(Interval::NON_NEGATIVE);
        if base.is_empty() || exponent.is_empty() {
            return Interval::EMPTY;
        }
        if base.upper() == 0.0 {
            return if exponent.upper() > 0.0 { Interval::ZERO } else { Interval::EMPTY };
        }
        // The logarithm of the result is a product, `y ln x`, whose first factor is zero at one.
        let [low, low_too] = lowest_corners(base, 1.0, exponent);
        let [high, high_too] = highest_corners(base, 1.0, exponent);
        let mut lower = real_power_down(low.0, low.1);
        let mut upper = real_power_up(high.0, high.1);
        if low != low_too {
            lower = smaller(lower, real_power_down(low_too.0, low_too.1));
        }
        if high != high_too {
            upper = larger(upper, real_power_up(high_too.0, high_too.1));
        }
        Interval::from_bounds(lower, upper)
    }
}

/// `x^y` rounded down, for `x` that is not negative, or the limit at zero and infinity.
fn real_power_down(x: f64, y: f64) -> f64 {
    match (limit(x, y), whole(y)) {
        (Some(limit), _) => limit,
        (None, Some(exponent)) => power_down(x, exponent),
        (None, None) if y.abs() == 0.5 => half_power(x, y).rounded_down(),
        (None, None) => below(nearest_power(x, y), 0.0),
    }
}

/// `x^y` rounded up; as [`real_power_down`].
fn real_power_up(x: f64, y: f64) -> f64 {
    match (limit(x, y), whole(y)) {
        (Some(limit), _) => limit,
        (None, Some(exponent)) => power_up(x, exponent),
        (None, None) if y.abs() == 0.5 => half_power(x, y).rounded_up(),
        (None, None) => nearest_power(x, y).next_up(),
    }
}

/// The power, less than one unit in the last place off. `f_pow` of `pxfm` 0.1 has ways of its own for the bases 2 and 10, and
/// they fail where the result is subnormal: their squares have the same powers.
fn nearest_power(x: f64, y: f64) -> f64 {
    if x == 2.0 || x == 10.0 { f_pow(x * x, 0.5 * y) } else { f_pow(x, y) }
}

/// The root, or its reciprocal: exact ones stay so, and `f_pow` of `pxfm` 0.1 fails for a reciprocal root of 1e302.
fn half_power(x: f64, y: f64) -> Scaled {
    let root = Scaled::exact(x).sqrt();
    if y > 0.0 { root } else { root.reciprocal() }
}

fn limit(x: f64, y: f64) -> Option<f64> {
    if x == 1.0 || y == 0.0 {
        return Some(1.0);
    }
    if x == 0.0 || x.is_infinite() || y.is_infinite() {
        return Some(if (x > 1.0) == (y > 0.0) { f64::INFINITY } else { 0.0 });
    }
    None
}

/// The exponent, when it is a whole number of a size that powers are computed for more tightly.
fn whole(y: f64) -> Option<i32> {
    let exponent = y as i32;
    (f64::from(exponent) == y).then_some(exponent)
}

#[cfg(test)]
mod tests;
