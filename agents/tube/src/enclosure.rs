//! What a tube's values can be: intervals, and boxes of any dimension.

use nalgebra::SVector;
use shoal_interval::{Interval, IntervalBox};
use std::fmt::Debug;
use std::ops::{Add, BitAnd, BitOr, Mul, Neg, Sub};

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
    + Neg<Output = Self>
    + Mul<Interval, Output = Self>
    + BitAnd<Output = Self>
    + BitOr<Output = Self>
{
    /// One value of a trajectory: a number or a vector.
    type Point;

    /// The innermost bounds of many sets, one pair an axis: what a tube keeps to answer questions about many slices at once.
    type Innermost: Copy + PartialEq + Debug;

    /// The number of coordinates.
    const AXES: usize;

    /// No value at all.
    const EMPTY: Self;

    /// Every value.
    const ENTIRE: Self;

    /// The innermost bounds of no set, which any set replaces.
    const UNBOUNDED: Self::Innermost;

    /// The number or the vector zero alone.
    fn zero() -> Self;

    /// The set of one coordinate, below [`AXES`](Enclosure::AXES).
    fn side(&self, axis: usize) -> Interval;

    /// The set of the vectors with these coordinates; empty if one is.
    fn from_sides(side: impl FnMut(usize) -> Interval) -> Self;

    /// Whether no value is in the set.
    fn is_empty(&self) -> bool;

    /// Whether the value is in the set.
    fn contains(&self, value: &Self::Point) -> bool;

    /// Whether every value of the set is in `other`. The empty set is in every set.
    fn is_subset_of(&self, other: &Self) -> bool;

    /// Whether every value of the set is in `other` and not on its boundary.
    fn is_interior_of(&self, other: &Self) -> bool;

    /// Whether no value is in both.
    fn is_disjoint_from(&self, other: &Self) -> bool;

    /// The width of the set, of its longest side for a box; NaN for the empty set.
    fn width(&self) -> f64;

    /// The length, area or volume of the set, rounded up; zero for the empty set.
    fn volume(&self) -> f64;

    /// `bounds`, moved inwards to those of this set where these are further in.
    fn innermost(&self, bounds: Self::Innermost) -> Self::Innermost;

    /// The innermost of two collections of sets.
    fn innermost_of(one: Self::Innermost, other: Self::Innermost) -> Self::Innermost;

    /// Whether each of the sets with these innermost bounds has a value in common with `self`. For boxes exact too,
    /// because boxes meet when they meet on each axis.
    fn meets_all(&self, bounds: &Self::Innermost) -> bool;
}

/// The innermost bounds of many intervals: the highest of their lower bounds, the lowest of their upper ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InnerBounds {
    /// The highest lower bound; `+inf` when one of the intervals is empty.
    pub highest_lower: f64,
    /// The lowest upper bound; `-inf` when one of the intervals is empty.
    pub lowest_upper: f64,
}

impl InnerBounds {
    const UNBOUNDED: InnerBounds =
        InnerBounds { highest_lower: f64::NEG_INFINITY, lowest_upper: f64::INFINITY };

    #[inline]
    fn and(self, other: InnerBounds) -> InnerBounds {
        let (own, others) = (self, other);
        InnerBounds {
            highest_lower: if own.highest_lower > others.highest_lower {
                own.highest_lower
            } else {
                others.highest_lower
            },
            lowest_upper: if own.lowest_upper < others.lowest_upper {
                own.lowest_upper
            } else {
                others.lowest_upper
            },
        }
    }

    #[inline]
    fn of(interval: Interval) -> InnerBounds {
        InnerBounds { highest_lower: interval.lower(), lowest_upper: interval.upper() }
    }

    #[inline]
    fn all_meet(self, interval: Interval) -> bool {
        let none_is_empty = self.highest_lower < f64::INFINITY;
        none_is_empty
            && !interval.is_empty()
            && self.highest_lower <= interval.upper()
            && interval.lower() <= self.lowest_upper
    }
}

impl Enclosure for Interval {
    type Point = f64;
    type Innermost = InnerBounds;

