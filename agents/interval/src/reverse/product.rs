//! What a product, a quotient or a reciprocal says about its operands. All give the tightest interval.

use crate::interval::Interval;

impl Interval {
    /// The numbers of `x` for which some `b` in `self` gives `x * b` in `c`, as a hull.
    ///
    /// Unlike a division it keeps everything when both `self` and `c` may be zero, and it drops the gap around zero when
    /// only `self` may.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let (factor, product) = (Interval::new(-1.0, 1.0)?, Interval::new(1.0, 2.0)?);
    /// let x = Interval::new(-0.1, 9.0)?;
    /// assert_eq!(factor.mul_rev(product, x), Interval::new(1.0, 9.0)?);
    /// assert_eq!(Interval::ZERO.mul_rev(Interval::ZERO, x), x);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: IEEE 1788-2015, table 10.1 (mulRev).
    #[inline]
    pub fn mul_rev(self, c: Interval, x: Interval) -> Interval {
        if self.contains(0.0) {
            if c.contains(0.0) {
                return x;
            }
            let above = c / self.intersection(Interval::NON_NEGATIVE);
            let below = c / self.intersection(-Interval::NON_NEGATIVE);
            return x.intersection(above).hull(x.intersection(below));
        }
        x.intersection(c / self)
    }

    /// The numbers `x` for which some `b` in `self` gives `x * b` in `c`, as two pieces in ascending order: the division
    /// with two results.
    ///
    /// The second piece is empty unless zero parts `self` and is not in `c`.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let (factor, product) = (Interval::new(-1.0, 2.0)?, Interval::new(1.0, 2.0)?);
    /// let (below, above) = factor.mul_rev_to_pair(product);
    /// assert_eq!(below, Interval::new(f64::NEG_INFINITY, -1.0)?);
    /// assert_eq!(above, Interval::new(0.5, f64::INFINITY)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: IEEE 1788-2015, clause 10.5.5 (mulRevToPair).
    pub fn mul_rev_to_pair(self, c: Interval) -> (Interval, Interval) {
        if !self.contains(0.0) || c.is_empty() {
            return (c / self, Interval::EMPTY);
        }
        if c.contains(0.0) {
            return (Interval::ENTIRE, Interval::EMPTY);
        }
        let by_positive = c / self.intersection(Interval::NON_NEGATIVE);
        let by_negative = c / self.intersection(-Interval::NON_NEGATIVE);
        let (below, above) =
            if c.lower() > 0.0 { (by_negative, by_positive) } else { (by_positive, by_negative) };
        if below.is_empty() { (above, below) } else { (below, above) }
    }

    /// The numbers of `x` for which some `b` in `self`, not zero, gives `x / b` in `c`, as a hull.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let (divisor, quotient) = (Interval::new(2.0, 4.0)?, Interval::new(1.0, 3.0)?);
    /// assert_eq!(divisor.div_rev1(quotient, Interval::ENTIRE), Interval::new(2.0, 12.0)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub fn div_rev1(self, c: Interval, x: Interval) -> Interval {
        let product = c * self;
        if !self.contains(0.0) || c.contains(0.0) && self != Interval::ZERO {
            return x.intersection(product);
        }
        // Zero closes the products, but is none.
        product.above(0.0).intersection(x.above(0.0)).hull(product.below(0.0).intersection(x.below(0.0)))
    }

    /// The numbers of `x`, not zero, for which some `a` in `self` gives `a / x` in `c`, as a hull.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let (dividend, quotient) = (Interval::new(6.0, 12.0)?, Interval::new(1.0, 3.0)?);
    /// assert_eq!(dividend.div_rev2(quotient, Interval::ENTIRE), Interval::new(2.0, 12.0)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    pub fn div_rev2(self, c: Interval, x: Interval) -> Interval {
        let above = c.mul_rev(self, x.above(0.0)).above(0.0);
        let below = c.mul_rev(self, x.below(0.0)).below(0.0);
        above.hull(below)
    }

    /// The numbers of `x` whose reciprocal is in `self`, as a hull.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let reciprocal = Interval::new(-1.0, 0.25)?;
    /// assert_eq!(reciprocal.recip_rev(Interval::new(-9.0, 9.0)?), Interval::new(-9.0, 9.0)?);
    /// assert_eq!(reciprocal.recip_rev(Interval::new(0.0, 9.0)?), Interval::new(4.0, 9.0)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub fn recip_rev(self, x: Interval) -> Interval {
        Interval::ONE.div_rev2(self, x)
    }
}
