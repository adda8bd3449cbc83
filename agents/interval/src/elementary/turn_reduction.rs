//! Angles moved by whole turns to within half a turn, to the last bit and at any size.
//!
//! Source: M. Payne and R. Hanek, *Radian Reduction for Trigonometric Functions*, 1983.

use super::scaled::Scaled;
use crate::interval::Interval;
use crate::set::smaller;
use std::f64::consts;

/// A finite angle less the nearest multiple of a full turn: the tightest bounds, or one unit in the last place more.
pub(super) fn wrapped(angle_rad: f64) -> Interval {
    let size = angle_rad.abs();
    if size <= consts::PI {
        return Interval::from_bounds(angle_rad, angle_rad);
    }
    let (rest, is_negative) = rest_of_turn(size);
    let bounds = Interval::from_bounds(rest.rounded_down(), smaller(rest.rounded_up(), Interval::PI.upper()));
    if is_negative == (angle_rad < 0.0) { bounds } else { -bounds }
}

/// The distance of a finite angle above pi from the nearest multiple of a full turn, and whether it is below that.
///
/// The angle is a whole number times a power of two: multiplied by the digits of one by two pi it is in turns, where only
/// the digits after the point matter, and of these the first 192.
fn rest_of_turn(angle_rad: f64) -> (Scaled, bool) {
    let bits = angle_rad.to_bits();
    let whole = bits & ((1 << 52) - 1) | 1 << 52;
    // The exponent of the last bit of the number is at least -51.
    let first_digit = ((bits >> 52) as usize + 64) - 1075;
    let digits = |word: usize| {
        let (index, shift) = (first_digit / 64 + word, first_digit % 64);
        let pair = u128::from(TURNS_PER_RADIAN[index]) << 64 | u128::from(TURNS_PER_RADIAN[index + 1]);
        u128::from((pair << shift >> 64) as u64)
    };
    let last = u128::from(whole) * digits(2);
    let middle = u128::from(whole) * digits(1) + (last >> 64);
    let first = u128::from(whole).wrapping_mul(digits(0)) + (middle >> 64);
    let (leading, trailing) = (first << 64 | u128::from(middle as u64), last as u64);

    let is_negative = leading >> 127 == 1;
    let (leading, trailing) = if is_negative {
        // The complement is off by one unit of the last of 192 digits, as is the product anyhow.
        (!leading, !trailing)
    } else {
        (leading, trailing)
    };
    // No number below 2^1024 is closer to a whole turn than 2^-64 turns.
    let zeros = leading.leading_zeros().min(64);
    let fraction = leading << zeros | u128::from(trailing) << zeros >> 64;
    let high = (fraction >> 75) as f64 / (1_u64 << 52) as f64;
    let low = (fraction >> 22 & ((1 << 53) - 1)) as f64 / (1_u128 << 105) as f64;
    let nearest = high + low;
    let turns = Scaled::near(nearest, low - (nearest - high), -1 - i64::from(zeros));
    (turns.times(FULL_TURN).with_tolerance(TOLERANCE), is_negative)
}

/// Twice pi.
const FULL_TURN: Scaled = Scaled::near(consts::FRAC_PI_2, 6.123233995736766e-17, 2);

/// 139 digits are right, of which up to 64 are zeros.
const TOLERANCE: f64 = 1.0 / (1_u128 << 70) as f64;

/// One by two pi, in digits of 64 bits: the first is before the point.
const TURNS_PER_RADIAN: [u64; 20] = [
    0x0000_0000_0000_0000,
    0x28be_60db_9391_054a,
    0x7f09_d5f4_7d4d_3770,
    0x36d8_a566_4f10_e410,
    0x7f94_58ea_f7ae_f158,
    0x6dc9_1b8e_9093_74b8,
    0x0192_4bba_8274_6487,
    0x3f87_7ac7_2c4a_69cf,
    0xba20_8d7d_4bae_d121,
    0x3a67_1c09_ad17_df90,
    0x4e64_758e_60d4_ce7d,
    0x2721_17e2_ef7e_4a0e,
    0xc7fe_25ff_f781_6603,
    0xfbcb_c462_d682_9b47,
    0xdb4d_9fb3_c9f2_c26d,
    0xd3d1_8fd9_a797_fa8b,
    0x5d49_eeb1_faf9_7c5e,
    0xcf41_ce7d_e294_a4ba,
    0x9afe_d7ec_47e3_5742,
    0x1580_cc11_bf1e_daea,
];

#[cfg(test)]
mod tests;
