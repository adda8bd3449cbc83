//! A fuzzy range to a point.

use super::{FuzzyError, Grade};
use crate::interval::Interval;
use crate::separator::Ring;
use nalgebra::SVector;

/// The vectors whose distance to a point is about right: a fuzzy set whose membership, over the distance, is a trapezium.
///
/// It is 1 for distances in the core, 0 outside of the support, and straight in between.
///
/// Source: seed 000, figure 5.5.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FuzzyRing<const N: usize> {
    centre: SVector<f64, N>,
    support: Interval,
    core: Interval,
}

impl<const N: usize> FuzzyRing<N> {
    /// The fuzzy set around `centre` with these distances, in the unit of the axes.
    ///
    /// # Errors
    /// [`FuzzyError::Core`] when the core is empty or not inside of the support, or when they are not bounded.
    pub fn new(
        centre: SVector<f64, N>,
        support: Interval,
        core: Interval,
    ) -> Result<FuzzyRing<N>, FuzzyError> {
        if core.is_empty() || !core.is_subset_of(support) || !support.is_bounded() {
            return Err(FuzzyError::Core);
        }
        Ok(FuzzyRing { centre, support, core })
    }

    /// The separator of the vectors whose membership is at least `grade`; at zero, of the support.
    pub fn cut(&self, grade: Grade) -> Ring<N> {
        let (lower, upper) = self.bounds(grade);
        Ring::with_uncertain_range(self.centre, lower, upper)
    }

    /// The fuzzy set as `count` crisp granules of equal worth, each inside of the one before.
    ///
    /// The granules are separators with some play: their inner approximations give a staircase below the membership, their
    /// outer ones a staircase above it, each within `1 / count` of it. A score function that uses the mean of the
    /// steps where the fuzzy set would stand has alpha-cuts whose inner and outer approximations hold for the fuzzy set.
    ///
    /// Source: seed 000, figure 5.6 (the membership discretized).
    pub fn steps(&self, count: u32) -> Vec<Ring<N>> {
        (1..=count)
            .map(|step| {
                let (above_lower, above_upper) = self.bounds(Grade::from_parts(step - 1, count));
                let (below_lower, below_upper) = self.bounds(Grade::from_parts(step, count));
                Ring::with_uncertain_range(self.centre, above_lower | below_lower, above_upper | below_upper)
            })
            .collect()
    }

    /// Where the distances with at least this membership begin and end, enclosed.
    fn bounds(&self, grade: Grade) -> (Interval, Interval) {
        let (numerator, denominator) = grade.parts();
        let exact = |x: f64| Interval::spanning(x, x);
        let between = |support: f64, core: f64| {
            if numerator == 0 {
                return exact(support);
            }
            if numerator == denominator {
                return exact(core);
            }
            let share = grade.to_interval();
            (exact(support) + share * (exact(core) - exact(support))) & Interval::spanning(support, core)
        };
        (between(self.support.lower(), self.core.lower()), between(self.support.upper(), self.core.upper()))
    }
}
