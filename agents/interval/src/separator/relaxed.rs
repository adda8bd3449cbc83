//! The separator of a relaxed intersection, which tolerates a number of outliers.

use super::{Separation, Separator};
use crate::contractor::relaxed_intersection_of_boxes;
use crate::interval_box::IntervalBox;
use std::marker::PhantomData;

/// The separator of the vectors that are in all sets of a list but at most `outliers` of them.
///
/// With no outlier this is their [`intersection_of`](super::intersection_of), with one less than there are sets their
/// [`union_of`](super::union_of), with as many as there are sets the universe. A vector is not in the relaxed set of `m` sets
/// with `q` outliers when it is in at least `q + 1` of the complements, so the inner contractor relaxes the inner
/// boxes with `m - q - 1` outliers.
///
/// Axis by axis, each side of the result starts and ends where enough of the contracted boxes overlap: minimal for boxes
/// of one dimension, not always for more (that problem is NP-hard). Takes `m log m` steps an axis.
///
/// ```
/// use shoal_interval::separator::{InBox, Separator, q_intersection};
/// use shoal_interval::{Interval, IntervalBox};
///
/// let granule = |lower, upper| InBox::new(IntervalBox::from([Interval::new(lower, upper).unwrap()]));
/// let most = q_intersection([granule(0.0, 4.0), granule(3.0, 6.0), granule(9.0, 9.5)], 1);
/// assert_eq!(most.outer(IntervalBox::ENTIRE)[0], Interval::new(3.0, 4.0)?);
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
///
/// Source: seed 001, section 2.4.4; seed 000, equation (2.34); Jaulin, *Robust set-membership state estimation*, 2009.
pub fn q_intersection<S, L: AsRef<[S]>>(separators: L, outliers: usize) -> QIntersection<S, L> {
    QIntersection { separators, outliers, kind: PhantomData }
}

/// The separator made by [`q_intersection`].
#[derive(Debug, Clone, Copy)]
pub struct QIntersection<S, L> {
    separators: L,
    outliers: usize,
    kind: PhantomData<fn() -> S>,
}

impl<const N: usize, S: Separator<N>, L: AsRef<[S]>> Separator<N> for QIntersection<S, L> {
    fn inner(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        let separators = self.separators.as_ref();
        with_boxes(
            separators,
            |separator| separator.inner(domain),
            |boxes| {
                // In `outliers + 1` of `m` complements is in all but `m - outliers - 1` of them, if there are so many.
                match separators.len().checked_sub(self.outliers.saturating_add(1)) {
                    Some(relaxed) => relaxed_intersection_of_boxes(boxes, relaxed) & domain,
                    None => IntervalBox::EMPTY,
                }
            },
        )
    }

    fn outer(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        let separators = self.separators.as_ref();
        with_boxes(
            separators,
            |separator| separator.outer(domain),
            |boxes| relaxed_intersection_of_boxes(boxes, self.outliers) & domain,
        )
    }

    fn separate(&self, domain: IntervalBox<N>) -> Separation<N> {
        Separation { inner: self.inner(domain), outer: self.outer(domain) }
    }
}

/// Up to this many boxes need no memory of their own.
const FEW: usize = 16;

/// Hands on the boxes that `contract` makes of each separator, without an allocation when they are few.
pub(crate) fn with_boxes<const N: usize, S, R>(
    separators: &[S],
    contract: impl Fn(&S) -> IntervalBox<N>,
    then: impl FnOnce(&[IntervalBox<N>]) -> R,
) -> R {
    if separators.len() > FEW {
        let boxes: Vec<IntervalBox<N>> = separators.iter().map(contract).collect();
        return then(&boxes);
    }
    let mut boxes = [IntervalBox::EMPTY; FEW];
    for (contracted, separator) in boxes.iter_mut().zip(separators) {
        *contracted = contract(separator);
    }
    then(&boxes[..separators.len()])
}
