//! Inclusion tests: what a whole box has to do with a set.

use crate::interval_box::IntervalBox;
use crate::membership::Membership;
use std::marker::PhantomData;

/// What finds out how a box lies to a set.
///
/// Both certain answers must be proofs, rounding included. The empty box may get either of them.
///
/// Source: seed 001, section 2.4.2; seed 002, equation (3.37).
pub trait InclusionTest<const N: usize> {
    /// How `domain` lies to the set.
    fn test(&self, domain: &IntervalBox<N>) -> Membership;
}

impl<const N: usize, T: InclusionTest<N> + ?Sized> InclusionTest<N> for &T {
    fn test(&self, domain: &IntervalBox<N>) -> Membership {
        (**self).test(domain)
    }
}

impl<const N: usize, T: InclusionTest<N> + ?Sized> InclusionTest<N> for Box<T> {
    fn test(&self, domain: &IntervalBox<N>) -> Membership {
        (**self).test(domain)
    }
}

/// An inclusion test made of a closure.
pub fn from_test_fn<const N: usize, F>(test: F) -> FromTestFn<F>
where
    F: Fn(&IntervalBox<N>) -> Membership,
{
    FromTestFn { test }
}

/// The inclusion test made of a closure by [`from_test_fn`].
#[derive(Debug, Clone, Copy)]
pub struct FromTestFn<F> {
    test: F,
}

impl<const N: usize, F: Fn(&IntervalBox<N>) -> Membership> InclusionTest<N> for FromTestFn<F> {
    fn test(&self, domain: &IntervalBox<N>) -> Membership {
        (self.test)(domain)
    }
}

/// The inclusion test of the vectors that a function takes into a box: set inversion.
///
/// `function` must be an inclusion function that is defined on all of the boxes it gets: its result holds the images
/// of all vectors of the box. A box outside of a function's domain needs [`from_test_fn`], since an empty image does not
/// say that the vectors are in the set.
///
/// ```
/// use shoal_interval::paving::{InclusionTest, set_inversion};
/// use shoal_interval::{Interval, IntervalBox, Membership};
///
/// let circle = set_inversion(
///     |x: &IntervalBox<2>| IntervalBox::from([x[0].sqr() + x[1].sqr()]),
///     IntervalBox::from([Interval::new(3.0, 4.0)?]),
/// );
/// let far = IntervalBox::from([Interval::new(5.0, 6.0)?; 2]);
/// assert_eq!(circle.test(&far), Membership::Outside);
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
///
/// Source: seed 001, table 2.2; seed 002, equations (3.35) and (3.37).
pub fn set_inversion<const N: usize, const M: usize, F>(
    function: F,
    target: IntervalBox<M>,
) -> SetInversion<M, F>
where
    F: Fn(&IntervalBox<N>) -> IntervalBox<M>,
{
    SetInversion { function, target }
}

/// The inclusion test made by [`set_inversion`].
#[derive(Debug, Clone, Copy)]
pub struct SetInversion<const M: usize, F> {
    function: F,
    target: IntervalBox<M>,
}

impl<const N: usize, const M: usize, F: Fn(&IntervalBox<N>) -> IntervalBox<M>> InclusionTest<N>
    for SetInversion<M, F>
{
    fn test(&self, domain: &IntervalBox<N>) -> Membership {
        let image = (self.function)(domain);
        if (image & self.target).is_empty() {
            Membership::Outside
        } else if image.is_subset_of(&self.target) {
            Membership::Inside
        } else {
            Membership::Undecided
        }
    }
}

/// The inclusion test of the vectors that are in all sets of a list but at most `outliers` of them.
///
/// Counts the tests that prove inclusion and those that prove separation: with `m` tests and `q` outliers, `m - q`
/// inclusions prove that a box is inside, `q + 1` separations that it is outside.
///
/// Source: seed 001, equations (2.51) to (2.54).
pub fn relaxed<T, L: AsRef<[T]>>(tests: L, outliers: usize) -> Relaxed<T, L> {
    Relaxed { tests, outliers, kind: PhantomData }
}

/// The inclusion test made by [`relaxed`].
#[derive(Debug, Clone, Copy)]
pub struct Relaxed<T, L> {
    tests: L,
    outliers: usize,
    kind: PhantomData<fn() -> T>,
}

impl<const N: usize, T: InclusionTest<N>, L: AsRef<[T]>> InclusionTest<N> for Relaxed<T, L> {
    fn test(&self, domain: &IntervalBox<N>) -> Membership {
        let tests = self.tests.as_ref();
        let needed = tests.len().saturating_sub(self.outliers);
        let (mut inclusions, mut separations) = (0, 0);
        for test in tests {
            if inclusions >= needed || separations > self.outliers {
                break;
            }
            match test.test(domain) {
                Membership::Inside => inclusions += 1,
                Membership::Outside => separations += 1,
                Membership::Undecided => {}
            }
        }
        if inclusions >= needed {
            Membership::Inside
        } else if separations > self.outliers {
            Membership::Outside
        } else {
            Membership::Undecided
        }
    }
}
