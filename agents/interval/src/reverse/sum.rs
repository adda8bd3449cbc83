//! What a sum or a difference says about its terms. All give the tightest interval.

use crate::interval::Interval;

impl Interval {
    /// The numbers of `x` for which some `b` in `self` gives `x + b` in `c`, as a hull.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let sum = Interval::new(5.0, 6.0)?;
    /// assert_eq!(Interval::ONE.add_rev(sum, Interval::new(0.0, 4.5)?), Interval::new(4.0, 4.5)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub fn add_rev(self, c: Interval, x: Interval) -> Interval {
        x.intersection(c - self)
    }

    /// The numbers of `x` for which some `b` in `self` gives `x - b` in `c`, as a hull.
    #[inline]
    pub fn sub_rev1(self, c: Interval, x: Interval) -> Interval {
        x.intersection(c + self)
    }

    /// The numbers of `x` for which some `a` in `self` gives `a - x` in `c`, as a hull.
    #[inline]
    pub fn sub_rev2(self, c: Interval, x: Interval) -> Interval {
        x.intersection(self - c)
    }
}
