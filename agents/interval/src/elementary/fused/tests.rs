//! One rounding, judged by exact arithmetic on whole numbers.

use super::*;
use crate::strategies::{SplitMix64, UNIT_SHIFT, exact};

/// Numbers whose product meets the third one: of like size, cancelling, or far apart.
fn arguments(random: &mut SplitMix64) -> (f64, f64, f64) {
    let (a, b) = match random.next() % 4 {
        0 => (random.any_size(), random.any_size()),
        1 => (random.subnormal(), random.number()),
        2 => (random.between(-2.0, 2.0) * 1e-160, random.between(-2.0, 2.0) * 1e-155),
        _ => (random.number(), random.number()),
    };
    let c = match random.next() % 5 {
        0 => random.number(),
        1 => random.subnormal(),
        2 => -(a * b),
        3 => -(a * b) * random.between(0.999, 1.001),
        _ => f64::from_bits((a * b).to_bits() ^ (random.next() % 4)) * 2.0,
    };
    (a, b, if c.is_finite() { c } else { f64::MAX.copysign(c) })
}

#[test]
fn bounds_are_the_tightest_at_every_size() {
    let mut random = SplitMix64(60);
    for _ in 0..100_000 {
        let (a, b, c) = arguments(&mut random);
        let result = exact(a) * exact(b) + (exact(c) << UNIT_SHIFT);
        let order = |x: f64| match x {
            f64::INFINITY => std::cmp::Ordering::Greater,
            f64::NEG_INFINITY => std::cmp::Ordering::Less,
            finite => (exact(finite) << UNIT_SHIFT).cmp(&result),
        };
        let (down, up) = (mul_add_down(a, b, c), mul_add_up(a, b, c));
        assert!(order(down).is_le() && order(up).is_ge(), "{a:e} * {b:e} + {c:e} is lost: {down:e} {up:e}");
        assert!(order(down).is_eq() || order(down.next_up()).is_gt(), "{a:e} * {b:e} + {c:e} above {down:e}");
        assert!(order(up).is_eq() || order(up.next_down()).is_lt(), "{a:e} * {b:e} + {c:e} below {up:e}");
    }
}

#[test]
fn corners_hold_the_extremes() {
    let mut random = SplitMix64(61);
    for _ in 0..100_000 {
        let (x, y, z) = (random.interval(), random.interval(), random.interval());
        let fused = x.mul_add(y, z);
        assert!(fused.is_subset_of(x * y + z), "{x:?} * {y:?} + {z:?}");
        let corners = [x.lower(), x.upper()].map(|a| [y.lower(), y.upper()].map(|b| (a, b)));
        let corners = corners.as_flattened();
        let lowest =
            corners.iter().map(|&(a, b)| mul_add_down(a, b, z.lower())).fold(f64::INFINITY, f64::min);
        let highest =
            corners.iter().map(|&(a, b)| mul_add_up(a, b, z.upper())).fold(f64::NEG_INFINITY, f64::max);
        assert_eq!((fused.lower(), fused.upper()), (lowest, highest), "{x:?} * {y:?} + {z:?}");
    }
}

#[test]
fn missing_bounds_and_the_empty_set() {
    let (empty, entire, ray) = (Interval::EMPTY, Interval::ENTIRE, Interval::NON_NEGATIVE);
    assert!(empty.mul_add(entire, entire).is_empty());
    assert!(entire.mul_add(empty, entire).is_empty());
    assert!(entire.mul_add(entire, empty).is_empty());
    assert_eq!(Interval::ZERO.mul_add(entire, Interval::ONE), Interval::ONE);
    assert_eq!(ray.mul_add(ray, Interval::ONE), Interval::new(1.0, f64::INFINITY).unwrap());
    assert_eq!((-ray).mul_add(ray, ray), entire);
    let huge = Interval::point(f64::MAX).unwrap();
    assert_eq!(huge.mul_add(huge, -huge), Interval::new(f64::MAX, f64::INFINITY).unwrap());
    assert_eq!(huge.mul_add(Interval::point(2.0).unwrap(), -huge), huge);
}
