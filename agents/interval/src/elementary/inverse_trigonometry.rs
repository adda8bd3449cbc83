//! Inverse sine, cosine and tangent, rounded outwards.

use super::outward::{above, below};
use crate::interval::Interval;
use pxfm::{f_acos, f_asin, f_atan};

/// Where inverse sine and cosine are defined.
const SINES: Interval = Interval::from_bounds(-1.0, 1.0);

impl Interval {
    /// The angles in `[-pi/2, pi/2]`, in radians, whose sine is in the set; empty when no number in the set is a sine.
    ///
    /// Every bound is at most one unit in the last place from the tightest; `asin 0 = 0` is exact.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// assert_eq!(Interval::new(0.0, 3.0)?.asin(), Interval::new(0.0, Interval::HALF_PI.upper())?);
    /// assert!(Interval::new(2.0, 3.0)?.asin().is_empty());
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: IEEE 1788-2015, table 9.1.
    #[inline]
    pub fn asin(self) -> Interval {
        let sines = self.intersection(SINES);
        if sines.is_empty() {
            return Interval::EMPTY;
        }
        Interval::from_bounds(-asin_up(-sines.lower()), asin_up(sines.upper()))
    }

    /// The angles in `[0, pi]`, in radians, whose cosine is in the set; empty when no number in the set is a cosine.
    ///
    /// Every bound is at most one unit in the last place from the tightest; `acos 1 = 0` is exact.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// assert_eq!(Interval::new(0.0, 3.0)?.acos(), Interval::new(0.0, Interval::HALF_PI.upper())?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: IEEE 1788-2015, table 9.1.
    #[inline]
    pub fn acos(self) -> Interval {
        let cosines = self.intersection(SINES);
        if cosines.is_empty() {
            return Interval::EMPTY;
        }
        let lower = if cosines.upper() == 1.0 { 0.0 } else { below(f_acos(cosines.upper()), 0.0) };
        let upper = if cosines.lower() == 1.0 { 0.0 } else { f_acos(cosines.lower()).next_up() };
        Interval::from_bounds(lower, upper)
    }

    /// The angles in `(-pi/2, pi/2)`, in radians, whose tangent is in the set.
    ///
    /// Every bound is at most one unit in the last place from the tightest; `atan 0 = 0` is exact.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let angle = Interval::new(0.0, f64::INFINITY)?.atan();
    /// assert_eq!(angle, Interval::new(0.0, Interval::HALF_PI.upper())?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: IEEE 1788-2015, table 9.1.
    #[inline]
    pub fn atan(self) -> Interval {
        if self.is_empty() {
            return Interval::EMPTY;
        }
        Interval::from_bounds(-atan_up(-self.lower()), atan_up(self.upper()))
    }
}

#[inline]
fn asin_up(sine: f64) -> f64 {
    if sine == 0.0 { 0.0 } else { above(f_asin(sine), Interval::HALF_PI.upper()) }
}

#[inline]
fn atan_up(tangent: f64) -> f64 {
    if tangent == 0.0 { 0.0 } else { above(f_atan(tangent), Interval::HALF_PI.upper()) }
}

#[cfg(test)]
mod tests;
