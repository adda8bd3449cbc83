//! Whole powers against exact arithmetic.

use super::*;
use crate::strategies::{SplitMix64, UNIT_SHIFT, exact};
use num_bigint::BigInt;
use std::cmp::Ordering;

/// How a finite number that is not negative compares to `x^exponent`, exactly, for a positive `x`.
fn compare(bound: f64, x: f64, exponent: i32) -> Ordering {
    if bound.is_infinite() {
        return Ordering::Greater;
    }
    if bound < 0.0 {
        return Ordering::Less;
    }
    let count = exponent.unsigned_abs();
    // Both are whole numbers in units of 2^-1074.
    let (bound, power) = (exact(bound), exact(x).pow(count));
    if exponent > 0 {
        (bound << (UNIT_SHIFT * (count - 1))).cmp(&power)
    } else {
        (bound * power).cmp(&(BigInt::from(1) << (UNIT_SHIFT * (count + 1))))
    }
}

#[test]
fn powers_are_enclosed_to_the_last_bit() {
    let mut random = SplitMix64(70);
    let mut loose = 0;
    for round in 0..8_000 {
        let x = if round % 4 == 0 { random.between(0.0, 100.0).round() } else { random.number().abs() };
        if x == 0.0 {
            continue;
        }
        let exponent = match random.next() % 24 {
            0 => -1,
            choice => choice as i32 - 11,
        };
        if exponent == 0 {
            continue;
        }
        let (down, up) = (power_down(x, exponent), power_up(x, exponent));
        let order = |bound| compare(bound, x, exponent);
        assert!(order(down).is_le() && order(up).is_ge(), "{x:e}^{exponent} is not in [{down:e}, {up:e}]");
        if down.is_finite() && up.is_finite() {
            assert!(order(down).is_ne() || down == up, "{x:e}^{exponent} is exact");
            loose += usize::from(down != up && down.next_up() != up);
        }
    }
    assert!(loose <= 1, "no closer to a number than the tolerance, but by accident");
}

/// Powers of numbers next to 1 are closer to an `f64` than their digits can tell.
#[test]
fn powers_that_are_nearly_exact() {
    for steps in 1..40_u64 {
        for exponent in (-30..=30).filter(|&n| n != 0) {
            for x in [f64::from_bits(1.0_f64.to_bits() + steps), f64::from_bits(1.0_f64.to_bits() - steps)] {
                let (down, up) = (power_down(x, exponent), power_up(x, exponent));
                assert!(compare(down, x, exponent).is_le() && compare(up, x, exponent).is_ge());
                assert!(up <= down.next_up().next_up(), "{x}^{exponent}: [{down:e}, {up:e}]");
            }
        }
    }
}

#[test]
fn exact_powers_are_points() {
    let over = |lower, upper| Interval::new(lower, upper).unwrap();
    assert_eq!(Interval::point(3.0).unwrap().powi(33), Interval::point(5_559_060_566_555_523.0).unwrap());
    assert_eq!(Interval::point(2.0).unwrap().powi(-1074), Interval::point(f64::from_bits(1)).unwrap());
    assert_eq!(Interval::point(-0.5).unwrap().powi(1073), Interval::point(-f64::from_bits(2)).unwrap());
    assert_eq!(over(-2.0, 1.0).powi(-3), Interval::ENTIRE);
    assert_eq!(over(-2.0, 1.0).powi(-4), over(0.0625, f64::INFINITY));
    assert_eq!(over(-2.0, 0.0).powi(-3), over(f64::NEG_INFINITY, -0.125));
    assert_eq!(over(0.0, 2.0).powi(-3), over(0.125, f64::INFINITY));
    assert_eq!(over(-3.0, 2.0).powi(1), over(-3.0, 2.0));
    assert_eq!(Interval::ZERO.powi(0), Interval::ONE);
    assert_eq!(Interval::ENTIRE.powi(3), Interval::ENTIRE);
    assert_eq!(Interval::ENTIRE.powi(-3), Interval::ENTIRE);
    assert_eq!(Interval::ENTIRE.powi(-4), Interval::NON_NEGATIVE);
    for exponent in [-4, -3, -1] {
        assert!(Interval::ZERO.powi(exponent).is_empty());
    }
    for exponent in -3..=3 {
        assert!(Interval::EMPTY.powi(exponent).is_empty());
    }
}

#[test]
fn the_largest_exponents() {
    for exponent in [i32::MAX, i32::MIN, i32::MIN + 1] {
        assert_eq!(Interval::ONE.powi(exponent), Interval::ONE);
        let near_one = Interval::point(1.0_f64.next_up()).unwrap().powi(exponent);
        let nearest = core_math::pow(1.0_f64.next_up(), f64::from(exponent));
        assert!(near_one.lower() <= nearest && nearest <= near_one.upper());
        assert_eq!(near_one.lower().next_up(), near_one.upper());
        let two = Interval::point(2.0).unwrap().powi(exponent);
        let beyond = if exponent > 0 { (f64::MAX, f64::INFINITY) } else { (0.0, f64::from_bits(1)) };
        assert_eq!((two.lower(), two.upper()), beyond);
    }
}
