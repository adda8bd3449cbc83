//! In which quarter turns the ends of an interval of angles are, and what lies between.
//!
//! Whatever sine, cosine and tangent do - grow, fall, peak, have a pole - they do from one multiple of pi/2 to the next. Pi is
//! irrational, so that no `f64` but zero is at such a multiple, and the quarter of a number is known without doubt from
//! the signs of its sine and cosine, at any size.

use crate::interval::Interval;
use pxfm::f_sincos;
use std::f64::consts::FRAC_2_PI;

/// Angles up to this size have their quarter turns counted by a division.
const COUNTED_TO: f64 = 4_194_304.0;

/// How near a count may be to a whole number before signs decide: the division by pi/2 errs by less than 2^-30.
const DOUBT: f64 = 1.0 / (1 << 28) as f64;

/// This many multiples of pi/2 and more are not told apart: they are every kind of multiple twice.
const EVERY: i64 = 8;

/// A walk along the angles from one end of an interval to the other.
#[derive(Debug, Clone, Copy)]
pub(super) struct QuarterTurns {
    /// The quarter turn of the lower end: the angle is in `[start, start + 1)` times pi/2, modulo a full turn.
    start: i64,
    /// How many multiples of pi/2 are passed: above the lower end, and not above the upper end. At most [`EVERY`].
    passed: i64,
}

impl QuarterTurns {
    /// The walk through a bounded set of angles in radians, by a division; nothing when that leaves a doubt.
    #[inline]
    pub(super) fn counted(angles: Interval) -> Option<QuarterTurns> {
        let (start, end) = (counted(angles.lower())?, counted(angles.upper())?);
        Some(QuarterTurns { start, passed: (end - start).min(EVERY) })
    }

    /// The walk through a bounded set of angles in radians, whose sines and cosines at both ends are given.
    ///
    /// The ends tell how many multiples are passed up to full turns, and the width, which differs by less than one quarter
    /// turn from that many, how many full turns.
    pub(super) fn from_signs(angles: Interval, at_lower: (f64, f64), at_upper: (f64, f64)) -> QuarterTurns {
        let width = (angles.upper() - angles.lower()) * FRAC_2_PI;
        if width > (EVERY + 1) as f64 {
            return QuarterTurns { start: 0, passed: EVERY };
        }
        let (start, end) = (quarter(at_lower), quarter(at_upper));
        let beyond_full_turns = (end - start) & 3;
        let full_turns = ((width - beyond_full_turns as f64) / 4.0).round_ties_even() as i64;
        QuarterTurns { start, passed: (beyond_full_turns + 4 * full_turns).min(EVERY) }
    }

    /// The walk through a bounded set of angles in radians.
    #[inline]
    pub(super) fn through(angles: Interval) -> QuarterTurns {
        match QuarterTurns::counted(angles) {
            Some(turns) => turns,
            None => QuarterTurns::from_signs(angles, f_sincos(angles.lower()), f_sincos(angles.upper())),
        }
    }

    /// Whether a multiple `4 n + remainder` of pi/2 is passed, for any `n`.
    #[inline]
    pub(super) fn pass(self, remainder: i64) -> bool {
        ((remainder - self.start - 1) & 3) < self.passed
    }

    /// Whether an odd multiple of pi/2 is passed.
    #[inline]
    pub(super) fn pass_odd(self) -> bool {
        (self.start & 1) < self.passed
    }

    /// Whether more than a full turn is passed for certain.
    #[inline]
    pub(super) fn pass_more_than_a_turn(self) -> bool {
        self.passed > 4
    }
}

/// How many whole times pi/2 is in an angle, when the division leaves no doubt.
#[inline]
fn counted(angle: f64) -> Option<i64> {
    if angle.abs() > COUNTED_TO {
        return None;
    }
    let quarters = angle * FRAC_2_PI;
    // Adding and subtracting 1.5 * 2^52 rounds to a whole number.
    const ROUNDER: f64 = 6_755_399_441_055_744.0;
    let whole = (quarters - 0.5 + ROUNDER) - ROUNDER;
    let rest = quarters - whole;
    if (DOUBT..=1.0 - DOUBT).contains(&rest) {
        Some(whole as i64)
    } else if angle == 0.0 {
        Some(0)
    } else {
        None
    }
}

/// The quarter turn of an angle, modulo four, from its sine and cosine, which are never rounded past zero.
fn quarter((sine, cosine): (f64, f64)) -> i64 {
    if sine >= 0.0 && cosine > 0.0 {
        0
    } else if sine > 0.0 {
        1
    } else if cosine < 0.0 {
        2
    } else {
        3
    }
}

#[cfg(test)]
mod tests;
