//! Sine, cosine and tangent, rounded outwards.

use super::outward::{above, below};
use super::quarter_turns::QuarterTurns;
use crate::interval::Interval;
use crate::set::{larger, smaller};
use pxfm::{f_cos, f_sin, f_sincos, f_tan};

/// Every value of a sine or a cosine.
const ALL_VALUES: Interval = Interval::from_bounds(-1.0, 1.0);

impl Interval {
    /// The sines of the angles in the set, in radians.
    ///
    /// Every bound is at most one unit in the last place from the tightest, however large the angles; a peak in the set
    /// gives exactly 1 or -1, and `sin 0 = 0` is exact.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let sine = Interval::new(0.0, 2.0)?.sin();
    /// assert_eq!(sine, Interval::new(0.0, 1.0)?);
    /// let far = Interval::point(1e22)?.sin();
    /// assert!(far.contains(-0.8522008497671888) && far.width() < 3e-16);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: IEEE 1788-2015, table 9.1.
    #[inline]
    pub fn sin(self) -> Interval {
        if self.is_empty() {
            return Interval::EMPTY;
        }
        if !self.is_bounded() {
            return ALL_VALUES;
        }
        let Some(turns) = QuarterTurns::counted(self) else {
            return sines_and_cosines_by_signs(self).0;
        };
        let (up, down) = (turns.pass(1), turns.pass(3));
        if up && down {
            return ALL_VALUES;
        }
        let at_lower = sine_of_end(f_sin(self.lower()));
        let at_upper = if self.is_point() { at_lower } else { sine_of_end(f_sin(self.upper())) };
        between(at_lower, at_upper, up, down)
    }

    /// The cosines of the angles in the set, in radians. Guarantees as for [`Interval::sin`]; `cos 0 = 1` is exact.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let cosine = Interval::new(-1.0, 4.0)?.cos();
    /// assert_eq!(cosine, Interval::new(-1.0, 1.0)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: IEEE 1788-2015, table 9.1.
    #[inline]
    pub fn cos(self) -> Interval {
        if self.is_empty() {
            return Interval::EMPTY;
        }
        if !self.is_bounded() {
            return ALL_VALUES;
        }
        let Some(turns) = QuarterTurns::counted(self) else {
            return sines_and_cosines_by_signs(self).1;
        };
        let (up, down) = (turns.pass(0), turns.pass(2));
        if up && down {
            return ALL_VALUES;
        }
        let (from, to) = (self.lower(), self.upper());
        let at_lower = cosine_of_end(from, f_cos(from));
        let at_upper = if self.is_point() { at_lower } else { cosine_of_end(to, f_cos(to)) };
        between(at_lower, at_upper, up, down)
    }

    /// The sines and the cosines, in this order: the same as [`Interval::sin`] and [`Interval::cos`], in less time.
    #[inline]
    pub fn sin_cos(self) -> (Interval, Interval) {
        if self.is_empty() {
            return (Interval::EMPTY, Interval::EMPTY);
        }
        if !self.is_bounded() {
            return (ALL_VALUES, ALL_VALUES);
        }
        let Some(turns) = QuarterTurns::counted(self) else {
            return sines_and_cosines_by_signs(self);
        };
        if turns.pass_more_than_a_turn() {
            return (ALL_VALUES, ALL_VALUES);
        }
        let at_lower = f_sincos(self.lower());
        let at_upper = if self.is_point() { at_lower } else { f_sincos(self.upper()) };
        sines_and_cosines(self, turns, at_lower, at_upper)
    }

    /// The tangents of the angles in the set, in radians; [`Interval::ENTIRE`] when a pole, an odd multiple of pi/2, is
    /// inside.
    ///
    /// Every bound is at most one unit in the last place from the tightest, however large the angles; `tan 0 = 0` is
    /// exact.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let tangent = Interval::new(0.0, 1.0)?.tan();
    /// assert!(tangent.lower() == 0.0 && tangent.contains(1.557407724654902));
    /// assert_eq!(Interval::new(1.0, 2.0)?.tan(), Interval::ENTIRE);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: IEEE 1788-2015, table 9.1.
    #[inline]
    pub fn tan(self) -> Interval {
        if self.is_empty() {
            return Interval::EMPTY;
        }
        if !self.is_bounded() || QuarterTurns::through(self).pass_odd() {
            return Interval::ENTIRE;
        }
        let (from, to) = (self.lower(), self.upper());
        let lower = if from == 0.0 { 0.0 } else { f_tan(from).next_down() };
        let upper = if to == 0.0 { 0.0 } else { f_tan(to).next_up() };
        Interval::from_bounds(lower, upper)
    }
}

/// The sines and the cosines of a bounded set of angles that are large, or close to a multiple of pi/2.
#[cold]
fn sines_and_cosines_by_signs(angles: Interval) -> (Interval, Interval) {
    let (at_lower, at_upper) = (f_sincos(angles.lower()), f_sincos(angles.upper()));
    let turns = QuarterTurns::from_signs(angles, at_lower, at_upper);
    sines_and_cosines(angles, turns, at_lower, at_upper)
}

#[inline]
fn sines_and_cosines(
    angles: Interval,
    turns: QuarterTurns,
    at_lower: (f64, f64),
    at_upper: (f64, f64),
) -> (Interval, Interval) {
    let at_ends = (sine_of_end(at_lower.0), sine_of_end(at_upper.0));
    let sines = between(at_ends.0, at_ends.1, turns.pass(1), turns.pass(3));
    let at_ends = (cosine_of_end(angles.lower(), at_lower.1), cosine_of_end(angles.upper(), at_upper.1));
    (sines, between(at_ends.0, at_ends.1, turns.pass(0), turns.pass(2)))
}

/// The values between two ends, and the peaks that are passed from one to the other.
#[inline]
fn between(one: Interval, other: Interval, up: bool, down: bool) -> Interval {
    let lower = if down { -1.0 } else { smaller(one.lower(), other.lower()) };
    let upper = if up { 1.0 } else { larger(one.upper(), other.upper()) };
    Interval::from_bounds(lower, upper)
}

/// What is around a sine: only that of zero is zero.
#[inline]
fn sine_of_end(nearest: f64) -> Interval {
    if nearest == 0.0 { Interval::ZERO } else { around(nearest) }
}

#[inline]
fn cosine_of_end(angle: f64, nearest: f64) -> Interval {
    if angle == 0.0 { Interval::ONE } else { around(nearest) }
}

/// A value and its two neighbours, which hold the exact one, but no more than a sine or cosine can be.
#[inline]
fn around(nearest: f64) -> Interval {
    Interval::from_bounds(below(nearest, -1.0), above(nearest, 1.0))
}

#[cfg(test)]
mod tests;
