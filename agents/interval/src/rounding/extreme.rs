//! The same operations where a result or its error may underflow or overflow: scaled by powers of two, which is exact,
//! until the error can be computed.

use std::cmp::Ordering;

/// Numbers are kept within 2^±400 by scaling them by 2^±600: products and quotients of two such have exact errors.
const SMALL: f64 = f64::from_bits((1023 - 400) << 52);
const LARGE: f64 = f64::from_bits((1023 + 400) << 52);
const SCALE_UP: f64 = f64::from_bits((1023 + 600) << 52);
const SCALE_DOWN: f64 = f64::from_bits((1023 - 600) << 52);

#[cold]
pub(super) fn add_down(a: f64, b: f64) -> f64 {
    let sum = a + b;
    if sum.is_infinite() {
        return overflow_down(sum, a.is_infinite() || b.is_infinite());
    }
    // Next to the largest number only the way round that starts from the larger operand does not overflow.
    let (large, small) = if a.abs() >= b.abs() { (a, b) } else { (b, a) };
    let error = small - (sum - large);
    if error < 0.0 { sum.next_down() } else { sum }
}

#[cold]
pub(super) fn mul_down(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 {
        return 0.0;
    }
    let product = a * b;
    if product.is_infinite() {
        return overflow_down(product, a.is_infinite() || b.is_infinite());
    }
    let (a, b) = (Scaled::from(a), Scaled::from(b));
    let nearest = a.value * b.value;
    let error = a.value.mul_add(b.value, -nearest);
    let seen = scale(product, a.ups + b.ups);
    step_down(product, order(seen, nearest, error))
}

#[cold]
pub(super) fn div_down(a: f64, b: f64) -> f64 {
    if a == 0.0 || b.is_infinite() {
        return 0.0;
    }
    let quotient = a / b;
    if quotient.is_infinite() {
        return overflow_down(quotient, a.is_infinite());
    }
    let (a, b) = (Scaled::from(a), Scaled::from(b));
    let nearest = a.value / b.value;
    let remainder = (-nearest).mul_add(b.value, a.value);
    let error = if b.value > 0.0 { remainder } else { -remainder };
    let seen = scale(quotient, a.ups - b.ups);
    step_down(quotient, order(seen, nearest, error))
}

#[cold]
pub(super) fn sqrt_down(x: f64) -> f64 {
    match order_of_root(x) {
        Some(Ordering::Greater) => x.sqrt().next_down(),
        _ => x.sqrt(),
    }
}

#[cold]
pub(super) fn sqrt_up(x: f64) -> f64 {
    match order_of_root(x) {
        Some(Ordering::Less) => x.sqrt().next_up(),
        _ => x.sqrt(),
    }
}

/// How the computed root compares with the exact one; `None` for zero and infinity, whose roots are exact.
fn order_of_root(x: f64) -> Option<Ordering> {
    if x == 0.0 || x.is_infinite() {
        return None;
    }
    // The root of a tiny number is not tiny: 2^300 is the root of the scale.
    let root = x.sqrt() * f64::from_bits((1023 + 300) << 52);
    let remainder = (-root).mul_add(root, x * SCALE_UP);
    0.0_f64.partial_cmp(&remainder)
}

/// A number of moderate size: the original times 2^600 to the power of `ups`.
struct Scaled {
    value: f64,
    ups: i32,
}

impl From<f64> for Scaled {
    fn from(x: f64) -> Scaled {
        if x.abs() < SMALL {
            Scaled { value: x * SCALE_UP, ups: 1 }
        } else if x.abs() > LARGE {
            Scaled { value: x * SCALE_DOWN, ups: -1 }
        } else {
            Scaled { value: x, ups: 0 }
        }
    }
}

fn scale(x: f64, ups: i32) -> f64 {
    let factor = if ups < 0 { SCALE_DOWN } else { SCALE_UP };
    (0..ups.unsigned_abs()).fold(x, |scaled, _| scaled * factor)
}

/// How `seen` compares with the exact result, of which `nearest` is the nearest number and `error` has the sign of what is
/// missing. A number other than the nearest is beyond the exact result.
fn order(seen: f64, nearest: f64, error: f64) -> Ordering {
    match seen.partial_cmp(&nearest) {
        Some(Ordering::Equal) | None => 0.0_f64.partial_cmp(&error).unwrap_or(Ordering::Greater),
        Some(different) => different,
    }
}

/// The result, or the next number below it when the result is above the exact one.
fn step_down(result: f64, order: Ordering) -> f64 {
    if order == Ordering::Greater { result.next_down() } else { result }
}

/// A result that is infinite: for good where an operand was, otherwise because no number is large enough.
fn overflow_down(result: f64, operand_is_infinite: bool) -> f64 {
    if operand_is_infinite { result } else { result.next_down() }
}
