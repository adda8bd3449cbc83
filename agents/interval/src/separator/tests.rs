//! Separators never put a vector on the wrong side, and cut what they can.

use super::*;
use crate::contractor::contract_distance;
use crate::interval::Interval;
use crate::membership::Membership;
use crate::paving::InclusionTest;
use crate::strategies::number;
use nalgebra::{SVector, Vector2, Vector3};
use proptest::prelude::*;

fn over(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap()
}

fn exact(x: f64) -> Interval {
    Interval::spanning(x, x)
}

/// Whether a vector is in a ring, as far as rounding lets that be known.
fn in_ring<const N: usize>(
    point: &SVector<f64, N>,
    centre: &SVector<f64, N>,
    range: Interval,
) -> Option<bool> {
    let square =
        (0..N).fold(Interval::ZERO, |sum, axis| sum + (exact(point[axis]) - exact(centre[axis])).sqr());
    let distance = square.sqrt();
    if distance.is_subset_of(range) {
        Some(true)
    } else if (distance & range).is_empty() {
        Some(false)
    } else {
        None
    }
}

/// Fails if a separation puts `point`, of which it is known whether it is in the set, on the wrong side.
fn keeps<const N: usize>(
    separator: &impl Separator<N>,
    domain: IntervalBox<N>,
    point: SVector<f64, N>,
    member: Option<bool>,
) -> Result<(), TestCaseError> {
    let separation = separator.separate(domain);
    prop_assert_eq!(
        separation,
        Separation { inner: separator.inner(domain), outer: separator.outer(domain) }
    );
    prop_assert!(separation.inner.is_subset_of(&domain) && separation.outer.is_subset_of(&domain));
    if domain.contains(&point) {
        prop_assert!(member != Some(true) || separation.outer.contains(&point), "lost {}", point);
        prop_assert!(member != Some(false) || separation.inner.contains(&point), "added {}", point);
    }
    Ok(())
}

/// A box around a point, which is at a random place in it.
fn around<const N: usize>(point: &SVector<f64, N>, below: [f64; N], above: [f64; N]) -> IntervalBox<N> {
    IntervalBox::from(std::array::from_fn(|axis| {
        Interval::spanning(point[axis] - below[axis], point[axis] + above[axis])
    }))
}

fn small() -> impl Strategy<Value = f64> {
    prop_oneof![3 => -8.0..8.0_f64, 1 => (-8_i32..=8).prop_map(f64::from)]
}

fn length() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), 0.0..1.0e-9_f64, 0.0..1.0_f64, 0.0..8.0_f64, (0_i32..8).prop_map(f64::from)]
}

