//! What a square, a square root or an absolute value says about its argument.

use crate::interval::Interval;

impl Interval {
    /// The numbers of `x` whose square is in `self`, as a hull.
    ///
    /// Each of the two roots is met with `x` before they are joined, so the sign of `x` is respected. The tightest
    /// interval.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let square = Interval::new(4.0, 9.0)?;
    /// assert_eq!(square.sqr_rev(Interval::ENTIRE), Interval::new(-3.0, 3.0)?);
    /// assert_eq!(square.sqr_rev(Interval::new(-1.0, 5.0)?), Interval::new(2.0, 3.0)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: IEEE 1788-2015, table 10.1 (sqrRev).
    #[inline]
    pub fn sqr_rev(self, x: Interval) -> Interval {
        either_sign(self.sqrt(), x)
    }

    /// The numbers of `x` whose square root is in `self`, as a hull. The tightest interval.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let root = Interval::new(-1.0, 3.0)?;
    /// assert_eq!(root.sqrt_rev(Interval::ENTIRE), Interval::new(0.0, 9.0)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub fn sqrt_rev(self, x: Interval) -> Interval {
        x.intersection(self.intersection(Interval::NON_NEGATIVE).sqr())
    }

    /// The numbers of `x` whose absolute value is in `self`, as a hull. Exact.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let size = Interval::new(1.0, 2.0)?;
    /// assert_eq!(size.abs_rev(Interval::new(-5.0, 0.5)?), Interval::new(-2.0, -1.0)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: IEEE 1788-2015, table 10.1 (absRev).
    #[inline]
    pub fn abs_rev(self, x: Interval) -> Interval {
        either_sign(self.intersection(Interval::NON_NEGATIVE), x)
    }
}

#[inline]
fn either_sign(size: Interval, x: Interval) -> Interval {
    x.intersection(size).hull(x.intersection(-size))
}
