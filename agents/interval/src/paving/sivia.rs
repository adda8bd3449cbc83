//! Set inversion via interval analysis: with a test, with a contractor, with a separator, with outliers.

use super::engine::run;
use super::{InclusionTest, Options, Paving, PavingError, relaxed};
use crate::contractor::Contractor;
use crate::interval_box::IntervalBox;
use crate::membership::Membership;
use crate::separator::Separator;

/// Paves `initial` with an inclusion test: SIVIA.
///
/// The boxes are those of a regular sub-paving, got from the initial box by bisections alone.
///
/// # Errors
/// [`PavingError`] when the initial box is unbounded or the precision is not a positive number.
///
/// Source: seed 001, table 2.2; seed 002, algorithm 3.2; Jaulin and Walter, *Set inversion via interval analysis for
/// nonlinear bounded-error estimation*, 1993.
pub fn sivia<const N: usize>(
    test: &(impl InclusionTest<N> + Sync + ?Sized),
    initial: IntervalBox<N>,
    options: &Options<N>,
) -> Result<Paving<N>, PavingError> {
    run(initial, options, |domain, paving| sort(test.test(&domain), domain, paving))
}

/// Paves `initial` with a contractor and an inclusion test: CSIVIA.
///
/// What the contractor removes is outside; the test sorts what it leaves. A contractor for a thin set, which has no
/// inside, goes with a test that always answers [`Membership::Undecided`].
///
/// # Errors
/// [`PavingError`] when the initial box is unbounded or the precision is not a positive number.
///
/// Source: seed 001, table 2.3.
pub fn csivia<const N: usize>(
    contractor: &(impl Contractor<N> + Sync + ?Sized),
    test: &(impl InclusionTest<N> + Sync + ?Sized),
    initial: IntervalBox<N>,
    options: &Options<N>,
) -> Result<Paving<N>, PavingError> {
    run(initial, options, |domain, paving| {
        let left = contractor.contract(domain);
        paving.outside.extend(domain.difference(&left));
        if left.is_empty() {
            return left;
        }
        sort(test.test(&left), left, paving)
    })
}

/// Paves `initial` with a separator: SIVIA with an inner and an outer contractor.
///
/// What the outer contractor removes is outside, what the inner one then removes of the rest is inside, and what is left is
/// bisected.
///
/// # Errors
/// [`PavingError`] when the initial box is unbounded or the precision is not a positive number.
///
/// Source: seed 002, algorithm 3.3; seed 000, section 2.3.3.
pub fn pave<const N: usize>(
    separator: &(impl Separator<N> + Sync + ?Sized),
    initial: IntervalBox<N>,
    options: &Options<N>,
) -> Result<Paving<N>, PavingError> {
    run(initial, options, |domain, paving| {
        let outer = separator.outer(domain);
        paving.outside.extend(domain.difference(&outer));
        if outer.is_empty() {
            return outer;
        }
        let undecided = separator.inner(outer);
        paving.inner.extend(outer.difference(&undecided));
        undecided
    })
}

/// Paves `initial` with inclusion tests of which at most `outliers` may be wrong: RSIVIA.
///
/// The same with separators is [`pave`] with a [`q_intersection`](crate::separator::q_intersection).
///
/// # Errors
/// [`PavingError`] when the initial box is unbounded or the precision is not a positive number.
///
/// Source: seed 001, table 2.4.
pub fn rsivia<const N: usize, T: InclusionTest<N> + Sync>(
    tests: &[T],
    outliers: usize,
    initial: IntervalBox<N>,
    options: &Options<N>,
) -> Result<Paving<N>, PavingError> {
    sivia(&relaxed(tests, outliers), initial, options)
}

/// Puts a box where it belongs; returns it if that is not known.
fn sort<const N: usize>(
    membership: Membership,
    domain: IntervalBox<N>,
    paving: &mut Paving<N>,
) -> IntervalBox<N> {
    match membership {
        Membership::Inside => paving.inner.push(domain),
        Membership::Outside => paving.outside.push(domain),
        Membership::Undecided => return domain,
    }
    IntervalBox::EMPTY
}
