//! Sign and rounding to whole numbers. All exact.

use crate::interval::Interval;

impl Interval {
    /// The signs of the numbers in the set: -1, 0 or 1, as a hull.
    ///
    /// Source: IEEE 1788-2015, table 9.1.
    #[inline]
    pub fn sign(self) -> Interval {
        self.rounded_by(|x| f64::from(i8::from(x > 0.0) - i8::from(x < 0.0)))
    }

    /// The largest whole numbers that are not above the numbers in the set, as a hull.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// assert_eq!(Interval::new(-1.5, 2.5)?.floor(), Interval::new(-2.0, 2.0)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: IEEE 1788-2015, table 9.1.
    #[inline]
    pub fn floor(self) -> Interval {
        self.rounded_by(f64::floor)
    }

    /// The smallest whole numbers that are not below the numbers in the set, as a hull.
    ///
    /// Source: IEEE 1788-2015, table 9.1.
    #[inline]
    pub fn ceil(self) -> Interval {
        self.rounded_by(f64::ceil)
    }

    /// The whole numbers next to the numbers in the set on the way to zero, as a hull.
    ///
    /// Source: IEEE 1788-2015, table 9.1.
    #[inline]
    pub fn trunc(self) -> Interval {
        self.rounded_by(f64::trunc)
    }

    /// The whole numbers nearest to the numbers in the set, as a hull; halves go to the even one.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// assert_eq!(Interval::new(0.5, 1.5)?.round_ties_even(), Interval::new(0.0, 2.0)?);
    /// assert_eq!(Interval::new(0.5, 1.5)?.round_ties_away(), Interval::new(1.0, 2.0)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: IEEE 1788-2015, table 9.1.
    #[inline]
    pub fn round_ties_even(self) -> Interval {
        self.rounded_by(f64::round_ties_even)
    }

    /// The whole numbers nearest to the numbers in the set, as a hull; halves go away from zero.
    ///
    /// Source: IEEE 1788-2015, table 9.1.
    #[inline]
    pub fn round_ties_away(self) -> Interval {
        self.rounded_by(f64::round)
    }

    /// Every step function grows, so its values at the bounds are the bounds of its values; at a missing bound it misses
    /// too.
    #[inline]
    fn rounded_by(self, step: impl Fn(f64) -> f64) -> Interval {
        if self.is_empty() { self } else { Interval::from_bounds(step(self.lower()), step(self.upper())) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn over(lower: f64, upper: f64) -> Interval {
        Interval::new(lower, upper).unwrap()
    }

    #[test]
    fn steps_at_the_bounds() {
        let x = over(-2.5, 1.5);
        assert_eq!(x.floor(), over(-3.0, 1.0));
        assert_eq!(x.ceil(), over(-2.0, 2.0));
        assert_eq!(x.trunc(), over(-2.0, 1.0));
        assert_eq!(x.round_ties_even(), over(-2.0, 2.0));
        assert_eq!(x.round_ties_away(), over(-3.0, 2.0));
        assert_eq!(x.sign(), over(-1.0, 1.0));
        assert_eq!(over(-0.0, 3.0).sign(), over(0.0, 1.0));
        assert_eq!(over(-0.4, 0.4).round_ties_away(), Interval::ZERO);
    }

    #[test]
    fn missing_bounds_and_the_empty_set() {
        let steps = [
            Interval::floor,
            Interval::ceil,
            Interval::trunc,
            Interval::round_ties_even,
            Interval::round_ties_away,
        ];
        for step in steps {
            assert_eq!(step(Interval::ENTIRE), Interval::ENTIRE);
            assert_eq!(step(Interval::EMPTY), Interval::EMPTY);
            assert_eq!(step(over(f64::MIN, f64::MAX)), over(f64::MIN, f64::MAX));
            assert_eq!(step(over(f64::from_bits(1), 1.0)).upper(), 1.0);
        }
        assert_eq!(Interval::ENTIRE.sign(), over(-1.0, 1.0));
        assert_eq!(Interval::EMPTY.sign(), Interval::EMPTY);
    }
}
