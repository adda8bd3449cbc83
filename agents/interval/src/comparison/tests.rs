use super::*;
use crate::strategies::number;
use proptest::prelude::*;

fn between(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap()
}

#[test]
fn the_empty_set_compared() {
    let (none, one) = (Interval::EMPTY, Interval::ONE);
    assert!(none.is_interior_of(none) && none.is_interior_of(one) && !one.is_interior_of(none));
    assert!(none.is_disjoint_from(none) && none.is_disjoint_from(one) && one.is_disjoint_from(none));
    assert!(none.is_less_than(none) && !none.is_less_than(one) && !one.is_less_than(none));
    assert!(none.is_strictly_less_than(none) && !none.is_strictly_less_than(one));
    assert!(!one.is_strictly_less_than(none));
    assert!(none.precedes(one) && one.precedes(none) && none.strictly_precedes(none));
    assert!(!none.is_entire() && !none.is_common());
}

#[test]
fn missing_bounds_compared() {
    let (entire, ray) = (Interval::ENTIRE, Interval::NON_NEGATIVE);
    assert!(entire.is_interior_of(entire) && entire.is_strictly_less_than(entire));
    assert!(between(1.0, f64::INFINITY).is_interior_of(ray) && !ray.is_interior_of(ray));
    assert!(!ray.is_strictly_less_than(ray) && ray.is_less_than(ray));
    assert!((-ray).precedes(ray) && !(-ray).strictly_precedes(ray));
    assert!(entire.is_entire() && !entire.is_common() && !ray.is_common() && Interval::ONE.is_common());
}

#[test]
fn each_way_to_lie_to_each_other() {
    let x = between(1.0, 3.0);
    let cases = [
        (between(4.0, 5.0), Overlap::Before, Overlap::After),
        (between(3.0, 5.0), Overlap::Meets, Overlap::MetBy),
        (between(2.0, 5.0), Overlap::Overlaps, Overlap::OverlappedBy),
        (between(1.0, f64::INFINITY), Overlap::Starts, Overlap::StartedBy),
        (Interval::ENTIRE, Overlap::ContainedBy, Overlap::Contains),
        (between(f64::NEG_INFINITY, 3.0), Overlap::Finishes, Overlap::FinishedBy),
        (x, Overlap::Equals, Overlap::Equals),
        (between(3.0, 3.0), Overlap::FinishedBy, Overlap::Finishes),
        (between(1.0, 1.0), Overlap::StartedBy, Overlap::Starts),
        (between(-0.0, 0.0), Overlap::After, Overlap::Before),
        (Interval::EMPTY, Overlap::SecondEmpty, Overlap::FirstEmpty),
    ];
    for (y, forth, back) in cases {
        assert_eq!((x.overlap(y), y.overlap(x)), (forth, back), "{x} to {y}");
    }
    assert_eq!(Interval::EMPTY.overlap(Interval::EMPTY), Overlap::BothEmpty);
    assert_eq!(Interval::ENTIRE.overlap(Interval::ENTIRE), Overlap::Equals);
    assert_eq!(between(-0.0, 1.0).overlap(between(0.0, 1.0)), Overlap::Equals);
}

proptest! {
    #[test]
    fn comparisons_agree_with_each_other(a in number(), b in number(), c in number(), d in number()) {
        let (x, y) = (Interval::spanning(a, b), Interval::spanning(c, d));
        prop_assert_eq!(x.is_disjoint_from(y), (x & y).is_empty());
        prop_assert!(!x.is_interior_of(y) || x.is_subset_of(y) && !y.is_subset_of(x));
        prop_assert!(!x.strictly_precedes(y) || x.precedes(y) && x.is_strictly_less_than(y));
        prop_assert!(!x.precedes(y) || x.is_less_than(y));
        let overlap = x.overlap(y);
        prop_assert_eq!(matches!(overlap, Overlap::Before | Overlap::After), x.is_disjoint_from(y));
        prop_assert_eq!(overlap == Overlap::ContainedBy, x.is_interior_of(y));
        prop_assert_eq!(overlap == Overlap::Equals, x == y);
    }
}
