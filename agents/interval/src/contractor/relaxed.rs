//! Intersections that forgive `q` outliers.
//!
//! Source: seed 001, section 2.5; seed 000, equation (2.34); seed 002, section 3.6.

use super::Contractor;
use crate::interval::Interval;
use crate::interval_box::IntervalBox;

/// Up to this many sets are sorted on the stack; more are sorted on the heap.
const ON_STACK: usize = 32;

/// The hull of the numbers that are in all `intervals` but at most `outliers` of them.
///
/// No outlier is the plain intersection; all but one is the hull; as many outliers as intervals, or more, say nothing, and
/// the answer is [`Interval::ENTIRE`]. Exact; takes `O(m log m)` for `m` intervals.
///
/// ```
/// use shoal_interval::Interval;
/// use shoal_interval::contractor::relaxed_intersection;
///
/// let measured = [Interval::new(0.0, 4.0)?, Interval::new(2.0, 6.0)?, Interval::new(5.0, 9.0)?];
/// assert!(relaxed_intersection(&measured, 0).is_empty());
/// assert_eq!(relaxed_intersection(&measured, 1), Interval::new(2.0, 6.0)?);
/// assert_eq!(relaxed_intersection(&measured, 2), Interval::new(0.0, 9.0)?);
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
///
/// Source: seed 000, equation (2.34).
pub fn relaxed_intersection(intervals: &[Interval], outliers: usize) -> Interval {
    let side = |index: usize| intervals[index];
    if intervals.len() <= ON_STACK {
        relax(intervals.len(), side, outliers, &mut [0.0; ON_STACK], &mut [0.0; ON_STACK])
    } else {
        let mut room = vec![0.0; 2 * intervals.len()];
        let (lowers, uppers) = room.split_at_mut(intervals.len());
        relax(intervals.len(), side, outliers, lowers, uppers)
    }
}

/// A box that holds every vector that is in all `boxes` but at most `outliers` of them: [`relaxed_intersection`] axis by
/// axis.
///
/// Not always the smallest such box: on each axis, other boxes may be the outliers.
///
/// ```
/// use shoal_interval::contractor::relaxed_intersection_of_boxes;
/// use shoal_interval::{Interval, IntervalBox};
///
/// let over = |lower, upper| Interval::new(lower, upper).unwrap();
/// let boxes = [
///     IntervalBox::from([over(0.0, 4.0), over(0.0, 4.0)]),
///     IntervalBox::from([over(2.0, 6.0), over(2.0, 6.0)]),
///     IntervalBox::from([over(5.0, 9.0), over(-2.0, 1.0)]),
/// ];
/// let most = relaxed_intersection_of_boxes(&boxes, 1);
/// assert_eq!(most, IntervalBox::from([over(2.0, 6.0), over(0.0, 4.0)]));
/// ```
pub fn relaxed_intersection_of_boxes<const N: usize>(
    boxes: &[IntervalBox<N>],
    outliers: usize,
) -> IntervalBox<N> {
    // A box that is empty on one axis is in none of its axes' intersections.
    let side = |axis: usize| {
        move |index: usize| {
            let candidate: &IntervalBox<N> = &boxes[index];
            if candidate.is_empty() { Interval::EMPTY } else { candidate[axis] }
        }
    };
    let sides = if boxes.len() <= ON_STACK {
        let (mut lowers, mut uppers) = ([0.0; ON_STACK], [0.0; ON_STACK]);
        std::array::from_fn(|axis| relax(boxes.len(), side(axis), outliers, &mut lowers, &mut uppers))
    } else {
        let mut room = vec![0.0; 2 * boxes.len()];
        let (lowers, uppers) = room.split_at_mut(boxes.len());
        std::array::from_fn(|axis| relax(boxes.len(), side(axis), outliers, lowers, uppers))
    };
    IntervalBox::from(sides) & IntervalBox::ENTIRE
}

/// Sweeps over the sorted bounds: the answer begins at the first lower bound and ends at the last upper bound where
/// enough intervals are open.
fn relax(
    count: usize,
    interval: impl Fn(usize) -> Interval,
    outliers: usize,
    lowers: &mut [f64],
    uppers: &mut [f64],
) -> Interval {
    let Some(needed) = count.checked_sub(outliers).filter(|&needed| needed > 0) else {
        return Interval::ENTIRE;
    };
    let mut held = 0;
    for candidate in (0..count).map(interval).filter(|candidate| !candidate.is_empty()) {
        (lowers[held], uppers[held]) = (candidate.lower(), candidate.upper());
        held += 1;
    }
    let (lowers, uppers) = (&mut lowers[..held], &mut uppers[..held]);
    lowers.sort_unstable_by(f64::total_cmp);
    uppers.sort_unstable_by(f64::total_cmp);

    // Bounds belong to their intervals: at a lower bound, only intervals that ended before it are closed.
    let mut closed = 0;
    let first = lowers.iter().enumerate().find(|&(opened, &lower)| {
        while uppers[closed] < lower {
            closed += 1;
        }
        opened + 1 >= needed + closed
    });
    let mut not_open_yet = 0;
    let last = uppers.iter().rev().enumerate().find(|&(ending_later, &upper)| {
        while lowers[held - 1 - not_open_yet] > upper {
            not_open_yet += 1;
        }
        ending_later + 1 >= needed + not_open_yet
    });
    match (first, last) {
        (Some((_, &lower)), Some((_, &upper))) => Interval::from_bounds(lower, upper),
        _ => Interval::EMPTY,
    }
}

