//! Separators: pairs of contractors, one for a set and one for what is not in it.
//!
//! A separator for a set `S` cuts a box `[x]` from both sides. It gives two boxes inside `[x]` for which
//!
//! - `[x] \ inner ⊂ S`: what the inner contractor removes is proved to be in the set,
//! - `([x] \ outer) ∩ S = ∅`: what the outer contractor removes is proved to be outside of it.
//!
//! What is in both is undecided.
//!
//! Source: seed 000, equations (2.32) and (2.33).

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
pub trait Separator<const N: usize> {
    /// Cuts `domain`. Both boxes of the answer are inside `domain`.
    fn separate(&self, domain: IntervalBox<N>) -> Separation<N>;
}

impl<const N: usize, S: Separator<N> + ?Sized> Separator<N> for &S {
    #[inline]
    fn separate(&self, domain: IntervalBox<N>) -> Separation<N> {
        (**self).separate(domain)
    }
}

impl<const N: usize, S: Separator<N> + ?Sized> Separator<N> for Box<S> {
    #[inline]
    fn separate(&self, domain: IntervalBox<N>) -> Separation<N> {
        (**self).separate(domain)
    }
}
