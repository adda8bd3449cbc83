//! A wall that a rangefinder may see: what it returns from a box of positions.

use super::contract_polar;
use super::rotation::contract_linear;
use crate::interval::Interval;
use crate::interval_box::IntervalBox;
use nalgebra::Vector2;

/// A straight wall from `a` to `b`, in metres. It is seen from its left side only, where `b` is counterclockwise of `a`; from
/// the other side it is transparent.
///
/// A wall with two sides is two walls, one each way.
///
/// Source: seed 000, section 4.3.1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wall {
    a: Vector2<f64>,
    b: Vector2<f64>,
}

impl Wall {
    /// The wall from `a` to `b`. A coordinate that is NaN or infinite stands for one of which nothing is known.
    pub fn new(a: Vector2<f64>, b: Vector2<f64>) -> Wall {
        Wall { a, b }
    }

    /// The same wall, seen from its other side.
    pub fn reversed(self) -> Wall {
        Wall { a: self.b, b: self.a }
    }

    /// The determinants that tell whether a ray from a point `M` of `position`, in a direction `u` of `bearing` (radians
    /// from the `x` axis towards the `y` axis), hits the wall:
    ///
    /// `z1 = det(MA, u)`, `z2 = det(u, MB)`, `z3 = det(MA, AB)`, `z4 = det(u, AB) = z1 + z2`.
    ///
    /// The ray hits the wall when the first three are not negative, and then at the distance `z3 / z4`.
    ///
    /// ```
    /// use nalgebra::Vector2;
    /// use shoal_interval::contractor::Wall;
    /// use shoal_interval::{Interval, IntervalBox};
    ///
    /// let wall = Wall::new(Vector2::new(2.0, -1.0), Vector2::new(2.0, 1.0));
    /// let z = wall.determinants(IntervalBox::from([Interval::ZERO; 2]), Interval::ZERO);
    /// assert_eq!(z.map(|z| (z.lower(), z.upper())), [(1.0, 1.0), (1.0, 1.0), (4.0, 4.0), (2.0, 2.0)]);
    /// ```
    ///
    /// Source: seed 000, equations (4.2) to (4.5), with the signs of the worked example.
    pub fn determinants(self, position: IntervalBox<2>, bearing: Interval) -> [Interval; 4] {
        let (sine, cosine) = bearing.sin_cos();
        let (to_a, to_b, along) = (self.start() - position, self.end() - position, self.along());
        [
            to_a[0] * sine - to_a[1] * cosine,
            cosine * to_b[1] - sine * to_b[0],
            to_a[0] * along[1] - to_a[1] * along[0],
            cosine * along[1] - sine * along[0],
        ]
    }

    /// The point `a`.
    pub(super) fn start(self) -> IntervalBox<2> {
        point(self.a)
    }

    /// The point `b`.
    pub(super) fn end(self) -> IntervalBox<2> {
        point(self.b)
    }

    /// The vector from `a` to `b`.
    pub(super) fn along(self) -> IntervalBox<2> {
        self.end() - self.start()
    }

    /// The distance from `a` to `b`.
    pub(super) fn length(self) -> Interval {
        let along = self.along();
        (along[0].sqr() + along[1].sqr()).sqrt()
    }

    /// Contracts positions, directions and distances of the rays that hit the wall. Whether any are left.
    ///
    /// One pass over the polar coordinates of the point that is hit, which is on the wall, and over the determinants, which
    /// hold the distance from the whole line without the dependency between its two ends.
    pub(super) fn contract_hit(
        self,
        position: &mut IntervalBox<2>,
        bearing: &mut Interval,
        distance: &mut Interval,
    ) -> bool {
        let (start, end, along) = (self.start(), self.end(), self.along());
        let mut hit = start | end;
        let [mut x, mut y] = (hit - *position).sides();
        contract_polar(&mut x, &mut y, distance, bearing);
        let ray = IntervalBox::from([x, y]);
        hit = hit & (*position + ray);
        let share = along
            .iter()
            .zip((hit - start).iter())
            .fold(Interval::from_bounds(0.0, 1.0), |share, (&along, &reached)| along.mul_rev(reached, share));
        hit = hit & (start + along * share);
        *position = *position & (hit - ray);

        let (sine, cosine) = bearing.sin_cos();
        let from =
            |end: IntervalBox<2>, coefficients: [Interval; 2], mut value, position: &mut IntervalBox<2>| {
                let mut to_end = end - *position;
                contract_linear(&mut to_end, coefficients, &mut value);
                *position = *position & (end - to_end);
                value
            };
        from(start, [sine, -cosine], Interval::NON_NEGATIVE, position);
        from(end, [-sine, cosine], Interval::NON_NEGATIVE, position);
        let facing = (cosine * along[1] - sine * along[0]) & Interval::NON_NEGATIVE;
        let in_front = (*distance * facing) & Interval::NON_NEGATIVE;
        let height = from(start, [along[1], -along[0]], in_front, position);
        *distance = facing.mul_rev(height, *distance);
        !(position.is_empty() || bearing.is_empty() || distance.is_empty())
    }

