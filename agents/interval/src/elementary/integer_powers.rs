//! Powers with a whole exponent, and reciprocals.

use super::error_free::two_product;
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
pub(super) fn power_down(x: f64, exponent: i32) -> f64 {
    match limit(x, exponent) {
        Some(limit) => limit,
        None => Power::of(x, exponent).rounded_down(),
    }
}

/// `x^exponent` rounded up; as [`power_down`].
pub(super) fn power_up(x: f64, exponent: i32) -> f64 {
    match limit(x, exponent) {
        Some(limit) => limit,
        None => Power::of(x, exponent).rounded_up(),
    }
}

fn limit(x: f64, exponent: i32) -> Option<f64> {
    if x == 0.0 {
        Some(if exponent > 0 { 0.0 } else { f64::INFINITY })
    } else if x.is_infinite() {
        Some(if exponent > 0 { f64::INFINITY } else { 0.0 })
    } else {
        None
    }
}

/// A positive number close to `(high + low) * 2^exponent`: the exact one is within `tolerance * 2^exponent`.
///
/// `high` is between 1/2 and 2 and the nearest number to `high + low`.
struct Power {
    high: f64,
    low: f64,
    exponent: i64,
    tolerance: f64,
}

impl Power {
    /// Left to right through the bits of the exponent, so that what comes between has fewer digits than the result: an
    /// exact result comes from exact steps.
    ///
    /// A step has a relative error below 2^-103, and squaring doubles the one so far: x^n has less than n times that.
    fn of(x: f64, exponent: i32) -> Power {
        let (size, shift) = mantissa_and_exponent(x);
        let mut power = Power { high: size, low: 0.0, exponent: shift, tolerance: 0.0 };
        let count = exponent.unsigned_abs();
        for bit in (0..count.ilog2()).rev() {
            power = power.times(power.high, power.low, power.exponent);
            if count >> bit & 1 == 1 {
                power = power.times(size, 0.0, shift);
            }
        }
        if power.tolerance > 0.0 {
            power.tolerance = f64::from(count) * UNIT_TOLERANCE;
        }
        if exponent > 0 { power } else { power.reciprocal() }
    }

    #[inline]
    fn times(&self, high: f64, low: f64, exponent: i64) -> Power {
        let (product, error) = two_product(self.high, high);
        let tolerance = if self.low == 0.0 && low == 0.0 { self.tolerance } else { UNIT_TOLERANCE };
        let error = error + (self.high * low + self.low * high);
        let scale = if product >= 2.0 { 0.5 } else { 1.0 };
        let total = product + error;
        Power {
            high: scale * total,
            low: scale * (error - (total - product)),
            exponent: self.exponent + exponent + i64::from(product >= 2.0),
            tolerance,
        }
    }

    fn reciprocal(&self) -> Power {
        let nearest = 1.0 / self.high;
        let remainder = (-nearest).mul_add(self.high, 1.0) - nearest * self.low;
        let exact = self.tolerance == 0.0 && self.low == 0.0 && remainder == 0.0;
        let low = nearest * remainder;
        let high = nearest + low;
        Power {
            high,
            low: low - (high - nearest),
            exponent: -self.exponent,
            tolerance: if exact { 0.0 } else { 4.0 * self.tolerance + UNIT_TOLERANCE },
        }
    }

    fn rounded_down(&self) -> f64 {
        if self.exponent > 1025 {
            return f64::MAX;
        }
        if self.exponent < -1080 {
            return 0.0;
        }
        let (nearest, excess) = self.to_nearest();
        if nearest.is_infinite() || excess - self.tolerance < 0.0 { nearest.next_down() } else { nearest }
    }

    fn rounded_up(&self) -> f64 {
        if self.exponent > 1025 {
            return f64::INFINITY;
        }
        if self.exponent < -1080 {
            return f64::from_bits(1);
        }
        let (nearest, excess) = self.to_nearest();
        if excess + self.tolerance > 0.0 { nearest.next_up() } else { nearest }
    }

    /// The nearest number, or infinity, to `high` alone, and by how much `high + low` is above it in units of
    /// 2^exponent.
    fn to_nearest(&self) -> (f64, f64) {
        // Two factors, as one alone may be subnormal or infinite; only the second product is rounded.
        let exponent = self.exponent as i32;
        let first = exponent / 2;
        let (one, other) = (power_of_two(first), power_of_two(exponent - first));
        let nearest = self.high * one * other;
        let back = nearest * power_of_two(-first) * power_of_two(first - exponent);
        let rest = if back.is_finite() { self.high - back } else { 0.0 };
        (nearest, rest + self.low)
    }
}

/// Twice 2^-102, for the roundings of the last steps: see [`Power::of`].
const UNIT_TOLERANCE: f64 = f64::from_bits((1023 - 101) << 52);

fn power_of_two(exponent: i32) -> f64 {
    f64::from_bits(((1023 + exponent) as u64) << 52)
}

/// A positive finite number as a number in `[1, 2)` times a power of two.
fn mantissa_and_exponent(x: f64) -> (f64, i64) {
    let (x, shift) = if x < f64::MIN_POSITIVE { (x * power_of_two(100), -100) } else { (x, 0) };
    let bits = x.to_bits();
    let size = f64::from_bits(bits & ((1 << 52) - 1) | 1023 << 52);
    (size, (bits >> 52) as i64 - 1023 + shift)
}

#[cfg(test)]
mod tests;
