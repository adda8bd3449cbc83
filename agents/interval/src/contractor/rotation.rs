//! Contractors for rotated vectors.

use super::{Contracted, Contractor, Modulo, contract_atan2, contract_distance, from_fn};
use crate::interval::Interval;
use crate::interval_box::IntervalBox;

/// Contracts a vector of the plane, an angle and the turned vector, linked by `rotated = R(angle) vector`:
///
/// `x' = x cos(angle) - y sin(angle)`, `y' = x sin(angle) + y cos(angle)`, in radians, any angle.
///
/// One pass over the four linear equations of `R` and of its inverse, over the equality of the two lengths, and over the
/// angle between the two vectors. Loses no solution; not minimal, because the coordinates appear more than once.
///
/// ```
/// use shoal_interval::contractor::contract_rotation;
/// use shoal_interval::{Interval, IntervalBox};
///
/// let mut body = IntervalBox::from([Interval::new(1.0, 1.1)?, Interval::ZERO]);
/// let mut heading = Interval::new(0.0, 3.0)?;
/// let mut world = IntervalBox::from([Interval::new(0.5, 0.6)?, Interval::new(-9.0, 9.0)?]);
/// contract_rotation(&mut body, &mut heading, &mut world);
/// assert!(heading.contains(1.0) && heading.width() < 0.2);
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
///
/// Source: seed 001, equation (4.47), in the plane.
pub fn contract_rotation(
    vector: &mut IntervalBox<2>,
    angle: &mut Interval,
    rotated: &mut IntervalBox<2>,
) -> Contracted {
    let before = (*vector, *angle, *rotated);
    if vector.is_empty() || angle.is_empty() || rotated.is_empty() {
        return empty(vector, angle, rotated);
    }
    let (sine, cosine) = angle.sin_cos();
    turn(vector, rotated, sine, cosine);
    turn(rotated, vector, -sine, cosine);

    let mut origin = IntervalBox::from([Interval::ZERO; 2]);
    let mut length = Interval::NON_NEGATIVE;
    contract_distance(vector, &mut origin, &mut length);
    contract_distance(rotated, &mut origin, &mut length);
    contract_distance(vector, &mut origin, &mut length);
    if vector.is_empty() || rotated.is_empty() {
        return empty(vector, angle, rotated);
    }
    *angle = congruent(*angle, direction(*rotated) - direction(*vector));
    if angle.is_empty() {
        return empty(vector, angle, rotated);
    }
    Contracted::from_flags(false, (*vector, *angle, *rotated) != before)
}

fn empty(vector: &mut IntervalBox<2>, angle: &mut Interval, rotated: &mut IntervalBox<2>) -> Contracted {
    (*vector, *angle, *rotated) = (IntervalBox::EMPTY, Interval::EMPTY, IntervalBox::EMPTY);
    Contracted::Empty
}

/// Contracts `to = R from` by its two equations, both ways.
fn turn(from: &mut IntervalBox<2>, to: &mut IntervalBox<2>, sine: Interval, cosine: Interval) {
    contract_linear(from, [cosine, -sine], &mut to[0]);
    contract_linear(from, [sine, cosine], &mut to[1]);
}

/// Contracts `value = coefficients · vector`.
pub(super) fn contract_linear(
    vector: &mut IntervalBox<2>,
    coefficients: [Interval; 2],
    value: &mut Interval,
) {
    let terms = [coefficients[0] * vector[0], coefficients[1] * vector[1]];
    *value = *value & (terms[0] + terms[1]);
    vector[0] = coefficients[0].mul_rev(*value - terms[1], vector[0]);
    vector[1] = coefficients[1].mul_rev(*value - terms[0], vector[1]);
}

/// An interval that holds the directions of all vectors of a box. Of two that start at different angles, the narrower.
fn direction(vector: IntervalBox<2>) -> Interval {
    let from = |start: Interval| {
        let ([mut x, mut y], mut angle) = (vector.sides(), start);
        contract_atan2(&mut x, &mut y, &mut angle);
        angle
    };
    let half_turn = Interval::PI.upper();
    let across_x = from(Interval::from_bounds(-half_turn, half_turn));
    let across_negative_x = from(Interval::from_bounds(0.0, 2.0 * half_turn));
    if across_x.width() <= across_negative_x.width() { across_x } else { across_negative_x }
}

