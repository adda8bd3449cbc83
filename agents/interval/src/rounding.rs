//! One operation on two numbers, rounded down or up.
//!
//! The operation is done once, to nearest, and its exact error is then computed (error-free transformations). Only the
//! sign of the error decides whether to take one step to the neighbouring number, so an exact result stays as it is, and
//! an inexact one is the tightest bound that exists, subnormal ones included. Which way an error falls is a coin toss that
//! no processor predicts, so the step is arithmetic on the bits and not a branch.
//!
//! Arguments are never NaN. Zero times infinity is zero, as bounds need it: the infinity is a missing bound, not a number.
//!
//! Source: J.-M. Muller et al., *Handbook of Floating-Point Arithmetic*, 2nd edition, chapter 4.

mod extreme;

/// Above 2^-960 the error of a product is a number that `f64` can hold; below it may vanish.
pub(crate) const ERROR_IS_EXACT_ABOVE_BITS: u64 = (1023 - 960) << 52;
const SIGN_BIT: u64 = 1 << 63;

/// `a + b`, rounded down. The infinities that bounds may hold (`-inf` on the left side of an interval) stay.
#[inline]
pub(crate) fn add_down(a: f64, b: f64) -> f64 {
    let sum = a + b;
    let b_seen = sum - a;
    let error = (a - (sum - b_seen)) + (b - b_seen);
    if error.is_finite() { step_down_if(error < 0.0, sum) } else { extreme::add_down(a, b) }
}

/// `a + b`, rounded up.
#[inline]
pub(crate) fn add_up(a: f64, b: f64) -> f64 {
    -add_down(-a, -b)
}

/// `a - b`, rounded down.
#[inline]
pub(crate) fn sub_down(a: f64, b: f64) -> f64 {
    add_down(a, -b)
}

/// `a - b`, rounded up.
#[inline]
pub(crate) fn sub_up(a: f64, b: f64) -> f64 {
    add_up(a, -b)
}

/// `a * b`, rounded down.
#[inline]
pub(crate) fn mul_down(a: f64, b: f64) -> f64 {
    let product = a * b;
    if has_exact_error(product) {
        step_down_if(a.mul_add(b, -product) < 0.0, product)
    } else {
        extreme::mul_down(a, b)
    }
}

/// `a * b`, rounded up.
#[inline]
pub(crate) fn mul_up(a: f64, b: f64) -> f64 {
    -mul_down(-a, b)
}

/// `a / b`, rounded down. `b` is not zero, and not both are infinite.
#[inline]
pub(crate) fn div_down(a: f64, b: f64) -> f64 {
    let quotient = a / b;
    if has_exact_error(quotient) && has_exact_error(a) {
        let remainder = (-quotient).mul_add(b, a);
        // The remainder's sign is relative to the divisor's: compare the signs, not a product that could underflow.
        let below = (remainder < 0.0) != (b < 0.0) && remainder != 0.0;
        step_down_if(below, quotient)
    } else {
        extreme::div_down(a, b)
    }
}

/// `a / b`, rounded up. `b` is not zero, and not both are infinite.
#[inline]
pub(crate) fn div_up(a: f64, b: f64) -> f64 {
    -div_down(-a, b)
}

/// The square root of a number that is not negative, rounded down.
#[inline]
pub(crate) fn sqrt_down(x: f64) -> f64 {
    let root = x.sqrt();
    if has_exact_error(x) {
        step_down_if((-root).mul_add(root, x) < 0.0, root)
    } else {
        extreme::sqrt_down(x)
    }
}

/// The square root of a number that is not negative, rounded up.
#[inline]
pub(crate) fn sqrt_up(x: f64) -> f64 {
    let root = x.sqrt();
    if has_exact_error(x) {
        -step_down_if((-root).mul_add(root, x) > 0.0, -root)
    } else {
        extreme::sqrt_up(x)
    }
}

/// Whether the size of `x` is such that the error of a product or quotient that it came from can be computed: not tiny,
/// infinite or NaN.
#[inline]
fn has_exact_error(x: f64) -> bool {
    let size = x.to_bits() & !SIGN_BIT;
    size.wrapping_sub(ERROR_IS_EXACT_ABOVE_BITS) <= f64::MAX.to_bits() - ERROR_IS_EXACT_ABOVE_BITS
}

/// `x`, or the next number below it when `step` says so, without a branch. `x` is finite, and not zero if there is a step.
#[inline]
pub(crate) fn step_down_if(step: bool, x: f64) -> f64 {
    let bits = x.to_bits();
    // One bit less is a step towards zero: down for a positive number, up for a negative one.
    let down = (bits.cast_signed() >> 63) | 1;
    f64::from_bits(bits.wrapping_sub((down & -i64::from(step)).cast_unsigned()))
}

#[cfg(test)]
mod tests;
