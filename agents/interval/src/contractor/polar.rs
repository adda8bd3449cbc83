//! The minimal contractor between Cartesian and polar coordinates.
//!
//! In one quadrant, the solutions are a rectangle intersected with a sector of a ring. For a fixed `x`, each of the limits
//! of the rectangle, of the sector and of the ring confines `y` to an interval; intervals have a common point when each two
//! of them do, and each two of them do when `x` is on one side of a certain number: the abscissa of the point where the
//! two limits meet. So the possible `x` are an interval that the meeting points bound, and the same holds for `y`, for the
//! range and for the bearing. The contractor takes the bounds of this interval, which is exact, in each quadrant and
//! then their hull.

use super::quadrant::{Piece, visit_quadrants};
use super::{Contracted, Contractor, replace};
use crate::elementary::atan2;
use crate::interval::Interval;
use crate::interval_box::IntervalBox;
use crate::rounding::{
    add_down, add_up, div_down, div_up, mul_down, mul_up, sqrt_down, sqrt_up, sub_down, sub_up,
};
use crate::set::{larger, smaller};

/// Contracts Cartesian and polar coordinates of the same point: `x = range cos(bearing)`, `y = range sin(bearing)`,
/// `range >= 0`.
///
/// Angles are in radians from the `x` axis towards the `y` axis, and any real angle is taken modulo 2π: `[6, 7]` looks
/// along the `x` axis. The origin has range zero and every bearing.
///
/// Minimal: the exact hull, but for a few units in the last place of the lengths and of the bearing. (The printed polar
/// contractor, seed 002 algorithm 5.3, is not: it narrows neither range nor bearing by the other.) Angles beyond 2⁴⁰ rad
/// contract the other three but are themselves left as they are.
///
/// ```
/// use shoal_interval::Interval;
/// use shoal_interval::contractor::{Contracted, contract_polar};
///
/// let (mut x, mut y) = (Interval::new(3.0, 9.0)?, Interval::new(0.0, 4.0)?);
/// let mut range = Interval::new(0.0, 5.0)?;
/// let mut bearing = Interval::new(0.5, 3.0)?;
/// assert_eq!(contract_polar(&mut x, &mut y, &mut range, &mut bearing), Contracted::Narrowed);
/// assert_eq!(format!("{x:.2} {y:.2}"), "[3.00, 4.39] [1.63, 4.00]");
/// assert_eq!(format!("{range:.2} {bearing:.3}"), "[3.41, 5.00] [0.500, 0.928]");
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
///
/// Source: seed 002, equations (5.3) to (5.6), made minimal.
pub fn contract_polar(
    x: &mut Interval,
    y: &mut Interval,
    range: &mut Interval,
    bearing: &mut Interval,
) -> Contracted {
    let before = [*x, *y, *range, *bearing];
    let distance = *range & Interval::NON_NEGATIVE;
    if before.iter().any(|side| side.is_empty()) || distance.is_empty() {
        return replace([x, y, range, bearing], [Interval::EMPTY; 4]);
    }
    let mut hull = [Interval::EMPTY; 4];
    let (lower_is_known, upper_is_known) = visit_quadrants(*bearing, |piece| {
        let (turned_x, turned_y) = piece.turn(before[0], before[1]);
        if turned_x.is_empty() || turned_y.is_empty() {
            return;
        }
        let Some(found) = contract_in_quadrant(turned_x, turned_y, distance, piece) else { return };
        let (found_x, found_y) = piece.turn_back(found.x, found.y);
        let angles = piece.angles(found.from, found.to) & before[3];
        if !angles.is_empty() {
            for (side, part) in hull.iter_mut().zip([found_x, found_y, found.range, angles]) {
                *side = *side | part;
            }
        }
    });
    let [.., angle] = &mut hull;
    if !angle.is_empty() {
        let lower = if lower_is_known { angle.lower() } else { before[3].lower() };
        let upper = if upper_is_known { angle.upper() } else { before[3].upper() };
        *angle = Interval::from_bounds(lower, upper);
    }
    replace([x, y, range, bearing], hull)
}

/// What a quadrant holds.
struct Found {
    x: Interval,
    y: Interval,
    range: Interval,
    /// The angles from the beginning of the quadrant; `None` where the piece itself ends.
    from: Option<f64>,
    to: Option<f64>,
}

