//! The pavings that the seeds print, with their numbers. The examples of this crate draw the same ones.

use nalgebra::Vector2;
use shoal_interval::contractor::{Contractor, Sector, from_fn};
use shoal_interval::figure::Figure;
use shoal_interval::fuzzy::{AlphaCut, Grade, Score, ScoreFunction};
use shoal_interval::paving::{
    Options, Paving, Stopped, csivia, from_test_fn, gomne, pave, rsivia, set_inversion, sivia,
};
use shoal_interval::separator::{
    InBox, Ring, Separator, from_contractors, intersection_of, q_intersection, union_of,
};
use shoal_interval::{Interval, IntervalBox, Membership};
use std::f64::consts::PI;

fn over(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap()
}

fn ring(x: f64, y: f64, lower: f64, upper: f64) -> Ring<2> {
    Ring::new(Vector2::new(x, y), over(lower, upper))
}

fn initial() -> IntervalBox<2> {
    IntervalBox::from([over(-10.0, 10.0); 2])
}

fn three_beacons() -> [Ring<2>; 3] {
    [ring(3.0, 3.0, 3.0, 4.0), ring(-3.0, -1.0, 5.0, 6.0), ring(-2.0, 2.0, 4.0, 5.0)]
}

/// Fails unless the paving is complete and encloses a set of this area, with no more than this play.
fn encloses(paving: &Paving<2>, area: f64, play: f64) {
    let (inner, outer) = (paving.inner_volume(), paving.outer_volume());
    assert_eq!(paving.stopped(), Stopped::Complete);
    assert!(inner.upper() <= area && area <= outer.lower(), "{area} is not between {inner} and {outer}");
    assert!(outer.upper() - inner.lower() <= play, "{inner} and {outer} are too far apart");
}

/// Seed 001, figures 2.9 and 2.10 (a): one beacon.
#[test]
fn one_beacon() {
    let [beacon, ..] = three_beacons();
    let options = Options::new(0.1);
    let classical = sivia(&beacon, initial(), &options).unwrap();
    let contractor = from_fn(move |domain| beacon.outer(domain));
    let contracted = csivia(&contractor, &beacon, initial(), &options).unwrap();
    let separated = pave(&beacon, initial(), &options).unwrap();
    for (paving, play) in [(&classical, 4.5), (&contracted, 2.6), (&separated, 0.9)] {
        encloses(paving, 7.0 * PI, play);
    }
    assert!(contracted.statistics().bisections < classical.statistics().bisections);
    assert!(2 * separated.statistics().bisections < classical.statistics().bisections);
}

/// Seed 001, figure 2.10 (b) and (c); the bracket is the one that this crate promises.
#[test]
fn two_and_three_beacons() {
    let beacons = three_beacons();
    let options = Options::new(0.05);
    let two = pave(&intersection_of(&beacons[..2]), initial(), &options).unwrap();
    assert_eq!(two.parts(), 2, "the mirror image at the line through both beacons is a solution as well");
    let three = pave(&intersection_of(beacons), initial(), &options).unwrap();
    encloses(&three, 0.422_833_2, 0.0318);
    assert!(three.inner_volume().lower() >= 0.4061 && three.outer_volume().upper() <= 0.4379);
    assert!(three.statistics().bisections <= 170);
    assert_eq!(three.parts(), 1);
}