/// The numbers of `angle` that differ from one of `other` by whole turns.
fn congruent(angle: Interval, other: Interval) -> Interval {
    let turn = Interval::TWO_PI;
    let same: Modulo<_> = from_fn(move |x: IntervalBox<1>| x & IntervalBox::from([other])).modulo(0, turn);
    same.contract(IntervalBox::from([angle]))[0]
}

/// Contracts a vector of space, three Euler angles and the turned vector, linked by
/// `rotated = Rz(yaw) Ry(pitch) Rx(roll) vector`.
///
/// `angles` are yaw, pitch and roll in radians. The three rotations are contracted in turn, forwards and backwards, each by
/// [`contract_rotation`] in its plane. Loses no solution; not minimal.
///
/// ```
/// use shoal_interval::contractor::contract_euler_rotation;
/// use shoal_interval::{Interval, IntervalBox};
///
/// let mut body = IntervalBox::from([Interval::ONE, Interval::ZERO, Interval::ZERO]);
/// let mut angles = [Interval::new(0.0, 0.1)?, Interval::new(0.0, 0.2)?, Interval::ENTIRE];
/// let mut world = IntervalBox::ENTIRE;
/// contract_euler_rotation(&mut body, &mut angles, &mut world);
/// assert_eq!(format!("{world:.2}"), "[0.97, 1.00] x [0.00, 0.10] x [-0.20, 0.00]");
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
///
/// Source: seed 001, equation (4.47).
pub fn contract_euler_rotation(
    vector: &mut IntervalBox<3>,
    angles: &mut [Interval; 3],
    rotated: &mut IntervalBox<3>,
) -> Contracted {
    let before = (*vector, *angles, *rotated);
    let [yaw, pitch, roll] = angles;
    // Each plane lists its axes in the order in which a positive angle turns.
    let (mut rolled, mut pitched) = (IntervalBox::ENTIRE, IntervalBox::ENTIRE);
    contract_in_plane(vector, roll, &mut rolled, [1, 2]);
    contract_in_plane(&mut rolled, pitch, &mut pitched, [2, 0]);
    contract_in_plane(&mut pitched, yaw, rotated, [0, 1]);
    contract_in_plane(&mut rolled, pitch, &mut pitched, [2, 0]);
    contract_in_plane(vector, roll, &mut rolled, [1, 2]);
    if [&*vector, &rolled, &pitched, &*rotated].into_iter().any(IntervalBox::is_empty)
        || angles.iter().any(|angle| angle.is_empty())
    {
        (*vector, *angles, *rotated) = (IntervalBox::EMPTY, [Interval::EMPTY; 3], IntervalBox::EMPTY);
        return Contracted::Empty;
    }
    Contracted::from_flags(false, (*vector, *angles, *rotated) != before)
}

/// Turns two axes; the third stays as it is.
fn contract_in_plane(
    vector: &mut IntervalBox<3>,
    angle: &mut Interval,
    rotated: &mut IntervalBox<3>,
    plane: [usize; 2],
) {
    let mut flat = IntervalBox::from(plane.map(|axis| vector[axis]));
    let mut turned = IntervalBox::from(plane.map(|axis| rotated[axis]));
    contract_rotation(&mut flat, angle, &mut turned);
    for (place, axis) in plane.into_iter().enumerate() {
        (vector[axis], rotated[axis]) = (flat[place], turned[place]);
    }
    let still = 3 - plane[0] - plane[1];
    let common = vector[still] & rotated[still];
    (vector[still], rotated[still]) = (common, common);
}

/// `(x', y') = R(angle) (x, y)` over the box of `x`, `y`, `angle`, `x'`, `y'`, by [`contract_rotation`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Rotation;

impl Contractor<5> for Rotation {
    fn contract(&self, domain: IntervalBox<5>) -> IntervalBox<5> {
        let [x, y, mut angle, turned_x, turned_y] = domain.sides();
        let (mut vector, mut rotated) = (IntervalBox::from([x, y]), IntervalBox::from([turned_x, turned_y]));
        contract_rotation(&mut vector, &mut angle, &mut rotated);
        IntervalBox::from([vector[0], vector[1], angle, rotated[0], rotated[1]])
    }
}

#[cfg(test)]
mod tests;
