//! Polar coordinates: nothing lost, and each bound that is left belongs to a solution.

use super::*;
use crate::strategies::interval_with_members;
use proptest::prelude::*;
use pxfm::{f_atan2, f_sincos};

fn over(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap()
}

/// An interval around `truth`, thin, everyday or large, with the truth at a random place; sometimes without a bound.
fn around(truth: f64, (width, share, open): (f64, f64, u8)) -> Interval {
    let lower = if open == 1 { f64::NEG_INFINITY } else { truth - share * width };
    let upper = if open == 2 { f64::INFINITY } else { truth + (1.0 - share) * width };
    over(lower, upper)
}

fn places() -> impl Strategy<Value = [(f64, f64, u8); 4]> {
    let width = prop_oneof![Just(0.0), 0.0..1e-6_f64, 0.0..1.0_f64, 0.0..30.0_f64];
    let open = prop_oneof![20 => Just(0_u8), 1 => Just(1), 1 => Just(2)];
    prop::array::uniform4((width, prop_oneof![Just(0.0), Just(1.0), 0.0..1.0_f64], open))
}

/// Some solution of the box that has one coordinate fixed by `face`, found on a fine grid of the remaining freedom, must
/// exist within `tolerance`.
fn slack(sides: [Interval; 4], range: f64, bearing: f64) -> f64 {
    let (sine, cosine) = f_sincos(bearing);
    let outside = |side: Interval, x: f64| (side.lower() - x).max(x - side.upper()).max(0.0);
    outside(sides[0], range * cosine).max(outside(sides[1], range * sine)).max(outside(sides[2], range))
}

/// For one bearing, how far the nearest range is from satisfying the other three intervals.
fn best_slack_at_bearing(sides: [Interval; 4], bearing: f64) -> f64 {
    let (sine, cosine) = f_sincos(bearing);
    let mut possible = sides[2] & Interval::NON_NEGATIVE;
    let mut candidates = vec![possible.lower().max(0.0), possible.upper()];
    for (side, slope) in [(sides[0], cosine), (sides[1], sine)] {
        for bound in [side.lower(), side.upper()] {
            candidates.push(bound / slope);
        }
    }
    possible = possible.inflate(1e-12);
    candidates
        .into_iter()
        .filter(|r| r.is_finite())
        .map(|r| r.clamp(possible.lower().max(0.0), possible.upper().min(1e9)))
        .map(|r| slack(sides, r, bearing))
        .fold(f64::INFINITY, f64::min)
}

/// Whether `x` can be `value`, the other three being as they were: `y` runs over a grid and the points that matter.
fn point_slack(sides: [Interval; 4], x: f64, y: f64) -> f64 {
    let outside = |side: Interval, x: f64| (side.lower() - x).max(x - side.upper()).max(0.0);
    let range = (x * x + y * y).sqrt();
    let lengths = outside(sides[0], x).max(outside(sides[1], y)).max(outside(sides[2], range));
    if range < 1e-9 {
        return lengths;
    }
    let bearing = f_atan2(y, x);
    let turn = 2.0 * std::f64::consts::PI;
    let first = ((sides[3].lower() - bearing) / turn).floor();
    let off = (0..4)
        .map(|k| outside(sides[3], bearing + (first + f64::from(k)) * turn))
        .fold(f64::INFINITY, f64::min);
    lengths.max(off * range)
}