/// Seed 001, figures 2.11 and 2.12, table 2.5.
#[test]
fn a_fourth_beacon_right_or_wrong() {
    let [a, b, c] = three_beacons();
    let options = Options::new(0.05);
    let good = pave(&intersection_of([a, b, c, ring(4.0, -4.0, 3.0, 4.0)]), initial(), &options).unwrap();
    assert!(good.proves_not_empty() && good.outer_volume().upper() < 0.13);
    let rings = [a, b, c, ring(4.0, -4.0, 1.0, 2.0)];
    assert!(pave(&intersection_of(rings), initial(), &options).unwrap().proves_empty());

    let relaxed = |outliers| pave(&q_intersection(rings, outliers), initial(), &options).unwrap();
    encloses(&relaxed(1), 0.422_833_2, 0.0340);
    let pairs =
        [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)].map(|(i, j)| rings[i].intersection(rings[j]));
    for (outliers, same) in [
        (2, pave(&union_of(pairs), initial(), &options).unwrap()),
        (3, pave(&union_of(rings), initial(), &options).unwrap()),
    ] {
        let paving = relaxed(outliers);
        assert!(paving.inner_volume().upper() <= same.outer_volume().lower());
        assert!(same.inner_volume().upper() <= paving.outer_volume().lower());
        let tested = rsivia(&rings, outliers, initial(), &Options::new(0.4)).unwrap();
        assert!(tested.inner_volume().upper() <= paving.outer_volume().lower());
        assert!(paving.inner_volume().upper() <= tested.outer_volume().lower());
    }

    let found = gomne(&rings, 0, initial(), &options).unwrap();
    assert_eq!((found.at_least, found.enough), (1, 1));
    assert_eq!(found.paving, relaxed(1));
}

/// Seed 001, figures 3.6 and 3.7.
#[test]
fn bearings_only() {
    let seen = [
        (Vector2::new(-3.0, -3.0), over(0.2, 0.3)),
        (Vector2::new(-4.0, 4.0), over(5.55, 5.65)),
        (Vector2::new(3.0, 1.0), over(4.4, 4.5)),
    ];
    let separators = seen.map(|(beacon, bearing)| {
        let sector = Sector::new(IntervalBox::centred(&beacon, 0.0), bearing);
        from_contractors(sector.complement(), sector)
    });
    let relaxed =
        |outliers| pave(&q_intersection(separators, outliers), initial(), &Options::new(0.05)).unwrap();
    // The area of a polygon, in double precision: the sector's borders are straight.
    encloses(&relaxed(0), common_area(&seen), 0.0130);
    assert_eq!(relaxed(0).membership(&Vector2::new(2.35, -1.5)), Membership::Inside);
    let (one, two) = (relaxed(1), relaxed(2));
    assert!(relaxed(0).outer_volume().upper() < one.inner_volume().lower());
    assert!(one.outer_volume().upper() < two.inner_volume().lower());
    assert_eq!(one.membership(&Vector2::new(2.35, -1.5)), Membership::Inside);
    assert_eq!(two.membership(&Vector2::new(7.0, -0.4)), Membership::Inside);
}

/// The area in which all bearings are possible: a square cut by half-planes, and then the shoelace formula.
fn common_area(seen: &[(Vector2<f64>, Interval)]) -> f64 {
    let mut corners = [(-10.0, -10.0), (10.0, -10.0), (10.0, 10.0), (-10.0, 10.0)]
        .map(|(x, y)| Vector2::new(x, y))
        .to_vec();
    for (beacon, bearing) in seen {
        for (side, sign) in [(bearing.lower(), 1.0), (bearing.upper(), -1.0)] {
            let (sine, cosine) = pxfm::f_sincos(side);
            let height = |at: &Vector2<f64>| sign * (cosine * (at.y - beacon.y) - sine * (at.x - beacon.x));
            let mut kept = Vec::new();
            for (from, to) in corners.iter().zip(corners.iter().cycle().skip(1)) {
                let (start, end) = (height(from), height(to));
                if start >= 0.0 {
                    kept.push(*from);
                }
                if (start >= 0.0) != (end >= 0.0) {
                    kept.push(from + (to - from) * (start / (start - end)));
                }
            }
            corners = kept;
        }
    }
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    0.5 * edges.map(|(from, to)| from.x * to.y - from.y * to.x).sum::<f64>()
}