/// The outer and the inner box of a ring from three passes of the distance contractor, minimal when the centre is a point.
fn by_distances<const N: usize>(
    centre: &SVector<f64, N>,
    range: Interval,
    domain: IntervalBox<N>,
) -> Separation<N> {
    let contract = |mut range: Interval| {
        let mut centre = IntervalBox::from(std::array::from_fn(|axis| exact(centre[axis])));
        let mut left = domain;
        contract_distance(&mut left, &mut centre, &mut range);
        left
    };
    let outside = contract(Interval::from_bounds(range.upper(), f64::INFINITY));
    let hole = contract(Interval::from_bounds(0.0, range.lower()));
    Separation { inner: if range.lower() > 0.0 { outside | hole } else { outside }, outer: contract(range) }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn rings_of_any_size(
        centre in prop::array::uniform2(number()), point in prop::array::uniform2(number()),
        a in number(), b in number(), c in number(), d in number(),
    ) {
        let (centre, point) = (Vector2::from(centre), Vector2::from(point));
        let range = Interval::spanning(a, b);
        let domain = IntervalBox::from([exact(point.x) | exact(c), exact(point.y) | exact(d)]);
        keeps(&Ring::new(centre, range), domain, point, in_ring(&point, &centre, range))?;
    }

    #[test]
    fn rings_of_everyday_size(
        centre in prop::array::uniform3(small()), point in prop::array::uniform3(small()),
        below in prop::array::uniform3(length()), above in prop::array::uniform3(length()),
        lower in -1.0..10.0_f64, width in length(),
    ) {
        let (centre, point) = (Vector3::from(centre), Vector3::from(point));
        let range = Interval::spanning(lower, lower + width);
        let ring = Ring::new(centre, range);
        let domain = around(&point, below, above);
        keeps(&ring, domain, point, in_ring(&point, &centre, range))?;
        match ring.test(&domain) {
            Membership::Inside => prop_assert!(ring.inner(domain).width() < 1.0e-6 || ring.inner(domain).is_empty()),
            Membership::Outside => prop_assert!(ring.outer(domain).is_empty()),
            Membership::Undecided => {}
        }
        let uncertain = Ring::with_uncertain_range(
            centre, Interval::spanning(lower, lower + 0.3 * width), Interval::spanning(lower + 0.7 * width, lower + width),
        );
        let for_all = Interval::spanning(lower + 0.31 * width, lower + 0.69 * width);
        keeps(&uncertain, domain, point, in_ring(&point, &centre, range).filter(|member| !member))?;
        keeps(&uncertain, domain, point, in_ring(&point, &centre, for_all).filter(|&member| member))?;
    }

    #[test]
    fn rings_are_minimal(
        centre in prop::array::uniform2(small()), point in prop::array::uniform2(small()),
        below in prop::array::uniform2(0.01..5.0_f64), above in prop::array::uniform2(0.01..5.0_f64),
        lower in 0.0..8.0_f64, width in 0.1..4.0_f64,
    ) {
        let (centre, point) = (Vector2::from(centre), Vector2::from(point));
        let range = Interval::spanning(lower, lower + width);
        let domain = around(&point, below, above);
        let (separation, expected) = (Ring::new(centre, range).separate(domain), by_distances(&centre, range, domain));
        for (found, expected) in [(separation.inner, expected.inner), (separation.outer, expected.outer)] {
            // Where the border only touches the box, rounding decides whether a touching point is left.
            prop_assert!(found.is_subset_of(&expected.inflate(1.0e-6)) || found.width() < 1.0e-5, "{found} {expected}");
            prop_assert!(expected.is_subset_of(&found.inflate(1.0e-6)) || expected.width() < 1.0e-5, "{found} {expected}");
        }
    }

    #[test]
    fn the_algebra_follows_the_sets(
        points in prop::collection::vec(prop::array::uniform2(small()), 8),
        below in prop::array::uniform2(length()), above in prop::array::uniform2(length()), outliers in 0_usize..6,
    ) {
        let centres = [Vector2::new(0.0, 0.0), Vector2::new(3.0, 1.0), Vector2::new(-2.0, 2.5), Vector2::new(1.0, -4.0)];
        let range = over(1.5, 4.5);
        let rings = centres.map(|centre| Ring::new(centre, range));
        let [a, b, ..] = rings;
        let domain = around(&Vector2::from(points[0]), below, above);
        for point in points.into_iter().map(Vector2::from) {
            let members = centres.map(|centre| in_ring(&point, &centre, range));
            let [Some(in_a), Some(in_b), Some(in_c), Some(in_d)] = members else { continue };
            let count = [in_a, in_b, in_c, in_d].into_iter().filter(|&member| member).count();
            keeps(&a.complement(), domain, point, Some(!in_a))?;
            keeps(&a.intersection(b), domain, point, Some(in_a && in_b))?;
            keeps(&a.union(b), domain, point, Some(in_a || in_b))?;
            keeps(&a.difference(b), domain, point, Some(in_a && !in_b))?;
            keeps(&intersection_of(rings), domain, point, Some(count == 4))?;
            keeps(&union_of(rings), domain, point, Some(count > 0))?;
            keeps(&q_intersection(rings, outliers), domain, point, Some(count + outliers >= 4))?;
            let boxed: Vec<Box<dyn Separator<2>>> = rings.iter().map(|&ring| Box::new(ring) as _).collect();
            keeps(&q_intersection(&boxed[..], outliers), domain, point, Some(count + outliers >= 4))?;
        }
        prop_assert_eq!(q_intersection(rings, 0).outer(domain).is_empty(), intersection_of_hulls_is_empty(&rings, domain));
        prop_assert_eq!(q_intersection(rings, 3).outer(domain), union_of(rings).outer(domain));
        prop_assert_eq!(q_intersection(rings, 4).outer(domain), domain);
    }

    #[test]
    fn boxes_and_half_spaces(
        point in prop::array::uniform2(small()), below in prop::array::uniform2(length()),
        above in prop::array::uniform2(length()), set in prop::array::uniform4(-8_i32..8), offset in -9_i32..9,
    ) {
        let point = Vector2::from(point);
        let domain = around(&point, below, above);
        let [a, b, c, d] = set.map(f64::from);
        let set = IntervalBox::from([Interval::spanning(a, b), Interval::spanning(c, d)]);
        keeps(&InBox::new(set), domain, point, Some(set.contains(&point)))?;
        let product = exact(point.x) * a + exact(point.y) * b;
        let offset = f64::from(offset);
        let member = match product - offset {
            difference if difference.upper() <= 0.0 => Some(true),
            difference if difference.lower() > 0.0 => Some(false),
            _ => None,
        };
        keeps(&HalfSpace::new(Vector2::new(a, b), offset), domain, point, member)?;
    }

    #[test]
    fn polygons(
        point in prop::array::uniform2(-8.0..8.0_f64), below in prop::array::uniform2(length()),
        above in prop::array::uniform2(length()), corners in prop::collection::vec(prop::array::uniform2(-8_i32..8), 3..8),
    ) {
        let point = Vector2::from(point);
        let domain = around(&point, below, above);
        let corners: Vec<_> = corners.into_iter().map(|[x, y]| Vector2::new(f64::from(x), f64::from(y))).collect();
        // The even-odd rule, another way: the slope's crossing compared with the point.
        let edges = corners.iter().zip(corners.iter().cycle().skip(1));
        let crossings = edges.filter(|(from, to)| {
            (from.y > point.y) != (to.y > point.y)
                && point.x < from.x + (point.y - from.y) / (to.y - from.y) * (to.x - from.x)
        });
        let inside = crossings.count() % 2 == 1;
        keeps(&Polygon::new(corners).unwrap(), domain, point, Some(inside))?;
    }

    #[test]
    fn overlaps_of_many_are_counted(
        lowers in prop::collection::vec(-20_i32..20, 1..40), widths in prop::collection::vec(0_i32..12, 40),
        outliers in 0_usize..42, at in -30_i32..30,
    ) {
        let intervals: Vec<Interval> = lowers.iter().zip(&widths)
            .map(|(&lower, &width)| over(f64::from(lower), f64::from(lower + width))).collect();
        let granules: Vec<InBox<1>> = intervals.iter().map(|&side| InBox::new(IntervalBox::from([side]))).collect();
        let relaxed = q_intersection(&granules[..], outliers).outer(IntervalBox::from([over(-40.0, 40.0)]))[0];
        let enough = |x: f64| intervals.iter().filter(|side| side.contains(x)).count() + outliers >= intervals.len();
        prop_assert!(relaxed.contains(f64::from(at)) || !enough(f64::from(at)));
        if !relaxed.is_empty() {
            prop_assert!(enough(relaxed.lower()) && enough(relaxed.upper()), "not minimal");
        }
    }
}