    /// The positions from which some direction of `bearing` misses the wall: the hull of the three ways to miss it, which
    /// are past either end and from behind.
    pub(super) fn contract_miss(self, position: IntervalBox<2>, bearing: Interval) -> IntervalBox<2> {
        let (sine, cosine) = bearing.sin_cos();
        let along = self.along();
        let miss = |end: IntervalBox<2>, coefficients: [Interval; 2]| {
            let (mut to_end, mut value) = (end - position, -Interval::NON_NEGATIVE);
            contract_linear(&mut to_end, coefficients, &mut value);
            position & (end - to_end)
        };
        miss(self.start(), [sine, -cosine])
            | miss(self.end(), [-sine, cosine])
            | miss(self.start(), [along[1], -along[0]])
    }

    /// The positions from which some direction of `bearing` does not hit the wall nearer than `reach`.
    pub(super) fn contract_not_nearer(
        self,
        position: IntervalBox<2>,
        bearing: Interval,
        reach: f64,
    ) -> IntervalBox<2> {
        if position.is_empty() || reach <= 0.0 {
            return position;
        }
        let missed = self.contract_miss(position, bearing);
        let (mut beyond, mut bearing) = (position, bearing);
        let hit = match Interval::new(reach, f64::INFINITY) {
            Ok(mut distance) => self.contract_hit(&mut beyond, &mut bearing, &mut distance),
            Err(_) => false,
        };
        if hit { missed | beyond } else { missed }
    }
}

fn point(vector: Vector2<f64>) -> IntervalBox<2> {
    let coordinate = |x: f64| if x.is_finite() { Interval::spanning(x, x) } else { Interval::ENTIRE };
    IntervalBox::from([coordinate(vector.x), coordinate(vector.y)])
}

/// What a rangefinder may get back.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WallReturn {
    /// The distances that may come back; empty when it is certain that none does.
    pub distance: Interval,
    /// Whether it may be that nothing comes back.
    pub may_miss: bool,
}

/// What comes back to a rangefinder at a point of `position` that looks in a direction of `bearing` (radians from the `x`
/// axis towards the `y` axis) from one wall.
///
/// The true distance is in the answer, and `may_miss` is true whenever the ray may pass the wall, whatever the signs
/// of the determinants that are undecided. A ray along the wall may or may not come back.
///
/// ```
/// use nalgebra::Vector2;
/// use shoal_interval::contractor::{Wall, wall_return};
/// use shoal_interval::{Interval, IntervalBox};
///
/// let wall = Wall::new(Vector2::new(2.0, -1.0), Vector2::new(2.0, 1.0));
/// let position = IntervalBox::from([Interval::ZERO; 2]);
/// let ahead = wall_return(position, Interval::ZERO, wall);
/// assert_eq!((ahead.distance, ahead.may_miss), (Interval::new(2.0, 2.0)?, false));
/// let behind = wall_return(position, Interval::point(std::f64::consts::PI)?, wall);
/// assert!(behind.distance.is_empty() && behind.may_miss);
/// let unsure = wall_return(position, Interval::new(0.0, 1.0)?, wall);
/// assert!(unsure.distance.contains(2.0) && unsure.may_miss);
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
///
/// Source: seed 000, equation (4.6).
pub fn wall_return(position: IntervalBox<2>, bearing: Interval, wall: Wall) -> WallReturn {
    if position.is_empty() || bearing.is_empty() {
        return WallReturn { distance: Interval::EMPTY, may_miss: false };
    }
    let [z1, z2, z3, z4] = wall.determinants(position, bearing);
    let surely_hit = z1.lower() >= 0.0 && z2.lower() >= 0.0 && z3.lower() >= 0.0 && z4.lower() > 0.0;
    let (mut from, mut towards, mut distance) = (position, bearing, Interval::NON_NEGATIVE);
    let may_hit = wall.contract_hit(&mut from, &mut towards, &mut distance);
    WallReturn { distance: if may_hit { distance } else { Interval::EMPTY }, may_miss: !surely_hit }
}

/// What comes back from several walls: the nearest distance, since a nearer wall hides those behind it.
///
/// Guarantees as for [`wall_return`]. Without walls nothing comes back.
///
/// Source: seed 000, section 4.3.2, figure 4.12.
pub fn nearest_return(position: IntervalBox<2>, bearing: Interval, walls: &[Wall]) -> WallReturn {
    let nothing = position.is_empty() || bearing.is_empty();
    let mut nearest = WallReturn { distance: Interval::EMPTY, may_miss: !nothing };
    for &wall in walls {
        let next = wall_return(position, bearing, wall);
        // The smaller of two that are certain; one that may be missed leaves the other as it was.
        let both = nearest.distance.min(next.distance);
        let first_alone = if next.may_miss { nearest.distance } else { Interval::EMPTY };
        let second_alone = if nearest.may_miss { next.distance } else { Interval::EMPTY };
        nearest = WallReturn {
            distance: both | first_alone | second_alone,
            may_miss: nearest.may_miss && next.may_miss,
        };
    }
    nearest
}

#[cfg(test)]
mod tests;
