//! Sums, products and middles of several intervals at once, without a branch.
//!
//! An [`Interval`] is kept as two lower bounds, so an operation on `N` intervals is `2 N` times the same operation on numbers,
//! rounded down. Written as loops over arrays, without branches, it becomes vector instructions. The bits are those of
//! [`rounding`](crate::rounding), which has the reasons. What needs more care (infinite bounds, the empty set, what is next to
//! underflow or overflow) is found out for all lanes together: then the answer is `None`, and the caller goes one by one.

use crate::interval::Interval;
use crate::rounding::{ERROR_IS_EXACT_ABOVE_BITS, step_down_if};
use crate::set::{larger, smaller};

const SIGN_BIT: u64 = 1 << 63;
/// The lowest bit of the exponent.
const EXPONENT_BIT: u64 = 1 << 52;

/// A number rounded down. The sign bit of the doubt says that it may be another one.
struct Rounded {
    down: f64,
    doubt: u64,
}

/// `a[i] + b[i]` for all i.
#[inline(always)]
pub(crate) fn sums<const N: usize>(a: &[Interval; N], b: &[Interval; N]) -> Option<[Interval; N]> {
    each(|index| {
        let [lower, neg_upper] = a[index].lower_bounds();
        let [other_lower, other_neg_upper] = b[index].lower_bounds();
        [sum(lower, other_lower), sum(neg_upper, other_neg_upper)]
    })
}

/// `a[i] - b[i]` for all i.
#[inline(always)]
pub(crate) fn differences<const N: usize>(a: &[Interval; N], b: &[Interval; N]) -> Option<[Interval; N]> {
    each(|index| {
        let [lower, neg_upper] = a[index].lower_bounds();
        let [other_lower, other_neg_upper] = b[index].lower_bounds();
        [sum(lower, other_neg_upper), sum(neg_upper, other_lower)]
    })
}

/// Everything within `radius` of `middle`; in doubt unless both are finite.
#[inline(always)]
pub(crate) fn centred(middle: f64, radius: f64) -> Option<Interval> {
    each(|_| [sum(middle, -radius), sum(-middle, -radius)]).map(|[interval]| interval)
}

/// The smallest intervals that hold `one[i]` and `other[i]`, for all i; in doubt unless all are finite.
#[inline(always)]
pub(crate) fn spanning<const N: usize>(one: &[f64; N], other: &[f64; N]) -> Option<[Interval; N]> {
    each(|index| {
        let (one, other) = (one[index], other[index]);
        let doubt = ((one + other).to_bits() & !SIGN_BIT) + EXPONENT_BIT;
        [smaller(one, other), smaller(-one, -other)].map(|down| Rounded { down, doubt })
    })
}

/// `a[i] * factor` for all i.
#[inline(always)]
pub(crate) fn products<const N: usize>(a: &[Interval; N], factor: Interval) -> Option<[Interval; N]> {
    let [least, neg_most] = factor.lower_bounds();
    if least < 0.0 && neg_most < 0.0 {
        // Both ends of the factor may be the one that counts, for either bound.
        return each(|index| {
            let [lower, neg_upper] = a[index].lower_bounds();
            [
                lesser(product(lower, -neg_most), product(neg_upper, -least)),
                lesser(product(neg_upper, -neg_most), product(lower, -least)),
            ]
        });
    }
    // A factor that is not positive is the negative of one that is not negative.
    let is_negative = least < 0.0;
    let (least, most) = if is_negative { (neg_most, -least) } else { (least, -neg_most) };
    let a = if is_negative { a.map(|interval| -interval) } else { *a };
    each(|index| {
        let [lower, neg_upper] = a[index].lower_bounds();
        [lower, neg_upper].map(|bound| product(bound, if bound >= 0.0 { least } else { most }))
    })
}

/// The squares of the numbers in `a[i]`, for all i.
#[inline(always)]
pub(crate) fn squares<const N: usize>(a: &[Interval; N]) -> Option<[Interval; N]> {
    each(|index| {
        let [lower, neg_upper] = a[index].lower_bounds();
        let smallest = larger(larger(lower, neg_upper), 0.0);
        let neg_largest = smaller(lower, neg_upper);
        [smallest, neg_largest].map(|bound| product(bound, bound.abs()))
    })
}

/// Numbers near the middles of `a[i]`, for all i, by the rules of [`Interval::mid`].
#[inline(always)]
pub(crate) fn middles<const N: usize>(a: &[Interval; N]) -> Option<[f64; N]> {
    let mut middles = [0.0; N];
    let mut doubt = 0;
    for (middle, interval) in middles.iter_mut().zip(a) {
        let (lower, upper) = (interval.lower(), interval.upper());
        let sum = lower + upper;
        let half = 0.5 * sum;
        let above = if half < lower { lower } else { half };
        *middle = if above > upper { upper } else { above };
        doubt |= (sum.to_bits() & !SIGN_BIT) + EXPONENT_BIT;
    }
    (doubt & SIGN_BIT == 0).then_some(middles)
}

/// The intervals with these lower bounds and negatives of upper bounds, unless there is doubt about any.
#[inline(always)]
fn each<const N: usize>(bounds: impl Fn(usize) -> [Rounded; 2]) -> Option<[Interval; N]> {
    let mut intervals = [Interval::ZERO; N];
    let mut doubt = 0;
    for (index, interval) in intervals.iter_mut().enumerate() {
        let [lower, neg_upper] = bounds(index);
        *interval = Interval::from_lower_bounds(lower.down, neg_upper.down);
        doubt |= lower.doubt | neg_upper.doubt;
    }
    (doubt & SIGN_BIT == 0).then_some(intervals)
}

/// `a + b`; in doubt where not all is finite.
#[inline(always)]
fn sum(a: f64, b: f64) -> Rounded {
    let sum = a + b;
    let b_seen = sum - a;
    let error = (a - (sum - b_seen)) + (b - b_seen);
    // The largest exponent, that of infinities and NaN, carries over into the sign bit.
    Rounded { down: step_down_if(error < 0.0, sum), doubt: (error.to_bits() & !SIGN_BIT) + EXPONENT_BIT }
}

/// `a * b`; in doubt where the error of a product of numbers that are not zero is not known.
#[inline(always)]
fn product(a: f64, b: f64) -> Rounded {
    let product = a * b;
    let error = a.mul_add(b, -product);
    let size = product.to_bits() & !SIGN_BIT;
    // All bits, or none where a factor is zero: then so is the product, exactly.
    let kept = (-i64::from((a != 0.0) & (b != 0.0))).cast_unsigned();
    Rounded {
        down: f64::from_bits(step_down_if(error < 0.0, product).to_bits() & kept),
        // Zero times infinity is not a number.
        doubt: (size + EXPONENT_BIT) | (size.wrapping_sub(ERROR_IS_EXACT_ABOVE_BITS) & kept),
    }
}

#[inline(always)]
fn lesser(one: Rounded, other: Rounded) -> Rounded {
    Rounded { down: smaller(one.down, other.down), doubt: one.doubt | other.doubt }
}

#[cfg(test)]
mod tests;
