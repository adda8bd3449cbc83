//! How many of the measurements must be wrong.

use super::{Options, Paving, PavingError, pave};
use crate::interval_box::IntervalBox;
use crate::separator::{Separator, q_intersection};

/// What [`gomne`] finds out about the outliers among some sets.
#[derive(Debug, Clone, PartialEq)]
pub struct Outliers<const N: usize> {
    /// At least this many sets are wrong, if the truth is in the initial box: with fewer, no vector is left. A proof.
    pub at_least: usize,
    /// It is enough that this many sets are wrong: there are vectors that are in all others. A proof as well, so this is the
    /// smallest such number when it is equal to `at_least`; otherwise a finer precision may tell.
    pub enough: usize,
    /// How many outliers `paving` tolerates: `enough` and the margin, but not more than there are sets.
    pub tolerated: usize,
    /// The vectors that are in all sets but `tolerated` of them.
    pub paving: Paving<N>,
}

/// Finds the smallest number of outliers among `separators` that explains the rest, and paves the vectors that are in all
/// sets but that many, and a `margin` of undetected ones: GOMNE.
///
/// The number of outliers grows from zero until the inner approximation is not empty; with as many as there are sets every
/// vector is a solution, so this ends. The real number of outliers may be larger: they can agree by chance, which is what
/// the margin is for.
///
/// # Errors
/// [`PavingError`] when the initial box is unbounded or the precision is not a positive number.
///
/// Source: seed 001, table 2.5; Jaulin, Walter and Didrit, *Guaranteed robust nonlinear parameter bounding*, 1996.
pub fn gomne<const N: usize, S: Separator<N> + Sync>(
    separators: &[S],
    margin: usize,
    initial: IntervalBox<N>,
    options: &Options<N>,
) -> Result<Outliers<N>, PavingError> {
    let with = |outliers: usize| pave(&q_intersection(separators, outliers), initial, options);
    let all = separators.len();
    let mut at_least = None;
    let mut enough = 0;
    let mut paving = with(0)?;
    loop {
        if at_least.is_none() && !paving.proves_empty() {
            at_least = Some(enough);
        }
        if paving.proves_not_empty() || enough == all {
            break;
        }
        enough += 1;
        paving = with(enough)?;
    }
    let tolerated = enough.saturating_add(margin).min(all);
    if tolerated > enough {
        paving = with(tolerated)?;
    }
    Ok(Outliers { at_least: at_least.unwrap_or(all), enough, tolerated, paving })
}
