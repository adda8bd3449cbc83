//! Contractors of transformed sets: symmetries, translations and other bijections that turn boxes into boxes.
//!
//! Source: seed 001, section 3.3; seed 002, section 3.4.1.

use super::Contractor;
use crate::interval::Interval;
use crate::interval_box::IntervalBox;

/// A bijection that is *box-conservative*: the image of the hull of a set is the hull of its image.
///
/// What is rounded is rounded outwards, so [`forward`](BoxBijection::forward) and [`backward`](BoxBijection::backward)
/// enclose the exact images. Both map the empty box to the empty box.
///
/// Source: seed 001, equation (3.13).
pub trait BoxBijection<const N: usize> {
    /// A box that holds the image of `domain`; the smallest one, but for rounding.
    fn forward(&self, domain: IntervalBox<N>) -> IntervalBox<N>;

    /// A box that holds all that is mapped into `image`; the smallest one, but for rounding.
    fn backward(&self, image: IntervalBox<N>) -> IntervalBox<N>;

    /// This bijection and then `next`.
    fn followed_by<B: BoxBijection<N>>(self, next: B) -> FollowedBy<Self, B>
    where
        Self: Sized,
    {
        FollowedBy { first: self, second: next }
    }
}

/// A mirror on some axes: `x` becomes `2 centre - x` there.
///
/// One axis gives the axial symmetry of the plane, all axes the central symmetry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Symmetry<const N: usize> {
    /// On each axis that is mirrored, twice the centre.
    twice_centre: [Option<Interval>; N],
}

impl<const N: usize> Symmetry<N> {
    /// Mirrors one axis at `centre`, which is the enclosure of a number (zero: the sign of the axis changes).
    ///
    /// # Panics
    /// When `axis` is not below `N`, as any index would.
    pub fn axial(axis: usize, centre: Interval) -> Symmetry<N> {
        let mut twice_centre = [None; N];
        twice_centre[axis] = Some(centre + centre);
        Symmetry { twice_centre }
    }

    /// Mirrors all axes at a point, of which `centre` is the enclosure.
    pub fn central(centre: IntervalBox<N>) -> Symmetry<N> {
        Symmetry { twice_centre: std::array::from_fn(|axis| Some(centre[axis] + centre[axis])) }
    }

    /// Changes the signs of the chosen axes. Exact.
    pub fn negating(axes: [bool; N]) -> Symmetry<N> {
        Symmetry { twice_centre: axes.map(|chosen| chosen.then_some(Interval::ZERO)) }
    }
}

impl<const N: usize> BoxBijection<N> for Symmetry<N> {
    #[inline]
    fn forward(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        IntervalBox::from(std::array::from_fn(|axis| match self.twice_centre[axis] {
            Some(twice) => twice - domain[axis],
            None => domain[axis],
        }))
    }

    #[inline]
    fn backward(&self, image: IntervalBox<N>) -> IntervalBox<N> {
        self.forward(image)
    }
}

/// Adds the same vector to all: `x` becomes `x + offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Translation<const N: usize> {
    /// The vector that is added, or its enclosure.
    pub offset: IntervalBox<N>,
}

impl<const N: usize> BoxBijection<N> for Translation<N> {
    #[inline]
    fn forward(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        domain + self.offset
    }

    #[inline]
    fn backward(&self, image: IntervalBox<N>) -> IntervalBox<N> {
        image - self.offset
    }
}

/// Puts the axes into another order. Exact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Permutation<const N: usize> {
    order: [usize; N],
}

impl<const N: usize> Permutation<N> {
    /// Axis `i` of the image is axis `order[i]` of the domain; `None` unless each axis appears exactly once.
    pub fn new(order: [usize; N]) -> Option<Permutation<N>> {
        (0..N).all(|axis| order.contains(&axis)).then_some(Permutation { order })
    }

    /// Exchanges two axes.
    ///
    /// # Panics
    /// When an axis is not below `N`, as any index would.
    pub fn swapping(one: usize, other: usize) -> Permutation<N> {
        let mut order = std::array::from_fn(|axis| axis);
        order.swap(one, other);
        Permutation { order }
    }
}

impl<const N: usize> BoxBijection<N> for Permutation<N> {
    #[inline]
    fn forward(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        IntervalBox::from(self.order.map(|axis| domain[axis]))
    }

    #[inline]
    fn backward(&self, image: IntervalBox<N>) -> IntervalBox<N> {
        let mut domain = image;
        for (place, axis) in self.order.into_iter().enumerate() {
            domain[axis] = image[place];
        }
        domain
    }
}

/// Stretches each axis: `x` becomes `factor x`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scaling<const N: usize> {
    factors: [Interval; N],
}

impl<const N: usize> Scaling<N> {
    /// One factor for each axis; `None` unless all are positive and finite. Use [`Symmetry`] to change signs.
    pub fn new(factors: [f64; N]) -> Option<Scaling<N>> {
        let positive = factors.iter().all(|&factor| factor > 0.0 && factor.is_finite());
        positive.then(|| Scaling { factors: factors.map(|factor| Interval::spanning(factor, factor)) })
    }
}

