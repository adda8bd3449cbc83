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

//!
//! # The algebra
//! Contractors combine into contractors: [`intersection`](Contractor::intersection), [`union`](Contractor::union),
//! [`then`](Contractor::then), [`fixpoint`](Contractor::fixpoint), [`q_intersection`] against outliers,
//! [`transformed`](Contractor::transformed) by symmetries and other [box-conservative bijections](BoxBijection),
//! [`modulo`](Contractor::modulo) a period, [`on_axes`](Contractor::on_axes) of a bigger box, and
//! [`with_parameters`](Contractor::with_parameters) that are known.
//!
//! # Ready-made contractors
//! Most come both as a function that contracts variables in place and as a type that implements [`Contractor`], for what is left
//! when the rest is known.
//!
//! | constraint | in place | contractor | minimal |
//! |---|---|---|---|
//! | `z = x + y` | [`contract_sum`] | [`Sum`] | yes |
//! | `z = x y` | [`contract_product`] | [`Product`] | yes |
//! | `y = x²` | [`contract_square`] | [`Square`] | yes |
//! | `‖a - b‖ = r` | [`contract_distance`] | [`Ring`] | yes |
//! | `‖p - e‖ = c (t - a)` | [`contract_range`] | | yes |
//! | `angle = atan2(y, x)` | [`contract_atan2`] | [`Atan2`] | yes |
//! | the bearing under which a place is seen | | [`Sector`] | from one place |
//! | `(x, y) = r (cos b, sin b)` | [`contract_polar`] | [`Polar`] | yes |
//! | `w = R(angle) v` | [`contract_rotation`], [`contract_euler_rotation`] | [`Rotation`] | no |
//! | distance to a wall along a bearing (forwards: [`wall_return`], [`nearest_return`]) | | [`WallRange`], [`NothingSeen`] | no |
//! | silence in front of a wall | | [`Silence`] | yes |
//!
//! *Minimal* means here: the exact hull but for a few units in the last place, as long as squares neither overflow nor
//! underflow.

mod algebra;
mod arithmetic;
mod atan2;
mod axes;
mod bijection;
mod distance;
mod fixpoint;
mod modulo;
mod polar;
mod quadrant;
mod range;
mod relaxed;
mod ring;
mod rotation;
mod sector;
mod silence;
mod wall;
mod wall_range;

pub use algebra::{Intersection, Then, Union};
pub use arithmetic::{Product, Square, Sum, contract_product, contract_square, contract_sum};
pub use atan2::{Atan2, Atan2Seed, contract_atan2};
pub use axes::{OnAxes, WithParameters};
pub use bijection::{BoxBijection, FollowedBy, Permutation, Scaling, Symmetry, Transformed, Translation};
pub use distance::contract_distance;
pub use fixpoint::Fixpoint;
pub use modulo::Modulo;
pub use polar::{Polar, contract_polar};
pub use range::contract_range;
pub use relaxed::{QIntersection, q_intersection, relaxed_intersection, relaxed_intersection_of_boxes};
pub use ring::{Ring, RingComplement};
pub use rotation::{Rotation, contract_euler_rotation, contract_rotation};
pub use sector::{Sector, SectorComplement};
pub use silence::Silence;
pub use wall::{Wall, WallReturn, nearest_return, wall_return};
pub use wall_range::{NothingSeen, WallRange, WallRangeComplement};

use crate::interval::Interval;
use crate::interval_box::IntervalBox;

/// What narrows a box of `N` dimensions without losing a member of the set that it stands for.
///
/// An implementation must keep the two promises of [this module](self): the result is inside the domain, and no member of
/// the set that was in the domain is missing from it. The empty box is always contracted to the empty box.
pub trait Contractor<const N: usize> {
    /// The part of `domain` that may hold members of the set.
    fn contract(&self, domain: IntervalBox<N>) -> IntervalBox<N>;

    /// The contractor for the vectors that are in both sets: each contracts the same box, and the results are intersected.
    ///
    /// [`Contractor::then`] contracts more for the same price; this one does not depend on the order.
    /// Source: seed 001, section 3.3.
    fn intersection<C: Contractor<N>>(self, other: C) -> Intersection<Self, C>
    where
        Self: Sized,
    {
        Intersection::new(self, other)
    }

    /// The contractor for the vectors that are in either set: the hull of both results.
    ///
    /// Minimal when both are. Source: seed 001, section 3.3.
    fn union<C: Contractor<N>>(self, other: C) -> Union<Self, C>
    where
        Self: Sized,
    {
        Union::new(self, other)
    }

    /// The contractor for the vectors that are in both sets, `other` contracting what `self` has left:
    /// `other ∘ self`.
    ///
    /// Source: seed 001, section 3.3.
    fn then<C: Contractor<N>>(self, other: C) -> Then<Self, C>
    where
        Self: Sized,
    {
        Then::new(self, other)
    }

