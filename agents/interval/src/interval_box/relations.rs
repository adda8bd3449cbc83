//! How a box lies to a vector or to another box.
//!
//! These are the tests of set inversion: with an inclusion function `[f]` of `f`, the box `[x]` is inside the solution
//! set of `f(x) in [y]` if `[f]([x])` is a subset of `[y]` (inner test), and outside if the two are disjoint (outer test).
//!
//! Source: seed 001, section 2.3.6 (inclusion test, figure 2.8).

use super::IntervalBox;
use nalgebra::SVector;

impl<const N: usize> IntervalBox<N> {
    /// Whether `vector` is in the box. One with a NaN or an infinite coordinate is in none.
    #[inline]
    pub fn contains(&self, vector: &SVector<f64, N>) -> bool {
        self.sides.iter().zip(vector.iter()).all(|(side, &coordinate)| side.contains(coordinate))
    }

    /// Whether every vector of `self` is in `other`. The empty box is inside every box.
    #[inline]
    pub fn is_subset_of(&self, other: &IntervalBox<N>) -> bool {
        self.is_empty() || self.sides.iter().zip(other.iter()).all(|(side, &outer)| side.is_subset_of(outer))
    }

    /// Whether every vector of `self` is in `other` and not on its boundary. The empty box is; an unbounded side has no
    /// boundary where it has no bound.
    #[inline]
    pub fn is_interior_of(&self, other: &IntervalBox<N>) -> bool {
        self.is_empty()
            || self.sides.iter().zip(other.iter()).all(|(side, &outer)| side.is_interior_of(outer))
    }

    /// Whether no vector is in both boxes: the outer test. The empty box is disjoint from every box.
    ///
    /// ```
    /// use shoal_interval::{Interval, IntervalBox};
    ///
    /// let near_m = IntervalBox::from([Interval::new(0.0, 1.0)?; 2]);
    /// let far_m = IntervalBox::from([Interval::new(0.5, 1.5)?, Interval::new(2.0, 3.0)?]);
    /// assert!(near_m.is_disjoint_from(&far_m));
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub fn is_disjoint_from(&self, other: &IntervalBox<N>) -> bool {
        self.is_empty()
            || other.is_empty()
            || self.sides.iter().zip(other.iter()).any(|(side, &against)| side.is_disjoint_from(against))
    }

    /// Whether some vector is in both boxes, be it on their faces only.
    #[inline]
    pub fn overlaps(&self, other: &IntervalBox<N>) -> bool {
        !self.is_disjoint_from(other)
    }
}
