//! Pavings enclose, fill, end, and do not depend on threads.

use super::*;
use crate::contractor::from_fn;
use crate::interval::Interval;
use crate::interval_box::IntervalBox;
use crate::membership::Membership;
use crate::separator::{InBox, Ring, Separator, intersection_of, q_intersection, union_of};
use nalgebra::{SVector, Vector2};
use proptest::prelude::*;

fn over(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap()
}

fn square(half: f64) -> IntervalBox<2> {
    IntervalBox::from([over(-half, half); 2])
}

fn beacons() -> [Ring<2>; 3] {
    [
        Ring::new(Vector2::new(3.0, 3.0), over(3.0, 4.0)),
        Ring::new(Vector2::new(-3.0, -1.0), over(5.0, 6.0)),
        Ring::new(Vector2::new(-2.0, 2.0), over(4.0, 5.0)),
    ]
}

/// Fails unless the boxes fill the initial one without overlapping.
fn fills(paving: &Paving<2>, initial: IntervalBox<2>) {
    let all: Vec<_> = paving.inner().iter().chain(paving.boundary()).chain(paving.outside()).collect();
    let volume = all.iter().fold(Interval::ZERO, |sum, part| sum + part.volume_enclosure());
    assert!(volume.contains(initial.volume()) && volume.width() < 1.0e-9 * initial.volume(), "{volume}");
    for (index, one) in all.iter().enumerate() {
        assert!(one.is_subset_of(&initial));
        for other in &all[index + 1..] {
            assert_eq!((**one & **other).volume(), 0.0, "{one} and {other} overlap");
        }
    }
}

#[test]
fn three_beacons_within_the_promised_bracket() {
    let paving = pave(&intersection_of(beacons()), square(10.0), &Options::new(0.05)).unwrap();
    let (inner, outer) = (paving.inner_volume(), paving.outer_volume());
    assert!(inner.lower() >= 0.4061 && outer.upper() <= 0.4379, "{inner} {outer}");
    assert!(inner.upper() <= 0.422_833_2 && 0.422_833_2 <= outer.lower());
    assert!(paving.statistics().bisections <= 170, "{:?}", paving.statistics());
    assert_eq!((paving.parts(), paving.stopped()), (1, Stopped::Complete));
    assert!(paving.boundary().iter().all(|part| part.width() < 0.05));
    fills(&paving, square(10.0));
}

#[test]
fn every_algorithm_encloses_the_same_set() {
    let rings = beacons();
    let initial = square(10.0);
    let options = Options::new(0.2);
    let all = from_test_fn(|domain: &IntervalBox<2>| relaxed(&rings[..], 0).test(domain));
    let contractor = from_fn(|domain| intersection_of(rings).outer(domain));
    let pavings = [
        sivia(&all, initial, &options).unwrap(),
        rsivia(&rings, 0, initial, &options).unwrap(),
        csivia(&contractor, &all, initial, &options).unwrap(),
        pave(&intersection_of(rings), initial, &options).unwrap(),
        pave(&q_intersection(rings, 0), initial, &options).unwrap(),
    ];
    for paving in &pavings {
        fills(paving, initial);
        assert!(paving.inner_volume().upper() <= 0.422_833_2 && 0.422_833_2 <= paving.outer_volume().lower());
    }
    assert_eq!(pavings[0], pavings[1]);
    let bisections = |index: usize| pavings[index].statistics().bisections;
    let counts = [bisections(0), bisections(2), bisections(3)];
    assert!(
        counts.is_sorted_by(|a, b| a > b),
        "contracting saves bisections, and on both sides more: {counts:?}"
    );
}

#[test]
fn threads_change_nothing() {
    let separator = union_of(beacons());
    let test = relaxed(beacons(), 1);
    for budget in [1_000_000, 1_000, 333] {
        let options = Options::new(0.05).with_budget(budget);
        let one = pave(&separator, square(10.0), &options).unwrap();
        let tested = sivia(&test, square(10.0), &options).unwrap();
        for threads in [0, 2, 3, 7] {
            assert_eq!(pave(&separator, square(10.0), &options.with_threads(threads)).unwrap(), one);
            assert_eq!(sivia(&test, square(10.0), &options.with_threads(threads)).unwrap(), tested);
        }
    }
}

#[test]
fn a_spent_budget_is_said_and_proves_what_it_can() {
    for budget in [0, 1, 2, 10, 100] {
        let options = Options::new(0.01).with_budget(budget);
        let paving = pave(&union_of(beacons()), square(10.0), &options).unwrap();
        let Stopped::BudgetSpent { left } = paving.stopped() else {
            panic!("{budget} boxes cannot be enough")
        };
        assert!(left > 0 && left <= paving.boundary().len());
        assert_eq!(paving.statistics().boxes, budget);
        fills(&paving, square(10.0));
    }
}

