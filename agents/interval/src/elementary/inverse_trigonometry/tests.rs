//! Inverse functions where they begin and end.

use super::*;

#[test]
fn ends_and_special_sets() {
    let over = |lower, upper| Interval::new(lower, upper).unwrap();
    let half_pi = Interval::HALF_PI;
    assert_eq!(Interval::ENTIRE.asin(), (-half_pi).hull(half_pi));
    assert_eq!(Interval::ENTIRE.acos(), over(0.0, Interval::PI.upper()));
    assert_eq!(Interval::ENTIRE.atan(), (-half_pi).hull(half_pi));
    assert_eq!(Interval::ONE.acos(), Interval::ZERO);
    assert!(half_pi.is_subset_of(Interval::ONE.asin()));
    assert!(Interval::PI.is_subset_of((-Interval::ONE).acos()));
    assert_eq!(Interval::point(f64::MAX).unwrap().atan().upper(), half_pi.upper());
    for empty in [Interval::EMPTY, over(1.5, 2.0), over(-2.0, -1.5)] {
        assert!(empty.asin().is_empty() && empty.acos().is_empty());
    }
    assert!(Interval::EMPTY.atan().is_empty());
}
