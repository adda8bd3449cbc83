//! The box: a product of intervals.

use crate::interval::Interval;
use crate::lanes;
use nalgebra::SVector;
use std::ops::{BitAnd, BitOr, Index, IndexMut};

mod arithmetic;
mod bisection;
mod difference;
mod measures;
mod relations;
mod vectors;

pub use difference::Difference;

/// An axis-aligned box of `N` dimensions: the vectors whose every coordinate is in the interval of its axis.
///
/// A box with one empty side is empty, whatever its other sides; what the operations return is then
/// [`IntervalBox::EMPTY`], empty on all sides.
///
/// ```
/// use nalgebra::Vector2;
/// use shoal_interval::{Interval, IntervalBox};
///
/// let position_m = IntervalBox::from([Interval::new(1.0, 3.0)?, Interval::new(1.0, 2.0)?]);
/// assert!(position_m.contains(&Vector2::new(2.0, 1.5)));
/// assert_eq!(position_m.width(), 2.0);
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
///
/// Source: seed 001, equations (2.19) to (2.22).
#[derive(Clone, Copy, PartialEq)]
pub struct IntervalBox<const N: usize> {
    sides: [Interval; N],
}

impl<const N: usize> IntervalBox<N> {
    /// No vector at all.
    pub const EMPTY: IntervalBox<N> = IntervalBox { sides: [Interval::EMPTY; N] };

    /// Every vector.
    pub const ENTIRE: IntervalBox<N> = IntervalBox { sides: [Interval::ENTIRE; N] };

    /// All vectors whose every coordinate is within `radius` of that of `mid`, by the rules of [`Interval::centred`].
    pub fn centred(mid: &SVector<f64, N>, radius: f64) -> IntervalBox<N> {
        IntervalBox::from(std::array::from_fn(|axis| Interval::centred(mid[axis], radius)))
    }

    /// The smallest box that holds both vectors, by the rules of [`Interval::spanning`] along each axis.
    ///
    /// ```
    /// use nalgebra::Vector2;
    /// use shoal_interval::{Interval, IntervalBox};
    ///
    /// let leg_m = IntervalBox::spanning(&Vector2::new(3.0, 0.0), &Vector2::new(-1.0, 2.0));
    /// assert_eq!(leg_m[0], Interval::new(-1.0, 3.0)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub fn spanning(one: &SVector<f64, N>, other: &SVector<f64, N>) -> IntervalBox<N> {
        let (one, other) = (std::array::from_fn(|axis| one[axis]), std::array::from_fn(|axis| other[axis]));
        let sides = lanes::spanning(&one, &other);
        let with_care = || std::array::from_fn(|axis| Interval::spanning(one[axis], other[axis]));
        IntervalBox { sides: sides.unwrap_or_else(with_care) }
    }

    /// Whether no vector is in the box.
    #[inline]
    pub fn is_empty(&self) -> bool {
        // Without a branch for each side.
        self.sides.iter().fold(false, |empty, side| empty | side.is_empty())
    }

    /// Whether every side lies between two finite numbers. The empty box does.
    pub fn is_bounded(&self) -> bool {
        self.is_empty() || self.sides.iter().all(|side| side.is_bounded())
    }

    /// A vector near the middle, always finite and inside the box; all NaN for the empty box.
    pub fn mid(&self) -> SVector<f64, N> {
        if let Some(middles) = lanes::middles(&self.sides) {
            return SVector::from(middles);
        }
        let empty = self.is_empty();
        SVector::from_fn(|axis, _| if empty { f64::NAN } else { self.sides[axis].mid() })
    }

    /// The vectors that are in both boxes; also written `x & y`. Exact.
    #[inline]
    pub fn intersection(&self, other: &IntervalBox<N>) -> IntervalBox<N> {
        let mut sides = self.sides;
        for (side, other) in sides.iter_mut().zip(&other.sides) {
            *side = side.common_bounds(*other);
        }
        IntervalBox { sides }.or_empty()
    }

    /// The smallest box that holds both; also written `x | y`. Exact.
    #[inline]
    pub fn hull(&self, other: &IntervalBox<N>) -> IntervalBox<N> {
        if self.is_empty() {
            return other.or_empty();
        }
        if other.is_empty() {
            return *self;
        }
        let mut sides = self.sides;
        for (side, other) in sides.iter_mut().zip(&other.sides) {
            *side = side.hull(*other);
        }
        IntervalBox { sides }
    }

    /// The sides, in the order of the axes.
    #[inline]
    pub fn iter(&self) -> std::slice::Iter<'_, Interval> {
        self.sides.iter()
    }

    /// The sides as an array, in the order of the axes.
    #[inline]
    pub const fn sides(&self) -> [Interval; N] {
        self.sides
    }

    /// The same box, empty on all sides if it was on one.
    #[inline]
    fn or_empty(&self) -> IntervalBox<N> {
        if self.is_empty() { IntervalBox::EMPTY } else { *self }
    }
}

impl<const N: usize> From<[Interval; N]> for IntervalBox<N> {
    #[inline]
    fn from(sides: [Interval; N]) -> IntervalBox<N> {
        IntervalBox { sides }
    }
}

/// A single interval as a box of one dimension.
impl From<Interval> for IntervalBox<1> {
    #[inline]
    fn from(side: Interval) -> IntervalBox<1> {
        IntervalBox { sides: [side] }
    }
}

/// Panics, like any index, when there is no such axis.
impl<const N: usize> Index<usize> for IntervalBox<N> {
    type Output = Interval;

    #[inline]
    fn index(&self, axis: usize) -> &Interval {
        &self.sides[axis]
    }
}

/// Panics, like any index, when there is no such axis.
impl<const N: usize> IndexMut<usize> for IntervalBox<N> {
    #[inline]
    fn index_mut(&mut self, axis: usize) -> &mut Interval {
        &mut self.sides[axis]
    }
}

impl<'a, const N: usize> IntoIterator for &'a IntervalBox<N> {
    type Item = &'a Interval;
    type IntoIter = std::slice::Iter<'a, Interval>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl<const N: usize> BitAnd for IntervalBox<N> {
    type Output = IntervalBox<N>;

    #[inline]
    fn bitand(self, other: IntervalBox<N>) -> IntervalBox<N> {
        self.intersection(&other)
    }
}

impl<const N: usize> BitOr for IntervalBox<N> {
    type Output = IntervalBox<N>;

    #[inline]
    fn bitor(self, other: IntervalBox<N>) -> IntervalBox<N> {
        self.hull(&other)
    }
}

#[cfg(test)]
mod tests;
