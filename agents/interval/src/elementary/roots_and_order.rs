//! Square, square root, absolute value, minimum and maximum.

use crate::interval::Interval;
use crate::rounding::{mul_down, mul_up, sqrt_down, sqrt_up};
use crate::set::{larger, smaller};

impl Interval {
    /// The squares of the numbers in the set, rounded outwards. Tighter than `x * x`, which takes two numbers.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// assert_eq!(Interval::new(-2.0, 3.0)?.sqr(), Interval::new(0.0, 9.0)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub fn sqr(self) -> Interval {
        if self.is_empty() {
            return Interval::EMPTY;
        }
        let (smallest, largest) = (self.mignitude(), self.magnitude());
        Interval::from_bounds(mul_down(smallest, smallest), mul_up(largest, largest))
    }

    /// The square roots of the numbers in the set that have one, rounded outwards; empty when none has.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// assert_eq!(Interval::new(-1.0, 9.0)?.sqrt(), Interval::new(0.0, 3.0)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub fn sqrt(self) -> Interval {
        let real = self.intersection(Interval::NON_NEGATIVE);
        if real.is_empty() {
            return Interval::EMPTY;
        }
        Interval::from_bounds(sqrt_down(real.lower()), sqrt_up(real.upper()))
    }

    /// The absolute values of the numbers in the set. Exact.
    #[inline]
    pub fn abs(self) -> Interval {
        if self.is_empty() {
            return Interval::EMPTY;
        }
        Interval::from_bounds(self.mignitude(), self.magnitude())
    }

    /// The smaller of one number from each set. Exact.
    #[inline]
    pub fn min(self, other: Interval) -> Interval {
        if self.is_empty() || other.is_empty() {
            return Interval::EMPTY;
        }
        Interval::from_bounds(smaller(self.lower(), other.lower()), smaller(self.upper(), other.upper()))
    }

    /// The larger of one number from each set. Exact.
    #[inline]
    pub fn max(self, other: Interval) -> Interval {
        if self.is_empty() || other.is_empty() {
            return Interval::EMPTY;
        }
        Interval::from_bounds(larger(self.lower(), other.lower()), larger(self.upper(), other.upper()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes() {
        let x = Interval::new(-3.0, 2.0).unwrap();
        assert_eq!(x.abs(), Interval::new(0.0, 3.0).unwrap());
        assert_eq!(x.min(Interval::ZERO), Interval::new(-3.0, 0.0).unwrap());
        assert_eq!(x.max(Interval::ZERO), Interval::new(0.0, 2.0).unwrap());
        assert_eq!(Interval::ENTIRE.sqr(), Interval::NON_NEGATIVE);
        assert_eq!(Interval::ENTIRE.sqrt(), Interval::NON_NEGATIVE);
        assert!(Interval::new(-3.0, -2.0).unwrap().sqrt().is_empty());
    }

    #[test]
    fn the_empty_set_stays_empty() {
        let empty = Interval::EMPTY;
        for result in
            [empty.sqr(), empty.sqrt(), empty.abs(), empty.min(Interval::ONE), empty.max(Interval::ONE)]
        {
            assert!(result.is_empty());
        }
    }

    #[test]
    fn a_square_that_underflows_or_overflows_is_still_enclosed() {
        let tiny = Interval::point(1e-200).unwrap().sqr();
        assert_eq!((tiny.lower(), tiny.upper()), (0.0, f64::from_bits(1)));
        let huge = Interval::point(1e200).unwrap().sqr();
        assert_eq!((huge.lower(), huge.upper()), (f64::MAX, f64::INFINITY));
    }
}