    const AXES: usize = 1;
    const EMPTY: Interval = Interval::EMPTY;
    const ENTIRE: Interval = Interval::ENTIRE;
    const UNBOUNDED: InnerBounds = InnerBounds::UNBOUNDED;

    #[inline]
    fn zero() -> Interval {
        Interval::ZERO
    }

    #[inline]
    fn side(&self, _axis: usize) -> Interval {
        *self
    }

    #[inline]
    fn from_sides(mut side: impl FnMut(usize) -> Interval) -> Interval {
        side(0)
    }

    #[inline]
    fn is_empty(&self) -> bool {
        Interval::is_empty(*self)
    }

    #[inline]
    fn contains(&self, value: &f64) -> bool {
        Interval::contains(*self, *value)
    }

    #[inline]
    fn is_subset_of(&self, other: &Interval) -> bool {
        Interval::is_subset_of(*self, *other)
    }

    #[inline]
    fn is_interior_of(&self, other: &Interval) -> bool {
        Interval::is_interior_of(*self, *other)
    }

    #[inline]
    fn is_disjoint_from(&self, other: &Interval) -> bool {
        Interval::is_disjoint_from(*self, *other)
    }

    #[inline]
    fn width(&self) -> f64 {
        Interval::width(*self)
    }

    #[inline]
    fn volume(&self) -> f64 {
        if self.is_empty() { 0.0 } else { self.width() }
    }

    #[inline]
    fn innermost(&self, bounds: InnerBounds) -> InnerBounds {
        bounds.and(InnerBounds::of(*self))
    }

    #[inline]
    fn innermost_of(one: InnerBounds, other: InnerBounds) -> InnerBounds {
        one.and(other)
    }

    #[inline]
    fn meets_all(&self, bounds: &InnerBounds) -> bool {
        bounds.all_meet(*self)
    }
}

impl<const N: usize> Enclosure for IntervalBox<N> {
    type Point = SVector<f64, N>;
    type Innermost = [InnerBounds; N];

    const AXES: usize = N;
    const EMPTY: IntervalBox<N> = IntervalBox::EMPTY;
    const ENTIRE: IntervalBox<N> = IntervalBox::ENTIRE;
    const UNBOUNDED: [InnerBounds; N] = [InnerBounds::UNBOUNDED; N];

    #[inline]
    fn zero() -> IntervalBox<N> {
        IntervalBox::from([Interval::ZERO; N])
    }

    #[inline]
    fn side(&self, axis: usize) -> Interval {
        self[axis]
    }

    #[inline]
    fn from_sides(side: impl FnMut(usize) -> Interval) -> IntervalBox<N> {
        IntervalBox::from(std::array::from_fn(side)) & IntervalBox::ENTIRE
    }

    #[inline]
    fn is_empty(&self) -> bool {
        IntervalBox::is_empty(self)
    }

    #[inline]
    fn contains(&self, value: &SVector<f64, N>) -> bool {
        IntervalBox::contains(self, value)
    }

    #[inline]
    fn is_subset_of(&self, other: &IntervalBox<N>) -> bool {
        IntervalBox::is_subset_of(self, other)
    }

    #[inline]
    fn is_interior_of(&self, other: &IntervalBox<N>) -> bool {
        IntervalBox::is_interior_of(self, other)
    }

    #[inline]
    fn is_disjoint_from(&self, other: &IntervalBox<N>) -> bool {
        IntervalBox::is_disjoint_from(self, other)
    }

    #[inline]
    fn width(&self) -> f64 {
        IntervalBox::width(self)
    }

    #[inline]
    fn volume(&self) -> f64 {
        IntervalBox::volume(self)
    }

    #[inline]
    fn innermost(&self, bounds: [InnerBounds; N]) -> [InnerBounds; N] {
        std::array::from_fn(|axis| bounds[axis].and(InnerBounds::of(self[axis])))
    }

    #[inline]
    fn innermost_of(one: [InnerBounds; N], other: [InnerBounds; N]) -> [InnerBounds; N] {
        std::array::from_fn(|axis| one[axis].and(other[axis]))
    }

    #[inline]
    fn meets_all(&self, bounds: &[InnerBounds; N]) -> bool {
        bounds.iter().zip(self.iter()).all(|(bounds, &side)| bounds.all_meet(side))
    }
}