fn intersection_of_hulls_is_empty(rings: &[Ring<2>], domain: IntervalBox<2>) -> bool {
    rings.iter().fold(domain, |left, ring| left & ring.outer(domain)).is_empty()
}

#[test]
fn what_is_not_known_removes_nothing() {
    let domain = IntervalBox::from([over(0.0, 1.0), over(2.0, 3.0)]);
    let unknown = Separation { inner: domain, outer: domain };
    assert_eq!(Ring::new(Vector2::new(f64::NAN, 0.0), over(1.0, 2.0)).separate(domain), unknown);
    assert_eq!(Ring::new(Vector2::new(0.0, f64::INFINITY), over(1.0, 2.0)).separate(domain), unknown);
    assert_eq!(Ring::disc(Vector2::zeros(), f64::NAN).separate(domain), unknown);
    assert_eq!(HalfSpace::new(Vector2::new(f64::NAN, 1.0), 0.0).separate(domain), unknown);
    assert_eq!(HalfSpace::new(Vector2::new(1.0, 1.0), f64::INFINITY).separate(domain), unknown);
}

#[test]
fn empty_sets_and_empty_boxes() {
    let domain = IntervalBox::from([over(0.0, 1.0), over(2.0, 3.0)]);
    let nothing = Separation { inner: domain, outer: IntervalBox::EMPTY };
    assert_eq!(Ring::new(Vector2::zeros(), Interval::EMPTY).separate(domain), nothing);
    assert_eq!(Ring::new(Vector2::zeros(), over(-2.0, -1.0)).separate(domain), nothing);
    assert_eq!(Ring::disc(Vector2::zeros(), -1.0).separate(domain), nothing);
    assert_eq!(InBox::new(IntervalBox::EMPTY).separate(domain), nothing);
    assert_eq!(union_of::<Ring<2>, _>([]).separate(domain), nothing);
    let everything = Separation { inner: IntervalBox::EMPTY, outer: domain };
    assert_eq!(intersection_of::<Ring<2>, _>([]).separate(domain), everything);
    assert_eq!(Ring::new(Vector2::zeros(), Interval::ENTIRE).separate(domain), everything);
    let square = Polygon::new(vec![
        Vector2::new(0.0, 0.0),
        Vector2::new(4.0, 0.0),
        Vector2::new(4.0, 4.0),
        Vector2::new(0.0, 4.0),
    ])
    .unwrap();
    assert_eq!(
        square.separate(IntervalBox::from([over(1.0, 2.0), over(1.0, 3.0)])).inner,
        IntervalBox::EMPTY
    );
    let gone = Separation { inner: IntervalBox::EMPTY, outer: IntervalBox::EMPTY };
    assert_eq!(square.separate(IntervalBox::EMPTY), gone);
    assert_eq!(Ring::disc(Vector2::zeros(), 1.0).separate(IntervalBox::EMPTY), gone);
    assert_eq!(HalfSpace::new(Vector2::new(1.0, 0.0), 0.0).separate(IntervalBox::EMPTY), gone);
    assert_eq!(InBox::new(domain).separate(IntervalBox::EMPTY), gone);
}

#[test]
fn unbounded_boxes_are_cut_to_the_set() {
    let ring = Ring::new(Vector2::new(1.0, 0.0), over(3.0, 5.0));
    assert_eq!(ring.outer(IntervalBox::ENTIRE), IntervalBox::from([over(-4.0, 6.0), over(-5.0, 5.0)]));
    assert_eq!(ring.inner(IntervalBox::ENTIRE), IntervalBox::ENTIRE);
    let right = IntervalBox::from([over(5.0, f64::INFINITY), over(0.0, 0.0)]);
    assert_eq!(ring.separate(right).outer, IntervalBox::from([over(5.0, 6.0), Interval::ZERO]));
    assert_eq!(ring.separate(right).inner, IntervalBox::from([over(6.0, f64::INFINITY), Interval::ZERO]));
}

#[test]
fn polygons_need_three_finite_corners() {
    assert_eq!(Polygon::new(vec![Vector2::zeros(); 2]), Err(PolygonError::TooFewCorners { corners: 2 }));
    let corners = vec![Vector2::zeros(), Vector2::new(1.0, f64::INFINITY), Vector2::zeros()];
    assert!(matches!(Polygon::new(corners), Err(PolygonError::NotFinite { index: 1, .. })));
}
