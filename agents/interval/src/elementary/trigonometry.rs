//! Sine and cosine, rounded outwards.

use crate::interval::Interval;
use pxfm::{f_cos, f_sin};
use std::f64::consts::PI;

/// Beyond this many half turns the bounds are no longer followed: the answer is `[-1, 1]`.
const HALF_TURNS_FOLLOWED: f64 = (1_u64 << 40) as f64;

impl Interval {
    /// The sines of the angles in the set, in radians.
    ///
    /// Every bound is at most two units in the last place from the exact one, except within that distance of a peak,
    /// where the peak itself is returned. Angles beyond 2^40 half turns give `[-1, 1]`.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let sine = Interval::new(0.0, 2.0)?.sin();
    /// assert_eq!(sine, Interval::new(0.0, 1.0)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub fn sin(self) -> Interval {
        if self.is_empty() {
            return Interval::EMPTY;
        }
        let peaks = Peaks::among(self / half_turn() - Interval::from_bounds(0.5, 0.5));
        peaks.enclose(sine_of(self.lower()), sine_of(self.upper()))
    }

    /// The cosines of the angles in the set, in radians. Guarantees as for [`Interval::sin`].
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let cosine = Interval::new(-1.0, 4.0)?.cos();
    /// assert_eq!(cosine, Interval::new(-1.0, 1.0)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub fn cos(self) -> Interval {
        if self.is_empty() {
            return Interval::EMPTY;
        }
        let peaks = Peaks::among(self / half_turn());
        peaks.enclose(cosine_of(self.lower()), cosine_of(self.upper()))
    }

    /// The sines and the cosines, in this order.
    #[inline]
    pub fn sin_cos(self) -> (Interval, Interval) {
        (self.sin(), self.cos())
    }
}

/// Which peaks of the cosine an interval may hold: the interval is in half turns, the peaks are its integers, even ones
/// up and odd ones down. Between two peaks the cosine is monotonic, so the ends of the interval tell the rest.
struct Peaks {
    up: bool,
    down: bool,
}

impl Peaks {
    fn among(half_turns: Interval) -> Peaks {
        let (from, to) = (half_turns.lower(), half_turns.upper());
        if half_turns.magnitude() > HALF_TURNS_FOLLOWED {
            return Peaks { up: true, down: true };
        }
        // `from - 1` may be rounded, but never past an integer.
        let first_even = 2.0 * (from / 2.0).ceil();
        let first_odd = 2.0 * ((from - 1.0) / 2.0).ceil() + 1.0;
        Peaks { up: first_even <= to, down: first_odd <= to }
    }

    fn enclose(&self, at_lower: Interval, at_upper: Interval) -> Interval {
        let ends = at_lower.hull(at_upper);
        let lower = if self.down { -1.0 } else { ends.lower() };
        let upper = if self.up { 1.0 } else { ends.upper() };
        Interval::from_bounds(lower, upper)
    }
}

/// The number pi, between two neighbouring `f64`.
fn half_turn() -> Interval {
    Interval::from_bounds(PI, PI.next_up())
}

fn sine_of(angle_rad: f64) -> Interval {
    if angle_rad == 0.0 { Interval::ZERO } else { around(f_sin(angle_rad)) }
}

fn cosine_of(angle_rad: f64) -> Interval {
    if angle_rad == 0.0 { Interval::ONE } else { around(f_cos(angle_rad)) }
}

/// The value and its two neighbours, which hold the exact one: `pxfm` is within half a unit in the last place. The sine of
/// an infinite angle is NaN, and then every value is possible.
fn around(value: f64) -> Interval {
    if value.is_nan() {
        return Interval::from_bounds(-1.0, 1.0);
    }
    Interval::from_bounds(value.next_down().max(-1.0), value.next_up().min(1.0))
}

#[cfg(test)]
mod tests;