#[test]
fn what_cannot_be_paved_is_refused() {
    let [ring, ..] = beacons();
    for precision in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = sivia(&ring, square(1.0), &Options::new(precision)).unwrap_err();
        assert!(matches!(error, PavingError::Precision { axis: 0, .. }), "{error}");
    }
    let half_plane = IntervalBox::from([over(0.0, 1.0), Interval::NON_NEGATIVE]);
    let error = pave(&ring, half_plane, &Options::new(0.1)).unwrap_err();
    assert!(matches!(error, PavingError::Unbounded { axis: 1, .. }) && error.to_string().contains("bounded"));
    assert!(SubPaving::outer(&ring, half_plane, &Options::new(0.1)).is_err());

    let paving = pave(&ring, IntervalBox::EMPTY, &Options::new(0.1)).unwrap();
    assert_eq!((paving.stopped(), paving.statistics().boxes), (Stopped::Complete, 0));
    assert!(paving.proves_empty() && paving.hull().is_empty() && paving.parts() == 0);
}

#[test]
fn a_precision_beyond_numbers_still_ends() {
    let undecided = from_test_fn(|_: &IntervalBox<1>| Membership::Undecided);
    let narrow = IntervalBox::from([over(1.0, 1.0 + 4.0 * f64::EPSILON)]);
    let paving = sivia(&undecided, narrow, &Options::new(1.0e-300)).unwrap();
    assert_eq!((paving.boundary().len(), paving.stopped()), (4, Stopped::Complete));
    let point = IntervalBox::from([Interval::ONE]);
    assert_eq!(sivia(&undecided, point, &Options::new(1.0e-300)).unwrap().boundary(), [point]);

    // From the largest numbers down to a single one.
    let at_zero = InBox::new(IntervalBox::from([Interval::ZERO]));
    let separator = at_zero.complement();
    let widest = IntervalBox::from([over(f64::MIN, f64::MAX)]);
    let test = from_test_fn(move |domain: &IntervalBox<1>| {
        if separator.inner(*domain).is_empty() { Membership::Inside } else { Membership::Undecided }
    });
    let paving = sivia(&test, widest, &Options::new(f64::MIN_POSITIVE * f64::EPSILON)).unwrap();
    assert_eq!((paving.stopped(), paving.boundary().len()), (Stopped::Complete, 2));
}

#[test]
fn an_axis_of_its_own_precision() {
    let undecided = from_test_fn(|_: &IntervalBox<2>| Membership::Undecided);
    let initial = IntervalBox::from([over(0.0, 1.0), over(0.0, 1000.0)]);
    let paving = sivia(&undecided, initial, &Options::per_axis([0.26, 1001.0])).unwrap();
    assert!(paving.boundary().iter().all(|part| part[0].width() == 0.25 && part[1].width() == 1000.0));
}

#[test]
fn membership_of_points() {
    let [ring, ..] = beacons();
    let paving = pave(&ring, square(10.0), &Options::new(0.1)).unwrap();
    assert_eq!(paving.membership(&Vector2::new(3.0, -0.5)), Membership::Inside);
    assert_eq!(paving.membership(&Vector2::new(3.0, 3.0)), Membership::Outside);
    assert_eq!(paving.membership(&Vector2::new(-1.0, 3.0)), Membership::Undecided);
    assert_eq!(paving.membership(&Vector2::new(11.0, 3.0)), Membership::Undecided);
    assert_eq!(paving.membership(&Vector2::new(f64::NAN, 3.0)), Membership::Undecided);
    let apart = union_of([Ring::disc(Vector2::new(-5.0, 0.0), 1.0), Ring::disc(Vector2::new(5.0, 0.0), 1.0)]);
    assert_eq!(pave(&apart, square(10.0), &Options::new(0.2)).unwrap().parts(), 2);
}

#[test]
fn outliers_are_counted_and_bounded() {
    let good = beacons();
    let faulty = Ring::new(Vector2::new(4.0, -4.0), over(1.0, 2.0));
    let rings = [good[0], good[1], good[2], faulty];
    let options = Options::new(0.05);
    let found = gomne(&rings, 0, square(10.0), &options).unwrap();
    assert_eq!((found.at_least, found.enough, found.tolerated), (1, 1, 1));
    assert_eq!(found.paving, pave(&q_intersection(rings, 1), square(10.0), &options).unwrap());
    let with_margin = gomne(&rings, 1, square(10.0), &options).unwrap();
    assert_eq!((with_margin.enough, with_margin.tolerated), (1, 2));

    let nowhere = [Ring::new(Vector2::zeros(), Interval::EMPTY); 3];
    let all = gomne(&nowhere, 9, square(1.0), &options).unwrap();
    assert_eq!((all.at_least, all.enough, all.tolerated), (3, 3, 3));
    let none: [Ring<2>; 0] = [];
    assert_eq!(gomne(&none, 0, square(1.0), &options).unwrap().enough, 0);
    let empty = gomne(&rings, 0, IntervalBox::EMPTY, &options).unwrap();
    assert_eq!((empty.at_least, empty.enough), (4, 4));
}