/// The contractor for the vectors that satisfy all of `contractors` but at most `outliers` of them.
///
/// Each contracts the box alone; the results are put together by [`relaxed_intersection_of_boxes`]. With as many outliers
/// as contractors nothing is known, and the box stays as it is.
///
/// ```
/// use shoal_interval::contractor::{Contractor, Ring, q_intersection};
/// use shoal_interval::{Interval, IntervalBox};
///
/// // Three ranges, the last of which is wrong.
/// let ring = |x: f64, y: f64, range: f64| {
///     let centre = IntervalBox::from([Interval::spanning(x, x), Interval::spanning(y, y)]);
///     Ring::new(centre, Interval::centred(range, 0.5))
/// };
/// let ranges = [ring(0.0, 0.0, 5.0), ring(6.0, 0.0, 5.0), ring(3.0, -40.0, 5.0)];
/// let domain = IntervalBox::from([Interval::new(-20.0, 20.0)?; 2]);
/// assert!(q_intersection(ranges, 0).contract(domain).is_empty());
/// let robust = q_intersection(ranges, 1).fixpoint(0.01).contract(domain);
/// assert!(robust.contains(&nalgebra::Vector2::new(3.0, 4.0)));
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
///
/// Source: seed 001, section 2.5.
pub fn q_intersection<C>(contractors: impl IntoIterator<Item = C>, outliers: usize) -> QIntersection<C> {
    QIntersection { contractors: contractors.into_iter().collect(), outliers }
}

/// All constraints but a few hold; made by [`q_intersection`].
#[derive(Debug, Clone, PartialEq)]
pub struct QIntersection<C> {
    contractors: Vec<C>,
    outliers: usize,
}

impl<const N: usize, C: Contractor<N>> Contractor<N> for QIntersection<C> {
    fn contract(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        let contracted = |contractor: &C| contractor.contract(domain);
        let count = self.contractors.len();
        let relaxed = if count <= ON_STACK {
            let mut boxes = [IntervalBox::EMPTY; ON_STACK];
            for (place, contractor) in boxes.iter_mut().zip(&self.contractors) {
                *place = contracted(contractor);
            }
            relaxed_intersection_of_boxes(&boxes[..count], self.outliers)
        } else {
            let boxes: Vec<_> = self.contractors.iter().map(contracted).collect();
            relaxed_intersection_of_boxes(&boxes, self.outliers)
        };
        relaxed & domain
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contractor::from_fn;
    use proptest::prelude::*;

    fn over(lower: f64, upper: f64) -> Interval {
        Interval::new(lower, upper).unwrap()
    }

    fn printed_boxes() -> [IntervalBox<2>; 3] {
        [
            IntervalBox::from([over(0.0, 4.0), over(0.0, 4.0)]),
            IntervalBox::from([over(2.0, 6.0), over(2.0, 6.0)]),
            IntervalBox::from([over(5.0, 9.0), over(-2.0, 1.0)]),
        ]
    }

    #[test]
    fn three_boxes() {
        let domain = IntervalBox::from([over(-10.0, 10.0); 2]);
        let among =
            |q| q_intersection(printed_boxes().map(|held| from_fn(move |x| x & held)), q).contract(domain);
        assert!(among(0).is_empty());
        assert_eq!(among(1), IntervalBox::from([over(2.0, 6.0), over(0.0, 4.0)]));
        assert_eq!(among(2), IntervalBox::from([over(0.0, 9.0), over(-2.0, 6.0)]));
        assert_eq!(among(3), domain);
        assert_eq!(among(usize::MAX), domain);
    }

    #[test]
    fn odd_lists() {
        assert_eq!(relaxed_intersection(&[], 0), Interval::ENTIRE);
        assert_eq!(relaxed_intersection(&[Interval::EMPTY], 0), Interval::EMPTY);
        assert_eq!(relaxed_intersection(&[Interval::EMPTY, Interval::ENTIRE], 1), Interval::ENTIRE);
        assert!(relaxed_intersection(&[Interval::EMPTY, Interval::EMPTY], 1).is_empty());
        let touching = [over(0.0, 1.0), over(1.0, 2.0), over(-0.0, 0.0)];
        assert_eq!(relaxed_intersection(&touching, 1), over(0.0, 1.0));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn exactly_the_numbers_in_enough_intervals(
            bounds in prop::collection::vec((-8_i32..8, -8_i32..8), 0..40),
            outliers in 0_usize..6,
        ) {
            // Whole bounds meet often, and half-whole numbers stand for all between them.
            let intervals: Vec<Interval> =
                bounds.iter().map(|&(a, b)| Interval::new(f64::from(a), f64::from(b)).unwrap_or(Interval::EMPTY)).collect();
            let enough = |x: f64| intervals.iter().filter(|i| i.contains(x)).count() + outliers >= intervals.len();
            let held = (-40..=40).map(|half| f64::from(half) / 2.0).filter(|&x| enough(x));
            let expected = held.fold(Interval::EMPTY, |hull, x| hull | over(x, x));
            let answer = relaxed_intersection(&intervals, outliers);
            if outliers >= intervals.len() {
                prop_assert_eq!(answer, Interval::ENTIRE);
            } else {
                prop_assert_eq!(answer, expected);
            }
        }
    }
}
