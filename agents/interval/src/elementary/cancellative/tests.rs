//! A sum is undone, and nothing is claimed where there was no sum.

use super::*;
use crate::strategies::{SplitMix64, exact};

#[test]
fn the_smallest_set_whose_sum_holds_everything() {
    let mut random = SplitMix64(50);
    let mut undone = 0;
    for _ in 0..50_000 {
        let term = random.interval();
        let sum = if random.next().is_multiple_of(2) { random.interval() } else { term + random.interval() };
        let before = sum.cancel_minus(term);
        assert_eq!(sum.cancel_plus(-term), before);
        if !sum.is_bounded() {
            assert_eq!(before, Interval::ENTIRE);
            continue;
        }
        let low = exact(sum.lower()) - exact(term.lower());
        let high = exact(sum.upper()) - exact(term.upper());
        if low > high {
            assert_eq!(before, Interval::ENTIRE, "{sum:?} without {term:?}");
            continue;
        }
        undone += 1;
        let (lower, upper) = (before.lower(), before.upper());
        assert!(
            lower == f64::NEG_INFINITY
                || exact(lower) <= low && (lower == f64::MAX || exact(lower.next_up()) > low)
        );
        assert!(
            upper == f64::INFINITY
                || exact(upper) >= high && (upper == f64::MIN || exact(upper.next_down()) < high)
        );
    }
    assert!(undone > 10_000);
}

#[test]
fn special_sets() {
    let unbounded = Interval::NON_NEGATIVE;
    assert_eq!(Interval::EMPTY.cancel_minus(Interval::EMPTY), Interval::EMPTY);
    assert_eq!(Interval::EMPTY.cancel_minus(Interval::ONE), Interval::EMPTY);
    assert_eq!(Interval::EMPTY.cancel_minus(unbounded), Interval::ENTIRE);
    assert_eq!(Interval::ONE.cancel_minus(Interval::EMPTY), Interval::ENTIRE);
    assert_eq!(unbounded.cancel_minus(unbounded), Interval::ENTIRE);
    // Both differences overflow, and the widths differ by the smallest number there is.
    let (huge, tiny) = (f64::MAX, f64::from_bits(1));
    let narrower = Interval::new(tiny, huge).unwrap();
    assert_eq!(narrower.cancel_minus(Interval::new(0.0, huge).unwrap()), Interval::ENTIRE);
    assert_eq!(Interval::new(0.0, huge).unwrap().cancel_minus(narrower), Interval::new(-tiny, 0.0).unwrap());
}
