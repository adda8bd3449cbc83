//! The sixteen ways in which two intervals can lie to each other.

use crate::interval::Interval;
use std::cmp::Ordering::{Equal, Greater, Less};

/// How an interval `[a, b]` lies to another, `[c, d]`: what [`Interval::overlap`] tells. Exactly one of these is the case.
///
/// Swapping the two turns each into the one named in brackets. A point never meets: `[2, 2]` starts `[2, 3]`.
///
/// Source: IEEE 1788-2015, clause 10.6.4; J. F. Allen, *Maintaining knowledge about temporal intervals*, 1983.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Overlap {
    /// Both are empty (`BothEmpty`).
    BothEmpty,
    /// Only the first is empty (`SecondEmpty`).
    FirstEmpty,
    /// Only the second is empty (`FirstEmpty`).
    SecondEmpty,
    /// `b < c`: all of the first is below the second (`After`).
    Before,
    /// `a < b = c < d`: the first ends where the second begins (`MetBy`).
    Meets,
    /// `a < c < b < d`: the first begins and ends earlier, and they share more than one number (`OverlappedBy`).
    Overlaps,
    /// `a = c`, `b < d`: they begin together and the first ends earlier (`StartedBy`).
    Starts,
    /// `c < a`, `b < d`: the first is inside the second (`Contains`).
    ContainedBy,
    /// `c < a`, `b = d`: the first begins later and they end together (`FinishedBy`).
    Finishes,
    /// `a = c`, `b = d` (`Equals`).
    Equals,
    /// `a < c`, `b = d`: the first begins earlier and they end together (`Finishes`).
    FinishedBy,
    /// `a < c`, `d < b`: the second is inside the first (`ContainedBy`).
    Contains,
    /// `a = c`, `d < b`: they begin together and the first ends later (`Starts`).
    StartedBy,
    /// `c < a < d < b`: the first begins and ends later, and they share more than one number (`Overlaps`).
    OverlappedBy,
    /// `c < d = a < b`: the first begins where the second ends (`Meets`).
    MetBy,
    /// `d < a`: all of the first is above the second (`Before`).
    After,
}

impl Overlap {
    pub(super) fn between(first: Interval, second: Interval) -> Overlap {
        match (first.is_empty(), second.is_empty()) {
            (true, true) => return Overlap::BothEmpty,
            (true, false) => return Overlap::FirstEmpty,
            (false, true) => return Overlap::SecondEmpty,
            (false, false) => {}
        }
        let ((a, b), (c, d)) = ((first.lower(), first.upper()), (second.lower(), second.upper()));
        if b < c {
            return Overlap::Before;
        }
        if d < a {
            return Overlap::After;
        }
        // Bounds are never NaN.
        let order = |x: f64, y: f64| x.partial_cmp(&y).unwrap_or(Equal);
        match (order(a, c), order(b, d)) {
            (Less, Less) if b == c => Overlap::Meets,
            (Less, Less) => Overlap::Overlaps,
            (Less, Equal) => Overlap::FinishedBy,
            (Less, Greater) => Overlap::Contains,
            (Equal, Less) => Overlap::Starts,
            (Equal, Equal) => Overlap::Equals,
            (Equal, Greater) => Overlap::StartedBy,
            (Greater, Less) => Overlap::ContainedBy,
            (Greater, Equal) => Overlap::Finishes,
            (Greater, Greater) if d == a => Overlap::MetBy,
            (Greater, Greater) => Overlap::OverlappedBy,
        }
    }
}
