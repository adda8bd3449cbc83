//! Alpha-cuts: the vectors whose score reaches a grade.

use super::{FuzzyError, Grade, ScoreFunction};
use crate::contractor::Contractor;
use crate::interval::Interval;
use crate::interval_box::IntervalBox;
use crate::separator::{Separator, with_boxes};

/// The hull of the numbers of `domain` whose score reaches `grade`, where the granules are intervals.
///
/// Minimal and exact. The score rises only where a granule begins and falls only where one ends, so that only bounds are
/// looked at; they count as members, which the seed's line 7 (`>` for `>=`) forgets. Takes `m` scores for `m`
/// granules. Granules that are missing count as empty.
///
/// Source: seed 000, algorithm 1.
pub fn contract_interval(
    score: &ScoreFunction,
    grade: Grade,
    granules: &[Interval],
    domain: Interval,
) -> Interval {
    let granule = |index: usize| granules.get(index).copied().unwrap_or(Interval::EMPTY);
    where_holds(score.granules(), &granule, domain, &|members| score.of(members) >= grade)
}

/// A box that holds the vectors of `domain` whose score reaches `grade`, where the granules are boxes.
///
/// Axis by axis as in [`contract_interval`], since a vector is in no more granules than each of its coordinates is. Not
/// always minimal: that is NP-hard.
///
/// Source: seed 000, algorithm 2 and theorem 5.2.3.
pub fn contract_box<const N: usize>(
    score: &ScoreFunction,
    grade: Grade,
    granules: &[IntervalBox<N>],
    domain: IntervalBox<N>,
) -> IntervalBox<N> {
    boxes_where(score.granules(), granules, domain, &|members| score.of(members) >= grade)
}

/// The contractor of an alpha-cut, from contractors of its granules.
///
/// Source: seed 000, algorithm 3 and theorem 5.2.4.
#[derive(Debug, Clone, PartialEq)]
pub struct AlphaCutContractor<C> {
    score: ScoreFunction,
    grade: Grade,
    granules: Vec<C>,
}

impl<C> AlphaCutContractor<C> {
    /// The contractor of the vectors whose score reaches `grade`.
    ///
    /// # Errors
    /// [`FuzzyError::GranuleCount`] when the score function is one of another number of granules.
    pub fn new(
        score: ScoreFunction,
        grade: Grade,
        granules: Vec<C>,
    ) -> Result<AlphaCutContractor<C>, FuzzyError> {
        check_count(&score, granules.len())?;
        Ok(AlphaCutContractor { score, grade, granules })
    }
}

impl<const N: usize, C: Contractor<N>> Contractor<N> for AlphaCutContractor<C> {
    fn contract(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        with_boxes(
            &self.granules,
            |granule| granule.contract(domain),
            |boxes| contract_box(&self.score, self.grade, boxes, domain),
        )
    }
}

/// The separator of an alpha-cut, from separators of its granules.
///
/// Its inner contractor follows from De Morgan's rule: a vector is not in the cut when the granules that it is not in leave
/// too low a score.
///
/// ```
/// use nalgebra::Vector2;
/// use shoal_interval::fuzzy::{AlphaCut, Grade, ScoreFunction};
/// use shoal_interval::paving::{Options, pave};
/// use shoal_interval::separator::Ring;
/// use shoal_interval::{Interval, IntervalBox};
///
/// let ring = |x, lower, upper| Ring::new(Vector2::new(x, 0.0), Interval::new(lower, upper).unwrap());
/// let granules = vec![ring(-2.0, 2.0, 3.0), ring(2.0, 2.0, 3.0)];
/// // The second range is worth two thirds: it alone is enough for one half.
/// let cut = AlphaCut::new(ScoreFunction::weighted_mean(&[1, 2])?, Grade::new(1, 2)?, granules)?;
/// let paving = pave(&cut, IntervalBox::from([Interval::new(-6.0, 6.0)?; 2]), &Options::new(0.1))?;
/// let area = 5.0 * std::f64::consts::PI;
/// assert!(paving.inner_volume().upper() <= area && area <= paving.outer_volume().lower());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// Source: seed 000, theorem 5.2.1, equations (5.15) and (5.16).
#[derive(Debug, Clone, PartialEq)]
pub struct AlphaCut<S> {
    score: ScoreFunction,
    grade: Grade,
    granules: Vec<S>,
}

impl<S> AlphaCut<S> {
    /// The separator of the vectors whose score reaches `grade`.
    ///
    /// # Errors
    /// [`FuzzyError::GranuleCount`] when the score function is one of another number of granules.
    pub fn new(score: ScoreFunction, grade: Grade, granules: Vec<S>) -> Result<AlphaCut<S>, FuzzyError> {
        check_count(&score, granules.len())?;
        Ok(AlphaCut { score, grade, granules })
    }
}

impl<const N: usize, S: Separator<N>> Separator<N> for AlphaCut<S> {
    fn inner(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        let fails = |not_in: &dyn Fn(usize) -> bool| self.score.of(|granule| !not_in(granule)) < self.grade;
        with_boxes(
            &self.granules,
            |granule| granule.inner(domain),
            |boxes| boxes_where(self.score.granules(), boxes, domain, &fails),
        )
    }

    fn outer(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        with_boxes(
            &self.granules,
            |granule| granule.outer(domain),
            |boxes| contract_box(&self.score, self.grade, boxes, domain),
        )
    }
}

fn check_count(score: &ScoreFunction, given: usize) -> Result<(), FuzzyError> {
    if score.granules() == given {
        Ok(())
    } else {
        Err(FuzzyError::GranuleCount { expected: score.granules(), given })
    }
}

/// A monotone condition on the granules that something is in.
type Condition<'a> = &'a dyn Fn(&dyn Fn(usize) -> bool) -> bool;

fn boxes_where<const N: usize>(
    count: usize,
    granules: &[IntervalBox<N>],
    domain: IntervalBox<N>,
    holds: Condition<'_>,
) -> IntervalBox<N> {
    let mut left = domain;
    for axis in 0..N {
        let side = |index: usize| match granules.get(index) {
            Some(granule) if !granule.is_empty() => granule[axis],
            _ => Interval::EMPTY,
        };
        left[axis] = where_holds(count, &side, domain[axis], holds);
        if left[axis].is_empty() {
            return IntervalBox::EMPTY;
        }
    }
    left
}

/// The hull of the numbers of `domain` for which the condition holds.
fn where_holds(
    count: usize,
    granule: &dyn Fn(usize) -> Interval,
    domain: Interval,
    holds: Condition<'_>,
) -> Interval {
    if domain.is_empty() {
        return Interval::EMPTY;
    }
    // An infinite bound stands for the numbers beyond all others, so it is compared like one.
    let holds_at = |x: f64| holds(&|index| granule(index).lower() <= x && x <= granule(index).upper());
    let bounds = |bound: fn(Interval) -> f64| {
        let of_granules = (0..count).map(move |index| bound(granule(index)));
        std::iter::once(bound(domain))
            .chain(of_granules)
            .filter(|&x| domain.lower() <= x && x <= domain.upper())
    };
    // Asking only about what would improve on the best so far saves most of the scores.
    let mut lower = f64::INFINITY;
    for x in bounds(Interval::lower) {
        if x < lower && holds_at(x) {
            lower = x;
        }
    }
    if lower == f64::INFINITY {
        return Interval::EMPTY;
    }
    let mut upper = lower;
    for x in bounds(Interval::upper) {
        if x > upper && holds_at(x) {
            upper = x;
        }
    }
    Interval::from_bounds(lower, upper)
}
