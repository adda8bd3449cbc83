//! Sums, differences, scaling, dot product and length of boxes of vectors, rounded outwards.

use super::IntervalBox;
use crate::interval::Interval;
use crate::lanes;
use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

impl<const N: usize> IntervalBox<N> {
    /// The box with `change` applied to each side.
    ///
    /// ```
    /// use shoal_interval::{Interval, IntervalBox};
    ///
    /// let offset_m = IntervalBox::from([Interval::new(-2.0, 1.0)?, Interval::new(3.0, 4.0)?]);
    /// assert_eq!(offset_m.map(Interval::abs)[0], Interval::new(0.0, 2.0)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub fn map(&self, change: impl FnMut(Interval) -> Interval) -> IntervalBox<N> {
        if self.is_empty() {
            return IntervalBox::EMPTY;
        }
        IntervalBox { sides: self.sides.map(change) }.or_empty()
    }

    /// The dot products of a vector of `self` with one of `other`, rounded outwards at each of the operations.
    ///
    /// ```
    /// use nalgebra::Vector2;
    /// use shoal_interval::{Interval, IntervalBox};
    ///
    /// let velocity_m_s = IntervalBox::from([Interval::new(1.0, 2.0)?, Interval::new(-1.0, 1.0)?]);
    /// let direction = IntervalBox::from(Vector2::new(3.0, 4.0));
    /// assert_eq!(velocity_m_s.dot(&direction), Interval::new(-1.0, 10.0)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub fn dot(&self, other: &IntervalBox<N>) -> Interval {
        if self.is_empty() || other.is_empty() {
            return Interval::EMPTY;
        }
        sum(self.sides.iter().zip(other.iter()).map(|(&own, &side)| own * side))
    }

    /// The Euclidean lengths of the vectors in the box, rounded outwards at each of the operations.
    ///
    /// Without rounding it would be minimal: each coordinate is used once. Lengths whose square overflows are only
    /// known to be above 1e154.
    ///
    /// ```
    /// use shoal_interval::{Interval, IntervalBox};
    ///
    /// let offset_m = IntervalBox::from([Interval::new(-3.0, 3.0)?, Interval::new(2.0, 4.0)?]);
    /// assert_eq!(offset_m.norm(), Interval::new(2.0, 5.0)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub fn norm(&self) -> Interval {
        if self.is_empty() {
            return Interval::EMPTY;
        }
        sum(self.sides.iter().map(|side| side.sqr())).sqrt()
    }
}

/// The sum of the terms, exact when there is one, zero when there is none.
#[inline]
fn sum(mut terms: impl Iterator<Item = Interval>) -> Interval {
    let first = terms.next().unwrap_or(Interval::ZERO);
    terms.fold(first, |total, term| total + term)
}

/// What `operation` makes of each side of one box with that of the other.
#[cold]
fn side_by_side<const N: usize>(
    one: &IntervalBox<N>,
    other: &IntervalBox<N>,
    operation: impl Fn(Interval, Interval) -> Interval,
) -> IntervalBox<N> {
    IntervalBox { sides: std::array::from_fn(|axis| operation(one.sides[axis], other.sides[axis])) }
        .or_empty()
}

impl<const N: usize> Add for IntervalBox<N> {
    type Output = IntervalBox<N>;

    #[inline]
    fn add(self, other: IntervalBox<N>) -> IntervalBox<N> {
        match lanes::sums(&self.sides, &other.sides) {
            Some(sides) => IntervalBox { sides },
            None => side_by_side(&self, &other, |own, side| own + side),
        }
    }
}

impl<const N: usize> Sub for IntervalBox<N> {
    type Output = IntervalBox<N>;

    #[inline]
    fn sub(self, other: IntervalBox<N>) -> IntervalBox<N> {
        match lanes::differences(&self.sides, &other.sides) {
            Some(sides) => IntervalBox { sides },
            None => side_by_side(&self, &other, |own, side| own - side),
        }
    }
}

impl<const N: usize> AddAssign for IntervalBox<N> {
    #[inline]
    fn add_assign(&mut self, other: IntervalBox<N>) {
        *self = *self + other;
    }
}

impl<const N: usize> SubAssign for IntervalBox<N> {
    #[inline]
    fn sub_assign(&mut self, other: IntervalBox<N>) {
        *self = *self - other;
    }
}

impl<const N: usize> Neg for IntervalBox<N> {
    type Output = IntervalBox<N>;

    #[inline]
    fn neg(self) -> IntervalBox<N> {
        IntervalBox { sides: self.sides.map(|side| -side) }
    }
}

/// Every side times the same set of numbers: a velocity box times a duration.
impl<const N: usize> Mul<Interval> for IntervalBox<N> {
    type Output = IntervalBox<N>;

    #[inline]
    fn mul(self, factor: Interval) -> IntervalBox<N> {
        match lanes::products(&self.sides, factor) {
            Some(sides) => IntervalBox { sides },
            None => side_by_side(&self, &IntervalBox { sides: [factor; N] }, |own, factor| own * factor),
        }
    }
}

/// Every side times the same number; a NaN stands for any number.
impl<const N: usize> Mul<f64> for IntervalBox<N> {
    type Output = IntervalBox<N>;

    #[inline]
    fn mul(self, factor: f64) -> IntervalBox<N> {
        self * Interval::spanning(factor, factor)
    }
}

impl<const N: usize> Mul<IntervalBox<N>> for Interval {
    type Output = IntervalBox<N>;

    #[inline]
    fn mul(self, vector: IntervalBox<N>) -> IntervalBox<N> {
        vector * self
    }
}

impl<const N: usize> Mul<IntervalBox<N>> for f64 {
    type Output = IntervalBox<N>;

    #[inline]
    fn mul(self, vector: IntervalBox<N>) -> IntervalBox<N> {
        vector * self
    }
}
