//! A positive number with more digits and a larger range than `f64`, and a bound on its error.

use super::error_free::two_product;
use crate::set::larger;

/// A positive number close to `(high + low) * 2^exponent`: the exact one is within `tolerance * 2^exponent`.
///
/// `high` is between 1/2 and 2 and the nearest number to `high + low`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scaled {
    high: f64,
    low: f64,
    exponent: i64,
    tolerance: f64,
}

impl Scaled {
    /// The tolerance for the rounding errors of one product or reciprocal.
    pub(super) const STEP: f64 = f64::from_bits((1023 - 101) << 52);

    /// A positive finite number, exactly.
    #[inline]
    pub(super) fn exact(x: f64) -> Scaled {
        let (x, shift) = if x < f64::MIN_POSITIVE { (x * power_of_two(100), 100) } else { (x, 0) };
        let bits = x.to_bits();
        let high = f64::from_bits(bits & ((1 << 52) - 1) | 1023 << 52);
        Scaled { high, low: 0.0, exponent: (bits >> 52) as i64 - 1023 - shift, tolerance: 0.0 }
    }

    /// A number that is known to within [`Scaled::STEP`] as `(high + low) * 2^exponent`, for `high` in `[1, 2]`.
    pub(super) const fn near(high: f64, low: f64, exponent: i64) -> Scaled {
        Scaled { high, low, exponent, tolerance: Scaled::STEP }
    }

    /// Whether nothing was lost so far.
    #[inline]
    pub(super) fn is_exact(self) -> bool {
        self.tolerance == 0.0
    }

    #[inline]
    pub(super) fn with_tolerance(self, tolerance: f64) -> Scaled {
        Scaled { tolerance, ..self }
    }

    /// The product, with a relative error below 2^-103 of its own. The tolerance of the product is at least that of
    /// its factors, but not their sum: who multiplies knows how the errors grow, and says so.
    #[inline]
    pub(super) fn times(self, other: Scaled) -> Scaled {
        let Scaled { high, low, exponent, .. } = other;
        let (product, error) = two_product(self.high, high);
        let own = if self.low == 0.0 && low == 0.0 { 0.0 } else { Scaled::STEP };
        let tolerance = larger(own, larger(self.tolerance, other.tolerance));
        let error = error + (self.high * low + self.low * high);
        let scale = if product >= 2.0 { 0.5 } else { 1.0 };
        let total = product + error;
        Scaled {
            high: scale * total,
            low: scale * (error - (total - product)),
            exponent: self.exponent + exponent + i64::from(product >= 2.0),
            tolerance,
        }
    }

    /// The square root of a number that [`Scaled::exact`] made.
    pub(super) fn sqrt(self) -> Scaled {
        let odd = self.exponent & 1;
        let square = if odd == 1 { 2.0 * self.high } else { self.high };
        let root = square.sqrt();
        let rest = (-root).mul_add(root, square);
        let tolerance = if rest == 0.0 { 0.0 } else { Scaled::STEP };
        Scaled { high: root, low: rest / (2.0 * root), exponent: (self.exponent - odd) / 2, tolerance }
    }

    pub(super) fn reciprocal(self) -> Scaled {
        let nearest = 1.0 / self.high;
        let remainder = (-nearest).mul_add(self.high, 1.0) - nearest * self.low;
        let exact = self.tolerance == 0.0 && self.low == 0.0 && remainder == 0.0;
        let low = nearest * remainder;
        let high = nearest + low;
        Scaled {
            high,
            low: low - (high - nearest),
            exponent: -self.exponent,
            tolerance: if exact { 0.0 } else { 4.0 * self.tolerance + Scaled::STEP },
        }
    }

    #[inline]
    pub(super) fn rounded_down(self) -> f64 {
        if self.exponent > 1025 {
            return f64::MAX;
        }
        if self.exponent < -1080 {
            return 0.0;
        }
        let (nearest, excess) = self.nearest_and_excess();
        if nearest.is_infinite() || excess - self.tolerance < 0.0 { nearest.next_down() } else { nearest }
    }

    #[inline]
    pub(super) fn rounded_up(self) -> f64 {
        if self.exponent > 1025 {
            return f64::INFINITY;
        }
        if self.exponent < -1080 {
            return f64::from_bits(1);
        }
        let (nearest, excess) = self.nearest_and_excess();
        if excess + self.tolerance > 0.0 { nearest.next_up() } else { nearest }
    }

    /// The nearest number, or infinity, to `high` alone, and by how much `high + low` is above it in units of
    /// 2^exponent.
    #[inline]
    fn nearest_and_excess(self) -> (f64, f64) {
        let exponent = self.exponent as i32;
        if (-1000..1000).contains(&exponent) {
            return (self.high * power_of_two(exponent), self.low);
        }
        self.nearest_and_excess_at_the_ends(exponent)
    }

    #[cold]
    fn nearest_and_excess_at_the_ends(self, exponent: i32) -> (f64, f64) {
        // Two factors, as one alone may be subnormal or infinite; only the second product is rounded.
        let first = exponent / 2;
        let (one, other) = (power_of_two(first), power_of_two(exponent - first));
        let nearest = self.high * one * other;
        let back = nearest * power_of_two(-first) * power_of_two(first - exponent);
        let rest = if back.is_finite() { self.high - back } else { 0.0 };
        (nearest, rest + self.low)
    }
}

#[inline]
fn power_of_two(exponent: i32) -> f64 {
    f64::from_bits(((1023 + exponent) as u64) << 52)
}
