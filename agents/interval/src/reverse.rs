//! Backward steps of a forward-backward contractor: what an operation's result says about its argument.
//!
//! Source: seed 001, section 2.3.5; Benhamou et al., *Revising hull and box consistency* (HC4-Revise), 1999.

use crate::interval::Interval;

impl Interval {
    /// The numbers `x` of `self` whose square is in `square`, as a hull.
    ///
    /// Each of the two roots is met with `self` before they are joined, so the sign of `self` is respected.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let x = Interval::new(-1.0, 5.0)?;
    /// assert_eq!(x.with_square_in(Interval::new(4.0, 9.0)?), Interval::new(2.0, 3.0)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub fn with_square_in(self, square: Interval) -> Interval {
        let root = square.sqrt();
        self.intersection(root).hull(self.intersection(-root))
    }

    /// The numbers `x` of `self` for which some `y` in `factor` gives `x * y` in `product`, as a hull.
    ///
    /// Unlike a division it keeps everything when both `factor` and `product` may be zero, and it drops the gap around zero
    /// when only `factor` may.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let x = Interval::new(-0.1, 9.0)?;
    /// let product = Interval::new(1.0, 2.0)?;
    /// assert_eq!(x.with_product_in(Interval::new(-1.0, 1.0)?, product), Interval::new(1.0, 9.0)?);
    /// assert_eq!(x.with_product_in(Interval::ZERO, Interval::ZERO), x);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub fn with_product_in(self, factor: Interval, product: Interval) -> Interval {
        if factor.contains(0.0) {
            if product.contains(0.0) {
                return self;
            }
            let above = product / factor.intersection(Interval::NON_NEGATIVE);
            let below = product / factor.intersection(-Interval::NON_NEGATIVE);
            return self.intersection(above).hull(self.intersection(below));
        }
        self.intersection(product / factor)
    }
}
