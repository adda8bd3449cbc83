//! What is done for all lanes at once has the bits of what is done bound by bound.

use proptest::prelude::*;

use super::*;
use crate::interval_box::IntervalBox;
use crate::rounding::{add_down, add_up, mul_down, mul_up};
use crate::strategies::number;

/// Any set, the empty one and those without bounds too.
fn any_interval() -> impl Strategy<Value = Interval> {
    let special = vec![Interval::EMPTY, Interval::ENTIRE, Interval::ZERO, Interval::NON_NEGATIVE];
    let bounded = (number(), number()).prop_map(|(one, other)| Interval::spanning(one, other));
    let point = number().prop_map(|value| Interval::spanning(value, value));
    let above = number().prop_map(|lower| Interval::from_bounds(lower, f64::INFINITY));
    prop_oneof![2 => prop::sample::select(special), 8 => bounded, 2 => point, 1 => above]
}

fn any_box() -> impl Strategy<Value = IntervalBox<3>> {
    prop::array::uniform3(any_interval()).prop_map(IntervalBox::from)
}

fn bound_by_bound(a: Interval, b: Interval, bounds: impl Fn() -> (f64, f64)) -> Interval {
    if a.is_empty() || b.is_empty() {
        return Interval::EMPTY;
    }
    let (lower, upper) = bounds();
    Interval::from_bounds(lower, upper)
}

fn sum_of(a: Interval, b: Interval) -> Interval {
    bound_by_bound(a, b, || (add_down(a.lower(), b.lower()), add_up(a.upper(), b.upper())))
}

/// The least and the greatest of all four products of bounds.
fn product_of(a: Interval, b: Interval) -> Interval {
    let corners =
        [(a.lower(), b.lower()), (a.lower(), b.upper()), (a.upper(), b.lower()), (a.upper(), b.upper())];
    bound_by_bound(a, b, || {
        let down = corners.map(|(a, b)| mul_down(a, b)).into_iter().reduce(f64::min);
        let up = corners.map(|(a, b)| mul_up(a, b)).into_iter().reduce(f64::max);
        (down.unwrap(), up.unwrap())
    })
}

/// All of them, or the empty box if one is empty.
fn together(sides: [Interval; 3]) -> IntervalBox<3> {
    if sides.iter().any(|side| side.is_empty()) { IntervalBox::EMPTY } else { IntervalBox::from(sides) }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn boxes_are_added_side_by_side(a in any_box(), b in any_box()) {
        let of = |each: fn(Interval, Interval) -> Interval| {
            together(std::array::from_fn(|axis| each(a[axis], b[axis])))
        };
        prop_assert_eq!(a + b, of(sum_of));
        prop_assert_eq!(a - b, of(|a, b| sum_of(a, -b)));
    }

    #[test]
    fn boxes_are_scaled_side_by_side(a in any_box(), factor in any_interval()) {
        prop_assert_eq!(a * factor, together(a.sides().map(|side| product_of(side, factor))));
        for side in a.sides() {
            prop_assert_eq!(factor * side, product_of(side, factor));
        }
    }

    #[test]
    fn squares_are_those_of_single_intervals(a in any_box()) {
        if let Some(found) = squares(&a.sides()) {
            prop_assert_eq!(found, a.sides().map(Interval::sqr));
        }
    }

    #[test]
    fn middles_are_those_of_single_intervals(a in any_box()) {
        let each = a.sides().map(Interval::mid);
        let expected = if a.is_empty() { [f64::NAN; 3] } else { each };
        prop_assert_eq!(<[f64; 3]>::from(a.mid()).map(f64::to_bits), expected.map(f64::to_bits));
    }

    #[test]
    fn boxes_of_numbers_are_those_of_single_intervals(one in number(), other in number(), radius in number()) {
        let both = IntervalBox::spanning(&[one; 2].into(), &[other, f64::NAN].into());
        prop_assert_eq!(both.sides(), [Interval::spanning(one, other), Interval::ENTIRE]);
        let around = bound_by_bound(Interval::ZERO, Interval::ZERO, || {
            (add_down(one, -radius.abs()), add_up(one, radius.abs()))
        });
        prop_assert_eq!(Interval::centred(one, radius.abs()), around);
    }
}

#[test]
fn everyday_numbers_leave_no_doubt() {
    let a = [Interval::spanning(-1.0, 2.5), Interval::ZERO, Interval::spanning(3.0, 4.0)];
    for factor in
        [Interval::spanning(-1.0, 2.0), Interval::ZERO, Interval::ONE, Interval::spanning(-2.0, -1.0)]
    {
        assert!(products(&a, factor).is_some(), "{factor}");
    }
    assert!(sums(&a, &a).is_some() && differences(&a, &a).is_some() && squares(&a).is_some());
    assert!(sums(&a, &[Interval::EMPTY; 3]).is_none() && products(&a, Interval::ENTIRE).is_none());
}
