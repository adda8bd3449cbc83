//! Product plus number, rounded once.

use super::corners::{highest_corners, lowest_corners};
use super::error_free::sign_of_product_and_sum;
use crate::interval::Interval;
use crate::set::{larger, smaller};

impl Interval {
    /// `x * y + z` for numbers taken from `self`, `factor` and `addend`, rounded outwards once.
    ///
    /// The smallest interval with `f64` bounds that holds every result, subnormal results included; never wider than
    /// `x * y + z` written with operators.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let x = Interval::new(1.0, 2.0)?;
    /// assert_eq!(x.mul_add(Interval::new(-3.0, 4.0)?, Interval::ONE), Interval::new(-5.0, 9.0)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: IEEE 1788-2015, table 9.1 (fma).
    #[inline]
    pub fn mul_add(self, factor: Interval, addend: Interval) -> Interval {
        if self.is_empty() || factor.is_empty() || addend.is_empty() {
            return Interval::EMPTY;
        }
        let [low, low_too] = lowest_corners(self, 0.0, factor);
        let [high, high_too] = highest_corners(self, 0.0, factor);
        let (least, most) = (addend.lower(), addend.upper());
        let mut lower = mul_add_down(low.0, low.1, least);
        let mut upper = mul_add_up(high.0, high.1, most);
        if low != low_too {
            lower = smaller(lower, mul_add_down(low_too.0, low_too.1, least));
        }
        if high != high_too {
            upper = larger(upper, mul_add_up(high_too.0, high_too.1, most));
        }
        Interval::from_bounds(lower, upper)
    }
}

/// `a * b + c`, rounded down. Zero times infinity is zero; an infinite `c` stays.
#[inline]
fn mul_add_down(a: f64, b: f64, c: f64) -> f64 {
    if a == 0.0 || b == 0.0 || c.is_infinite() {
        return c;
    }
    let nearest = a.mul_add(b, c);
    if nearest.is_infinite() {
        let overflowed = nearest > 0.0 && a.is_finite() && b.is_finite();
        return if overflowed { f64::MAX } else { nearest };
    }
    if excess(a, b, c, nearest) < 0.0 { nearest.next_down() } else { nearest }
}

/// `a * b + c`, rounded up.
#[inline]
fn mul_add_up(a: f64, b: f64, c: f64) -> f64 {
    -mul_add_down(-a, b, -c)
}

/// A number of the sign of `a * b + c - nearest`, for finite numbers where `nearest` is `a * b + c` to nearest.
#[inline]
fn excess(a: f64, b: f64, c: f64, nearest: f64) -> f64 {
    let (product_size, addend_size) = ((a * b).abs(), c.abs());
    if (POWER_OF_MINUS_900..=POWER_OF_1000).contains(&product_size) && addend_size <= POWER_OF_1000 {
        return sign_of_product_and_sum(a, b, c, -nearest);
    }
    excess_at_the_ends(a, b, c, nearest)
}

/// [`excess`] where the product or its error may under- or overflow: everything is scaled by a power of two, so exactly.
#[cold]
fn excess_at_the_ends(a: f64, b: f64, c: f64, nearest: f64) -> f64 {
    let product_size = (a * b).abs();
    if product_size < c.abs() * POWER_OF_MINUS_110 {
        // Far below the last bit of `c`, which therefore is the nearest number.
        return if (a > 0.0) == (b > 0.0) { 1.0 } else { -1.0 };
    }
    let (small, large) = if a.abs() < b.abs() { (a, b) } else { (b, a) };
    if product_size < POWER_OF_MINUS_900 {
        // The smaller factor is below 2^-450 and the others below 2^-790.
        let up = |x: f64| x * POWER_OF_600 * POWER_OF_600;
        return sign_of_product_and_sum(up(small), large, up(c), -up(nearest));
    }
    // The product is above 2^890: a small `c` can only break a tie, by its sign.
    let down = |x: f64| x * POWER_OF_MINUS_200;
    let c = if c != 0.0 && c.abs() < POWER_OF_600 { POWER_OF_600.copysign(c) } else { c };
    sign_of_product_and_sum(small, down(large), down(c), -down(nearest))
}

const POWER_OF_1000: f64 = f64::from_bits((1023 + 1000) << 52);
const POWER_OF_600: f64 = f64::from_bits((1023 + 600) << 52);
const POWER_OF_MINUS_110: f64 = f64::from_bits((1023 - 110) << 52);
const POWER_OF_MINUS_200: f64 = f64::from_bits((1023 - 200) << 52);
const POWER_OF_MINUS_900: f64 = f64::from_bits((1023 - 900) << 52);

#[cfg(test)]
mod tests;
