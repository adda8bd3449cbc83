//! Cutting a box in two, as every paving algorithm does.

use super::IntervalBox;

impl<const N: usize> IntervalBox<N> {
    /// The axis of the longest side, the first of them if several are as long; 0 for the empty box.
    ///
    /// ```
    /// use shoal_interval::{Interval, IntervalBox};
    ///
    /// let position_m = IntervalBox::from([Interval::new(1.0, 2.0)?, Interval::new(-1.0, 3.0)?]);
    /// assert_eq!(position_m.widest_axis(), 1);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub fn widest_axis(&self) -> usize {
        if self.is_empty() {
            return 0;
        }
        let mut widest = (0, f64::NEG_INFINITY);
        for (axis, side) in self.sides.iter().enumerate() {
            let width = side.width();
            if width > widest.1 {
                widest = (axis, width);
            }
        }
        widest.0
    }

    /// The two halves of the box, cut at the middle of its longest side: together they are the box, and they share
    /// only the face between them. The half with the smaller coordinates comes first.
    ///
    /// `None` when there is nothing to cut: the box is empty, a side is unbounded, or every side is so short that no
    /// `f64` lies between its bounds. When only the longest side is that short, the longest of the others is cut.
    /// An algorithm that cuts until it gets `None` therefore ends.
    ///
    /// ```
    /// use shoal_interval::{Interval, IntervalBox};
    ///
    /// let position_m = IntervalBox::from([Interval::new(1.0, 2.0)?, Interval::new(-1.0, 3.0)?]);
    /// let (south, north) = position_m.bisect().expect("bounded and wide");
    /// assert_eq!(south[1], Interval::new(-1.0, 1.0)?);
    /// assert_eq!(north[1], Interval::new(1.0, 3.0)?);
    /// assert!(IntervalBox::<2>::ENTIRE.bisect().is_none());
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: seed 002, figure 3.3.
    #[inline]
    pub fn bisect(&self) -> Option<(IntervalBox<N>, IntervalBox<N>)> {
        if self.is_empty() || !self.is_bounded() {
            return None;
        }
        self.bisect_axis(self.widest_axis()).or_else(|| self.bisect_another_axis())
    }

    /// The two halves of the box, cut at the middle of the side of `axis`.
    ///
    /// `None` when there is no such axis, the box is empty, or [`Interval::bisect`](crate::Interval::bisect) cannot cut
    /// that side. The other sides may be unbounded.
    #[inline]
    pub fn bisect_axis(&self, axis: usize) -> Option<(IntervalBox<N>, IntervalBox<N>)> {
        let (low, high) = self.sides.get(axis)?.bisect()?;
        if self.is_empty() {
            return None;
        }
        let (mut first, mut second) = (*self, *self);
        first.sides[axis] = low;
        second.sides[axis] = high;
        Some((first, second))
    }

    /// Cuts the longest of the sides that can be cut.
    #[cold]
    fn bisect_another_axis(&self) -> Option<(IntervalBox<N>, IntervalBox<N>)> {
        let mut widest = (None, f64::NEG_INFINITY);
        for (axis, side) in self.sides.iter().enumerate() {
            let width = side.width();
            if width > widest.1 && side.bisect().is_some() {
                widest = (Some(axis), width);
            }
        }
        self.bisect_axis(widest.0?)
    }
}
