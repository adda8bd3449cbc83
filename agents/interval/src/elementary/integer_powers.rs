//! Powers with a whole exponent, and reciprocals.

use super::scaled::Scaled;
use crate::interval::Interval;

impl Interval {
    /// The reciprocals of the numbers in the set that are not zero, as a hull; empty when zero is the only one.
    ///
    /// Tightest, but for the last bit of a bound below 2^-960.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// assert_eq!(Interval::new(2.0, 4.0)?.recip(), Interval::new(0.25, 0.5)?);
    /// assert_eq!(Interval::new(0.0, 4.0)?.recip(), Interval::new(0.25, f64::INFINITY)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: IEEE 1788-2015, table 9.1.
    #[inline]
    pub fn recip(self) -> Interval {
        Interval::ONE / self
    }

    /// The numbers in the set to the power of `exponent`, which may be negative: then those that are not zero.
    ///
    /// Every bound is at most one unit in the last place from the tightest, and a power that is exact in `f64` is not
    /// widened. `x^0 = 1` for every number, zero included.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let x = Interval::new(-2.0, 3.0)?;
    /// assert_eq!(x.powi(3), Interval::new(-8.0, 27.0)?);
    /// assert_eq!(x.powi(4), Interval::new(0.0, 81.0)?);
    /// assert_eq!(Interval::new(2.0, 4.0)?.powi(-2), Interval::new(0.0625, 0.25)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: IEEE 1788-2015, table 9.1 (pown).
    pub fn powi(self, exponent: i32) -> Interval {
        if self.is_empty() {
            return Interval::EMPTY;
        }
        match exponent {
            0 => Interval::ONE,
            1 => self,
            2 => self.sqr(),
            -1 => self.recip(),
            _ if exponent % 2 == 0 => even_power(self, exponent),
            _ => odd_power(self, exponent),
        }
    }
}

fn even_power(x: Interval, exponent: i32) -> Interval {
    let (smallest, largest) = (x.mignitude(), x.magnitude());
    if exponent > 0 {
        Interval::from_bounds(power_down(smallest, exponent), power_up(largest, exponent))
    } else if largest == 0.0 {
        Interval::EMPTY
    } else {
        Interval::from_bounds(power_down(largest, exponent), power_up(smallest, exponent))
    }
}

fn odd_power(x: Interval, exponent: i32) -> Interval {
    let (from, to) = (x.lower(), x.upper());
    if exponent > 0 {
        return Interval::from_bounds(odd_power_down(from, exponent), -odd_power_down(-to, exponent));
    }
    if from == 0.0 && to == 0.0 {
        Interval::EMPTY
    } else if from < 0.0 && to > 0.0 {
        Interval::ENTIRE
    } else if from >= 0.0 {
        Interval::from_bounds(power_down(to, exponent), power_up(from, exponent))
    } else {
        Interval::from_bounds(-power_up(-to, exponent), -power_down(-from, exponent))
    }
}

fn odd_power_down(x: f64, exponent: i32) -> f64 {
    if x < 0.0 { -power_up(-x, exponent) } else { power_down(x, exponent) }
}

/// `x^exponent` rounded down, for `x` that is not negative and a positive exponent, or the limit at zero and infinity.
#[inline]
pub(super) fn power_down(x: f64, exponent: i32) -> f64 {
    match limit(x, exponent) {
        Some(limit) => limit,
        None => power(x, exponent).rounded_down(),
    }
}

/// `x^exponent` rounded up; as [`power_down`].
#[inline]
pub(super) fn power_up(x: f64, exponent: i32) -> f64 {
    match limit(x, exponent) {
        Some(limit) => limit,
        None => power(x, exponent).rounded_up(),
    }
}

#[inline]
fn limit(x: f64, exponent: i32) -> Option<f64> {
    if x == 0.0 {
        Some(if exponent > 0 { 0.0 } else { f64::INFINITY })
    } else if x.is_infinite() {
        Some(if exponent > 0 { f64::INFINITY } else { 0.0 })
    } else {
        None
    }
}

/// Left to right through the bits of the exponent, so that what comes between has fewer digits than the result: an exact
/// result comes from exact steps.
///
/// A step has a relative error below 2^-103, and squaring doubles the one so far: x^n has less than n times that.
#[inline]
fn power(x: f64, exponent: i32) -> Scaled {
    let x = Scaled::exact(x);
    let mut power = x;
    let count = exponent.unsigned_abs();
    for bit in (0..count.ilog2()).rev() {
        power = power.times(power);
        if count >> bit & 1 == 1 {
            power = power.times(x);
        }
    }
    if !power.is_exact() {
        power = power.with_tolerance(f64::from(count) * Scaled::STEP);
    }
    if exponent > 0 { power } else { power.reciprocal() }
}

#[cfg(test)]
mod tests;
