//! What a paving algorithm finds.

use crate::interval::Interval;
use crate::interval_box::IntervalBox;
use crate::membership::Membership;
use nalgebra::SVector;

/// A set between two unions of boxes; see [the module](super) for what the three kinds of boxes prove.
///
/// Boxes touch but do not overlap, and together they fill the initial box. They are closed, so boxes of different kinds
/// share the points of a common face; there the side whose kind is right for the set counts, and
/// [`membership`](Paving::membership) answers [`Membership::Undecided`].
#[derive(Debug, Clone, PartialEq)]
pub struct Paving<const N: usize> {
    pub(super) inner: Vec<IntervalBox<N>>,
    pub(super) boundary: Vec<IntervalBox<N>>,
    pub(super) outside: Vec<IntervalBox<N>>,
    pub(super) statistics: Statistics,
    pub(super) stopped: Stopped,
}

/// How much work a paving was.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Statistics {
    /// How many boxes were looked at, with one test, contraction or separation each: the calls of the recursive algorithms
    /// in the seeds.
    pub boxes: usize,
    /// How many boxes were cut in two.
    pub bisections: usize,
}

/// Why a paving algorithm stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stopped {
    /// Every boundary box is narrower than the precision, or as narrow as numbers allow.
    Complete,
    /// The budget ran out. The proofs hold, but some boundary boxes are wider than the precision.
    BudgetSpent {
        /// How many boxes were not looked at; they are the last of the boundary.
        left: usize,
    },
}

impl<const N: usize> Paving<N> {
    pub(super) fn empty() -> Paving<N> {
        Paving {
            inner: Vec::new(),
            boundary: Vec::new(),
            outside: Vec::new(),
            statistics: Statistics::default(),
            stopped: Stopped::Complete,
        }
    }

    /// The boxes that are proved to be in the set.
    pub fn inner(&self) -> &[IntervalBox<N>] {
        &self.inner
    }

    /// The boxes of which nothing is known. The border of the set is in them.
    pub fn boundary(&self) -> &[IntervalBox<N>] {
        &self.boundary
    }

    /// The boxes that are proved to be outside of the set.
    pub fn outside(&self) -> &[IntervalBox<N>] {
        &self.outside
    }

    /// The outer approximation: all boxes that may hold members of the set.
    pub fn outer(&self) -> impl Iterator<Item = &IntervalBox<N>> + Clone {
        self.inner.iter().chain(&self.boundary)
    }

    /// How much work it was.
    pub fn statistics(&self) -> Statistics {
        self.statistics
    }

    /// Why the algorithm stopped.
    pub fn stopped(&self) -> Stopped {
        self.stopped
    }

    /// Whether the set is proved to have no member in the initial box.
    pub fn proves_empty(&self) -> bool {
        self.inner.is_empty() && self.boundary.is_empty()
    }

    /// Whether the set is proved to have a member.
    pub fn proves_not_empty(&self) -> bool {
        !self.inner.is_empty()
    }

    /// The volume of the inner approximation, rounded outwards: the set's own is at least the lower bound.
    pub fn inner_volume(&self) -> Interval {
        volume(self.inner.iter())
    }

    /// The volume of the outer approximation, rounded outwards: the set's own is at most the upper bound.
    pub fn outer_volume(&self) -> Interval {
        volume(self.outer())
    }

    /// The smallest box that holds the outer approximation, and with it all of the set that is in the initial box.
    pub fn hull(&self) -> IntervalBox<N> {
        self.outer().fold(IntervalBox::EMPTY, |hull, part| hull | *part)
    }

    /// What is proved of `point`; nothing where boxes of different kinds touch, and outside of the initial box.
    pub fn membership(&self, point: &SVector<f64, N>) -> Membership {
        let in_any = |boxes: &[IntervalBox<N>]| boxes.iter().any(|part| part.contains(point));
        match (in_any(&self.inner), in_any(&self.boundary), in_any(&self.outside)) {
            (true, false, false) => Membership::Inside,
            (false, false, true) => Membership::Outside,
            _ => Membership::Undecided,
        }
    }

    /// How many separate parts the outer approximation has; boxes that touch, even in a corner, are one part.
    ///
    /// The set has at most as many parts that do not touch as it has members in different ones: two members in
    /// different parts are proved not to be connected. Takes a comparison for each pair of boxes that overlap along the
    /// first axis.
    pub fn parts(&self) -> usize {
        let mut boxes: Vec<&IntervalBox<N>> = self.outer().collect();
        boxes.sort_by(|a, b| a[0].lower().total_cmp(&b[0].lower()));
        let mut part_of: Vec<usize> = (0..boxes.len()).collect();
        let mut parts = boxes.len();
        for (index, one) in boxes.iter().enumerate() {
            for (other_index, other) in boxes.iter().enumerate().skip(index + 1) {
                if other[0].lower() > one[0].upper() {
                    break;
                }
                if (**one & **other).is_empty() {
                    continue;
                }
                let (a, b) = (root(&mut part_of, index), root(&mut part_of, other_index));
                if a != b {
                    part_of[a] = b;
                    parts -= 1;
                }
            }
        }
        parts
    }
}

/// The box that stands for the part that a box belongs to. Shortens the way there for the next time.
fn root(part_of: &mut [usize], mut index: usize) -> usize {
    while part_of[index] != index {
        part_of[index] = part_of[part_of[index]];
        index = part_of[index];
    }
    index
}

fn volume<'a, const N: usize>(boxes: impl Iterator<Item = &'a IntervalBox<N>>) -> Interval {
    boxes.fold(Interval::ZERO, |sum, part| sum + part.volume_enclosure())
}
