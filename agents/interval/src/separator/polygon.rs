//! The separator of a polygon: a room, a harbour, a search area.

use super::{Separation, Separator};
use crate::interval::Interval;
use crate::interval_box::IntervalBox;
use nalgebra::Vector2;
use thiserror::Error;

/// The points of a polygon, inside and border, by the even-odd rule.
///
/// The separator is made from the border: a box is contracted to the hull of the edges' parts in it, and what is cut off
/// does not touch the border, so all of each cut piece is on the side of any of its points. The hull of the edges is minimal
/// up to rounding.
///
/// ```
/// use nalgebra::Vector2;
/// use shoal_interval::separator::{Polygon, Separator};
/// use shoal_interval::{Interval, IntervalBox};
///
/// let triangle = Polygon::new(vec![Vector2::new(0.0, 0.0), Vector2::new(4.0, 0.0), Vector2::new(0.0, 4.0)])?;
/// let domain = IntervalBox::from([Interval::new(1.0, 2.0)?, Interval::new(1.0, 4.0)?]);
/// let separation = triangle.separate(domain);
/// assert_eq!(separation.outer[1], Interval::new(1.0, 3.0)?);
/// assert_eq!(separation.inner[1], Interval::new(2.0, 4.0)?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// Source: seed 000, section 5.2.3 (the boundary-based separator of the room).
#[derive(Debug, Clone, PartialEq)]
pub struct Polygon {
    corners: Vec<Vector2<f64>>,
}

/// Why [`Polygon::new`] refused its corners.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum PolygonError {
    /// Fewer than three corners.
    #[error("a polygon has {corners} corners, but it needs at least three")]
    TooFewCorners {
        /// How many there were.
        corners: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("corner {index} of a polygon is at ({x}, {y}), but coordinates must be finite")]
    NotFinite {
        /// Which corner, counted from zero.
        index: usize,
        /// Its first coordinate.
        x: f64,
        /// Its second coordinate.
        y: f64,
    },
}

impl Polygon {
    /// The polygon with these corners, joined in their order and back to the first, in the unit of the axes.
    ///
    /// Edges may cross: a point is then inside if a ray from it crosses an odd number of edges.
    ///
    /// # Errors
    /// [`PolygonError`] when there are fewer than three corners, or one is not finite.
    pub fn new(corners: Vec<Vector2<f64>>) -> Result<Polygon, PolygonError> {
        if corners.len() < 3 {
            return Err(PolygonError::TooFewCorners { corners: corners.len() });
        }
        match corners.iter().position(|corner| !(corner.x.is_finite() && corner.y.is_finite())) {
            Some(index) => Err(PolygonError::NotFinite { index, x: corners[index].x, y: corners[index].y }),
            None => Ok(Polygon { corners }),
        }
    }

    /// The corners, in their order.
    pub fn corners(&self) -> &[Vector2<f64>] {
        &self.corners
    }

    fn edges(&self) -> impl Iterator<Item = (&Vector2<f64>, &Vector2<f64>)> {
        self.corners.iter().zip(self.corners.iter().cycle().skip(1))
    }

    /// The hull of the border's part in `domain`.
    fn border(&self, domain: &IntervalBox<2>) -> IntervalBox<2> {
        let mut hull = IntervalBox::EMPTY;
        for (from, to) in self.edges() {
            hull = hull | contract_segment(from, to, domain);
            if hull == *domain {
                break;
            }
        }
        hull
    }

    /// Whether `point` is inside, if rounding lets that be proved.
    fn contains(&self, point: Vector2<f64>) -> Option<bool> {
        let exact = |x: f64| Interval::spanning(x, x);
        let mut inside = false;
        for (from, to) in self.edges() {
            if (from.y > point.y) == (to.y > point.y) {
                continue;
            }
            // Positive when the point is left of an edge that goes up: then the ray to the right crosses it.
            let side = (exact(to.x) - exact(from.x)) * (exact(point.y) - exact(from.y))
                - (exact(point.x) - exact(from.x)) * (exact(to.y) - exact(from.y));
            if side.contains(0.0) {
                return None;
            }
            if (side.lower() > 0.0) == (to.y > from.y) {
                inside = !inside;
            }
        }
        Some(inside)
    }
}

impl Separator<2> for Polygon {
    fn inner(&self, domain: IntervalBox<2>) -> IntervalBox<2> {
        self.separate(domain).inner
    }

    fn outer(&self, domain: IntervalBox<2>) -> IntervalBox<2> {
        self.separate(domain).outer
    }

    fn separate(&self, domain: IntervalBox<2>) -> Separation<2> {
        let border = self.border(&domain);
        let mut separation = Separation { inner: border, outer: border };
        for piece in domain.difference(&border) {
            // A piece's middle can only be on the border when nothing fits between the piece's bounds.
            let middle = piece.mid();
            let inside = if border.contains(&middle) { None } else { self.contains(middle) };
            if inside != Some(true) {
                separation.inner = separation.inner | piece;
            }
            if inside != Some(false) {
                separation.outer = separation.outer | piece;
            }
        }
        separation
    }
}

/// The hull of the part of a segment that is in `domain`.
fn contract_segment(from: &Vector2<f64>, to: &Vector2<f64>, domain: &IntervalBox<2>) -> IntervalBox<2> {
    let side = |axis: usize| domain[axis] & Interval::spanning(from[axis], to[axis]);
    let sides = [side(0), side(1)];
    if sides.iter().any(|side| side.is_empty()) {
        return IntervalBox::EMPTY;
    }
    let start = |axis: usize| Interval::spanning(from[axis], from[axis]);
    let span = |axis: usize| Interval::spanning(to[axis], to[axis]) - start(axis);
    let mut share = Interval::from_bounds(0.0, 1.0);
    for (axis, &side) in sides.iter().enumerate() {
        share = span(axis).mul_rev(side - start(axis), share);
    }
    let contract = |axis: usize| sides[axis] & (start(axis) + share * span(axis));
    IntervalBox::from([contract(0), contract(1)]) & *domain
}
