//! The separator of a box.

use super::Separator;
use crate::interval::Interval;
use crate::interval_box::IntervalBox;

/// The vectors of a box. Both contractors are minimal and exact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InBox<const N: usize> {
    set: IntervalBox<N>,
}

impl<const N: usize> InBox<N> {
    /// The separator of the vectors of `set`.
    pub fn new(set: IntervalBox<N>) -> InBox<N> {
        InBox { set }
    }
}

impl<const N: usize> Separator<N> for InBox<N> {
    /// The hull of what is not in the box: one side can be cut when all others lie within the box, none when two stick out.
    fn inner(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        let mut beyond = (0..N).filter(|&axis| !domain[axis].is_subset_of(self.set[axis]));
        match (beyond.next(), beyond.next()) {
            (None, _) => IntervalBox::EMPTY,
            (Some(_), Some(_)) => domain,
            (Some(axis), None) => {
                let mut left = domain;
                left[axis] = without(domain[axis], self.set[axis]);
                left
            }
        }
    }

    #[inline]
    fn outer(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        domain & self.set
    }
}

/// The hull of the numbers of `x`, not all in `taken`, that are not in the inside of `taken`.
fn without(x: Interval, taken: Interval) -> Interval {
    if (x & taken).is_empty() {
        return x;
    }
    let lower = if x.lower() < taken.lower() { x.lower() } else { taken.upper() };
    let upper = if x.upper() > taken.upper() { x.upper() } else { taken.lower() };
    Interval::from_bounds(lower, upper)
}
