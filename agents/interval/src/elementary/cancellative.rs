//! The inverses of sum and difference.

use super::error_free::two_sum;
use crate::interval::Interval;
use crate::rounding::{sub_down, sub_up};

impl Interval {
    /// The smallest `z` for which `z + term` holds `self`: what was there before `term` was added to it.
    ///
    /// Unlike `self - term` it undoes a sum. There is none when `term` is wider than `self`, or either is unbounded;
    /// then [`Interval::ENTIRE`]. Tightest. An empty `self` gives the empty set with a bounded `term`.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let (x, y) = (Interval::new(1.0, 2.0)?, Interval::new(10.0, 10.5)?);
    /// assert_eq!((x + y).cancel_minus(y), x);
    /// assert_eq!(y.cancel_minus(x), Interval::ENTIRE);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: IEEE 1788-2015, section 12.12.5.1.
    pub fn cancel_minus(self, term: Interval) -> Interval {
        if self.is_empty() && term.is_bounded() {
            return Interval::EMPTY;
        }
        if term.is_empty() || !self.is_bounded() || !term.is_bounded() || is_wider(term, self) {
            return Interval::ENTIRE;
        }
        Interval::from_bounds(sub_down(self.lower(), term.lower()), sub_up(self.upper(), term.upper()))
    }

    /// The smallest `z` for which `z - term` holds `self`: `self.cancel_minus(-term)`.
    ///
    /// Source: IEEE 1788-2015, section 12.12.5.1.
    pub fn cancel_plus(self, term: Interval) -> Interval {
        self.cancel_minus(-term)
    }
}

/// Whether `term` is wider than `sum`, exactly: whether the lower bounds differ by more than the upper ones.
fn is_wider(term: Interval, sum: Interval) -> bool {
    let mut at_lower = two_sum(sum.lower(), -term.lower());
    let mut at_upper = two_sum(sum.upper(), -term.upper());
    if at_lower.0 == at_upper.0 && at_lower.0.is_infinite() {
        // All four bounds are above 2^960 in size, so halving them is exact.
        at_lower = two_sum(0.5 * sum.lower(), -0.5 * term.lower());
        at_upper = two_sum(0.5 * sum.upper(), -0.5 * term.upper());
    }
    // Rounding keeps the order, so the errors matter only when the rounded differences agree.
    at_lower.0 > at_upper.0 || at_lower.0 == at_upper.0 && at_lower.1 > at_upper.1
}

#[cfg(test)]
mod tests;
