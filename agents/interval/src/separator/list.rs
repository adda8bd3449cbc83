//! Separators of the intersection and of the union of any number of sets.

use super::Separator;
use crate::interval_box::IntervalBox;
use std::marker::PhantomData;

/// The separator of the vectors that are in every set of a list: an array, a slice or a vector of separators.
///
/// No set at all gives the universe. Sets of different kinds are joined with [`Separator::intersection`], or boxed.
pub fn intersection_of<S, L: AsRef<[S]>>(separators: L) -> IntersectionOf<S, L> {
    IntersectionOf { separators, kind: PhantomData }
}

/// The separator of the vectors that are in at least one set of a list: an array, a slice or a vector of separators.
///
/// No set at all gives the empty set. Sets of different kinds are joined with [`Separator::union`], or boxed.
pub fn union_of<S, L: AsRef<[S]>>(separators: L) -> UnionOf<S, L> {
    UnionOf { separators, kind: PhantomData }
}

/// The separator made of a list by [`intersection_of`].
#[derive(Debug, Clone, Copy)]
pub struct IntersectionOf<S, L> {
    separators: L,
    kind: PhantomData<fn() -> S>,
}

/// The separator made of a list by [`union_of`].
#[derive(Debug, Clone, Copy)]
pub struct UnionOf<S, L> {
    separators: L,
    kind: PhantomData<fn() -> S>,
}

impl<const N: usize, S: Separator<N>, L: AsRef<[S]>> Separator<N> for IntersectionOf<S, L> {
    #[inline]
    fn inner(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        in_any(self.separators.as_ref(), domain, S::inner)
    }

    #[inline]
    fn outer(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        in_all(self.separators.as_ref(), domain, S::outer)
    }
}

impl<const N: usize, S: Separator<N>, L: AsRef<[S]>> Separator<N> for UnionOf<S, L> {
    #[inline]
    fn inner(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        in_all(self.separators.as_ref(), domain, S::inner)
    }

    #[inline]
    fn outer(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        in_any(self.separators.as_ref(), domain, S::outer)
    }
}

/// Contracts with each, one after the other, until nothing is left.
#[inline]
fn in_all<const N: usize, S>(
    separators: &[S],
    domain: IntervalBox<N>,
    contract: impl Fn(&S, IntervalBox<N>) -> IntervalBox<N>,
) -> IntervalBox<N> {
    let mut left = domain;
    for separator in separators {
        left = contract(separator, left);
        if left.is_empty() {
            break;
        }
    }
    left
}

/// The hull of what each leaves. Once that is everything, the others cannot change it.
#[inline]
fn in_any<const N: usize, S>(
    separators: &[S],
    domain: IntervalBox<N>,
    contract: impl Fn(&S, IntervalBox<N>) -> IntervalBox<N>,
) -> IntervalBox<N> {
    let mut hull = IntervalBox::EMPTY;
    for separator in separators {
        hull = hull | contract(separator, domain);
        if hull == domain {
            break;
        }
    }
    hull
}
