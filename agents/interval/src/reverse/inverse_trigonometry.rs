//! What an inverse sine, cosine or tangent says about its argument.

use crate::interval::Interval;

impl Interval {
    /// The numbers of `x` whose inverse sine is in `self`, in radians, as a hull. As tight as [`Interval::sin`].
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let angle_rad = Interval::new(0.0, 7.0)?;
    /// assert_eq!(angle_rad.asin_rev(Interval::ENTIRE), Interval::new(0.0, 1.0)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    pub fn asin_rev(self, x: Interval) -> Interval {
        let quarter = Interval::HALF_PI.upper();
        // No inverse sine is as large as the number above half of pi.
        let angles = self.below(quarter).above(-quarter);
        x.intersection(angles.sin())
    }

    /// The numbers of `x` whose inverse cosine is in `self`, in radians, as a hull. As tight as [`Interval::cos`].
    pub fn acos_rev(self, x: Interval) -> Interval {
        let angles = self.below(Interval::PI.upper()).intersection(Interval::NON_NEGATIVE);
        x.intersection(angles.cos())
    }

    /// The numbers of `x` whose inverse tangent is in `self`, in radians, as a hull. As tight as [`Interval::tan`].
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let angle_rad = Interval::new(0.0, 7.0)?;
    /// assert_eq!(angle_rad.atan_rev(Interval::ENTIRE), Interval::NON_NEGATIVE);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    pub fn atan_rev(self, x: Interval) -> Interval {
        let quarter = Interval::HALF_PI.upper();
        let angles = self.below(quarter).above(-quarter);
        if angles.is_empty() {
            return Interval::EMPTY;
        }
        let below_every = -Interval::HALF_PI.lower() > angles.lower();
        let above_every = Interval::HALF_PI.lower() < angles.upper();
        let tangent = |angle| Interval::from_bounds(angle, angle).tan();
        let lower = if below_every { f64::NEG_INFINITY } else { tangent(angles.lower()).lower() };
        let upper = if above_every { f64::INFINITY } else { tangent(angles.upper()).upper() };
        x.intersection(Interval::from_bounds(lower, upper))
    }
}
