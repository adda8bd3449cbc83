//! Exponential and natural logarithm.

use super::scaled::Scaled;
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
        let lower = match from {
            0.0 => 1.0,
            _ if from < SUBNORMAL_BELOW => {
                subnormal_exponential(from).map_or(0.0, |value| value.rounded_down())
            }
            _ => f_exp(from).next_down(),
        };
        let upper = match to {
            0.0 => 1.0,
            f64::INFINITY => to,
            _ if to < SUBNORMAL_BELOW => {
                subnormal_exponential(to).map_or(f64::from_bits(1), |value| value.rounded_up())
            }
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
            _ => f_log(to).next_up(),
        };
        Interval::from_bounds(lower, upper)
    }
}

/// The exponential of a smaller number may be subnormal: there `f_exp` of `pxfm` 0.1 is now and then wrong by far.
const SUBNORMAL_BELOW: f64 = -708.0;

/// The exponential of a number below [`SUBNORMAL_BELOW`]; nothing when it is between zero and the smallest `f64`.
#[cold]
fn subnormal_exponential(x: f64) -> Option<Scaled> {
    if x < -746.0 {
        return None;
    }
    /// The exponential of -64.
    const FACTOR: Scaled = Scaled::near(1.588_337_373_481_681_2, -7.290_303_386_903_233e-17, -93);
    // The sum is exact: it has the last bit of `x` and fewer leading ones.
    let normal = Scaled::exact(f_exp(x + 64.0));
    // Half a unit in the last place of `f_exp`, with some reserve.
    Some(normal.times(FACTOR).with_tolerance(2.1 / (1_u64 << 53) as f64))
}
