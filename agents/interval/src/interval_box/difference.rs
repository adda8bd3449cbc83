//! What is left of a box when another is taken away.

use super::IntervalBox;
use crate::interval::Interval;
use std::iter::FusedIterator;

impl<const N: usize> IntervalBox<N> {
    /// The vectors of `self` that are not in `other`, as at most `2 N` boxes.
    ///
    /// Together the boxes are the closure of `self \ other`, exactly: nothing is rounded. They share faces at most with
    /// each other and with `other`. The order is fixed: what lies below `other` along the first axis, what lies above it, then
    /// the same along the second axis for what remains, and so on. Nothing is allocated.
    ///
    /// ```
    /// use shoal_interval::{Interval, IntervalBox};
    ///
    /// let area_m = IntervalBox::from([Interval::new(0.0, 4.0)?; 2]);
    /// let seen_m = IntervalBox::from([Interval::new(1.0, 2.0)?; 2]);
    /// let unseen_m2: f64 = area_m.difference(&seen_m).map(|piece| piece.volume()).sum();
    /// assert_eq!((area_m.difference(&seen_m).count(), unseen_m2), (4, 15.0));
    /// assert_eq!(area_m.difference(&area_m).count(), 0);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub fn difference(&self, other: &IntervalBox<N>) -> Difference<N> {
        if self.is_empty() {
            return Difference { rest: *self, other: *other, axis: N, above: None };
        }
        if self.is_disjoint_from(other) {
            return Difference { rest: *self, other: *other, axis: N, above: Some(*self) };
        }
        Difference { rest: *self, other: *other, axis: 0, above: None }
    }
}

/// The boxes that [`IntervalBox::difference`] leaves, in its order.
#[derive(Debug, Clone)]
pub struct Difference<const N: usize> {
    /// What is still to be cut: inside `other` along the axes before `axis`.
    rest: IntervalBox<N>,
    other: IntervalBox<N>,
    axis: usize,
    /// The piece above `other`, which waits while the one below is handed out.
    above: Option<IntervalBox<N>>,
}

impl<const N: usize> Iterator for Difference<N> {
    type Item = IntervalBox<N>;

    #[inline]
    fn next(&mut self) -> Option<IntervalBox<N>> {
        if self.above.is_some() {
            return self.above.take();
        }
        while self.axis < N {
            let axis = self.axis;
            self.axis += 1;
            let side = self.rest.sides[axis];
            let pieces = side.difference(self.other.sides[axis]);
            let [below, above] = pieces.map(|piece| self.piece(axis, piece));
            let shared = side.intersection(self.other.sides[axis]);
            if shared.is_point() && !side.is_point() {
                // All that remains is a face of a piece that is handed out here.
                self.axis = N;
            }
            self.rest.sides[axis] = shared;
            if below.is_some() {
                self.above = above;
                return below;
            }
            if above.is_some() {
                return above;
            }
        }
        None
    }
}

impl<const N: usize> FusedIterator for Difference<N> {}

impl<const N: usize> Difference<N> {
    #[inline]
    fn piece(&self, axis: usize, side: Interval) -> Option<IntervalBox<N>> {
        if side.is_empty() {
            return None;
        }
        let mut piece = self.rest;
        piece.sides[axis] = side;
        Some(piece)
    }
}
