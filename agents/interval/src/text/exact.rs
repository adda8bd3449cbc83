//! A number as it is written, exactly, and the nearest `f64` on either side of it.

use super::natural::Natural;
use crate::interval::Interval;

/// `(-1)^negative * numerator / denominator * 10^exponent_of_ten * 2^exponent_of_two`; the denominator is not zero.
#[derive(Debug, Clone)]
pub(super) struct Exact {
    pub negative: bool,
    pub numerator: Natural,
    pub denominator: Natural,
    pub exponent_of_ten: i64,
    pub exponent_of_two: i64,
}

/// Ten to this power, and two to the next one, is far above every finite `f64`; the inverse is far below the smallest.
const BEYOND_POWER_OF_TEN: i64 = 400;
const BEYOND_POWER_OF_TWO: i64 = 1200;

impl Exact {
    /// The smallest interval that holds the number.
    pub fn enclosure(&self) -> Interval {
        let (below, above) = self.size();
        let (lower, upper) = if self.negative { (-above, -below) } else { (below, above) };
        // Adding zero drops the sign of a zero.
        Interval::from_bounds(lower + 0.0, upper + 0.0)
    }

    /// The largest `f64` that is not above the absolute value, and the smallest that is not below it.
    fn size(&self) -> (f64, f64) {
        const UNDERFLOW: (f64, f64) = (0.0, f64::from_bits(1));
        const OVERFLOW: (f64, f64) = (f64::MAX, f64::INFINITY);
        if self.numerator.is_zero() {
            return (0.0, 0.0);
        }
        // Two to the power of three is below ten: a third of the bits are at least as many decimals.
        let decimals = |number: &Natural| (number.bits() / 3 + 1) as i64;
        let (ten, two) = (self.exponent_of_ten, self.exponent_of_two);
        let powers_of_two = self.numerator.bits() as i64 - self.denominator.bits() as i64 + two;
        if two == 0 && ten > BEYOND_POWER_OF_TEN + decimals(&self.denominator) {
            return OVERFLOW;
        }
        if two == 0 && ten < -BEYOND_POWER_OF_TEN - decimals(&self.numerator) {
            return UNDERFLOW;
        }
        if ten == 0 && powers_of_two > BEYOND_POWER_OF_TWO {
            return OVERFLOW;
        }
        if ten == 0 && powers_of_two < -BEYOND_POWER_OF_TWO {
            return UNDERFLOW;
        }
        self.neighbours()
    }

    /// What [`size`](Exact::size) gives, for exponents that are not beyond all measure.
    fn neighbours(&self) -> (f64, f64) {
        let grown = |number: &Natural, ten: i64, two: i64| {
            number.clone().times_power_of_ten(ten.max(0) as u64).times_power_of_two(two.max(0) as u64)
        };
        // Every finite `f64` is a whole multiple of its unit, 2^-1074.
        let value =
            grown(&self.numerator, self.exponent_of_ten, self.exponent_of_two).times_power_of_two(1074);
        let unit = grown(&self.denominator, -self.exponent_of_ten, -self.exponent_of_two);
        let order = |bits: u64| {
            let (mantissa, exponent) = parts(bits);
            let mut multiple = unit.clone();
            multiple.multiply_add(mantissa, 0);
            multiple.times_power_of_two(exponent).cmp(&value)
        };
        // Positive numbers are ordered as their bits are. The value is not below `low`, and below `high`.
        let (mut low, mut high) = (0, f64::INFINITY.to_bits());
        while high - low > 1 {
            let middle = low + (high - low) / 2;
            if order(middle).is_le() { low = middle } else { high = middle }
        }
        let below = f64::from_bits(low);
        if low > 0 && order(low).is_eq() { (below, below) } else { (below, below.next_up()) }
    }
}

/// A positive `f64` as `mantissa * 2^exponent` units of 2^-1074.
fn parts(bits: u64) -> (u64, u64) {
    let (exponent, fraction) = (bits >> 52, bits & ((1 << 52) - 1));
    if exponent == 0 { (fraction, 0) } else { (fraction | 1 << 52, exponent - 1) }
}
