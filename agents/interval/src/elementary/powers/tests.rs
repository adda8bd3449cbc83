//! Real powers of intervals: corners and members.

use super::*;
use crate::strategies::SplitMix64;

#[test]
fn members_stay() {
    let mut random = SplitMix64(80);
    for _ in 0..100_000 {
        let (xs, ys) = (random.interval(), random.interval());
        let powers = xs.powf(ys);
        for x in [xs.lower(), xs.mid(), xs.upper()] {
            for y in [ys.lower(), ys.mid(), ys.upper()] {
                if x > 0.0 && x.is_finite() && y.is_finite() {
                    let nearest = core_math::pow(x, y);
                    let held = powers.lower() <= nearest && nearest <= powers.upper();
                    assert!(held, "{x:e}^{y:e} is not in {powers:?} = {xs:?}^{ys:?}");
                }
            }
        }
    }
}

#[test]
fn corners() {
    let over = |lower, upper| Interval::new(lower, upper).unwrap();
    let (all, positive) = (Interval::ENTIRE, Interval::NON_NEGATIVE);
    assert_eq!(over(-1.0, 4.0).powf(over(0.5, 0.5)), over(0.0, 2.0));
    assert_eq!(over(0.5, 2.0).powf(over(-2.0, 3.0)), over(0.125, 8.0));
    assert_eq!(over(0.0, 2.0).powf(over(-1.0, 1.0)), positive);
    assert_eq!(over(0.0, 2.0).powf(Interval::ZERO), Interval::ONE);
    assert_eq!(over(0.25, 4.0).powf(over(-0.5, -0.5)), over(0.5, 2.0));
    assert_eq!(Interval::ZERO.powf(over(-1.0, 1.0)), Interval::ZERO);
    assert!(Interval::ZERO.powf(over(-1.0, 0.0)).is_empty());
    assert!(over(-2.0, -1.0).powf(all).is_empty());
    assert!(Interval::EMPTY.powf(all).is_empty() && all.powf(Interval::EMPTY).is_empty());
    assert_eq!(all.powf(all), positive);
    assert_eq!(Interval::ONE.powf(all), Interval::ONE);
    assert_eq!(over(2.0, f64::INFINITY).powf(positive), over(1.0, f64::INFINITY));
    assert_eq!(over(2.0, f64::INFINITY).powf(-positive), over(0.0, 1.0));
    assert_eq!(over(0.0, 0.5).powf(over(1.0, f64::INFINITY)), over(0.0, 0.5));
}
