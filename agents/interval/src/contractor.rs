//! Contractors: what narrows a box without losing a solution, and the algebra that combines them.
//!
//! A contractor `C` for a set `S` of vectors takes a box `[x]` and gives a box for which
//!
//! 1. `C([x]) ⊂ [x]` (contractance): nothing is added,
//! 2. `[x] ∩ S ⊂ C([x])` (consistency): no member of `S` is lost.
//!
//! It is *minimal* when the result is the smallest such box, the hull of `[x] ∩ S`. An empty result proves that the box
//! holds no member of `S`.
//!
//! Source: seed 000, equations (2.30) and (2.31); seed 001, sections 2.3.5 and 3.2; seed 002, equation (3.20).

mod distance;

pub use distance::{contract_distance, contract_range};

use crate::interval_box::IntervalBox;

/// What narrows a box of `N` dimensions without losing a member of the set that it stands for.
///
/// An implementation must keep the two promises of [this module](self): the result is inside the domain, and no member of
/// the set that was in the domain is missing from it. The empty box is always contracted to the empty box.
pub trait Contractor<const N: usize> {
    /// The part of `domain` that may hold members of the set.
    fn contract(&self, domain: IntervalBox<N>) -> IntervalBox<N>;
}

impl<const N: usize, C: Contractor<N> + ?Sized> Contractor<N> for &C {
    #[inline]
    fn contract(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        (**self).contract(domain)
    }
}

impl<const N: usize, C: Contractor<N> + ?Sized> Contractor<N> for Box<C> {
    #[inline]
    fn contract(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        (**self).contract(domain)
    }
}

/// A contractor made of a closure.
///
/// Whatever the closure adds to the box is taken away again, so only consistency is left to the closure.
///
/// ```
/// use shoal_interval::contractor::{Contractor, from_fn};
/// use shoal_interval::{Interval, IntervalBox};
///
/// // y = 2 x
/// let double = from_fn(|domain: IntervalBox<2>| {
///     let y = domain[1] & (domain[0] * 2.0);
///     IntervalBox::from([domain[0] & (y / 2.0), y])
/// });
/// let contracted = double.contract(IntervalBox::from([Interval::new(0.0, 5.0)?, Interval::new(-4.0, 4.0)?]));
/// assert_eq!(contracted, IntervalBox::from([Interval::new(0.0, 2.0)?, Interval::new(0.0, 4.0)?]));
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
pub fn from_fn<const N: usize, F>(contract: F) -> FromFn<F>
where
    F: Fn(IntervalBox<N>) -> IntervalBox<N>,
{
    FromFn { contract }
}

/// A contractor made of a closure by [`from_fn`].
#[derive(Debug, Clone, Copy)]
pub struct FromFn<F> {
    contract: F,
}

impl<const N: usize, F: Fn(IntervalBox<N>) -> IntervalBox<N>> Contractor<N> for FromFn<F> {
    #[inline]
    fn contract(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        (self.contract)(domain) & domain
    }
}

/// What an in-place contractor did.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Contracted {
    /// Nothing could be removed.
    Unchanged,
    /// Something was removed, and something is left.
    Narrowed,
    /// Nothing is left: the sets contradict the equation, and what was contracted is now empty.
    Empty,
}
