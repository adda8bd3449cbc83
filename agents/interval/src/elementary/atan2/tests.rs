//! The angles of boxes: members stay, and the bounds are the angles of corners.

use super::*;
use crate::strategies::SplitMix64;

fn coordinates(random: &mut SplitMix64) -> Interval {
    match random.next() % 8 {
        0 => Interval::spanning(0.0, random.number()),
        1 => Interval::ZERO,
        2..=4 => Interval::spanning(random.between(-3.0, 3.0), random.between(-3.0, 3.0)),
        _ => random.interval(),
    }
}

#[test]
fn angles_of_boxes_are_those_of_corners() {
    let mut random = SplitMix64(90);
    for _ in 0..100_000 {
        let (y, x) = (coordinates(&mut random), coordinates(&mut random));
        let angles = y.atan2(x);
        let with_zero = |set: Interval| {
            let zero = if set.contains(0.0) { 0.0 } else { set.upper() };
            [set.lower(), zero, set.upper()]
        };
        let (mut first, mut last) = (f64::INFINITY, f64::NEG_INFINITY);
        for y in with_zero(y) {
            for x in with_zero(x) {
                if y != 0.0 || x != 0.0 {
                    let nearest = core_math::atan2(y + 0.0, x + 0.0);
                    assert!(angles.contains(nearest), "{angles:?} without ({x:e}, {y:e})");
                    (first, last) = (first.min(nearest), last.max(nearest));
                }
            }
        }
        if first > last {
            assert!(angles.is_empty());
        } else if y.lower() < 0.0 && y.upper() >= 0.0 && x.lower() < 0.0 {
            assert_eq!(angles, Interval::HALF_TURNS);
        } else {
            let tight =
                angles.lower() >= first.next_down().next_down() && angles.upper() <= last.next_up().next_up();
            assert!(tight, "{angles:?} for {y:?} {x:?}");
        }
    }
}

#[test]
fn axes_and_rays() {
    let over = |lower, upper| Interval::new(lower, upper).unwrap();
    let (zero, one, ray) = (Interval::ZERO, Interval::ONE, Interval::NON_NEGATIVE);
    let half_pi = Interval::HALF_PI;
    assert_eq!(zero.atan2(one), zero);
    assert_eq!(zero.atan2(-one), Interval::PI);
    assert_eq!(one.atan2(zero), half_pi);
    assert_eq!((-one).atan2(zero), -half_pi);
    assert_eq!(zero.atan2(over(-1.0, 1.0)), over(0.0, Interval::PI.upper()));
    assert_eq!(over(-1.0, 1.0).atan2(zero), (-half_pi).hull(half_pi));
    assert_eq!(over(-1.0, 0.0).atan2(ray), over(-half_pi.upper(), 0.0));
    assert_eq!(ray.atan2(ray), over(0.0, half_pi.upper()));
    assert_eq!(one.atan2(Interval::ENTIRE), over(0.0, Interval::PI.upper()));
    assert_eq!(Interval::ENTIRE.atan2(one), (-half_pi).hull(half_pi));
    assert_eq!((-ray).atan2(-one), Interval::HALF_TURNS);
    assert!((-ray - one).atan2(-one).upper() < -1.5);
    assert!(Interval::EMPTY.atan2(one).is_empty() && one.atan2(Interval::EMPTY).is_empty());
}
