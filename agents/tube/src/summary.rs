//! What is remembered about many slices at once, so that a question about them need not look at each.

mod tree;

pub(crate) use tree::{Part, Step, SummaryTree};

use crate::enclosure::Enclosure;
use crate::time_domain::{TimeDomain, duration_s};
use std::collections::VecDeque;
use std::ops::Range;

/// What a row of neighbouring slices has in common.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Summary<T: Enclosure> {
    /// The hull of the slices.
    pub hull: T,
    /// Their highest lower and lowest upper bound.
    pub innermost: T::Innermost,
    /// The integral over them.
    pub integral: Integral<T>,
}

impl<T: Enclosure> Summary<T> {
    /// The summary of two rows, the second of which follows the first.
    #[inline]
    fn followed_by(&self, later: &Summary<T>) -> Summary<T> {
        Summary {
            hull: self.hull | later.hull,
            innermost: T::innermost_of(self.innermost, later.innermost),
            integral: self.integral.followed_by(&later.integral),
        }
    }
}

/// The integral over a stretch of time, and over every part of it that begins at its start or ends at its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Integral<T> {
    /// Over all of the time.
    pub whole: T,
    /// The hull of the integrals from the start to any time.
    pub from_start: T,
    /// The hull of the integrals from any time to the end.
    pub to_end: T,
}

impl<T: Enclosure> Integral<T> {
    /// The integral over no time.
    #[inline]
    pub(crate) fn zero() -> Integral<T> {
        Integral { whole: T::zero(), from_start: T::zero(), to_end: T::zero() }
    }

    /// The integral over a stretch and, after it, over a slice of which `area` is the integral. Within a slice the bounds
    /// of the integral grow linearly, so its ends tell the hull.
    #[inline]
    pub(crate) fn and_slice(&self, area: T) -> Integral<T> {
        let whole = self.whole + area;
        Integral { whole, from_start: self.from_start | whole, to_end: (self.to_end + area) | T::zero() }
    }

    /// The integral over two stretches, the second of which follows the first.
    #[inline]
    pub(crate) fn followed_by(&self, later: &Integral<T>) -> Integral<T> {
        Integral {
            whole: self.whole + later.whole,
            from_start: self.from_start | (self.whole + later.from_start),
            to_end: (self.to_end + later.whole) | later.to_end,
        }
    }
}

/// The slices themselves, with their lengths.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Slices<'a, T> {
    pub domain: &'a TimeDomain,
    pub values: &'a VecDeque<T>,
}

impl<T: Enclosure> Slices<'_, T> {
    /// The summary of some slices, by looking at each.
    fn summary(&self, range: Range<usize>) -> Summary<T> {
        let (mut hull, mut innermost, mut integral) = (T::EMPTY, T::UNBOUNDED, Integral::zero());
        let mut start_s = self.domain.border_at(range.start);
        for (index, &slice) in range.clone().zip(self.values.range(range)) {
            let end_s = self.domain.border_at(index + 1);
            hull = hull | slice;
            innermost = slice.innermost(innermost);
            integral = integral.and_slice(slice * duration_s(start_s, end_s));
            start_s = end_s;
        }
        Summary { hull, innermost, integral }
    }
}
