//! Sine and cosine hold every value and follow the peaks.

use super::*;
use crate::strategies::SplitMix64;
use crate::strategies::angles::quarters;
use num_bigint::BigInt;
use proptest::prelude::*;
use std::f64::consts::PI;

fn angles() -> impl Strategy<Value = (f64, f64, f64)> {
    let angle = prop_oneof![
        -7.0..7.0_f64,
        -1.0e6..1.0e6_f64,
        -1.0e13..1.0e13_f64,
        any::<f64>().prop_filter("finite", |x| x.is_finite())
    ];
    let width = prop_oneof![Just(0.0), 0.0..1.0e-9_f64, 0.0..2.0_f64, 0.0..10.0_f64];
    (angle, width, 0.0..=1.0_f64)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(10_000))]

    #[test]
    fn no_value_is_lost((start, width, share) in angles()) {
        let xs = Interval::spanning(start, start + width);
        let x = (start + share * width).clamp(xs.lower(), xs.upper());
        prop_assert!(xs.sin().contains(f_sin(x)), "sin {xs}");
        prop_assert!(xs.cos().contains(f_cos(x)), "cos {xs}");
    }

    #[test]
    fn narrow_angles_have_narrow_values(start in -10.0..10.0_f64) {
        let point = Interval::point(start).unwrap();
        prop_assert!(point.sin().width() <= 4.0 * f64::EPSILON);
        prop_assert!(point.cos().width() <= 4.0 * f64::EPSILON);
    }

    #[test]
    fn the_circle_has_radius_one(start in -10.0..10.0_f64) {
        let (sin, cos) = Interval::point(start).unwrap().sin_cos();
        prop_assert!((sin.sqr() + cos.sqr()).contains(1.0));
    }
}

#[test]
fn peaks() {
    let over = |lower, upper| Interval::new(lower, upper).unwrap();
    assert_eq!(over(0.0, 2.0).sin(), over(0.0, 1.0));
    assert_eq!(over(-2.0, 0.0).sin(), over(-1.0, 0.0));
    assert_eq!(over(4.0, 5.0).sin().lower(), -1.0);
    assert!(over(4.0, 5.0).sin().upper() < -0.7);
    assert_eq!(over(-0.5, 0.5).cos().upper(), 1.0);
    assert!(over(-0.5, 0.5).cos().lower() > 0.87);
    assert_eq!(over(3.0, 3.5).cos().lower(), -1.0);
    assert_eq!(over(0.0, 7.0).cos(), over(-1.0, 1.0));
    assert_eq!(Interval::ENTIRE.sin(), over(-1.0, 1.0));
    assert_eq!(Interval::ZERO.sin(), Interval::ZERO);
    assert_eq!(Interval::ZERO.cos(), Interval::ONE);
    assert!(Interval::EMPTY.sin().is_empty() && Interval::EMPTY.cos().is_empty());
}

/// The `f64` nearest to pi/2 is below it: the peak is just outside a point, and just inside its neighbours' hull.
#[test]
fn peaks_at_the_last_bit() {
    let half_pi = PI / 2.0;
    assert_eq!(Interval::new(half_pi, half_pi.next_up()).unwrap().sin().upper(), 1.0);
    assert_eq!(Interval::new(PI, PI.next_up()).unwrap().cos().lower(), -1.0);
}

/// Extremes from the exact count of the multiples of pi/2 that are passed, ends from `core-math`.
#[test]
fn sets_of_every_size_have_their_extremes() {
    let mut random = SplitMix64(100);
    for _ in 0..20_000 {
        let angles = random.interval();
        let (from, to) = (angles.lower(), angles.upper());
        let (first, last) = (quarters(from), quarters(to));
        let passed = |remainder: i32, every: i32| {
            let count = |quarter: &BigInt| (quarter - remainder + 4000) / every;
            // Division rounds to zero, so negative counts are shifted up by whole turns.
            let shift = &first - (&first % 4);
            count(&(&last - &shift)) > count(&(&first - &shift))
        };
        let expect = |at_from: f64, at_to: f64, up: bool, down: bool| {
            (if down { -1.0 } else { at_from.min(at_to) }, if up { 1.0 } else { at_from.max(at_to) })
        };
        let check = |found: Interval, (lowest, highest): (f64, f64)| {
            assert!(found.lower() <= lowest && highest <= found.upper(), "{angles:?}: {found:?}");
            let tight = found.lower() >= lowest.next_down() && found.upper() <= highest.next_up();
            assert!(tight, "{angles:?}: {found:?}");
        };
        let (sine, cosine) = (
            expect(core_math::sin(from), core_math::sin(to), passed(1, 4), passed(3, 4)),
            expect(core_math::cos(from), core_math::cos(to), passed(0, 4), passed(2, 4)),
        );
        check(angles.sin(), sine);
        check(angles.cos(), cosine);
        assert_eq!(angles.sin_cos(), (angles.sin(), angles.cos()));
        if passed(1, 2) {
            assert_eq!(angles.tan(), Interval::ENTIRE);
        } else {
            let tangent = angles.tan();
            assert!(tangent.lower() <= core_math::tan(from) && core_math::tan(to) <= tangent.upper());
            assert!(tangent.lower() >= core_math::tan(from).next_down().next_down());
            assert!(tangent.upper() <= core_math::tan(to).next_up().next_up());
        }
    }
}

#[test]
fn tangents_at_poles() {
    let over = |lower, upper| Interval::new(lower, upper).unwrap();
    let half_pi = PI / 2.0;
    assert_eq!(over(half_pi, half_pi.next_up()).tan(), Interval::ENTIRE);
    assert!(over(1.0, half_pi).tan().lower() > 1.5);
    assert!(over(half_pi.next_up(), 3.0).tan().upper() < 0.0);
    assert_eq!(Interval::ENTIRE.tan(), Interval::ENTIRE);
    assert!(Interval::EMPTY.tan().is_empty());
}
