//! Intervals as sets: membership, inclusion, intersection, hull.

use crate::interval::Interval;
use std::ops::{BitAnd, BitOr};

impl Interval {
    /// Whether the real number `value` is in the set. NaN and infinities are in no set.
    #[inline]
    pub const fn contains(self, value: f64) -> bool {
        self.lower() <= value && value <= self.upper() && value.is_finite()
    }

    /// Whether every number of `self` is in `other`. The empty set is a subset of every set.
    #[inline]
    pub const fn is_subset_of(self, other: Interval) -> bool {
        self.is_empty() || (other.lower() <= self.lower() && self.upper() <= other.upper())
    }

    /// The numbers that are in both; also written `x & y`. Exact.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let x = Interval::new(1.0, 3.0)?;
    /// assert_eq!(x.intersection(Interval::new(2.0, 5.0)?), Interval::new(2.0, 3.0)?);
    /// assert!(x.intersection(Interval::new(5.0, 7.0)?).is_empty());
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: seed 001, equation (2.3).
    #[inline]
    pub fn intersection(self, other: Interval) -> Interval {
        let both = self.common_bounds(other);
        if both.is_empty() { Interval::EMPTY } else { both }
    }

    /// The smallest interval that holds both; also written `x | y`. Exact.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let x = Interval::new(1.0, 3.0)?;
    /// assert_eq!(x.hull(Interval::new(5.0, 7.0)?), Interval::new(1.0, 7.0)?);
    /// assert_eq!(x.hull(Interval::EMPTY), x);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: seed 001, equations (2.4) and (2.5).
    #[inline]
    pub fn hull(self, other: Interval) -> Interval {
        // The bounds of the empty set, (+inf, -inf), are neutral here.
        let [lower, neg_upper] = self.lower_bounds();
        let [other_lower, other_neg_upper] = other.lower_bounds();
        Interval::from_lower_bounds(smaller(lower, other_lower), smaller(neg_upper, other_neg_upper))
    }

    /// The larger of the lower bounds and the smaller of the upper bounds, which are inverted when nothing is in both sets.
    #[inline]
    pub(crate) fn common_bounds(self, other: Interval) -> Interval {
        let [lower, neg_upper] = self.lower_bounds();
        let [other_lower, other_neg_upper] = other.lower_bounds();
        Interval::from_lower_bounds(larger(lower, other_lower), larger(neg_upper, other_neg_upper))
    }

    /// Everything within `radius` of the set, rounded outwards: `self + [-radius, radius]`.
    ///
    /// The empty set stays empty; a negative radius gives the empty set and a NaN [`Interval::ENTIRE`], as in
    /// [`Interval::centred`].
    #[inline]
    pub fn inflate(self, radius: f64) -> Interval {
        self + Interval::centred(0.0, radius)
    }
}

impl BitAnd for Interval {
    type Output = Interval;

    #[inline]
    fn bitand(self, other: Interval) -> Interval {
        self.intersection(other)
    }
}

impl BitOr for Interval {
    type Output = Interval;

    #[inline]
    fn bitor(self, other: Interval) -> Interval {
        self.hull(other)
    }
}

/// `f64::max` for bounds, which are never NaN: one instruction.
#[inline]
pub(crate) fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// `f64::min` for bounds, which are never NaN: one instruction.
#[inline]
pub(crate) fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn infinities_are_bounds_and_not_members() {
        assert!(!Interval::ENTIRE.contains(f64::INFINITY));
        assert!(!Interval::ENTIRE.contains(f64::NAN));
        assert!(Interval::ENTIRE.contains(f64::MAX));
        assert!(!Interval::EMPTY.contains(0.0));
    }

    #[test]
    fn the_empty_set_among_others() {
        assert!(Interval::EMPTY.is_subset_of(Interval::EMPTY));
        assert!(Interval::EMPTY.is_subset_of(Interval::ONE));
        assert!(!Interval::ONE.is_subset_of(Interval::EMPTY));
        assert_eq!(Interval::EMPTY | Interval::EMPTY, Interval::EMPTY);
        assert_eq!(Interval::EMPTY & Interval::ENTIRE, Interval::EMPTY);
        assert!(Interval::EMPTY.inflate(1.0).is_empty());
    }

    #[test]
    fn inflating_is_a_sum() {
        assert_eq!(Interval::ONE.inflate(0.5), Interval::new(0.5, 1.5).unwrap());
        assert_eq!(Interval::ONE.inflate(f64::NAN), Interval::ENTIRE);
        assert!(Interval::ONE.inflate(-1.0).is_empty());
    }
}
