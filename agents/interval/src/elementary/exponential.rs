//! Exponential and natural logarithm.

use super::outward::{above, below};
use crate::interval::Interval;
use pxfm::{f_exp, f_log};

impl Interval {
    /// The exponentials of the numbers in the set.
    ///
    /// Every bound is at most one unit in the last place from the tightest; `exp 0 = 1` is exact, and no lower bound is
    /// negative. What overflows has the largest number as lower bound and no upper bound.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let x = Interval::new(0.0, 1.0)?.exp();
    /// assert_eq!(x.lower(), 1.0);
    /// assert!(x.contains(std::f64::consts::E) && x.upper() < 2.718281828459046);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: IEEE 1788-2015, table 9.1.
    #[inline]
    pub fn exp(self) -> Interval {
        if self.is_empty() {
            return Interval::EMPTY;
        }
        let (from, to) = (self.lower(), self.upper());
        let lower = if from == 0.0 { 1.0 } else { below(f_exp(from), 0.0) };
        let upper = match to {
            0.0 => 1.0,
            f64::INFINITY => to,
            _ => f_exp(to).next_up(),
        };
        Interval::from_bounds(lower, upper)
    }

    /// The natural logarithms of the positive numbers in the set; empty when there is none.
    ///
    /// Every bound is at most one unit in the last place from the tightest; `ln 1 = 0` is exact.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// assert_eq!(Interval::new(-3.0, 1.0)?.ln(), Interval::new(f64::NEG_INFINITY, 0.0)?);
    /// assert!(Interval::new(-3.0, 0.0)?.ln().is_empty());
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: IEEE 1788-2015, table 9.1 (log).
    #[inline]
    pub fn ln(self) -> Interval {
        // Also true of the empty set.
        if self.upper() <= 0.0 {
            return Interval::EMPTY;
        }
        let (from, to) = (self.lower(), self.upper());
        let lower = if from <= 0.0 {
            f64::NEG_INFINITY
        } else if from == 1.0 {
            0.0
        } else {
            f_log(from).next_down()
        };
        let upper = match to {
            1.0 => 0.0,
            f64::INFINITY => to,
            _ => above(f_log(to), f64::INFINITY),
        };
        Interval::from_bounds(lower, upper)
    }
}
