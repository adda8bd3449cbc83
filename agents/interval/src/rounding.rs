//! One operation on two numbers, rounded down or up.
//!
//! The operation is done once, to nearest, and its exact error is then computed (error-free transformations). Only the
//! sign of the error decides whether to take one step to the neighbouring number, so an exact result stays as it is, and
//! an inexact one is the tightest bound that exists. Where the error itself could be lost to underflow, the step is taken
//! without asking.
//!
//! Arguments are never NaN. Zero times infinity is zero, as bounds need it: the infinity is a missing bound, not a number.
//!
//! Source: J.-M. Muller et al., *Handbook of Floating-Point Arithmetic*, 2nd edition, chapter 4.

/// Above this size an operation's error is a number that `f64` can hold; below it may vanish.
const ERROR_IS_EXACT_ABOVE: f64 = f64::from_bits((1023 - 960) << 52);

/// `a + b`, rounded down. The infinities that bounds may hold (`-inf` on the left side of an interval) stay.
#[inline]
pub(crate) fn add_down(a: f64, b: f64) -> f64 {
    let sum = a + b;
    let b_seen = sum - a;
    let error = (a - (sum - b_seen)) + (b - b_seen);
    // The error is NaN or infinite when something overflowed; then the step turns `+inf` into the largest number.
    if (0.0..=f64::MAX).contains(&error) { sum } else { sum.next_down() }
}

/// `a + b`, rounded up.
#[inline]
pub(crate) fn add_up(a: f64, b: f64) -> f64 {
    let sum = a + b;
    let b_seen = sum - a;
    let error = (a - (sum - b_seen)) + (b - b_seen);
    if (f64::MIN..=0.0).contains(&error) { sum } else { sum.next_up() }
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
    if (ERROR_IS_EXACT_ABOVE..=f64::MAX).contains(&product.abs()) {
        if a.mul_add(b, -product) < 0.0 { product.next_down() } else { product }
    } else if a == 0.0 || b == 0.0 {
        0.0
    } else if a.is_infinite() || b.is_infinite() {
        product
    } else {
        step_down(product, (a > 0.0) == (b > 0.0))
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
    let sizes = ERROR_IS_EXACT_ABOVE..=f64::MAX;
    if sizes.contains(&quotient.abs()) && sizes.contains(&a.abs()) {
        let remainder = (-quotient).mul_add(b, a);
        let below = if b > 0.0 { remainder < 0.0 } else { remainder > 0.0 };
        if below { quotient.next_down() } else { quotient }
    } else if a == 0.0 || b.is_infinite() {
        0.0
    } else if a.is_infinite() {
        quotient
    } else {
        step_down(quotient, (a > 0.0) == (b > 0.0))
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
    if (ERROR_IS_EXACT_ABOVE..=f64::MAX).contains(&x) {
        if (-root).mul_add(root, x) < 0.0 { root.next_down() } else { root }
    } else if x == 0.0 || x.is_infinite() {
        root
    } else {
        root.next_down()
    }
}

/// The square root of a number that is not negative, rounded up.
#[inline]
pub(crate) fn sqrt_up(x: f64) -> f64 {
    let root = x.sqrt();
    if (ERROR_IS_EXACT_ABOVE..=f64::MAX).contains(&x) {
        if (-root).mul_add(root, x) > 0.0 { root.next_up() } else { root }
    } else if x == 0.0 || x.is_infinite() {
        root
    } else {
        root.next_up()
    }
}

/// One step down from a result that overflowed or whose error is unknown, but not past zero when the exact result is
/// positive.
#[cold]
fn step_down(result: f64, exact_is_positive: bool) -> f64 {
    if exact_is_positive && result == 0.0 { 0.0 } else { result.next_down() }
}

#[cfg(test)]
mod tests;