/// Seed 002, section 3.5.4: 45 iterations, 5 with an optimal contractor.
///
/// The precision lies between the width 1/16 of the boxes that are printed and that of their parents. An iteration is a
/// box that is looked at. The five are reproduced when the interval is bisected, at 3, before it is first contracted; contracted first, to
/// [0, 2π], it is bisected at π, which is then in both halves: seven.
#[test]
fn zeros_of_the_sine() {
    let domain = IntervalBox::from([over(-1.0, 7.0)]);
    let options = Options::new(0.1);
    let sine = set_inversion(|x: &IntervalBox<1>| x.map(Interval::sin), IntervalBox::from([Interval::ZERO]));
    let classical = sivia(&sine, domain, &options).unwrap();
    assert_eq!(classical.statistics().boxes, 45);
    let printed = [over(-0.0625, 0.0), over(0.0, 0.0625), over(3.125, 3.1875), over(6.25, 6.3125)];
    assert_eq!(classical.boundary(), printed.map(|side| IntervalBox::from([side])));

    let contractor = from_fn(|x: IntervalBox<1>| IntervalBox::from([Interval::ZERO.sin_rev(x[0])]));
    let alone = contractor.contract(domain)[0];
    assert_eq!(alone, over(0.0, (2.0 * PI).next_up()));
    let thin = from_test_fn(|_: &IntervalBox<1>| Membership::Undecided);
    let contracted = csivia(&contractor, &thin, domain, &options).unwrap();
    assert_eq!((contracted.statistics().boxes, contracted.parts()), (7, 3));
    let (low, high) = domain.bisect().unwrap();
    let halves = [low, high].map(|half| csivia(&contractor, &thin, half, &options).unwrap());
    assert_eq!(1 + halves[0].statistics().boxes + halves[1].statistics().boxes, 5);
    let zeros: Vec<Interval> = halves.iter().flat_map(|half| half.boundary()).map(|part| part[0]).collect();
    assert_eq!(zeros, [Interval::ZERO, Interval::PI, Interval::PI * 2.0]);
}

/// Seed 000, examples 2.3.2 and 2.4.3; see the example `fuzzy_rings` for the landmarks.
#[test]
fn four_rings() {
    let rings = [
        ring(-1.0, 3.0, 2.2, 4.2),
        ring(-5.0, -4.0, 5.4, 7.4),
        ring(8.0, -1.0, 7.1, 9.1),
        ring(2.0, -6.0, 5.3, 7.3),
    ];
    let view = IntervalBox::from([over(-14.0, 22.0), over(-16.0, 14.0)]);
    let options = Options::new(0.3);
    let robot = Vector2::new(0.0, 0.0);
    let all = pave(&intersection_of(rings), view, &options).unwrap();
    assert_eq!(all.membership(&robot), Membership::Inside);
    let with_outlier = [rings[0], rings[1], ring(8.0, -1.0, 11.1, 13.1), rings[3]];
    assert!(pave(&intersection_of(with_outlier), view, &options).unwrap().proves_empty());
    let relaxed = pave(&q_intersection(with_outlier, 1), view, &options).unwrap();
    assert_eq!(relaxed.membership(&robot), Membership::Inside);

    // The alpha-cuts are nested, and the one at 1/2 is the union of intersections of table 5.1, row (iii).
    let cut = |numerator, denominator| {
        let score = ScoreFunction::weighted_mean(&[1, 2, 1, 1]).unwrap();
        let cut = AlphaCut::new(score, Grade::new(numerator, denominator).unwrap(), rings.to_vec()).unwrap();
        pave(&cut, view, &options).unwrap()
    };
    let cuts = [1, 2, 3, 4, 5].map(|fifths| cut(fifths, 5));
    assert!(
        cuts.is_sorted_by(
            |larger, smaller| larger.inner_volume().lower() > smaller.outer_volume().upper() - 1.5
        )
    );
    assert_eq!(cut(1, 2), cuts[2]);
    let [z1, z2, z3, z4] = rings;
    let normal_form = z1
        .intersection(z2)
        .union(z2.intersection(z3))
        .union(z2.intersection(z4))
        .union(z1.intersection(z3).intersection(z4));
    let same = pave(&normal_form, view, &options).unwrap();
    assert!(cuts[2].inner_volume().upper() <= same.outer_volume().lower());
    assert!(same.inner_volume().upper() <= cuts[2].outer_volume().lower());
    for x in -14..22 {
        for y in -16..14 {
            let point = Vector2::new(f64::from(x) + 0.3, f64::from(y) + 0.6);
            let answers = [cuts[2].membership(&point), same.membership(&point)];
            assert!(!(answers.contains(&Membership::Inside) && answers.contains(&Membership::Outside)));
        }
    }
}

