//! How two intervals lie to each other.
//!
//! Source: IEEE 1788-2015, clause 10.5.10 (boolean functions of intervals), table 10.3.

use crate::interval::Interval;

impl Interval {
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
}