/// The hull of the solutions in the first quadrant; `None` when there are none. No argument is empty or negative.
#[inline]
fn contract_in_quadrant(x: Interval, y: Interval, range: Interval, piece: &Piece) -> Option<Found> {
    let (x1, x2, y1, y2) = (x.lower(), x.upper(), y.lower(), y.upper());
    let (r1, r2) = (range.lower(), range.upper());
    let (start, end) = (&piece.start, &piece.end);
    if x1 > r2 || y1 > r2 || (y1 > 0.0 && end.sin_upper == 0.0) {
        return None;
    }

    // Where the limits meet: bounds from below ...
    let mut low = [x1, y1, r1];
    raise(&mut low[2], hypotenuse_down(x1, y1));
    if r1 > 0.0 {
        raise(&mut low[0], mul_down(r1, end.cos_lower));
        raise(&mut low[1], mul_down(r1, start.sin_lower));
        if r1 > y2 {
            raise(&mut low[0], leg_down(r1, y2));
        }
        if r1 > x2 {
            raise(&mut low[1], leg_down(r1, x2));
        }
    }
    if y1 > 0.0 {
        raise(&mut low[0], div_down(mul_down(y1, end.cos_lower), end.sin_upper));
        raise(&mut low[2], div_down(y1, end.sin_upper));
    }
    if x1 > 0.0 {
        raise(&mut low[1], div_down(mul_down(x1, start.sin_lower), start.cos_upper));
        raise(&mut low[2], div_down(x1, start.cos_upper));
    }
    // ... and from above.
    let mut high = [x2, y2, r2];
    reduce(&mut high[2], hypotenuse_up(x2, y2));
    if r2 < f64::INFINITY {
        reduce(&mut high[0], smaller(mul_up(r2, start.cos_upper), leg_up(r2, y1)));
        reduce(&mut high[1], smaller(mul_up(r2, end.sin_upper), leg_up(r2, x1)));
    }
    if y2 < f64::INFINITY && start.sin_lower > 0.0 {
        reduce(&mut high[0], div_up(mul_up(y2, start.cos_upper), start.sin_lower));
        reduce(&mut high[2], div_up(y2, start.sin_lower));
    }
    if x2 < f64::INFINITY && end.cos_lower > 0.0 {
        reduce(&mut high[1], div_up(mul_up(x2, end.sin_upper), end.cos_lower));
        reduce(&mut high[2], div_up(x2, end.cos_lower));
    }
    if end.sin_upper == 0.0 {
        high[1] = 0.0;
    }
    if low.iter().zip(&high).any(|(low, high)| low > high) {
        return None;
    }

    // A bearing is computed only when the piece begins or ends outside of the other three limits.
    let mut from = None;
    if mul_down(r1, start.cos_lower) > x2 {
        raise_angle(&mut from, angle_down(leg_down(r1, x2), x2));
    }
    if y1 > mul_up(r2, start.sin_upper) {
        raise_angle(&mut from, angle_down(y1, leg_up(r2, y1)));
    }
    if mul_down(y1, start.cos_lower) > mul_up(x2, start.sin_upper) {
        raise_angle(&mut from, angle_down(y1, x2));
    }
    let mut to = None;
    if mul_down(r1, end.sin_lower) > y2 {
        reduce_angle(&mut to, angle_up(y2, leg_down(r1, y2)));
    }
    if x1 > mul_up(r2, end.cos_upper) {
        reduce_angle(&mut to, angle_up(leg_up(r2, x1), x1));
    }
    if mul_down(x1, end.sin_lower) > mul_up(y2, end.cos_upper) {
        reduce_angle(&mut to, angle_up(y2, x1));
    }
    let [x, y, range] = std::array::from_fn(|axis| Interval::from_bounds(low[axis], high[axis]));
    Some(Found { x, y, range, from, to })
}

#[inline]
fn raise(bound: &mut f64, candidate: f64) {
    *bound = larger(*bound, candidate);
}

#[inline]
fn reduce(bound: &mut f64, candidate: f64) {
    *bound = smaller(*bound, candidate);
}

fn raise_angle(bound: &mut Option<f64>, candidate: f64) {
    *bound = Some(bound.map_or(candidate, |bound| larger(bound, candidate)));
}

fn reduce_angle(bound: &mut Option<f64>, candidate: f64) {
    *bound = Some(bound.map_or(candidate, |bound| smaller(bound, candidate)));
}

/// `√(a² + b²)` for finite `a` and `b`, rounded down.
#[inline]
fn hypotenuse_down(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 {
        return larger(a, b);
    }
    sqrt_down(add_down(mul_down(a, a), mul_down(b, b)))
}

/// `√(a² + b²)`, rounded up.
#[inline]
fn hypotenuse_up(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 {
        return larger(a, b);
    }
    sqrt_up(add_up(mul_up(a, a), mul_up(b, b)))
}

/// `√(hypotenuse² - leg²)`, rounded down. Squares would lose half of the digits when the two are close.
#[inline]
fn leg_down(hypotenuse: f64, leg: f64) -> f64 {
    sqrt_down(larger(0.0, mul_down(sub_down(hypotenuse, leg), add_down(hypotenuse, leg))))
}

/// `√(hypotenuse² - leg²)`, rounded up.
#[inline]
fn leg_up(hypotenuse: f64, leg: f64) -> f64 {
    sqrt_up(larger(0.0, mul_up(sub_up(hypotenuse, leg), add_up(hypotenuse, leg))))
}

/// The angle of the point `(x, y)` of the first quadrant, rounded down.
fn angle_down(y: f64, x: f64) -> f64 {
    if y == 0.0 { 0.0 } else { atan2::angle_down(y, x) }
}

/// The angle of the point `(x, y)` of the first quadrant, rounded up.
fn angle_up(y: f64, x: f64) -> f64 {
    if y == 0.0 { 0.0 } else { atan2::angle_up(y, x) }
}

/// `x = range cos(bearing)`, `y = range sin(bearing)` over the box of `x`, `y`, `range`, `bearing`, by
/// [`contract_polar`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Polar;

impl Contractor<4> for Polar {
    #[inline]
    fn contract(&self, domain: IntervalBox<4>) -> IntervalBox<4> {
        let [mut x, mut y, mut range, mut bearing] = domain.sides();
        contract_polar(&mut x, &mut y, &mut range, &mut bearing);
        IntervalBox::from([x, y, range, bearing])
    }
}

#[cfg(test)]
mod tests;