/// Seed 000, table 5.1: five score functions and what their cuts are.
#[test]
#[expect(clippy::nonminimal_bool, reason = "the disjunctive normal form stands as the seed prints it")]
fn cuts_are_set_expressions() {
    type Row = (Score, Grade, fn([bool; 4]) -> bool);
    let half = Grade::new(1, 2).unwrap();
    let granules =
        |granules: &[usize]| granules.iter().map(|&granule| (1, Score::granule(granule))).collect::<Vec<_>>();
    let three_quarters = Grade::new(3, 4).unwrap();
    let rows: [Row; 5] = [
        (Score::mean(granules(&[0, 1])), Grade::ONE, |z| z[0] && z[1]),
        (Score::mean(granules(&[0, 1])), half, |z| z[0] || z[1]),
        (
            Score::mean(
                [1, 2, 1, 1].into_iter().zip(0..4).map(|(weight, granule)| (weight, Score::granule(granule))),
            ),
            half,
            |z| (z[0] && z[1]) || (z[1] && z[2]) || (z[1] && z[3]) || (z[0] && z[2] && z[3]),
        ),
        (Score::mean(granules(&[0, 1, 2, 3])), three_quarters, |z| z.into_iter().filter(|&z| z).count() >= 3),
        (Score::least([Score::granule(0), Score::mean(granules(&[0, 1, 2, 3]))]), three_quarters, |z| {
            z[0] && z.into_iter().filter(|&z| z).count() >= 3
        }),
    ];
    let rings = [
        ring(-1.0, 3.0, 2.2, 4.2),
        ring(-5.0, -4.0, 5.4, 7.4),
        ring(8.0, -1.0, 7.1, 9.1),
        ring(2.0, -6.0, 5.3, 7.3),
    ];
    let is_in = |separator: &dyn Separator<2>, point: &Vector2<f64>| {
        let separation = separator.separate(IntervalBox::centred(point, 0.0));
        match (separation.inner.is_empty(), separation.outer.is_empty()) {
            (true, false) => Some(true),
            (false, true) => Some(false),
            _ => None,
        }
    };
    for (score, grade, expected) in rows {
        let score = ScoreFunction::new(4, score).unwrap();
        let cut = AlphaCut::new(score, grade, rings.to_vec()).unwrap();
        for x in -14..22 {
            for y in -16..14 {
                let point = Vector2::new(f64::from(x) + 0.31, f64::from(y) + 0.62);
                let members = rings.map(|ring| is_in(&ring, &point).unwrap());
                assert_eq!(is_in(&cut, &point), Some(expected(members)), "{point} at {grade}");
            }
        }
    }
}

/// The fixtures' three boxes, now paved: 1-relaxed, they are two rectangles.
#[test]
fn three_boxes_relaxed() {
    let boxes = [
        IntervalBox::from([over(0.0, 4.0), over(0.0, 4.0)]),
        IntervalBox::from([over(2.0, 6.0), over(2.0, 6.0)]),
        IntervalBox::from([over(5.0, 9.0), over(-2.0, 1.0)]),
    ];
    let relaxed = |outliers| {
        pave(&q_intersection(boxes.map(InBox::new), outliers), initial(), &Options::new(0.1)).unwrap()
    };
    assert!(relaxed(0).proves_empty());
    encloses(&relaxed(1), 4.0, 1.0e-9);
    // In the two corners that point inwards nothing can be cut.
    encloses(&relaxed(2), 16.0 + 16.0 + 12.0 - 4.0, 0.02);
    encloses(&relaxed(3), 400.0, 1.0e-9);
}

#[test]
fn figures_are_the_same_every_time() {
    let draw = |threads: usize| {
        let options = Options::new(0.1).with_threads(threads);
        let paving = pave(&union_of(three_beacons()), initial(), &options).unwrap();
        Figure::new(initial()).unwrap().title("union").paving(&paving).axes("x (m)", "y (m)").to_svg()
    };
    assert_eq!(draw(1), draw(3));
}
