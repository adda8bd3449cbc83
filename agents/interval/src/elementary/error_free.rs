//! Sums and products with their exact rounding errors, and the sign of an exact sum.
//!
//! Source: J. R. Shewchuk, *Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates*, 1997.

/// `a + b` rounded to nearest and the error: their sum is exact unless the sum overflows.
#[inline]
pub(super) fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_seen = sum - a;
    (sum, (a - (sum - b_seen)) + (b - b_seen))
}

/// `a * b` rounded to nearest and the error: their sum is exact when the product is between 2^-960 and 2^1023 in size.
#[inline]
pub(super) fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    (product, a.mul_add(b, -product))
}

/// A number of the sign of `a * b + c + d`, or zero when that is zero. Neither product nor sums may over- or underflow.
#[inline]
pub(super) fn sign_of_product_and_sum(a: f64, b: f64, c: f64, d: f64) -> f64 {
    // Growing an expansion: its parts do not overlap, so the largest part that is not zero has the sign of the sum.
    let (high, low) = two_product(a, b);
    let (carry, first) = two_sum(c, low);
    let (third, second) = two_sum(carry, high);
    let (carry, first) = two_sum(d, first);
    let (carry, second) = two_sum(carry, second);
    let (fourth, third) = two_sum(carry, third);
    [fourth, third, second, first].into_iter().find(|&part| part != 0.0).unwrap_or(0.0)
}
