//! What a minimum, a maximum, a sign or a rounding to whole numbers says about its argument.

use crate::interval::Interval;
use crate::rounding::add_up;

impl Interval {
    /// The numbers of `x` for which some `b` in `self` gives `min(x, b)` in `c`, as a hull. Exact.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let (other, smaller) = (Interval::new(3.0, 8.0)?, Interval::new(1.0, 2.0)?);
    /// assert_eq!(other.min_rev(smaller, Interval::ENTIRE), smaller);
    /// assert_eq!(smaller.min_rev(smaller, Interval::ENTIRE), Interval::new(1.0, f64::INFINITY)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    pub fn min_rev(self, c: Interval, x: Interval) -> Interval {
        if self.is_empty() {
            return Interval::EMPTY;
        }
        let not_above_self = Interval::from_bounds(f64::NEG_INFINITY, self.upper());
        let is_minimum = x.intersection(c).intersection(not_above_self);
        let other_is_minimum = self.intersection(c);
        if other_is_minimum.is_empty() {
            return is_minimum;
        }
        is_minimum.hull(x.intersection(at_least(other_is_minimum.lower())))
    }

    /// The numbers of `x` for which some `b` in `self` gives `max(x, b)` in `c`, as a hull. Exact.
    pub fn max_rev(self, c: Interval, x: Interval) -> Interval {
        -(-self).min_rev(-c, -x)
    }

    /// The numbers of `x` whose sign - -1, 0 or 1 - is in `self`, as a hull. Exact.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let not_negative = Interval::new(0.0, 1.0)?;
    /// assert_eq!(not_negative.sign_rev(Interval::new(-5.0, 3.0)?), Interval::new(0.0, 3.0)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    pub fn sign_rev(self, x: Interval) -> Interval {
        let only_if = |sign, part: Interval| if self.contains(sign) { part } else { Interval::EMPTY };
        only_if(-1.0, x.below(0.0))
            .hull(only_if(0.0, x.intersection(Interval::ZERO)))
            .hull(only_if(1.0, x.above(0.0)))
    }

    /// The numbers of `x` whose [`floor`](Interval::floor) is in `self`, as a hull. The tightest interval.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let floor = Interval::new(1.5, 3.0)?;
    /// assert_eq!(floor.floor_rev(Interval::ENTIRE), Interval::new(2.0, 4.0)?);
    /// assert!(floor.floor_rev(Interval::new(4.0, 9.0)?).is_empty());
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    pub fn floor_rev(self, x: Interval) -> Interval {
        let (first, last) = (self.lower().ceil(), self.upper().floor());
        if first <= last { x.below(add_up(last, 1.0)).intersection(at_least(first)) } else { Interval::EMPTY }
    }

    /// The numbers of `x` whose [`ceil`](Interval::ceil) is in `self`, as a hull. The tightest interval.
    pub fn ceil_rev(self, x: Interval) -> Interval {
        -(-self).floor_rev(-x)
    }
}

fn at_least(bound: f64) -> Interval {
    Interval::from_bounds(bound, f64::INFINITY)
}
