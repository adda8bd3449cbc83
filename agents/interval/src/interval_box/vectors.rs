//! Boxes from vectors and vectors from boxes.

use super::IntervalBox;
use crate::interval::Interval;
use nalgebra::SVector;

impl<const N: usize> IntervalBox<N> {
    /// The lower bounds of the sides; all `+inf` for the empty box. Source: seed 001, equation (2.20).
    #[inline]
    pub fn lower(&self) -> SVector<f64, N> {
        let sides = self.or_empty().sides;
        SVector::from_fn(|axis, _| sides[axis].lower())
    }

    /// The upper bounds of the sides; all `-inf` for the empty box. Source: seed 001, equation (2.21).
    #[inline]
    pub fn upper(&self) -> SVector<f64, N> {
        let sides = self.or_empty().sides;
        SVector::from_fn(|axis, _| sides[axis].upper())
    }

    /// The `2^N` corners, none for the empty box; a missing bound gives an infinite coordinate.
    ///
    /// The order is that of counting, the first axis being the fastest. The corners of a flat box repeat.
    ///
    /// ```
    /// use nalgebra::Vector2;
    /// use shoal_interval::{Interval, IntervalBox};
    ///
    /// let area_m = IntervalBox::from([Interval::new(0.0, 1.0)?, Interval::new(5.0, 6.0)?]);
    /// let corners: Vec<_> = area_m.corners().collect();
    /// assert_eq!(corners[1], Vector2::new(1.0, 5.0));
    /// assert_eq!(corners[2], Vector2::new(0.0, 6.0));
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    pub fn corners(&self) -> impl Iterator<Item = SVector<f64, N>> + use<N> {
        let sides = self.sides;
        let first = (!self.is_empty()).then_some([false; N]);
        std::iter::successors(first, |at_upper| {
            let mut next = *at_upper;
            let turned = next.iter().position(|&at_upper| !at_upper)?;
            next[..turned].fill(false);
            next[turned] = true;
            Some(next)
        })
        .map(move |at_upper| {
            SVector::from_fn(|axis, _| if at_upper[axis] { sides[axis].upper() } else { sides[axis].lower() })
        })
    }
}

/// The box that holds exactly this vector; a coordinate that is NaN or infinite gives what [`Interval::spanning`] does.
impl<const N: usize> From<SVector<f64, N>> for IntervalBox<N> {
    #[inline]
    fn from(vector: SVector<f64, N>) -> IntervalBox<N> {
        IntervalBox { sides: std::array::from_fn(|axis| Interval::spanning(vector[axis], vector[axis])) }
    }
}

impl<const N: usize> From<SVector<Interval, N>> for IntervalBox<N> {
    #[inline]
    fn from(sides: SVector<Interval, N>) -> IntervalBox<N> {
        IntervalBox { sides: std::array::from_fn(|axis| sides[axis]) }
    }
}

impl<const N: usize> From<IntervalBox<N>> for SVector<Interval, N> {
    #[inline]
    fn from(vector: IntervalBox<N>) -> SVector<Interval, N> {
        SVector::from_fn(|axis, _| vector.sides[axis])
    }
}
