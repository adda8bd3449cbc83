//! What a tube's values can be: intervals, and boxes of any dimension.

use nalgebra::SVector;
use shoal_interval::{Interval, IntervalBox};
use std::fmt::Debug;
use std::ops::{Add, BitAnd, BitOr, Mul, Sub};

/// A set that encloses the value of a trajectory at one time or over one slice.
///
/// `&` is the intersection, `|` the hull, `+` and `-` the sums over all pairs, and `* Interval` a velocity times a duration;
/// all round outwards.
pub trait Enclosure:
    Copy
    + PartialEq
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Interval, Output = Self>
    + BitAnd<Output = Self>
    + BitOr<Output = Self>
{
    /// One value of a trajectory: a number or a vector.
    type Point;

    /// No value at all.
    const EMPTY: Self;

    /// Every value.
    const ENTIRE: Self;

    /// Whether no value is in the set.
    fn is_empty(&self) -> bool;

    /// Whether the value is in the set.
    fn contains(&self, value: &Self::Point) -> bool;

    /// The width of the set, of its longest side for a box; NaN for the empty set.
    fn width(&self) -> f64;
}

impl Enclosure for Interval {
    type Point = f64;

    const EMPTY: Interval = Interval::EMPTY;
    const ENTIRE: Interval = Interval::ENTIRE;

    #[inline]
    fn is_empty(&self) -> bool {
        Interval::is_empty(*self)
    }

    #[inline]
    fn contains(&self, value: &f64) -> bool {
        Interval::contains(*self, *value)
    }

    #[inline]
    fn width(&self) -> f64 {
        Interval::width(*self)
    }
}

impl<const N: usize> Enclosure for IntervalBox<N> {
    type Point = SVector<f64, N>;

    const EMPTY: IntervalBox<N> = IntervalBox::EMPTY;
    const ENTIRE: IntervalBox<N> = IntervalBox::ENTIRE;

    #[inline]
    fn is_empty(&self) -> bool {
        IntervalBox::is_empty(self)
    }

    #[inline]
    fn contains(&self, value: &SVector<f64, N>) -> bool {
        IntervalBox::contains(self, value)
    }

    #[inline]
    fn width(&self) -> f64 {
        IntervalBox::width(self)
    }
}
