//! Separators: pairs of contractors, one for a set and one for what is not in it.
//!
//! A separator for a set `S` cuts a box `[x]` from both sides. It gives two boxes inside `[x]` for which
//!
//! - `[x] \ inner ⊂ S`: what the inner contractor removes is proved to be in the set,
//! - `([x] \ outer) ∩ S = ∅`: what the outer contractor removes is proved to be outside of it.
//!
//! What is in both is undecided. [`pave`](crate::paving::pave) bisects that, and cuts again.
//!
//! Ready-made: [`Ring`] (a range to a landmark), [`HalfSpace`], [`Polygon`] (a room), [`InBox`]. Two contractors make a
//! separator with [`from_contractors`]. They are combined by [`Separator::intersection`], [`Separator::union`],
//! [`Separator::difference`] and [`Separator::complement`]; lists by [`intersection_of`], [`union_of`] and the relaxed
//! [`q_intersection`], which tolerates outliers.
//!
//! ```
//! use nalgebra::Vector2;
//! use shoal_interval::separator::{InBox, Ring, Separator};
//! use shoal_interval::{Interval, IntervalBox};
//!
//! // 3 m to 4 m from a beacon, but not in the harbour.
//! let harbour = InBox::new(IntervalBox::from([Interval::new(0.0, 9.0)?, Interval::new(0.0, 9.0)?]));
//! let place = Ring::new(Vector2::new(0.0, 0.0), Interval::new(3.0, 4.0)?).difference(harbour);
//! let near = IntervalBox::from([Interval::new(-2.0, 9.0)?, Interval::new(0.0, 9.0)?]);
//! assert_eq!(place.outer(near).to_string(), "[-2, 0] x [0, 4]");
//! # Ok::<(), shoal_interval::IntervalError>(())
//! ```
//!
//! Source: seed 000, equations (2.32) and (2.33); Jaulin and Desrochers, *Introduction to the algebra of separators with
//! application to path planning*, 2014.

mod algebra;
mod half_space;
mod in_box;
mod list;
mod polygon;
mod relaxed;
mod ring;

pub use algebra::{Complement, Difference, FromContractors, Intersection, Union, from_contractors};
pub use half_space::HalfSpace;
pub use in_box::InBox;
pub use list::{IntersectionOf, UnionOf, intersection_of, union_of};
pub use polygon::{Polygon, PolygonError};
pub(crate) use relaxed::with_boxes;
pub use relaxed::{QIntersection, q_intersection};
pub use ring::Ring;

use crate::interval_box::IntervalBox;

/// What a [`Separator`] leaves of a box; see [this module](self) for what is proved of the rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Separation<const N: usize> {
    /// The part that may hold vectors that are not in the set: all that was removed is inside the set.
    pub inner: IntervalBox<N>,
    /// The part that may hold vectors of the set: all that was removed is outside the set.
    pub outer: IntervalBox<N>,
}

/// What cuts a box into a part inside a set, a part outside of it and a part that is undecided.
///
/// The two contractors keep the promises of [this module](self), and their results are inside the domain. The empty box is
/// always contracted to the empty box.
pub trait Separator<const N: usize> {
    /// The part of `domain` that may hold vectors that are not in the set: the contractor of the complement.
    fn inner(&self, domain: IntervalBox<N>) -> IntervalBox<N>;

    /// The part of `domain` that may hold vectors of the set: the contractor of the set.
    fn outer(&self, domain: IntervalBox<N>) -> IntervalBox<N>;

    /// Cuts `domain` from both sides.
    fn separate(&self, domain: IntervalBox<N>) -> Separation<N> {
        Separation { inner: self.inner(domain), outer: self.outer(domain) }
    }

    /// The separator of the vectors that are not in the set: inner and outer change places.
    fn complement(self) -> Complement<Self>
    where
        Self: Sized,
    {
        Complement::new(self)
    }

    /// The separator of the vectors that are in both sets.
    fn intersection<S: Separator<N>>(self, other: S) -> Intersection<Self, S>
    where
        Self: Sized,
    {
        Intersection::new(self, other)
    }

    /// The separator of the vectors that are in at least one of both sets.
    fn union<S: Separator<N>>(self, other: S) -> Union<Self, S>
    where
        Self: Sized,
    {
        Union::new(self, other)
    }

    /// The separator of the vectors that are in this set and not in the other.
    fn difference<S: Separator<N>>(self, other: S) -> Difference<Self, S>
    where
        Self: Sized,
    {
        Intersection::new(self, Complement::new(other))
    }
}

/// Passes both contractors on to what is pointed at.
macro_rules! pass_on {
    ($($pointer:ty),*) => {$(
        impl<const N: usize, S: Separator<N> + ?Sized> Separator<N> for $pointer {
            #[inline]
            fn inner(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
                (**self).inner(domain)
            }

            #[inline]
            fn outer(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
                (**self).outer(domain)
            }

            #[inline]
            fn separate(&self, domain: IntervalBox<N>) -> Separation<N> {
                (**self).separate(domain)
            }
        }
    )*};
}

pass_on!(&S, Box<S>);

#[cfg(test)]
mod tests;