#[test]
fn sub_pavings_are_sets() {
    let root = square(4.0);
    let options = Options::new(0.2);
    let disc = |x: f64, radius: f64| Ring::disc(Vector2::new(x, 0.0), radius);
    let outer = |ring: Ring<2>| SubPaving::outer(&ring, root, &options).unwrap();
    let (left, right) = (outer(disc(-1.0, 2.0)), outer(disc(1.0, 2.0)));
    let both = left.intersection(&right).unwrap();
    let any = left.union(&right).unwrap();
    assert!(both.is_subset_of(&left).unwrap() && left.is_subset_of(&any).unwrap());
    assert!(!any.is_subset_of(&left).unwrap());
    let sum = left.volume() + right.volume();
    assert!(!((both.volume() + any.volume()) & sum).is_empty());
    let rest = any.difference(&left).unwrap();
    assert_eq!(rest.union(&left).unwrap(), any);
    assert!(rest.intersection(&left).unwrap().is_empty());
    // Siblings are reunited: a union that is everything is one node.
    let everything =
        rest.union(&left).unwrap().union(&SubPaving::full(root).difference(&any).unwrap()).unwrap();
    assert_eq!((everything.node_count(), everything.boxes()), (1, vec![root]));
    assert_eq!(SubPaving::covering(&any.boxes(), root, &Options::new(0.01)).unwrap(), any);

    let inner = SubPaving::inner(&disc(-1.0, 2.0), root, &options).unwrap();
    let area = 4.0 * std::f64::consts::PI;
    assert!(inner.volume().upper() <= area && area <= left.volume().lower());
    assert!(inner.is_subset_of(&left).unwrap());
    assert!(inner.contains(&Vector2::new(-1.0, 0.0)) && !left.contains(&Vector2::new(3.0, 0.0)));
    assert!(inner.contains_box(&IntervalBox::from([over(-2.0, 0.0), over(-1.0, 1.0)])));
    assert!(!inner.contains_box(&IntervalBox::from([over(-2.0, 1.0), over(-1.0, 1.0)])));
    assert!(!SubPaving::full(root).contains_box(&square(5.0)));

    // A flat box on a common face is in the half that holds it.
    let lower_half =
        SubPaving::covering(&[IntervalBox::from([over(-4.0, 0.0), over(-4.0, 4.0)])], root, &options)
            .unwrap();
    assert_eq!(lower_half.node_count(), 3);
    assert!(lower_half.contains_box(&IntervalBox::from([Interval::ZERO, over(-4.0, 4.0)])));
    assert!(lower_half.contains(&Vector2::new(0.0, 0.0)));
    assert!(matches!(left.union(&SubPaving::full(square(2.0))), Err(SubPavingError::Roots { .. })));
    assert!(SubPaving::<2>::full(IntervalBox::EMPTY).is_empty());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn points_are_where_pavings_say(
        x in -6.0..6.0_f64, y in -6.0..6.0_f64, lower in 0.0..5.0_f64, width in 0.1..3.0_f64,
        points in prop::collection::vec(prop::array::uniform2(-6.0..6.0_f64), 30), outliers in 0_usize..3,
    ) {
        let centres = [Vector2::new(x, y), Vector2::new(y, 0.5 * x), Vector2::new(1.0, 1.0)];
        let range = over(lower, lower + width);
        let rings = centres.map(|centre| Ring::new(centre, range));
        let paving = pave(&q_intersection(rings, outliers), square(6.0), &Options::new(0.3)).unwrap();
        let tested = rsivia(&rings, outliers, square(6.0), &Options::new(0.3)).unwrap();
        let tree = SubPaving::outer(&relaxed(rings, outliers), square(6.0), &Options::new(0.3)).unwrap();
        prop_assert!(!(tree.volume() & tested.outer_volume()).is_empty());
        for point in points.into_iter().map(SVector::from) {
            let count = centres.iter().filter(|centre| range.contains((point - **centre).norm())).count();
            let wrong = if count + outliers >= 3 { Membership::Outside } else { Membership::Inside };
            prop_assert!(paving.membership(&point) != wrong && tested.membership(&point) != wrong);
            prop_assert!(wrong == Membership::Inside || tree.contains(&point));
        }
    }
}
