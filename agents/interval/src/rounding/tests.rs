//! Every rounded operation against exact arithmetic on whole numbers: on the right side, and the nearest such number.

use super::*;
use crate::strategies::{UNIT_SHIFT, exact, number};
use num_bigint::BigInt;
use proptest::prelude::*;
use std::cmp::Ordering;

/// How a finite number compares to the exact result, in that order. Infinities are beyond every result.
type Compare<'a> = &'a dyn Fn(f64) -> Ordering;

/// Checks that `down` and `up` enclose the exact result, and that no `f64` is closer.
fn check(down: f64, up: f64, compare: Compare<'_>) -> Result<(), TestCaseError> {
    let compare = |x: f64| match x {
        f64::INFINITY => Ordering::Greater,
        f64::NEG_INFINITY => Ordering::Less,
        finite => compare(finite),
    };
    prop_assert!(compare(down) != Ordering::Greater, "{down:e} is above the exact result");
    prop_assert!(compare(up) != Ordering::Less, "{up:e} is below the exact result");
    prop_assert!(compare(down) == Ordering::Equal || compare(down.next_up()) == Ordering::Greater);
    prop_assert!(compare(up) == Ordering::Equal || compare(up.next_down()) == Ordering::Less);
    Ok(())
}

fn shifted(x: f64) -> BigInt {
    exact(x) << UNIT_SHIFT
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn sum(a in number(), b in number()) {
        let result = exact(a) + exact(b);
        let (down, up) = (add_down(a, b), add_up(a, b));
        check(down, up, &|x| exact(x).cmp(&result))?;
        prop_assert!(down == up || down.next_up() == up, "a sum is never widened twice");
    }

    #[test]
    fn sum_of_neighbours_in_size(a in number(), scale in -60_i32..60, b in -2.0..2.0_f64) {
        let b = a * b * f64::from_bits(((1023 + scale) as u64) << 52);
        prop_assume!(b.is_finite());
        let result = exact(a) + exact(b);
        check(add_down(a, b), add_up(a, b), &|x| exact(x).cmp(&result))?;
    }

    #[test]
    fn product(a in number(), b in number()) {
        let result = exact(a) * exact(b);
        check(mul_down(a, b), mul_up(a, b), &|x| shifted(x).cmp(&result))?;
    }

    #[test]
    fn product_near_underflow(a in 0.5..2.0_f64, b in 0.5..2.0_f64, exponent in 40_u64..130) {
        let b = b * f64::from_bits(exponent << 52);
        let a = a * f64::from_bits((1023 - 60) << 52);
        let result = exact(a) * exact(b);
        check(mul_down(a, b), mul_up(a, b), &|x| shifted(x).cmp(&result))?;
    }

    #[test]
    fn product_of_tiny_numbers(a in any::<u64>(), b in any::<u64>()) {
        // From subnormal to 2^-400, so that the product is at the very end of what there is.
        let tiny = |bits: u64| f64::from_bits((bits % (640 << 52)) | (bits & (1 << 63)));
        let (a, b) = (tiny(a), tiny(b));
        let result = exact(a) * exact(b);
        check(mul_down(a, b), mul_up(a, b), &|x| shifted(x).cmp(&result))?;
        let b = f64::from_bits(b.to_bits() + (600 << 52));
        let result = exact(a) * exact(b);
        check(mul_down(a, b), mul_up(a, b), &|x| shifted(x).cmp(&result))?;
    }

    #[test]
    fn sum_of_the_largest(a in 0_u64..4, b in 960_u64 << 52..2046 << 52, swap in any::<bool>(), sign in any::<bool>()) {
        let a = f64::from_bits(f64::MAX.to_bits() - a) * if sign { 1.0 } else { -1.0 };
        let b = -a.signum() * f64::from_bits(b);
        let (a, b) = if swap { (b, a) } else { (a, b) };
        let result = exact(a) + exact(b);
        check(add_down(a, b), add_up(a, b), &|x| exact(x).cmp(&result))?;
    }

    #[test]
    fn quotient(a in number(), b in number()) {
        prop_assume!(b != 0.0);
        let (dividend, divisor) = (shifted(a), exact(b));
        let compare = |x: f64| {
            let order = (exact(x) * &divisor).cmp(&dividend);
            if b > 0.0 { order } else { order.reverse() }
        };
        check(div_down(a, b), div_up(a, b), &compare)?;
    }

    #[test]
    fn square_root(x in number()) {
        let x = x.abs();
        let square = shifted(x);
        let compare = |root: f64| {
            if root < 0.0 { Ordering::Less } else { exact(root).pow(2).cmp(&square) }
        };
        check(sqrt_down(x), sqrt_up(x), &compare)?;
    }
}

#[test]
fn exact_results_are_not_widened() {
    assert_eq!((add_down(0.5, 0.25), add_up(0.5, 0.25)), (0.75, 0.75));
    assert_eq!((mul_down(0.5, 3.0), mul_up(0.5, 3.0)), (1.5, 1.5));
    assert_eq!((div_down(3.0, 2.0), div_up(3.0, 2.0)), (1.5, 1.5));
    assert_eq!((sqrt_down(2.25), sqrt_up(2.25)), (1.5, 1.5));
}

#[test]
fn missing_bounds_stay_missing() {
    let (largest, infinite) = (f64::MAX, f64::INFINITY);
    assert_eq!((add_down(largest, largest), add_up(largest, largest)), (largest, infinite));
    assert_eq!((add_down(-infinite, largest), add_up(infinite, -largest)), (-infinite, infinite));
    assert_eq!((mul_down(largest, 2.0), mul_up(largest, 2.0)), (largest, infinite));
    assert_eq!((mul_down(0.0, infinite), mul_up(-infinite, 0.0)), (0.0, 0.0));
    assert_eq!((mul_down(-infinite, 2.0), mul_up(infinite, 2.0)), (-infinite, infinite));
    assert_eq!((div_down(1.0, infinite), div_up(infinite, 2.0)), (0.0, infinite));
    assert_eq!((div_down(largest, 0.5), div_up(largest, 0.5)), (largest, infinite));
    assert_eq!((sqrt_down(infinite), sqrt_up(infinite)), (infinite, infinite));
}
