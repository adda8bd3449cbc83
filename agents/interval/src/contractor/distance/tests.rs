//! The distance contractor never loses a solution, and each bound that it leaves belongs to one.

use super::*;
use crate::strategies::{everyday_number, interval_with_members};
use proptest::prelude::*;

fn over(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap()
}

/// An interval that holds `truth` at a random place.
fn around(truth: f64, width: f64, share: f64) -> Interval {
    over(truth - share * width, truth + (1.0 - share) * width)
}

fn widths() -> impl Strategy<Value = [(f64, f64); 10]> {
    let width = prop_oneof![Just(0.0), 0.0..1.0e-6_f64, 0.0..1.0_f64, 0.0..300.0_f64];
    prop::array::uniform10((width, 0.0..=1.0_f64))
}

/// The interval, a little wider than rounding can make it.
fn loosened(interval: Interval) -> Interval {
    interval.inflate(1e-11 * interval.magnitude().max(1e-2))
}

/// Every distance between a point of one box and a point of the other: exact, because each coordinate appears once.
fn distances<const N: usize>(a: IntervalBox<N>, b: IntervalBox<N>) -> Interval {
    (a - b).iter().fold(Interval::ZERO, |sum, side| sum + side.sqr()).sqrt()
}

/// Whether some triple with `a[axis]` at `bound` satisfies the equation.
fn is_attained<const N: usize>(
    mut a: IntervalBox<N>,
    b: IntervalBox<N>,
    range: Interval,
    axis: usize,
    bound: f64,
) -> bool {
    a[axis] = Interval::spanning(bound, bound);
    !(loosened(distances(a, b)) & range).is_empty()
}

fn check_minimality<const N: usize>(
    a: IntervalBox<N>,
    b: IntervalBox<N>,
    range: Interval,
) -> Result<(), TestCaseError> {
    let (mut new_a, mut new_b, mut new_range) = (a, b, range);
    if contract_distance(&mut new_a, &mut new_b, &mut new_range) == Contracted::Empty {
        prop_assert!((distances(a, b) & range).is_empty());
        return Ok(());
    }
    prop_assert!(new_a.is_subset_of(&a) && new_b.is_subset_of(&b) && new_range.is_subset_of(range));
    for axis in 0..N {
        for bound in [new_a[axis].lower(), new_a[axis].upper()] {
            prop_assert!(
                is_attained(a, b, range, axis, bound),
                "{} {} {}: a[{}] = {}",
                a,
                b,
                range,
                axis,
                bound
            );
        }
        for bound in [new_b[axis].lower(), new_b[axis].upper()] {
            prop_assert!(
                is_attained(b, a, range, axis, bound),
                "{} {} {}: b[{}] = {}",
                a,
                b,
                range,
                axis,
                bound
            );
        }
    }
    for bound in [new_range.lower(), new_range.upper()] {
        prop_assert!(loosened(distances(a, b)).contains(bound));
    }
    Ok(())
}

/// A box of everyday size, thick or thin.
fn everyday_box<const N: usize>() -> impl Strategy<Value = IntervalBox<N>> {
    let side = (-10.0..10.0_f64, prop_oneof![Just(0.0), 0.0..1.0_f64, 0.0..20.0_f64]);
    prop::collection::vec(side, N).prop_map(|sides| {
        IntervalBox::from(std::array::from_fn(|axis| over(sides[axis].0, sides[axis].0 + sides[axis].1)))
    })
}

