//! An interval of angles, cut into quadrants that are each turned into the first one.
//!
//! Angles are never reduced modulo 2π, which would round: the directions of the two bounds come from their sines and
//! cosines, which are good for an angle of any size, and only whole quarter turns are counted.

use crate::interval::Interval;
use crate::rounding::{add_down, add_up, sub_up};
use pxfm::f_sincos;
use std::f64::consts::FRAC_PI_2;

/// Up to this size, quarter turns are counted; half of the significand is left for the fraction.
const ANGLES_COUNTED: f64 = (1_u64 << 40) as f64;

/// A direction in the first quadrant, its cosine and its sine enclosed; none is negative.
#[derive(Clone, Copy)]
pub(super) struct Ray {
    pub(super) cos_lower: f64,
    pub(super) cos_upper: f64,
    pub(super) sin_lower: f64,
    pub(super) sin_upper: f64,
}

impl Ray {
    /// Where a quadrant begins.
    const FIRST: Ray = Ray { cos_lower: 1.0, cos_upper: 1.0, sin_lower: 0.0, sin_upper: 0.0 };

    /// Where a quadrant ends.
    const LAST: Ray = Ray { cos_lower: 0.0, cos_upper: 0.0, sin_lower: 1.0, sin_upper: 1.0 };

    /// The direction with this cosine and sine, each within half a unit in the last place.
    #[inline]
    fn around(cosine: f64, sine: f64) -> Ray {
        Ray {
            cos_lower: cosine.next_down().max(0.0),
            cos_upper: cosine.next_up().min(1.0),
            sin_lower: sine.next_down().max(0.0),
            sin_upper: sine.next_up().min(1.0),
        }
    }
}

/// The part of an interval of angles that lies in one quadrant, from `start` to `end` counterclockwise, turned into the
/// first quadrant.
pub(super) struct Piece {
    /// Which quadrant it was: 0 for the first, up to 3.
    quadrant: u8,
    pub(super) start: Ray,
    pub(super) end: Ray,
    /// Quarter turns below the quadrant; `None` when the angles are too large to be counted.
    quarters: Option<f64>,
    /// The bounds of the interval, where they are the ends of the piece.
    lower: Option<f64>,
    upper: Option<f64>,
}

impl Piece {
    /// A rectangle, turned like the piece, as far as it is in the first quadrant.
    #[inline]
    pub(super) fn turn(&self, x: Interval, y: Interval) -> (Interval, Interval) {
        let (x, y) = match self.quadrant {
            0 => (x, y),
            1 => (y, -x),
            2 => (-x, -y),
            _ => (-y, x),
        };
        (x & Interval::NON_NEGATIVE, y & Interval::NON_NEGATIVE)
    }

    /// A rectangle of the first quadrant, turned back. Neither side is empty.
    #[inline]
    pub(super) fn turn_back(&self, x: Interval, y: Interval) -> (Interval, Interval) {
        match self.quadrant {
            0 => (x, y),
            1 => (-y, x),
            2 => (-x, -y),
            _ => (y, -x),
        }
    }

    /// The angles of the piece, as far as they are not below `from` nor above `to`, which are measured from the beginning of
    /// the quadrant; `None` leaves an end of the piece where it is. All reals when the angles are too large to be counted.
    #[inline]
    pub(super) fn angles(&self, from: Option<f64>, to: Option<f64>) -> Interval {
        let Some(quarters) = self.quarters else { return Interval::ENTIRE };
        let below = Interval::HALF_PI * Interval::from_bounds(quarters, quarters);
        let lower = match (from, self.lower) {
            (None, Some(bound)) => bound,
            (from, _) => add_down(below.lower(), from.unwrap_or(0.0)),
        };
        let upper = match (to, self.upper) {
            (None, Some(bound)) => bound,
            (to, _) => add_up(below.upper(), to.unwrap_or(Interval::HALF_PI.upper())),
        };
        if lower <= upper { Interval::from_bounds(lower, upper) } else { Interval::EMPTY }
    }
}

