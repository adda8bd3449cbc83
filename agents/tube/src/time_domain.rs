//! How time is cut into slices.

use crate::error::TubeError;
use shoal_interval::Interval;
use std::collections::VecDeque;

/// Strictly increasing times, in seconds, that cut an interval of time into slices.
///
/// Slice `i` is the time from border `i` to border `i + 1`, both included; a domain of `n` slices has `n + 1` borders. The
/// borders are exactly the `f64` that were given. Finding the slice of a time takes constant time when the slices are about
/// as long as each other, and logarithmic time otherwise.
///
/// ```
/// use shoal_tube::{Place, TimeDomain};
///
/// let time = TimeDomain::uniform(0.0, 0.25, 4)?;
/// assert_eq!(time.place_of(0.3)?, Place::Slice(1));
/// assert_eq!(time.place_of(0.5)?, Place::Gate(2));
/// assert!(time.place_of(1.1).is_err());
/// # Ok::<(), shoal_tube::TubeError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct TimeDomain {
    /// Never empty, finite, strictly increasing.
    borders_s: VecDeque<f64>,
}

/// Where a time lies in a [`TimeDomain`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// Exactly on the border with this index.
    Gate(usize),
    /// Strictly inside the slice with this index.
    Slice(usize),
}

impl TimeDomain {
    /// The domain with these borders, in seconds.
    ///
    /// # Errors
    /// When there is no border, or one is not finite, or they do not increase.
    pub fn new(borders_s: impl IntoIterator<Item = f64>) -> Result<TimeDomain, TubeError> {
        let mut borders_s = borders_s.into_iter();
        let mut domain = TimeDomain::starting_at(borders_s.next().ok_or(TubeError::NoBorder)?)?;
        for border_s in borders_s {
            domain.append(border_s)?;
        }
        Ok(domain)
    }

    /// A domain of one instant and no slice, to [`append`](TimeDomain::append) to.
    ///
    /// # Errors
    /// When the time is not finite.
    pub fn starting_at(start_s: f64) -> Result<TimeDomain, TubeError> {
        Ok(TimeDomain { borders_s: VecDeque::from([finite(start_s)?]) })
    }

    /// `count` slices of `step_s` seconds each; border `i` is `start_s + i * step_s`, rounded to nearest.
    ///
    /// # Errors
    /// When a time is not finite, or the step is not positive or too small to be seen next to the start.
    pub fn uniform(start_s: f64, step_s: f64, count: usize) -> Result<TimeDomain, TubeError> {
        TimeDomain::new((0..=count).map(|index| start_s + index as f64 * step_s))
    }

    /// Adds a slice that ends at `end_s`.
    ///
    /// # Errors
    /// When the time is not finite or not after the current end; the domain is then unchanged.
    pub fn append(&mut self, end_s: f64) -> Result<(), TubeError> {
        if finite(end_s)? <= self.end_s() {
            return Err(TubeError::Unsorted { previous_s: self.end_s(), next_s: end_s });
        }
        self.borders_s.push_back(end_s);
        Ok(())
    }

    /// Forgets the `count` oldest slices, or all if there are fewer; the end of the last one always stays.
    pub fn drop_front(&mut self, count: usize) {
        self.borders_s.drain(..count.min(self.slice_count()));
    }

    /// The number of slices.
    #[inline]
    pub fn slice_count(&self) -> usize {
        self.borders_s.len() - 1
    }

    /// The first border, in seconds.
    #[inline]
    pub fn start_s(&self) -> f64 {
        self.borders_s[0]
    }

    /// The last border, in seconds.
    #[inline]
    pub fn end_s(&self) -> f64 {
        self.borders_s[self.borders_s.len() - 1]
    }

    /// All times of the domain, in seconds.
    pub fn span(&self) -> Interval {
        Interval::spanning(self.start_s(), self.end_s())
    }