/// The candidates for the free coordinate when the other is `fixed`: where the limits cross the line.
fn crossings(sides: [Interval; 4], fixed: f64, free: Interval, fixed_is_x: bool) -> Vec<f64> {
    let mut candidates = vec![free.lower(), free.upper(), 0.0];
    for r in [sides[2].lower(), sides[2].upper()] {
        let other = (r * r - fixed * fixed).max(0.0).sqrt();
        candidates.extend([other, -other]);
    }
    for angle in [sides[3].lower(), sides[3].upper()] {
        let (sine, cosine) = f_sincos(angle);
        candidates.push(if fixed_is_x { fixed * sine / cosine } else { fixed * cosine / sine });
    }
    candidates.retain(|c| c.is_finite());
    candidates.iter().map(|c| c.clamp(free.lower(), free.upper())).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6000))]

    #[test]
    fn no_solution_is_lost(range in prop_oneof![Just(0.0), 0.0..1e-3_f64, 0.0..50.0_f64, 0.0..1e12_f64], bearing in prop_oneof![-3.2..3.2_f64, -40.0..40.0_f64, -1e6..1e6_f64, -1e18..1e18_f64], places in places()) {
        // Sine and cosine are known to rounding: widen the box by it.
        let (sine, cosine) = Interval::spanning(bearing, bearing).sin_cos();
        let length = Interval::spanning(range, range);
        let truth = [cosine * length, sine * length, length, Interval::spanning(bearing, bearing)];
        let sides: [Interval; 4] = std::array::from_fn(|i| truth[i] | around(truth[i].mid(), places[i]));
        let before = IntervalBox::from(sides);
        let after = Polar.contract(before);
        prop_assert!(after.is_subset_of(&before) && !after.is_empty());
        for axis in 0..4 {
            prop_assert!(!(after[axis] & truth[axis]).is_empty(), "axis {}: {} -> {}", axis, before, after);
        }
        prop_assert!(after[2].contains(range) && after[3].contains(bearing), "{} -> {}", before, after);
    }

    #[test]
    fn each_bound_belongs_to_a_solution(range in 0.0..20.0_f64, bearing in -7.0..14.0_f64, places in places()) {
        let (sine, cosine) = f_sincos(bearing);
        let truth = [cosine * range, sine * range, range, bearing];
        let sides: [Interval; 4] = std::array::from_fn(|i| around(truth[i], places[i]).inflate(1e-9));
        let bounded = sides.map(|side| side & over(-100.0, 100.0));
        let after = Polar.contract(IntervalBox::from(bounded));
        prop_assert!(!after.is_empty());
        let tolerance = 1e-8;
        for bound in [after[3].lower(), after[3].upper()] {
            prop_assert!(best_slack_at_bearing(bounded, bound) < tolerance, "bearing {} of {} -> {}", bound, IntervalBox::from(bounded), after);
        }
        for x in [after[0].lower(), after[0].upper()] {
            let best = crossings(bounded, x, bounded[1], true).into_iter().map(|y| point_slack(bounded, x, y)).fold(f64::INFINITY, f64::min);
            prop_assert!(best < tolerance, "x = {} of {} -> {}: {}", x, IntervalBox::from(bounded), after, best);
        }
        for y in [after[1].lower(), after[1].upper()] {
            let best = crossings(bounded, y, bounded[0], false).into_iter().map(|x| point_slack(bounded, x, y)).fold(f64::INFINITY, f64::min);
            prop_assert!(best < tolerance, "y = {} of {} -> {}: {}", y, IntervalBox::from(bounded), after, best);
        }
        for r in [after[2].lower(), after[2].upper()] {
            // On a circle the limits are crossed at the sides of the rectangle and at the rays.
            let mut points = vec![(r, 0.0), (-r, 0.0), (0.0, r), (0.0, -r)];
            for x in [bounded[0].lower(), bounded[0].upper()] {
                let y = (r * r - x * x).max(0.0).sqrt();
                points.extend([(x, y), (x, -y)]);
            }
            for y in [bounded[1].lower(), bounded[1].upper()] {
                let x = (r * r - y * y).max(0.0).sqrt();
                points.extend([(x, y), (-x, y)]);
            }
            for angle in [bounded[3].lower(), bounded[3].upper()] {
                let (sine, cosine) = f_sincos(angle);
                points.push((r * cosine, r * sine));
            }
            let best = points.into_iter().map(|(x, y)| point_slack(bounded, x, y).max(((x * x + y * y).sqrt() - r).abs())).fold(f64::INFINITY, f64::min);
            prop_assert!(best < tolerance, "range {} of {} -> {}: {}", r, IntervalBox::from(bounded), after, best);
        }
    }

    #[test]
    fn what_is_empty_has_no_solution(x in (-9.0..9.0_f64, 0.0..6.0_f64), y in (-9.0..9.0_f64, 0.0..6.0_f64), r in (0.0..12.0_f64, 0.0..3.0_f64), b in (-8.0..8.0_f64, 0.0..2.0_f64)) {
        let before = IntervalBox::from([x, y, r, b].map(|(lower, width)| over(lower, lower + width)));
        let after = Polar.contract(before);
        let again = Polar.contract(after);
        prop_assert!(again.is_subset_of(&after));
        // Solutions on a grid of range and bearing.
        for i in 0..=8 {
            for j in 0..=8 {
                let (range, bearing) = (r.0 + r.1 * f64::from(i) / 8.0, b.0 + b.1 * f64::from(j) / 8.0);
                let (sine, cosine) = f_sincos(bearing);
                let solution = [range * cosine, range * sine];
                if before[0].contains(solution[0]) && before[1].contains(solution[1]) {
                    prop_assert!(after[0].inflate(1e-12).contains(solution[0]) && after[1].inflate(1e-12).contains(solution[1]));
                    prop_assert!(after[2].inflate(1e-12).contains(range) && after[3].inflate(1e-12).contains(bearing));
                }
            }
        }
        // What is minimal stays, but for rounding.
        for axis in 0..4 {
            if !again.is_empty() {
                prop_assert!(after[axis].is_subset_of(again[axis].inflate(1e-11)), "{} -> {} -> {}", before, after, again);
            }
        }
    }

    #[test]
    fn smaller_boxes_give_smaller_results(sides in prop::array::uniform4((-9.0..9.0_f64, 0.0..9.0_f64)), axis in 0_usize..4, cut in 0.0..1.0_f64) {
        let large = IntervalBox::from(sides.map(|(lower, width)| over(lower, lower + width)));
        let mut small = large;
        small[axis] = over(large[axis].lower(), large[axis].lower() + cut * sides[axis].1) & large[axis];
        // Inverse functions are rounded to one side by one place, which may be monotonic only to that place.
        prop_assert!(Polar.contract(small).is_subset_of(&Polar.contract(large).inflate(1e-13)));
    }

    #[test]
    fn boxes_of_any_size_are_contracted(x in interval_with_members(), y in interval_with_members(), r in interval_with_members(), b in interval_with_members()) {
        let before = IntervalBox::from([x.0, y.0, r.0, b.0]);
        prop_assert!(Polar.contract(before).is_subset_of(&before));
    }
}

