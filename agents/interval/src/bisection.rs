//! Cutting an interval: in two, at a number, by another interval. Nothing is rounded.

use crate::interval::Interval;
use crate::set::{larger, smaller};

impl Interval {
    /// The two halves, cut at [`mid`](Interval::mid); they share that number.
    ///
    /// `None` for the empty set, for an unbounded one, and when no `f64` lies between the bounds, so cutting until
    /// nothing is left to cut ends.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let (low, high) = Interval::new(-1.0, 3.0)?.bisect().expect("bounded and wide");
    /// assert_eq!((low, high), (Interval::new(-1.0, 1.0)?, Interval::new(1.0, 3.0)?));
    /// assert!(Interval::ONE.bisect().is_none());
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub fn bisect(self) -> Option<(Interval, Interval)> {
        let middle = self.mid();
        if !(self.is_bounded() && self.lower() < middle && middle < self.upper()) {
            return None;
        }
        Some((Interval::from_bounds(self.lower(), middle), Interval::from_bounds(middle, self.upper())))
    }

    /// The numbers up to `value` and those from `value` on; both hold `value` if the set does. One of them is empty when
    /// `value` is outside.
    ///
    /// A NaN, of which nothing is known, gives the whole set twice.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let (before, after) = Interval::new(0.0, 8.0)?.split_at(6.0);
    /// assert_eq!((before, after), (Interval::new(0.0, 6.0)?, Interval::new(6.0, 8.0)?));
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub fn split_at(self, value: f64) -> (Interval, Interval) {
        if value.is_nan() {
            return (self, self);
        }
        let below = between(self.lower(), smaller(self.upper(), value));
        let above = between(larger(self.lower(), value), self.upper());
        (below, above)
    }

    /// The numbers of `self` that are not in `other`, as what lies below `other` and what lies above it.
    ///
    /// Together the two are the closure of `self \ other`, exactly; a part without numbers is [`Interval::EMPTY`]. If no
    /// number is taken away, one of the parts is `self`.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let [below, above] = Interval::new(0.0, 8.0)?.difference(Interval::new(2.0, 9.0)?);
    /// assert_eq!(below, Interval::new(0.0, 2.0)?);
    /// assert!(above.is_empty());
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub fn difference(self, other: Interval) -> [Interval; 2] {
        if self.is_empty() || other.is_empty() {
            return [self, Interval::EMPTY];
        }
        let below = if self.lower() < other.lower() {
            Interval::from_bounds(self.lower(), smaller(self.upper(), other.lower()))
        } else {
            Interval::EMPTY
        };
        let above = if self.upper() > other.upper() {
            Interval::from_bounds(larger(self.lower(), other.upper()), self.upper())
        } else {
            Interval::EMPTY
        };
        [below, above]
    }
}

/// The real numbers between two bounds, of which there may be none.
#[inline]
fn between(lower: f64, upper: f64) -> Interval {
    if lower <= upper && lower < f64::INFINITY && upper > f64::NEG_INFINITY {
        Interval::from_bounds(lower, upper)
    } else {
        Interval::EMPTY
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::strategies::number;
    use proptest::prelude::*;

    #[test]
    fn what_cannot_be_cut_stays_whole() {
        let neighbours = Interval::new(1.0, 1.0_f64.next_up()).unwrap();
        for x in [Interval::EMPTY, Interval::ENTIRE, Interval::NON_NEGATIVE, Interval::ONE, neighbours] {
            assert!(x.bisect().is_none());
        }
        assert!(Interval::new(f64::MIN, f64::MAX).unwrap().bisect().is_some());
    }

    #[test]
    fn cuts_outside_and_at_nothing() {
        let x = Interval::new(0.0, 1.0).unwrap();
        assert_eq!(x.split_at(-1.0), (Interval::EMPTY, x));
        assert_eq!(x.split_at(f64::INFINITY), (x, Interval::EMPTY));
        assert_eq!(x.split_at(1.0), (x, Interval::ONE));
        assert_eq!(x.split_at(f64::NAN), (x, x));
        assert_eq!(Interval::ENTIRE.split_at(f64::NEG_INFINITY), (Interval::EMPTY, Interval::ENTIRE));
        assert_eq!(Interval::EMPTY.split_at(0.5), (Interval::EMPTY, Interval::EMPTY));
    }

    #[test]
    fn differences_at_the_edges() {
        let x = Interval::new(0.0, 1.0).unwrap();
        assert_eq!(x.difference(Interval::EMPTY), [x, Interval::EMPTY]);
        assert_eq!(x.difference(Interval::ONE), [x, Interval::EMPTY]);
        assert_eq!(x.difference(x), [Interval::EMPTY; 2]);
        assert_eq!(Interval::EMPTY.difference(x), [Interval::EMPTY; 2]);
        assert_eq!(x.difference(Interval::new(-2.0, -1.0).unwrap()), [Interval::EMPTY, x]);
    }

    proptest! {
        #[test]
        fn parts_are_the_whole(one in number(), other in number(), at in number()) {
            let x = Interval::spanning(one, other);
            let (below, above) = x.split_at(at);
            prop_assert_eq!(below | above, x);
            prop_assert_eq!(x.contains(at), !(below & above).is_empty());
        }

        #[test]
        fn what_is_left_is_not_in_what_was_taken(
            a in number(), b in number(), c in number(), d in number(), at in number(),
        ) {
            let (x, y) = (Interval::spanning(a, b), Interval::spanning(c, d));
            let parts = x.difference(y);
            let left = parts.iter().any(|part| part.contains(at));
            prop_assert!(left || y.contains(at) || !x.contains(at));
            prop_assert!(!left || x.contains(at) && !at.is_nan());
            prop_assert!(parts.iter().all(|part| !part.is_interior_of(y) || part.is_empty()));
        }
    }
}
