//! How two intervals lie to each other.
//!
//! Comparisons follow IEEE 1788-2015, clause 10.5.10 (required boolean functions of intervals), 10.6.3 (`isCommonInterval`)
//! and 10.6.4 (`overlap`); the names of the standard are given in brackets where ours differ. Nothing is rounded.

use crate::interval::Interval;

mod overlap;

pub use overlap::Overlap;

impl Interval {
    /// Whether the set is all real numbers.
    #[inline]
    pub const fn is_entire(self) -> bool {
        self.lower() == f64::NEG_INFINITY && self.upper() == f64::INFINITY
    }

    /// Whether the set is bounded and not empty (`isCommonInterval`): what ordinary interval arithmetic is about.
    #[inline]
    pub const fn is_common(self) -> bool {
        !self.is_empty() && self.is_bounded()
    }

    /// Whether every number of `self` is in `other` and not on its boundary (`interior`). The empty set is in the interior of
    /// every set; where there is no bound there is no boundary.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// assert!(Interval::new(1.0, 2.0)?.is_interior_of(Interval::new(0.0, 3.0)?));
    /// assert!(!Interval::new(1.0, 2.0)?.is_interior_of(Interval::new(1.0, 3.0)?));
    /// assert!(Interval::ENTIRE.is_interior_of(Interval::ENTIRE));
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub const fn is_interior_of(self, other: Interval) -> bool {
        let above = other.lower() < self.lower() || other.lower() == f64::NEG_INFINITY;
        let below = self.upper() < other.upper() || other.upper() == f64::INFINITY;
        self.is_empty() || (above && below && !other.is_empty())
    }

    /// Whether no number is in both (`disjoint`). The empty set is disjoint from every set, itself included.
    #[inline]
    pub const fn is_disjoint_from(self, other: Interval) -> bool {
        self.is_empty() || other.is_empty() || self.upper() < other.lower() || other.upper() < self.lower()
    }

    /// Whether each number of `self` has one in `other` that is at least as large, and each of `other` one in `self` that
    /// is at most as large (`less`): both bounds are in weak order. Two empty sets are, an empty one and another are not.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let (early_s, late_s) = (Interval::new(1.0, 4.0)?, Interval::new(2.0, 4.0)?);
    /// assert!(early_s.is_less_than(late_s) && !early_s.is_strictly_less_than(late_s));
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub const fn is_less_than(self, other: Interval) -> bool {
        if self.is_empty() || other.is_empty() {
            return self.is_empty() && other.is_empty();
        }
        self.lower() <= other.lower() && self.upper() <= other.upper()
    }

    /// Whether each number of `self` has a larger one in `other`, and each of `other` a smaller one in `self`
    /// (`strictLess`): both bounds are in strict order, or missing. Two empty sets are, an empty one and another are not.
    #[inline]
    pub const fn is_strictly_less_than(self, other: Interval) -> bool {
        if self.is_empty() || other.is_empty() {
            return self.is_empty() && other.is_empty();
        }
        let lower = self.lower() < other.lower()
            || self.lower() == f64::NEG_INFINITY && other.lower() == f64::NEG_INFINITY;
        let upper =
            self.upper() < other.upper() || self.upper() == f64::INFINITY && other.upper() == f64::INFINITY;
        lower && upper
    }

    /// Whether no number of `self` is above one of `other` (`precedes`); true if one of them is empty.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let (emission_s, reception_s) = (Interval::new(1.0, 2.0)?, Interval::new(2.0, 4.0)?);
    /// assert!(emission_s.precedes(reception_s) && !emission_s.strictly_precedes(reception_s));
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub const fn precedes(self, other: Interval) -> bool {
        self.is_empty() || other.is_empty() || self.upper() <= other.lower()
    }

    /// Whether every number of `self` is below every one of `other` (`strictPrecedes`); true if one of them is empty.
    #[inline]
    pub const fn strictly_precedes(self, other: Interval) -> bool {
        self.is_empty() || other.is_empty() || self.upper() < other.lower()
    }

    /// Which of the sixteen ways two sets can lie to each other is the case.
    ///
    /// ```
    /// use shoal_interval::{Interval, Overlap};
    ///
    /// let (window_s, ping_s) = (Interval::new(0.0, 3.0)?, Interval::new(2.0, 4.0)?);
    /// assert_eq!(window_s.overlap(ping_s), Overlap::Overlaps);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub fn overlap(self, other: Interval) -> Overlap {
        Overlap::between(self, other)
    }
}

#[cfg(test)]
mod tests;