/// A bound of an interval of angles.
#[derive(Clone, Copy)]
struct Bound {
    angle: f64,
    quadrant: u8,
    ray: Ray,
    quarters: Option<f64>,
}

impl Bound {
    /// `None` for a bound that is infinite.
    #[inline]
    fn of(angle: f64) -> Option<Bound> {
        if angle == 0.0 {
            return Some(Bound { angle, quadrant: 0, ray: Ray::FIRST, quarters: Some(0.0) });
        }
        if angle.is_infinite() {
            return None;
        }
        // Both are correctly rounded, so their signs are the true ones.
        let (sine, cosine) = f_sincos(angle);
        let (quadrant, ray) = match (cosine > 0.0, sine > 0.0) {
            (true, true) => (0, Ray::around(cosine, sine)),
            (false, true) => (1, Ray::around(sine, -cosine)),
            (false, false) => (2, Ray::around(-cosine, -sine)),
            (true, false) => (3, Ray::around(-sine, cosine)),
        };
        // Only the count of full turns is rounded, and the quotient is much closer to it than half a turn.
        let inside_turn = f64::from(quadrant);
        let turns = ((angle / FRAC_PI_2 - inside_turn - 0.5) / 4.0).round();
        let quarters = (angle.abs() <= ANGLES_COUNTED).then_some(4.0 * turns + inside_turn);
        Some(Bound { angle, quadrant, ray, quarters })
    }
}

/// Calls `visit` with pieces of `angle`, which is not empty: every direction is in a piece, and when the angles can be
/// counted the pieces within a full turn of each bound are among them.
///
/// Returns whether the bounds, the lower and the upper, are such that the [`Piece::angles`] bound them.
#[inline]
pub(super) fn visit_quadrants(angle: Interval, mut visit: impl FnMut(&Piece)) -> (bool, bool) {
    let bounds = (Bound::of(angle.lower()), Bound::of(angle.upper()));
    let counted = |bound: Option<Bound>| bound.and_then(|bound| Some((bound, bound.quarters?)));
    let mut visit_run =
        |first: f64, last: f64, lower: Option<Bound>, upper: Option<Bound>, is_counted: bool| {
            let mut quarters = first;
            while quarters <= last {
                let lower = lower.filter(|_| quarters == first);
                let upper = upper.filter(|_| quarters == last);
                visit(&Piece {
                    // The remainder of a whole number, exact.
                    quadrant: (quarters - 4.0 * (quarters / 4.0).floor()) as u8,
                    start: lower.map_or(Ray::FIRST, |bound| bound.ray),
                    end: upper.map_or(Ray::LAST, |bound| bound.ray),
                    quarters: is_counted.then_some(quarters),
                    lower: lower.map(|bound| bound.angle),
                    upper: upper.map(|bound| bound.angle),
                });
                quarters += 1.0;
            }
        };

    match (counted(bounds.0), counted(bounds.1)) {
        (Some((lower, first)), Some((upper, last))) => {
            if last - first <= 8.0 {
                visit_run(first, last, Some(lower), Some(upper), true);
            } else {
                visit_run(first, first + 4.0, Some(lower), None, true);
                visit_run(last - 4.0, last, None, Some(upper), true);
            }
            (true, true)
        }
        (Some((lower, first)), None) => {
            visit_run(first, first + 4.0, Some(lower), None, true);
            (true, false)
        }
        (None, Some((upper, last))) => {
            visit_run(last - 4.0, last, None, Some(upper), true);
            (false, true)
        }
        (None, None) => {
            match bounds {
                (Some(lower), Some(upper)) if sub_up(angle.upper(), angle.lower()) < 6.0 => {
                    let first = f64::from(lower.quadrant);
                    let ahead = f64::from((upper.quadrant + 4 - lower.quadrant) % 4);
                    // Back in the first quadrant: within it, or nearly a turn further.
                    let wraps = ahead == 0.0 && angle.upper() - angle.lower() > 3.0;
                    let last = first + if wraps { 4.0 } else { ahead };
                    visit_run(first, last, Some(lower), Some(upper), false);
                }
                _ => visit_run(0.0, 3.0, None, None, false),
            }
            (false, false)
        }
    }
}
