//! What an exponential or a logarithm says about its argument.

use crate::interval::Interval;

impl Interval {
    /// The numbers of `x` whose exponential is in `self`, as a hull. As tight as [`Interval::ln`].
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// assert_eq!(Interval::new(0.0, 1.0)?.exp_rev(Interval::new(-5.0, 5.0)?), Interval::new(-5.0, 0.0)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub fn exp_rev(self, x: Interval) -> Interval {
        x.intersection(self.ln())
    }

    /// The numbers of `x` whose natural logarithm is in `self`, as a hull. As tight as [`Interval::exp`].
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let negative = Interval::new(f64::NEG_INFINITY, 0.0)?;
    /// assert_eq!(negative.ln_rev(Interval::new(-5.0, 5.0)?), Interval::new(0.0, 1.0)?);
    /// assert!(negative.ln_rev(Interval::new(-5.0, 0.0)?).is_empty());
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub fn ln_rev(self, x: Interval) -> Interval {
        x.above(0.0).intersection(self.exp())
    }
}
