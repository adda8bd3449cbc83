//! Exact arithmetic with angles, and the angles that are hardest to reduce.

use super::{UNIT_SHIFT, exact};
use num_bigint::BigInt;
use std::sync::LazyLock;

/// Fixed-point numbers have this many bits after the point: enough for the last bits of an angle of any size.
pub(crate) const BITS: u32 = 1400;

/// The number pi in units of 2^-[`BITS`].
pub(crate) static PI: LazyLock<BigInt> = LazyLock::new(|| pi_scaled(BITS));

/// A finite number in units of 2^-[`BITS`].
pub(crate) fn fixed(x: f64) -> BigInt {
    exact(x) << (BITS - UNIT_SHIFT)
}

/// How many whole times pi/2 is in a number, rounded down. No `f64` is so close to a multiple that the error of pi tells.
pub(crate) fn quarters(angle: f64) -> BigInt {
    let quotient = (fixed(angle) << 1) / &*PI;
    if angle < 0.0 { quotient - 1 } else { quotient }
}

/// An angle less the nearest multiple of a full turn, in units of 2^-[`BITS`].
pub(crate) fn wrapped(angle: f64) -> BigInt {
    let (angle, full_turn): (BigInt, BigInt) = (fixed(angle), 2 * &*PI);
    let rest = angle % &full_turn;
    if rest > *PI {
        rest - full_turn
    } else if rest < -&*PI {
        rest + full_turn
    } else {
        rest
    }
}

/// The sine and the cosine of an angle, in units of 2^-[`BITS`] and correct to all but a few of the last bits.
pub(crate) fn sine_and_cosine(angle: f64) -> (BigInt, BigInt) {
    let angle = wrapped(angle);
    let (mut sine, mut cosine) = (BigInt::ZERO, BigInt::ZERO);
    let mut term = BigInt::from(1) << BITS;
    for order in 1_u32.. {
        match order % 4 {
            1 => cosine += &term,
            2 => sine += &term,
            3 => cosine -= &term,
            _ => sine -= &term,
        }
        term = ((term * &angle) >> BITS) / order;
        if term.bits() < 2 {
            return (sine, cosine);
        }
    }
    unreachable!("the terms of a power series vanish")
}

/// For every exponent, the numbers that are closer to a multiple of pi/2 than all with fewer digits: from the continued
/// fraction of 2^exponent / (pi/2).
///
/// Source: J.-M. Muller, *Elementary Functions*, section on the worst cases for range reduction.
pub(crate) fn hardest() -> Vec<f64> {
    let mut angles = Vec::new();
    for exponent in 0..971_u32 {
        let (mut numerator, mut denominator) = (BigInt::from(2) << (BITS + exponent), PI.clone());
        let (mut before, mut digits) = (BigInt::from(1), BigInt::ZERO);
        loop {
            let quotient = &numerator / &denominator;
            (before, digits) = (digits.clone(), &quotient * digits + before);
            (numerator, denominator) = (denominator.clone(), numerator - quotient * denominator);
            match u64::try_from(&digits) {
                Ok(size) if size < 1 << 53 => angles.push(size as f64 * power_of_two(exponent)),
                _ => break,
            }
        }
    }
    angles
}

fn power_of_two(exponent: u32) -> f64 {
    f64::from_bits((1023 + u64::from(exponent)) << 52)
}

/// The number pi in units of 2^-`bits`, to the last few units, by Machin's formula.
pub(crate) fn pi_scaled(bits: u32) -> BigInt {
    let arctan_of_inverse = |n: u32| {
        let mut power = (BigInt::from(1) << (bits + 32)) / n;
        let mut sum = power.clone();
        let mut divisor = 1_u32;
        while power != BigInt::ZERO {
            power = -power / (n * n);
            divisor += 2;
            sum += &power / divisor;
        }
        sum
    };
    (16 * arctan_of_inverse(5) - 4 * arctan_of_inverse(239)) >> 32
}
