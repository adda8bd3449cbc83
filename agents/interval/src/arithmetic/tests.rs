//! The operators hold every result, and their bounds are results of bounds.

use super::*;
use crate::strategies::{UNIT_SHIFT, exact, interval_with_members};
use num_bigint::BigInt;
use proptest::prelude::*;
use std::ops::RangeInclusive;

/// Whether an exact number, in units of 2^-1074, is inside. An infinite bound is no bound.
fn holds(interval: Interval, number: &BigInt) -> bool {
    holds_scaled(interval, number, &BigInt::from(1))
}

/// Whether `number / scale`, for a positive `scale`, is inside.
fn holds_scaled(interval: Interval, number: &BigInt, scale: &BigInt) -> bool {
    let above = !interval.lower().is_finite() || exact(interval.lower()) * scale <= *number;
    let below = !interval.upper().is_finite() || *number <= exact(interval.upper()) * scale;
    above && below && !interval.is_empty()
}

fn interval(bounds: RangeInclusive<f64>) -> Interval {
    Interval::new(*bounds.start(), *bounds.end()).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn no_result_is_lost((xs, x, _) in interval_with_members(), (ys, y, _) in interval_with_members()) {
        let unit = BigInt::from(1) << UNIT_SHIFT;
        prop_assert!(holds(xs + ys, &(exact(x) + exact(y))));
        prop_assert!(holds(xs - ys, &(exact(x) - exact(y))));
        prop_assert!(holds_scaled(xs * ys, &(exact(x) * exact(y)), &unit));
        if y != 0.0 {
            let (dividend, divisor) = (exact(x) * &unit, exact(y));
            let sign = BigInt::from(y.signum() as i8);
            prop_assert!(holds_scaled(xs / ys, &(dividend * &sign), &(divisor * sign)), "{xs} / {ys}");
        }
    }

    #[test]
    fn squares_and_roots_are_kept((xs, x, _) in interval_with_members()) {
        let unit = BigInt::from(1) << UNIT_SHIFT;
        prop_assert!(holds_scaled(xs.sqr(), &exact(x).pow(2), &unit));
        prop_assert!(xs.abs().contains(x.abs()));
        if x >= 0.0 {
            prop_assert!(xs.sqrt().lower() <= x.sqrt() && x.sqrt() <= xs.sqrt().upper());
        }
    }

    #[test]
    fn a_bound_is_the_rounded_bound_of_some_members(
        (xs, x, x_too) in interval_with_members(),
        (ys, y, _) in interval_with_members(),
    ) {
        let smaller_xs = Interval::spanning(x, x_too);
        let point = Interval::spanning(y, y);
        prop_assert!((smaller_xs + point).is_subset_of(xs + ys));
        prop_assert!((smaller_xs - point).is_subset_of(xs - ys));
        prop_assert!((smaller_xs * point).is_subset_of(xs * ys));
        prop_assert!((smaller_xs / point).is_subset_of(xs / ys));
        let corners = [xs.lower(), xs.upper()].map(|x| [ys.lower(), ys.upper()].map(|y| x * y));
        let (lowest, highest) = corners
            .as_flattened()
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &c| (low.min(c), high.max(c)));
        prop_assert!((xs * ys).lower() >= lowest.next_down() && (xs * ys).upper() <= highest.next_up());
    }
}

#[test]
fn printed_examples() {
    assert_eq!(interval(-1.0..=3.0) + interval(2.0..=7.0), interval(1.0..=10.0));
    assert_eq!(interval(-1.0..=3.0) - interval(2.0..=7.0), interval(-8.0..=1.0));
    assert_eq!(interval(-1.0..=3.0) * interval(2.0..=7.0), interval(-7.0..=21.0));
    assert_eq!(interval(-1.0..=3.0) / interval(2.0..=7.0), interval(-0.5..=1.5));
}

#[test]
fn every_pair_of_signs_multiplies() {
    let (plus, minus, across) = (interval(2.0..=3.0), interval(-3.0..=-2.0), interval(-2.0..=3.0));
    assert_eq!(plus * plus, interval(4.0..=9.0));
    assert_eq!(plus * minus, interval(-9.0..=-4.0));
    assert_eq!(plus * across, interval(-6.0..=9.0));
    assert_eq!(minus * plus, interval(-9.0..=-4.0));
    assert_eq!(minus * minus, interval(4.0..=9.0));
    assert_eq!(minus * across, interval(-9.0..=6.0));
    assert_eq!(across * plus, interval(-6.0..=9.0));
    assert_eq!(across * minus, interval(-9.0..=6.0));
    assert_eq!(across * across, interval(-6.0..=9.0));
    assert_eq!(Interval::ZERO * Interval::ENTIRE, Interval::ZERO);
}

#[test]
fn division_across_zero() {
    let infinity = f64::INFINITY;
    let (plus, minus, across) = (interval(1.0..=2.0), interval(-2.0..=-1.0), interval(-1.0..=1.0));
    assert_eq!(plus / interval(0.0..=4.0), interval(0.25..=infinity));
    assert_eq!(plus / interval(-4.0..=0.0), interval(-infinity..=-0.25));
    assert_eq!(minus / interval(0.0..=4.0), interval(-infinity..=-0.25));
    assert_eq!(minus / interval(-4.0..=0.0), interval(0.25..=infinity));
    assert_eq!(plus / across, Interval::ENTIRE);
    assert_eq!(across / interval(0.0..=4.0), Interval::ENTIRE);
    assert_eq!(interval(0.0..=2.0) / interval(0.0..=4.0), Interval::NON_NEGATIVE);
    assert_eq!(Interval::ZERO / across, Interval::ZERO);
    assert!((plus / Interval::ZERO).is_empty());
    assert!((Interval::ZERO / Interval::ZERO).is_empty());
    assert_eq!(plus / Interval::ENTIRE, Interval::ENTIRE);
    assert_eq!(plus / interval(2.0..=infinity), interval(0.0..=1.0));
}

#[test]
fn plain_numbers_and_the_empty_set() {
    assert_eq!(interval(1.0..=2.0) * 2.0 + 1.0, interval(3.0..=5.0));
    assert_eq!(1.0 - interval(1.0..=2.0), interval(-1.0..=0.0));
    assert_eq!(Interval::ONE * f64::NAN, Interval::ENTIRE);
    for result in [
        Interval::EMPTY + Interval::ENTIRE,
        Interval::EMPTY - Interval::ENTIRE,
        Interval::EMPTY * Interval::ZERO,
        Interval::ONE / Interval::EMPTY,
        -Interval::EMPTY,
    ] {
        assert_eq!(result, Interval::EMPTY);
    }
}