fn everyday_range() -> impl Strategy<Value = Interval> {
    (-1.0..20.0_f64, prop_oneof![Just(0.0), 0.0..1.0_f64, 0.0..10.0_f64])
        .prop_map(|(lower, width)| over(lower, lower + width))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(5000))]

    #[test]
    fn each_bound_belongs_to_a_solution_in_the_plane(a in everyday_box::<2>(), b in everyday_box(), range in everyday_range()) {
        check_minimality(a, b, range)?;
    }

    #[test]
    fn each_bound_belongs_to_a_solution_in_space(a in everyday_box::<3>(), b in everyday_box(), range in everyday_range()) {
        check_minimality(a, b, range)?;
    }

    #[test]
    fn nothing_is_lost_however_large(
        a in prop::array::uniform3(interval_with_members()),
        b in prop::array::uniform3(interval_with_members()),
        range in interval_with_members(),
    ) {
        let point = |members: &[(Interval, f64, f64); 3]| IntervalBox::from(std::array::from_fn::<_, 3, _>(|i| Interval::spanning(members[i].1, members[i].1)));
        let truth = distances(point(&a), point(&b));
        let before = (IntervalBox::from(a.map(|m| m.0)), IntervalBox::from(b.map(|m| m.0)), truth | range.0);
        let mut after = before;
        prop_assert_ne!(contract_distance(&mut after.0, &mut after.1, &mut after.2), Contracted::Empty);
        prop_assert!(point(&a).is_subset_of(&after.0) && point(&b).is_subset_of(&after.1) && !(truth & after.2).is_empty());
        prop_assert!(after.0.is_subset_of(&before.0) && after.1.is_subset_of(&before.1) && after.2.is_subset_of(before.2));

        let unbounded = |x: IntervalBox<3>| IntervalBox::from([x[0] | Interval::NON_NEGATIVE, Interval::ENTIRE, x[2]]);
        let mut wider = (unbounded(before.0), before.1, before.2);
        prop_assert_ne!(contract_distance(&mut wider.0, &mut wider.1, &mut wider.2), Contracted::Empty);
        prop_assert!(after.0.is_subset_of(&wider.0) && after.1.is_subset_of(&wider.1) && after.2.is_subset_of(wider.2));
    }

    #[test]
    fn a_second_pass_finds_nothing_after_an_unchanged_one(
        a in prop::array::uniform2(everyday_number()),
        b in prop::array::uniform2(everyday_number()),
        widths in widths(),
    ) {
        let mut a = IntervalBox::from([0, 1].map(|i| around(a[i], widths[i].0, widths[i].1)));
        let mut b = IntervalBox::from([0, 1].map(|i| around(b[i], widths[2 + i].0, widths[2 + i].1)));
        let mut range = Interval::centred(100.0, widths[4].0);
        let before = (a, b, range);
        match contract_distance(&mut a, &mut b, &mut range) {
            Contracted::Unchanged => prop_assert_eq!((a, b, range), before),
            Contracted::Narrowed => prop_assert!((a, b, range) != before && !a.is_empty()),
            Contracted::Empty => prop_assert!(a.is_empty() && b.is_empty() && range.is_empty()),
        }
    }
}

#[test]
fn an_axis_uses_what_the_others_leave() {
    let mut a = IntervalBox::from([Interval::ZERO; 3]);
    let mut b = IntervalBox::from([over(-10.0, 10.0), over(3.0, 4.0), Interval::ZERO]);
    let mut range = over(0.0, 5.0);
    assert_eq!(contract_distance(&mut a, &mut b, &mut range), Contracted::Narrowed);
    assert_eq!(b[0], over(-4.0, 4.0));
    assert_eq!(range, over(3.0, 5.0));
}

#[test]
fn only_the_possible_root_is_kept() {
    let mut a = IntervalBox::from([Interval::ZERO]);
    let mut b = IntervalBox::from([over(-1.0, 9.0)]);
    let mut range = over(2.0, 3.0);
    assert_eq!(contract_distance(&mut a, &mut b, &mut range), Contracted::Narrowed);
    assert_eq!(b[0], over(2.0, 3.0));
}

#[test]
fn contradictions_are_empty_and_repeated_passes_unchanged() {
    let mut a = IntervalBox::from([Interval::ZERO; 2]);
    let mut b = IntervalBox::from([over(1.0, 2.0); 2]);
    let mut range = over(1.0, 2.0);
    assert_eq!(contract_distance(&mut a, &mut b, &mut range), Contracted::Narrowed);
    assert_eq!(contract_distance(&mut a, &mut b, &mut range), Contracted::Unchanged);
    range = over(9.0, 10.0);
    assert_eq!(contract_distance(&mut a, &mut b, &mut range), Contracted::Empty);
    assert!(a.is_empty() && b.is_empty() && range.is_empty());
}