impl<const N: usize> BoxBijection<N> for Scaling<N> {
    #[inline]
    fn forward(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        IntervalBox::from(std::array::from_fn(|axis| domain[axis] * self.factors[axis]))
    }

    #[inline]
    fn backward(&self, image: IntervalBox<N>) -> IntervalBox<N> {
        IntervalBox::from(std::array::from_fn(|axis| image[axis] / self.factors[axis]))
    }
}

/// Two bijections in turn; made by [`BoxBijection::followed_by`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FollowedBy<A, B> {
    first: A,
    second: B,
}

impl<const N: usize, A: BoxBijection<N>, B: BoxBijection<N>> BoxBijection<N> for FollowedBy<A, B> {
    #[inline]
    fn forward(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        self.second.forward(self.first.forward(domain))
    }

    #[inline]
    fn backward(&self, image: IntervalBox<N>) -> IntervalBox<N> {
        self.first.backward(self.second.backward(image))
    }
}

/// The contractor of a transformed set, `f⁻¹ ∘ C ∘ f`; made by [`Contractor::transformed`].
///
/// The result is intersected with the domain, because the rounding of the bijection may have widened it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transformed<C, B> {
    contractor: C,
    bijection: B,
}

impl<C, B> Transformed<C, B> {
    pub(super) fn new(contractor: C, bijection: B) -> Transformed<C, B> {
        Transformed { contractor, bijection }
    }
}

impl<const N: usize, C: Contractor<N>, B: BoxBijection<N>> Contractor<N> for Transformed<C, B> {
    #[inline]
    fn contract(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        self.bijection.backward(self.contractor.contract(self.bijection.forward(domain))) & domain
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contractor::Ring;
    use crate::strategies::interval_with_members;
    use nalgebra::Vector2;
    use proptest::prelude::*;

    fn over(lower: f64, upper: f64) -> Interval {
        Interval::new(lower, upper).unwrap()
    }

    fn there_and_back(bijection: &impl BoxBijection<2>, domain: IntervalBox<2>) -> IntervalBox<2> {
        bijection.backward(bijection.forward(domain))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn nothing_is_lost_there_and_back(x in interval_with_members(), y in interval_with_members(), c in interval_with_members()) {
            let domain = IntervalBox::from([x.0, y.0]);
            let centre = IntervalBox::from([c.0, c.0]);
            prop_assert!(domain.is_subset_of(&there_and_back(&Symmetry::central(centre), domain)));
            let moved = there_and_back(&Translation { offset: centre }, domain);
            prop_assert!(domain.is_subset_of(&moved));
            let scaling = Scaling::new([0.1, 3.0]).unwrap();
            prop_assert!(domain.is_subset_of(&there_and_back(&scaling, domain)));
            let exact = Symmetry::negating([true, false]).followed_by(Permutation::swapping(0, 1));
            prop_assert_eq!(there_and_back(&exact, domain), domain);
        }
    }

    #[test]
    fn where_points_go() {
        let point = |x: f64, y: f64| IntervalBox::centred(&Vector2::new(x, y), 0.0);
        let p = point(3.0, 5.0);
        assert_eq!(Symmetry::axial(1, Interval::ONE).forward(p), point(3.0, -3.0));
        assert_eq!(Symmetry::central(point(1.0, 2.0)).forward(p), point(-1.0, -1.0));
        assert_eq!(Translation { offset: point(1.0, 2.0) }.backward(p), point(2.0, 3.0));
        let turn = Permutation::new([1, 0]).unwrap().followed_by(Symmetry::negating([true, false]));
        assert_eq!((turn.forward(p), turn.backward(p)), (point(-5.0, 3.0), point(5.0, -3.0)));
        assert_eq!(Scaling::new([2.0, 4.0]).unwrap().backward(p), point(1.5, 1.25));
    }

    #[test]
    fn what_is_no_bijection_is_refused() {
        assert_eq!(Permutation::new([0, 0]), None);
        assert_eq!(Permutation::new([0, 2]), None);
        assert_eq!(Scaling::new([0.0]), None);
        assert_eq!(Scaling::new([f64::NAN]), None);
    }

    #[test]
    fn a_stretched_ring_is_an_ellipse() {
        let unit = Ring::new(IntervalBox::from([Interval::ZERO; 2]), Interval::ONE);
        // Maps the ellipse (x/4)² + (y/2)² = 1 onto the unit circle.
        let ellipse = unit.transformed(Scaling::new([0.25, 0.5]).unwrap());
        let whole = ellipse.contract(IntervalBox::ENTIRE);
        assert_eq!(whole, IntervalBox::from([over(-4.0, 4.0), over(-2.0, 2.0)]));
        let moved = ellipse
            .transformed(Translation { offset: IntervalBox::from([over(-10.0, -10.0), Interval::ZERO]) });
        assert_eq!(moved.contract(IntervalBox::ENTIRE)[0], over(6.0, 14.0));
        assert!(moved.contract(IntervalBox::from([over(0.0, 5.0); 2])).is_empty());
    }
}
