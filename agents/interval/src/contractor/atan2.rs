//! The minimal contractor for `angle = atan2(y, x)`, and its construction from one octant by symmetries.

use super::{BoxBijection, Contracted, Contractor, Permutation, Symmetry, contract_polar};
use crate::interval::Interval;
use crate::interval_box::IntervalBox;

/// Contracts three intervals linked by `angle = atan2(y, x)`, modulo 2π: there is an `l >= 0` with `x = l cos(angle)` and
/// `y = l sin(angle)`.
///
/// In radians from the `x` axis towards the `y` axis; any interval of angles will do, `[6, 7]` is a sector around the `x`
/// axis. The constraint is the closed one of seed 001, equation (3.14): `l = 0` is allowed, so the origin has *every*
/// angle.
///
/// Minimal, but for a few units in the last place of the coordinates and of the angle, by [`contract_polar`] with a free
/// range. [`Atan2Seed::spread`] builds the same contractor from one octant.
///
/// ```
/// use shoal_interval::Interval;
/// use shoal_interval::contractor::contract_atan2;
///
/// let (mut x, mut y) = (Interval::new(1.0, 4.0)?, Interval::new(-9.0, 2.0)?);
/// let mut angle = Interval::new(6.0, 7.0)?;
/// contract_atan2(&mut x, &mut y, &mut angle);
/// assert_eq!(format!("{x:.2} {y:.2} {angle:.2}"), "[1.00, 4.00] [-1.17, 2.00] [6.00, 7.00]");
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
///
/// Source: seed 001, section 3.4. Its table 3.1 intersects the angles of the four quadrants where they must be united, and
/// mirrors two of them with the wrong sign.
#[inline]
pub fn contract_atan2(x: &mut Interval, y: &mut Interval, angle: &mut Interval) -> Contracted {
    let mut range = Interval::NON_NEGATIVE;
    contract_polar(x, y, &mut range, angle)
}

/// `angle = atan2(y, x)` over the box of `x`, `y`, `angle`, by [`contract_atan2`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Atan2;

impl Contractor<3> for Atan2 {
    #[inline]
    fn contract(&self, domain: IntervalBox<3>) -> IntervalBox<3> {
        let [mut x, mut y, mut angle] = domain.sides();
        contract_atan2(&mut x, &mut y, &mut angle);
        IntervalBox::from([x, y, angle])
    }
}

/// `angle = atan2(y, x)` in the octant `0 <= angle <= π/4` only, over the box of `x`, `y`, `angle`. Minimal.
///
/// There, the tangent and its inverse grow from 0 to 1, so that the constraint is the product `y = x tan(angle)` and has
/// none of the poles and jumps of the whole plane. [`Atan2Seed::spread`] makes the rest of the plane from it.
///
/// Source: seed 002, section 5.3.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Atan2Seed;

impl Atan2Seed {
    /// The contractor for the whole plane and any angle: the seed, mirrored at the diagonal, at the `x` axis and at the
    /// `y` axis, each time united with its mirror image, and repeated modulo 2π.
    ///
    /// [`contract_atan2`] does the same faster; this is how such a contractor is made.
    ///
    /// ```
    /// use shoal_interval::contractor::{Atan2Seed, Contractor};
    /// use shoal_interval::{Interval, IntervalBox};
    ///
    /// let atan2 = Atan2Seed.spread();
    /// let domain = [Interval::new(-4.0, -1.0)?, Interval::new(1.0, 9.0)?, Interval::new(2.0, 2.5)?];
    /// let contracted = atan2.contract(IntervalBox::from(domain));
    /// assert_eq!(format!("{contracted:.2}"), "[-4.00, -1.00] x [1.00, 8.75] x [2.00, 2.50]");
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: seed 001, section 3.4, equations (3.20) to (3.29).
    pub fn spread(self) -> impl Contractor<3> + Copy {
        let half_of_quarter = Interval::QUARTER_PI;
        let in_diagonal = Permutation::swapping(0, 1).followed_by(Symmetry::axial(2, half_of_quarter));
        let quadrant = self.union(self.transformed(in_diagonal));
        let half_plane = quadrant.union(quadrant.transformed(Symmetry::negating([false, true, true])));
        let in_y_axis =
            Symmetry::axial(2, Interval::HALF_PI).followed_by(Symmetry::negating([true, false, false]));
        let plane = half_plane.union(half_plane.transformed(in_y_axis));
        plane.modulo(2, Interval::TWO_PI)
    }
}

impl Contractor<3> for Atan2Seed {
    fn contract(&self, domain: IntervalBox<3>) -> IntervalBox<3> {
        let octant = Interval::from_bounds(0.0, Interval::QUARTER_PI.upper());
        let domain = domain & IntervalBox::from([Interval::NON_NEGATIVE, Interval::NON_NEGATIVE, octant]);
        if domain.is_empty() {
            return IntervalBox::EMPTY;
        }
        let [mut x, mut y, mut angle] = domain.sides();
        let slope = angle.tan() & Interval::from_bounds(0.0, 1.0);
        let possible_slope = x.mul_rev(y, slope);
        [x, y] = [slope.mul_rev(y, x), y & (x * slope)];
        if possible_slope.is_empty() {
            return IntervalBox::EMPTY;
        }
        // A slope that was not narrowed says nothing about the angle that it was computed from.
        let possible_angle = possible_slope.atan();
        if possible_slope.lower() > slope.lower() {
            angle = angle & Interval::from_bounds(possible_angle.lower(), f64::INFINITY);
        }
        if possible_slope.upper() < slope.upper() {
            angle = angle & Interval::from_bounds(f64::NEG_INFINITY, possible_angle.upper());
        }
        IntervalBox::from([x, y, angle]) & domain
    }
}

#[cfg(test)]
mod tests;
