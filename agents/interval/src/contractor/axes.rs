//! A contractor for some axes of a bigger box, and one whose last axes are known.

use super::Contractor;
use crate::interval_box::IntervalBox;

/// A contractor of `K` dimensions on chosen axes of a box of `N`; made by [`Contractor::on_axes`].
///
/// An axis may be chosen twice: `Product.on_axes::<2>([0, 0, 1])` is `y = x x`, though [`Square`](super::Square) contracts
/// better.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OnAxes<C, const K: usize, const N: usize> {
    contractor: C,
    axes: [usize; K],
}

impl<C, const K: usize, const N: usize> OnAxes<C, K, N> {
    pub(super) fn new(contractor: C, axes: [usize; K]) -> OnAxes<C, K, N> {
        for axis in axes {
            assert!(axis < N, "there is no axis {axis} in a box of {N} dimensions");
        }
        OnAxes { contractor, axes }
    }
}

impl<C: Contractor<K>, const K: usize, const N: usize> Contractor<N> for OnAxes<C, K, N> {
    #[inline]
    fn contract(&self, mut domain: IntervalBox<N>) -> IntervalBox<N> {
        if domain.is_empty() {
            return IntervalBox::EMPTY;
        }
        let contracted = self.contractor.contract(IntervalBox::from(self.axes.map(|axis| domain[axis])));
        for (place, axis) in self.axes.into_iter().enumerate() {
            // Intersected, because an axis that was chosen twice was contracted twice.
            domain[axis] = domain[axis] & contracted[place];
            if domain[axis].is_empty() {
                return IntervalBox::EMPTY;
            }
        }
        domain
    }
}

/// A contractor of `M` dimensions whose last `P` axes are known; made by [`Contractor::with_parameters`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WithParameters<C, const M: usize, const P: usize> {
    contractor: C,
    parameters: IntervalBox<P>,
}

impl<C, const M: usize, const P: usize> WithParameters<C, M, P> {
    pub(super) fn new(contractor: C, parameters: IntervalBox<P>) -> WithParameters<C, M, P> {
        WithParameters { contractor, parameters }
    }
}

impl<C: Contractor<M>, const M: usize, const P: usize, const N: usize> Contractor<N>
    for WithParameters<C, M, P>
{
    #[inline]
    fn contract(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        const { assert!(N + P == M, "the free axes and the parameters make up all axes of the contractor") };
        let whole = IntervalBox::from(std::array::from_fn(|axis| {
            if axis < N { domain[axis] } else { self.parameters[axis - N] }
        }));
        let contracted = self.contractor.contract(whole);
        if contracted.is_empty() {
            return IntervalBox::EMPTY;
        }
        IntervalBox::from(std::array::from_fn(|axis| contracted[axis]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contractor::{Product, Sum};
    use crate::interval::Interval;

    fn over(lower: f64, upper: f64) -> Interval {
        Interval::new(lower, upper).unwrap()
    }

    #[test]
    fn other_axes_are_left_alone() {
        let domain = IntervalBox::from([over(1.0, 2.0), over(-7.0, 7.0), over(0.0, 1.0), Interval::ENTIRE]);
        let contracted = Sum.on_axes::<4>([2, 0, 3]).contract(domain);
        assert_eq!(contracted, IntervalBox::from([domain[0], domain[1], domain[2], over(1.0, 3.0)]));
    }

    #[test]
    fn a_contradiction_on_some_axes_empties_all() {
        let domain = IntervalBox::from([over(1.0, 2.0), Interval::ONE, over(1.0, 2.0), over(9.0, 9.0)]);
        assert_eq!(Sum.on_axes::<4>([0, 2, 3]).contract(domain), IntervalBox::EMPTY);
        assert_eq!(Sum.on_axes::<4>([0, 2, 3]).contract(IntervalBox::EMPTY), IntervalBox::EMPTY);
    }

    #[test]
    fn an_axis_chosen_twice() {
        // y = x x with x in [2, 3]: the two factors are contracted apart and then agree.
        let contracted =
            Product.on_axes::<2>([0, 0, 1]).contract(IntervalBox::from([over(2.0, 3.0), over(0.0, 5.0)]));
        assert_eq!(contracted, IntervalBox::from([over(2.0, 2.5), over(4.0, 5.0)]));
    }

    #[test]
    #[should_panic(expected = "no axis 3")]
    fn an_axis_that_is_not_there() {
        let _ = Sum.on_axes::<3>([0, 1, 3]);
    }

    #[test]
    fn parameters_are_not_contracted_but_used() {
        let doubled = Product.with_parameters::<1, 2>(IntervalBox::from([over(2.0, 4.0), over(8.0, 8.0)]));
        assert_eq!(
            doubled.contract(IntervalBox::from([Interval::ENTIRE])),
            IntervalBox::from([over(2.0, 4.0)])
        );
        assert!(doubled.contract(IntervalBox::from([over(-9.0, 0.0)])).is_empty());
        assert!(Contractor::<1>::contract(&doubled, IntervalBox::EMPTY).is_empty());
    }
}
