//! How fine, how long and with how many threads to pave.

use super::PavingError;
use crate::interval_box::IntervalBox;

/// How fine, how long and with how many threads to pave.
///
/// ```
/// use shoal_interval::paving::Options;
///
/// let options = Options::<2>::new(0.05).with_budget(10_000).with_threads(2);
/// assert_eq!(options.precision(), [0.05, 0.05]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options<const N: usize> {
    precision: [f64; N],
    budget: usize,
    threads: usize,
}

impl<const N: usize> Options<N> {
    /// How many boxes are looked at unless [`with_budget`](Options::with_budget) says otherwise.
    pub const DEFAULT_BUDGET: usize = 1_000_000;

    /// Undecided boxes narrower than `precision` along every axis, in the unit of the axes, are not bisected any more.
    pub fn new(precision: f64) -> Options<N> {
        Options::per_axis([precision; N])
    }

    /// A precision for each axis, where the axes have different units or matter differently.
    ///
    /// The axis that is bisected is then the one whose side is longest in terms of its precision.
    pub fn per_axis(precision: [f64; N]) -> Options<N> {
        Options { precision, budget: Options::<N>::DEFAULT_BUDGET, threads: 1 }
    }

    /// Looks at no more than `boxes` boxes; what is then left is boundary, and the result says so.
    pub fn with_budget(self, boxes: usize) -> Options<N> {
        Options { budget: boxes, ..self }
    }

    /// Shares the work among `threads` threads; zero means one. The result does not depend on it.
    pub fn with_threads(self, threads: usize) -> Options<N> {
        Options { threads: threads.max(1), ..self }
    }

    /// The precision along each axis.
    pub fn precision(&self) -> [f64; N] {
        self.precision
    }

    /// How many boxes are looked at, at most.
    pub fn budget(&self) -> usize {
        self.budget
    }

    /// How many threads work.
    pub fn threads(&self) -> usize {
        self.threads
    }

    /// Whether `initial` can be paved like this.
    pub(super) fn check(&self, initial: &IntervalBox<N>) -> Result<(), PavingError> {
        for (axis, &precision) in self.precision.iter().enumerate() {
            if !(precision.is_finite() && precision > 0.0) {
                return Err(PavingError::Precision { axis, precision });
            }
        }
        match initial.iter().position(|side| !side.is_bounded()) {
            Some(axis) if !initial.is_empty() => Err(PavingError::Unbounded {
                axis,
                lower: initial[axis].lower(),
                upper: initial[axis].upper(),
            }),
            _ => Ok(()),
        }
    }

    /// Whether nothing finer than `undecided`, which is what a cut has left of `domain`, was asked for.
    ///
    /// What is left must be narrower than the precision. If the cut itself made it so, and by less than half, the box is
    /// cut once more: at that size a cut still removes much, and more for its price than a finer precision does.
    #[inline]
    pub(super) fn is_fine(&self, domain: &IntervalBox<N>, undecided: &IntervalBox<N>) -> bool {
        let narrower = |part: &IntervalBox<N>, share: f64| {
            (0..N).all(|axis| part[axis].width() < share * self.precision[axis])
        };
        narrower(domain, 1.0) || narrower(undecided, 0.5)
    }

    /// Both halves of a box along the axis that is longest in terms of its precision, of those between whose bounds there is
    /// another number; nothing if there is no such axis.
    #[inline]
    pub(super) fn bisect(&self, undecided: &IntervalBox<N>) -> Option<(IntervalBox<N>, IntervalBox<N>)> {
        let mut longest = (0.0, None);
        for axis in 0..N {
            let length = undecided[axis].width() / self.precision[axis];
            if length > longest.0
                && let Some(halves) = undecided.bisect_axis(axis)
            {
                longest = (length, Some(halves));
            }
        }
        longest.1
    }
}
