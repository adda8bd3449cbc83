//! The separator of one side of a line, of a plane.

use super::Separator;
use crate::interval::Interval;
use crate::interval_box::IntervalBox;
use nalgebra::SVector;

/// The vectors `x` with `normal · x <= offset`: one side of a line in two dimensions, of a plane in three.
///
/// Both contractors are minimal up to rounding, since each coordinate occurs once in the inequality. A normal or an
/// offset that is not finite says nothing: the separator then removes nothing.
///
/// ```
/// use nalgebra::Vector2;
/// use shoal_interval::separator::{HalfSpace, Separator};
/// use shoal_interval::{Interval, IntervalBox};
///
/// let below_diagonal = HalfSpace::new(Vector2::new(-1.0, 1.0), 0.0);
/// let domain = IntervalBox::from([Interval::new(0.0, 1.0)?, Interval::new(0.5, 2.0)?]);
/// assert_eq!(below_diagonal.outer(domain), IntervalBox::from([Interval::new(0.5, 1.0)?, Interval::new(0.5, 1.0)?]));
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfSpace<const N: usize> {
    normal: SVector<f64, N>,
    offset: f64,
}

impl<const N: usize> HalfSpace<N> {
    /// The separator of the vectors whose product with `normal` is at most `offset`, both in the units of the axes.
    pub fn new(normal: SVector<f64, N>, offset: f64) -> HalfSpace<N> {
        HalfSpace { normal, offset }
    }

    /// Contracts with `sign * (normal · x - offset) <= 0`.
    fn contract(&self, domain: IntervalBox<N>, sign: f64) -> IntervalBox<N> {
        let finite = self.offset.is_finite() && self.normal.iter().all(|x| x.is_finite());
        if domain.is_empty() || !finite {
            return domain;
        }
        let product = |axis: usize| domain[axis] * (sign * self.normal[axis]);
        let mut left = domain;
        for axis in 0..N {
            let others = (0..N).filter(|&other| other != axis).map(product);
            let sum = others.fold(Interval::ZERO, |sum, product| sum + product);
            let at_most = Interval::spanning(sign * self.offset, sign * self.offset) - sum;
            let allowed = at_most + Interval::from_bounds(f64::NEG_INFINITY, 0.0);
            let factor = sign * self.normal[axis];
            left[axis] = Interval::spanning(factor, factor).mul_rev(allowed, domain[axis]);
            if left[axis].is_empty() {
                return IntervalBox::EMPTY;
            }
        }
        left
    }
}

impl<const N: usize> Separator<N> for HalfSpace<N> {
    fn inner(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        self.contract(domain, -1.0)
    }

    fn outer(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        self.contract(domain, 1.0)
    }
}
