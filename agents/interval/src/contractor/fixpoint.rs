//! Repeating a contractor.

use super::Contractor;
use crate::interval::Interval;
use crate::interval_box::IntervalBox;

/// A contractor that is repeated until it brings little; made by [`Contractor::fixpoint`].
///
/// It stops after a pass that took less than `ratio` of its width from every side (0.01: one hundredth), when nothing is
/// left, and in any case after [`Fixpoint::MAX_PASSES`], because some systems converge so slowly that the last bit would
/// take millions of passes. A side without a bound counts as shrunk when either of its bounds moved. A ratio of zero or
/// below, or NaN, goes on until nothing moves at all. Wherever it stops, no solution has been lost.
///
/// ```
/// use shoal_interval::contractor::{Contractor, from_fn};
/// use shoal_interval::{Interval, IntervalBox};
///
/// // x = x / 2 has the one solution 0.
/// let halving = from_fn(|domain: IntervalBox<1>| IntervalBox::from([domain[0] * 0.5]));
/// let domain = IntervalBox::from([Interval::new(-1.0, 1.0)?]);
/// assert_eq!(halving.fixpoint(0.6).contract(domain).width(), 1.0);
/// assert!(halving.fixpoint(0.4).contract(domain).width() < 1e-70);
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fixpoint<C> {
    contractor: C,
    ratio: f64,
}

impl<C> Fixpoint<C> {
    /// The largest number of passes.
    pub const MAX_PASSES: usize = 256;

    pub(super) fn new(contractor: C, ratio: f64) -> Fixpoint<C> {
        Fixpoint { contractor, ratio }
    }
}

impl<const N: usize, C: Contractor<N>> Contractor<N> for Fixpoint<C> {
    fn contract(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        let mut before = domain;
        for _ in 0..Self::MAX_PASSES {
            let after = self.contractor.contract(before);
            if after.is_empty() {
                return IntervalBox::EMPTY;
            }
            if !before.iter().zip(after.iter()).any(|(&old, &new)| shrank(old, new, self.ratio)) {
                return after;
            }
            before = after;
        }
        before
    }
}

/// Whether a side lost at least `ratio` of its width. Neither is empty, and `new` is inside `old`.
fn shrank(old: Interval, new: Interval, ratio: f64) -> bool {
    if old == new {
        return false;
    }
    if !old.is_bounded() || ratio.is_nan() || ratio <= 0.0 {
        return true;
    }
    // Not a comparison of widths: the widths of huge intervals overflow, the lost share does not.
    let width = 0.5 * old.upper() - 0.5 * old.lower();
    let lost = (0.5 * new.lower() - 0.5 * old.lower()) + (0.5 * old.upper() - 0.5 * new.upper());
    lost >= ratio * width
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contractor::from_fn;
    use std::cell::Cell;

    fn over(lower: f64, upper: f64) -> Interval {
        Interval::new(lower, upper).unwrap()
    }

    #[test]
    fn slow_convergence_ends() {
        let passes = Cell::new(0);
        let slow = from_fn(|domain: IntervalBox<1>| {
            passes.set(passes.get() + 1);
            IntervalBox::from([over(domain[0].lower().next_up(), domain[0].upper())])
        });
        let domain = IntervalBox::from([over(0.0, 1.0)]);
        assert!(slow.fixpoint(0.0).contract(domain).is_subset_of(&domain));
        assert_eq!(passes.get(), Fixpoint::<()>::MAX_PASSES);
        passes.set(0);
        slow.fixpoint(1e-9).contract(domain);
        assert_eq!(passes.get(), 1);
    }

    #[test]
    fn sides_without_bounds_are_followed_and_end() {
        let rising = from_fn(|domain: IntervalBox<1>| IntervalBox::from([domain[0] + 1.0]));
        let left = rising.fixpoint(0.1).contract(IntervalBox::from([Interval::NON_NEGATIVE]));
        assert_eq!(left[0], over(256.0, f64::INFINITY));
        assert!(rising.fixpoint(f64::NAN).contract(IntervalBox::from([over(0.0, 9.5)])).is_empty());
        let huge = IntervalBox::from([over(f64::MIN, f64::MAX)]);
        let halving = from_fn(|domain: IntervalBox<1>| IntervalBox::from([domain[0] * 0.5]));
        assert!(halving.fixpoint(0.6).contract(huge)[0].is_subset_of(huge[0] * 0.5));
    }

    #[test]
    fn the_infeasible_system_of_the_seed_is_found_empty() {
        // y = x², x y = 2, y = 1 - x have no common solution. Source: seed 001, equations (2.42) to (2.49).
        let square = crate::contractor::Square;
        let hyperbola =
            crate::contractor::Product.with_parameters::<2, 1>(IntervalBox::from([over(2.0, 2.0)]));
        let line = crate::contractor::Sum.with_parameters::<2, 1>(IntervalBox::from([Interval::ONE]));
        let system = square.then(hyperbola).then(line).fixpoint(0.0);
        assert!(system.contract(IntervalBox::ENTIRE).is_empty());
    }
}