    /// The borders, in seconds, from the oldest on.
    pub fn borders_s(&self) -> impl ExactSizeIterator<Item = f64> + '_ {
        self.borders_s.iter().copied()
    }

    /// The times of one slice, in seconds.
    #[inline]
    pub fn slice_span(&self, index: usize) -> Option<Interval> {
        let (start_s, end_s) = (self.borders_s.get(index)?, self.borders_s.get(index + 1)?);
        Some(Interval::spanning(*start_s, *end_s))
    }

    /// The border or the slice that a time is in.
    ///
    /// # Errors
    /// When the time is not finite or outside the domain.
    pub fn place_of(&self, time_s: f64) -> Result<Place, TubeError> {
        let (start_s, end_s) = (self.start_s(), self.end_s());
        if finite(time_s)? < start_s || time_s > end_s {
            return Err(TubeError::OutsideDomain { time_s, start_s, end_s });
        }
        let border = self.last_border_up_to(time_s);
        Ok(if self.borders_s[border] == time_s { Place::Gate(border) } else { Place::Slice(border) })
    }

    /// The index of the last border that is not after a time of the domain.
    fn last_border_up_to(&self, time_s: f64) -> usize {
        let share = (time_s - self.start_s()) / (self.end_s() - self.start_s());
        // A cast of NaN, from a domain without slices, gives zero.
        let guess = (share * self.slice_count() as f64) as usize;
        for border in guess.saturating_sub(1)..=guess + 1 {
            if self.starts_last_before(border, time_s) {
                return border;
            }
        }
        self.borders_s.partition_point(|&border_s| border_s <= time_s).saturating_sub(1)
    }

    fn starts_last_before(&self, border: usize, time_s: f64) -> bool {
        self.borders_s.get(border).is_some_and(|&border_s| border_s <= time_s)
            && self.borders_s.get(border + 1).is_none_or(|&next_s| time_s < next_s)
    }
}

fn finite(time_s: f64) -> Result<f64, TubeError> {
    if time_s.is_finite() { Ok(time_s) } else { Err(TubeError::NotATime { time_s }) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn bad_times_are_refused() {
        assert_eq!(TimeDomain::new([]), Err(TubeError::NoBorder));
        assert!(matches!(TimeDomain::new([0.0, f64::NAN]), Err(TubeError::NotATime { .. })));
        assert!(matches!(TimeDomain::new([0.0, 1.0, 1.0]), Err(TubeError::Unsorted { .. })));
        assert!(TimeDomain::uniform(0.0, -1.0, 2).is_err());
        assert!(TimeDomain::uniform(1e18, 1.0, 2).is_err());
        let time = TimeDomain::starting_at(2.0).unwrap();
        assert_eq!(time.place_of(2.0), Ok(Place::Gate(0)));
        assert!(matches!(time.place_of(2.1), Err(TubeError::OutsideDomain { .. })));
        assert!(time.place_of(f64::INFINITY).is_err());
    }

    #[test]
    fn dropping_keeps_the_end() {
        let mut time = TimeDomain::uniform(0.0, 1.0, 4).unwrap();
        time.drop_front(1);
        assert_eq!((time.start_s(), time.slice_count()), (1.0, 3));
        time.drop_front(100);
        assert_eq!((time.start_s(), time.end_s(), time.slice_count()), (4.0, 4.0, 0));
        assert_eq!(time.slice_span(0), None);
    }

    proptest! {
        #[test]
        fn every_time_is_found(
            steps in prop::collection::vec(prop_oneof![1.0e-9..1.0e-3_f64, 0.1..10.0_f64], 1..50),
            share in 0.0..=1.0_f64,
        ) {
            let borders = steps.iter().scan(-3.0, |time, step| { *time += step; Some(*time) });
            let time = TimeDomain::new(borders).unwrap();
            let asked = (time.start_s() + share * (time.end_s() - time.start_s())).min(time.end_s());
            match time.place_of(asked).unwrap() {
                Place::Gate(index) => prop_assert_eq!(time.borders_s().nth(index), Some(asked)),
                Place::Slice(index) => {
                    let span = time.slice_span(index).unwrap();
                    prop_assert!(span.lower() < asked && asked < span.upper());
                }
            }
            for (index, border) in time.borders_s().enumerate() {
                prop_assert_eq!(time.place_of(border), Ok(Place::Gate(index)));
            }
        }
    }
}
