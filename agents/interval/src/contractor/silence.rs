//! The contractor for a silent stretch of a ping.

use super::rotation::contract_linear;
use super::{Contractor, Wall};
use crate::interval::Interval;
use crate::interval_box::IntervalBox;
use std::f64::consts::FRAC_PI_2;

/// The positions that a silence does not rule out: a ping that hits a wall at a right angle is always echoed, so where a
/// ping was silent, no wall was hit at a right angle.
///
/// With `h` the distance in front of the wall and `t` the place of the foot of the perpendicular along the wall, from 0 to
/// 1, the positions `0 < t < 1`, `h` inside of the silent stretch, are impossible: an open slanted rectangle in
/// front of the wall. The contractor keeps the four half planes `t <= 0`, `t >= 1`, `h <= d⁻` and `h >= d⁺` and is
/// minimal for them, since a box and a half plane have an exact hull.
///
/// Nothing is ruled out unless *every* direction that the ping may have had is within the tolerance of the perpendicular;
/// an oblique ping may be reflected elsewhere. The tolerance is the angle, half a beam width for instance, up to which the
/// beam still holds the perpendicular and its echo. The wall must be in open view: another wall in between may turn the
/// echo away.
///
/// ```
/// use nalgebra::Vector2;
/// use shoal_interval::contractor::{Contractor, Silence, Wall};
/// use shoal_interval::{Interval, IntervalBox};
///
/// // The wall stands at x = 5; a ping along the x axis was silent from 1 m to 3 m.
/// let wall = Wall::new(Vector2::new(5.0, -10.0), Vector2::new(5.0, 10.0));
/// let silent_m = Interval::new(1.0, 3.0)?;
/// let silence = Silence::new(wall, Interval::new(-0.01, 0.01)?, silent_m, 0.05);
/// let domain = IntervalBox::from([Interval::new(0.0, 3.5)?, Interval::new(-1.0, 1.0)?]);
/// assert_eq!(silence.contract(domain)[0], Interval::new(0.0, 2.0)?);
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
///
/// Source: seed 000, sections 4.2.2 and 4.3.2 (silence contractor).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Silence {
    wall: Wall,
    /// `h` times the length of the wall at both ends of the silence; empty when the ping says nothing.
    near: Interval,
    far: Interval,
}

impl Silence {
    /// A ping in a direction of `bearing` (radians) heard nothing at distances inside of `silent`; `tolerance_rad` is how
    /// far from the perpendicular the echo of a wall is still certain, at most π/2.
    ///
    /// A tolerance that is negative or NaN, and a silence that holds no more than one distance, rule nothing out.
    pub fn new(wall: Wall, bearing: Interval, silent: Interval, tolerance_rad: f64) -> Silence {
        let length = wall.length();
        let faces = faces(wall, bearing, tolerance_rad);
        let silent = if faces { silent } else { Interval::EMPTY };
        let times_length = |bound: f64| match Interval::point(bound) {
            Ok(bound) => bound * length,
            Err(_) => Interval::EMPTY,
        };
        if silent.is_empty() {
            return Silence { wall, near: Interval::ENTIRE, far: Interval::ENTIRE };
        }
        // In front of the wall begins at distance zero.
        Silence { wall, near: times_length(silent.lower().max(0.0)), far: times_length(silent.upper()) }
    }
}

/// Whether every direction of `bearing` looks at the front of the wall within the tolerance of a right angle.
fn faces(wall: Wall, bearing: Interval, tolerance_rad: f64) -> bool {
    let Ok(tolerance) = Interval::new(0.0, tolerance_rad) else { return false };
    if bearing.is_empty() || tolerance.upper() > FRAC_PI_2 {
        return false;
    }
    let (sine, cosine) = bearing.sin_cos();
    let [along_x, along_y] = wall.along().sides();
    // The perpendicular, towards the wall, is its direction turned by -90°.
    let ahead = cosine * along_y - sine * along_x;
    let aside = cosine * along_x + sine * along_y;
    let (tolerance_sine, tolerance_cosine) =
        Interval::from_bounds(tolerance.upper(), tolerance.upper()).sin_cos();
    let room = ahead * tolerance_sine - aside.abs() * tolerance_cosine;
    ahead.lower() > 0.0 && room.lower() >= 0.0
}

impl Contractor<2> for Silence {
    fn contract(&self, domain: IntervalBox<2>) -> IntervalBox<2> {
        if domain.is_empty() {
            return IntervalBox::EMPTY;
        }
        let [along_x, along_y] = self.wall.along().sides();
        let from_start = domain - self.wall.start();
        let keep = |coefficients: [Interval; 2], values: Interval| {
            let (mut kept, mut value) = (from_start, values);
            contract_linear(&mut kept, coefficients, &mut value);
            (kept + self.wall.start()) & domain
        };
        // det(MA, AB) = h |AB| and AM · AB = t |AB|².
        let (height, place) = ([-along_y, along_x], [along_x, along_y]);
        let squared_length = along_x.sqr() + along_y.sqr();
        keep(height, below(self.near))
            | keep(height, above(self.far))
            | keep(place, below(Interval::ZERO))
            | keep(place, above(squared_length))
    }
}

/// All numbers that may be below one of `bound`.
fn below(bound: Interval) -> Interval {
    if bound.is_empty() { bound } else { Interval::from_bounds(f64::NEG_INFINITY, bound.upper()) }
}

/// All numbers that may be above one of `bound`.
fn above(bound: Interval) -> Interval {
    if bound.is_empty() { bound } else { Interval::from_bounds(bound.lower(), f64::INFINITY) }
}

#[cfg(test)]
mod tests;