#[test]
fn the_origin_has_every_bearing() {
    let (origin, bearing) = (Interval::ZERO, over(1.0, 2.0));
    let domain = IntervalBox::from([origin, origin, over(0.0, 3.0), bearing]);
    let contracted = Polar.contract(domain);
    assert_eq!(contracted, IntervalBox::from([origin, origin, origin, bearing]));
    let corner = IntervalBox::from([over(-3.0, 0.0), over(-3.0, 0.0), over(0.0, 3.0), bearing]);
    assert_eq!(Polar.contract(corner), contracted);
    assert!(Polar.contract(IntervalBox::from([origin, origin, Interval::ONE, bearing])).is_empty());
}

#[test]
fn full_circles_and_many_turns() {
    let circle = IntervalBox::from([Interval::ENTIRE, Interval::ENTIRE, over(2.0, 3.0), Interval::ENTIRE]);
    assert_eq!(
        Polar.contract(circle),
        IntervalBox::from([over(-3.0, 3.0), over(-3.0, 3.0), over(2.0, 3.0), Interval::ENTIRE])
    );
    // Only the bearing π/2, in each of many turns.
    let up = |bearing| IntervalBox::from([Interval::ZERO, over(1.0, 2.0), over(0.0, 9.0), bearing]);
    let turned = Polar.contract(up(over(0.0, 100.0)))[3];
    let quarter = Interval::HALF_PI.lower();
    assert!(
        (turned.lower() - quarter).abs() < 1e-15 && (turned.upper() - 61.0 * quarter).abs() < 1e-13,
        "{turned:?}"
    );
    let half_known = Polar.contract(up(Interval::NON_NEGATIVE))[3];
    assert!((half_known.lower() - quarter).abs() < 1e-15 && half_known.upper() == f64::INFINITY);
    assert_eq!(Polar.contract(up(over(1e200, 1e201)))[3], over(1e200, 1e201));
    assert!(Polar.contract(up(over(1e200, 1e200))).is_empty());
}

#[test]
fn nothing_in_nothing_out() {
    let domain = IntervalBox::from([Interval::ONE, Interval::ONE, over(-3.0, -1.0), Interval::ENTIRE]);
    assert!(Polar.contract(domain).is_empty());
    assert!(Polar.contract(IntervalBox::EMPTY).is_empty());
}
