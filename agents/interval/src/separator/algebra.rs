//! Separators of a complement, of an intersection, of a union, and of two contractors.

use super::Separator;
use crate::contractor::Contractor;
use crate::interval_box::IntervalBox;

/// The separator that two contractors make: `inner` for the complement of a set, `outer` for the set.
///
/// ```
/// use shoal_interval::contractor::from_fn;
/// use shoal_interval::separator::{Separator, from_contractors};
/// use shoal_interval::{Interval, IntervalBox};
///
/// // x >= 1
/// let above = Interval::new(1.0, f64::INFINITY)?;
/// let below = Interval::new(f64::NEG_INFINITY, 1.0)?;
/// let separator = from_contractors(
///     from_fn(move |x: IntervalBox<1>| IntervalBox::from([x[0] & below])),
///     from_fn(move |x: IntervalBox<1>| IntervalBox::from([x[0] & above])),
/// );
/// let separation = separator.separate(IntervalBox::from([Interval::new(0.0, 3.0)?]));
/// assert_eq!(separation.inner[0], Interval::new(0.0, 1.0)?);
/// assert_eq!(separation.outer[0], Interval::new(1.0, 3.0)?);
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
pub fn from_contractors<I, O>(inner: I, outer: O) -> FromContractors<I, O> {
    FromContractors { inner, outer }
}

/// The separator made of two contractors by [`from_contractors`].
#[derive(Debug, Clone, Copy)]
pub struct FromContractors<I, O> {
    inner: I,
    outer: O,
}

impl<const N: usize, I: Contractor<N>, O: Contractor<N>> Separator<N> for FromContractors<I, O> {
    #[inline]
    fn inner(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        self.inner.contract(domain)
    }

    #[inline]
    fn outer(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        self.outer.contract(domain)
    }
}

/// The separator of a complement, made by [`Separator::complement`].
#[derive(Debug, Clone, Copy)]
pub struct Complement<S> {
    separator: S,
}

impl<S> Complement<S> {
    pub(super) fn new(separator: S) -> Complement<S> {
        Complement { separator }
    }
}

impl<const N: usize, S: Separator<N>> Separator<N> for Complement<S> {
    #[inline]
    fn inner(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        self.separator.outer(domain)
    }

    #[inline]
    fn outer(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        self.separator.inner(domain)
    }
}

/// The separator of an intersection, made by [`Separator::intersection`].
///
/// The outer contractors work one after the other, each on what the first has left; the inner box is the hull of both.
#[derive(Debug, Clone, Copy)]
pub struct Intersection<A, B> {
    first: A,
    second: B,
}

impl<A, B> Intersection<A, B> {
    pub(super) fn new(first: A, second: B) -> Intersection<A, B> {
        Intersection { first, second }
    }
}

impl<const N: usize, A: Separator<N>, B: Separator<N>> Separator<N> for Intersection<A, B> {
    #[inline]
    fn inner(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        self.first.inner(domain) | self.second.inner(domain)
    }

    #[inline]
    fn outer(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        self.second.outer(self.first.outer(domain))
    }
}

/// The separator of a union, made by [`Separator::union`]: that of an intersection with inner and outer exchanged.
#[derive(Debug, Clone, Copy)]
pub struct Union<A, B> {
    first: A,
    second: B,
}

impl<A, B> Union<A, B> {
    pub(super) fn new(first: A, second: B) -> Union<A, B> {
        Union { first, second }
    }
}

impl<const N: usize, A: Separator<N>, B: Separator<N>> Separator<N> for Union<A, B> {
    #[inline]
    fn inner(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        self.second.inner(self.first.inner(domain))
    }

    #[inline]
    fn outer(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        self.first.outer(domain) | self.second.outer(domain)
    }
}

/// The separator of a difference, made by [`Separator::difference`].
pub type Difference<A, B> = Intersection<A, Complement<B>>;
