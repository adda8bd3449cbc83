//! What a rangefinder among walls says about its position.

use super::{Contractor, Wall};
use crate::interval::Interval;
use crate::interval_box::IntervalBox;

/// The positions from which the nearest of `walls`, in some direction of `bearing`, is at a distance in `distance`.
///
/// The hull over the walls: one is hit at the distance, and no other nearer than the smallest distance that may have been
/// measured. So a wall that another hides is not taken for the one that was seen. Loses no position, also where it is
/// undecided whether a ray hits; not minimal.
///
/// ```
/// use nalgebra::Vector2;
/// use shoal_interval::contractor::{Contractor, Wall, WallRange};
/// use shoal_interval::{Interval, IntervalBox};
///
/// let near = Wall::new(Vector2::new(2.0, -5.0), Vector2::new(2.0, 5.0));
/// let hidden = Wall::new(Vector2::new(4.0, -5.0), Vector2::new(4.0, 5.0));
/// let walls = [near, hidden];
/// let seen = WallRange::new(&walls, Interval::ZERO, Interval::new(3.0, 3.5)?);
/// let room = IntervalBox::from([Interval::new(-5.0, 1.9)?, Interval::new(-1.0, 1.0)?]);
/// assert_eq!(seen.contract(room)[0], Interval::new(-1.5, -1.0)?);
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
///
/// Source: seed 000, equation (4.6) and section 4.3.2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WallRange<'a> {
    walls: &'a [Wall],
    bearing: Interval,
    distance: Interval,
}

impl<'a> WallRange<'a> {
    /// A `distance` that was measured in a direction of `bearing`, radians from the `x` axis towards the `y` axis.
    pub fn new(walls: &'a [Wall], bearing: Interval, distance: Interval) -> WallRange<'a> {
        WallRange { walls, bearing, distance: distance & Interval::NON_NEGATIVE }
    }

    /// The contractor for the positions from which another distance, or nothing, would have been measured, the
    /// boundaries included.
    ///
    /// With a bearing that is not a single angle, it is what may be so for *some* bearing.
    pub fn complement(self) -> WallRangeComplement<'a> {
        let WallRange { walls, bearing, distance } = self;
        let nearer = if distance.lower() > 0.0 && !distance.is_empty() {
            Interval::new(0.0, distance.lower()).unwrap_or(Interval::EMPTY)
        } else {
            Interval::EMPTY
        };
        let reach = if distance.is_empty() { 0.0 } else { distance.upper() };
        WallRangeComplement {
            nearer: WallRange { walls, bearing, distance: nearer },
            not_nearer: NothingSeen { walls, bearing, reach },
        }
    }
}

impl Contractor<2> for WallRange<'_> {
    fn contract(&self, domain: IntervalBox<2>) -> IntervalBox<2> {
        let mut hull = IntervalBox::EMPTY;
        for (index, wall) in self.walls.iter().enumerate() {
            let (mut position, mut bearing, mut distance) = (domain, self.bearing, self.distance);
            if !wall.contract_hit(&mut position, &mut bearing, &mut distance) {
                continue;
            }
            for (_, other) in self.walls.iter().enumerate().filter(|&(other, _)| other != index) {
                position = other.contract_not_nearer(position, bearing, distance.lower());
            }
            hull = hull | position;
        }
        hull
    }
}

/// The positions from which, in some direction of `bearing`, none of `walls` is nearer than `reach`: what it means that a
/// rangefinder has seen nothing.
///
/// ```
/// use nalgebra::Vector2;
/// use shoal_interval::contractor::{Contractor, NothingSeen, Wall};
/// use shoal_interval::{Interval, IntervalBox};
///
/// let walls = [Wall::new(Vector2::new(2.0, -5.0), Vector2::new(2.0, 5.0))];
/// let nothing = NothingSeen::new(&walls, Interval::ZERO, 3.0);
/// let room = IntervalBox::from([Interval::new(-5.0, 1.5)?, Interval::new(-1.0, 1.0)?]);
/// assert_eq!(nothing.contract(room)[0], Interval::new(-5.0, -1.0)?);
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
///
/// Source: seed 000, equation (4.6), first case, and section 4.3.2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NothingSeen<'a> {
    walls: &'a [Wall],
    bearing: Interval,
    reach: f64,
}

impl<'a> NothingSeen<'a> {
    /// A rangefinder that sees as far as `reach` has looked in a direction of `bearing` and seen nothing. An infinite
    /// reach sees every wall, one that is not positive or NaN none.
    pub fn new(walls: &'a [Wall], bearing: Interval, reach: f64) -> NothingSeen<'a> {
        NothingSeen { walls, bearing, reach: if reach.is_nan() { 0.0 } else { reach } }
    }
}

impl Contractor<2> for NothingSeen<'_> {
    fn contract(&self, domain: IntervalBox<2>) -> IntervalBox<2> {
        if self.bearing.is_empty() {
            return IntervalBox::EMPTY;
        }
        self.walls
            .iter()
            .fold(domain, |position, wall| wall.contract_not_nearer(position, self.bearing, self.reach))
    }
}

/// The positions from which the nearest wall is not at a measured distance; made by [`WallRange::complement`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WallRangeComplement<'a> {
    nearer: WallRange<'a>,
    not_nearer: NothingSeen<'a>,
}

impl Contractor<2> for WallRangeComplement<'_> {
    fn contract(&self, domain: IntervalBox<2>) -> IntervalBox<2> {
        self.nearer.contract(domain) | self.not_nearer.contract(domain)
    }
}

#[cfg(test)]
mod tests;