    /// The contractor that is repeated until one pass takes less than `ratio` of its width from every side; see
    /// [`Fixpoint`] for what bounds the number of passes.
    ///
    /// Source: seed 001, section 3.3 (repetition).
    fn fixpoint(self, ratio: f64) -> Fixpoint<Self>
    where
        Self: Sized,
    {
        Fixpoint::new(self, ratio)
    }

    /// The contractor for the vectors that `bijection` maps into this set: `f⁻¹ ∘ C ∘ f`. Minimal when this one is.
    ///
    /// ```
    /// use shoal_interval::contractor::{Contractor, Ring, Symmetry};
    /// use shoal_interval::{Interval, IntervalBox};
    ///
    /// let ring = Ring::new(IntervalBox::from([Interval::new(3.0, 3.0)?, Interval::ZERO]), Interval::ONE);
    /// let mirrored = ring.transformed(Symmetry::axial(0, Interval::ZERO));
    /// let anywhere = mirrored.contract(IntervalBox::ENTIRE);
    /// assert_eq!(anywhere, IntervalBox::from([Interval::new(-4.0, -2.0)?, Interval::new(-1.0, 1.0)?]));
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: seed 001, section 3.3, theorem.
    fn transformed<B: BoxBijection<N>>(self, bijection: B) -> Transformed<Self, B>
    where
        Self: Sized,
    {
        Transformed::new(self, bijection)
    }

    /// The contractor for this set and all its copies, each `period` further along `axis`; see [`Modulo`].
    ///
    /// Source: seed 001, section 3.3 (modulo).
    fn modulo(self, axis: usize, period: Interval) -> Modulo<Self>
    where
        Self: Sized,
    {
        Modulo::new::<N>(self, axis, period)
    }

    /// The contractor for `N` chosen axes of a box of `M` dimensions; the other axes are left alone.
    ///
    /// ```
    /// use shoal_interval::contractor::{Contractor, Sum};
    /// use shoal_interval::{Interval, IntervalBox};
    ///
    /// // x[3] = x[0] + x[1]
    /// let sum = Sum.on_axes::<4>([0, 1, 3]);
    /// let side = Interval::new(1.0, 2.0)?;
    /// let contracted = sum.contract(IntervalBox::from([side, side, side, Interval::ENTIRE]));
    /// assert_eq!(contracted[3], Interval::new(2.0, 4.0)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// # Panics
    /// When an axis is not below `M`, as any index would.
    fn on_axes<const M: usize>(self, axes: [usize; N]) -> OnAxes<Self, N, M>
    where
        Self: Sized,
    {
        OnAxes::new(self, axes)
    }

    /// The contractor for the first `M` of the `N = M + P` axes, the last `P` being known to lie in `parameters`.
    ///
    /// It stands for the vectors that satisfy the constraint with *some* parameters in their box.
    ///
    /// ```
    /// use shoal_interval::contractor::{Contractor, Sum};
    /// use shoal_interval::{Interval, IntervalBox};
    ///
    /// // x + y in [0, 1]
    /// let band = Sum.with_parameters::<2, 1>(IntervalBox::from([Interval::new(0.0, 1.0)?]));
    /// let contracted = band.contract(IntervalBox::from([Interval::ENTIRE, Interval::new(2.0, 3.0)?]));
    /// assert_eq!(contracted[0], Interval::new(-3.0, -1.0)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    fn with_parameters<const M: usize, const P: usize>(
        self,
        parameters: IntervalBox<P>,
    ) -> WithParameters<Self, N, P>
    where
        Self: Sized,
    {
        const { assert!(M + P == N, "the free axes and the parameters make up all axes of the contractor") };
        WithParameters::new(self, parameters)
    }
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

impl Contracted {
    /// What happened, when an in-place contractor that works on copies has put its results back.
    #[inline]
    fn from_flags(empty: bool, narrowed: bool) -> Contracted {
        match (empty, narrowed) {
            (true, _) => Contracted::Empty,
            (false, true) => Contracted::Narrowed,
            (false, false) => Contracted::Unchanged,
        }
    }
}

/// Puts the contracted intervals in the place of the old ones, all empty if one is, and says what that changed.
#[inline]
fn replace<const N: usize>(variables: [&mut Interval; N], contracted: [Interval; N]) -> Contracted {
    let empty = contracted.iter().any(|interval| interval.is_empty());
    let mut narrowed = false;
    for (variable, interval) in variables.into_iter().zip(contracted) {
        narrowed |= *variable != interval;
        *variable = if empty { Interval::EMPTY } else { interval };
    }
    Contracted::from_flags(empty, narrowed)
}

#[cfg(test)]
mod tests;
