//! How time is cut into slices.

mod regular;

use crate::error::TubeError;
use crate::storage::push_sparingly;
use regular::Regular;
use shoal_interval::Interval;
use std::collections::VecDeque;
use std::ops::Range;
use std::sync::Arc;

/// How often the place of a time is guessed before it is bisected.
const GUESSES: usize = 4;

/// Strictly increasing times, in seconds, that cut an interval of time into slices.
///
/// Slice `i` is the time from border `i` to border `i + 1`, both included; a domain of `n` slices has `n + 1` borders. The
/// borders are exactly the `f64` that were given.
///
/// A clone costs nothing: tubes of one vehicle share their domain, and a tube that grows or forgets takes a copy of its own
/// only then. Slices of one length ([`uniform`](TimeDomain::uniform)) are not stored at all. The slice of a time is found
/// in constant time when slices are about as long as each other, in logarithmic time otherwise.
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
#[derive(Debug, Clone)]
pub struct TimeDomain {
    borders: Borders,
}

#[derive(Debug, Clone)]
enum Borders {
    /// One step apart.
    Regular(Regular),
    /// Never empty, finite, strictly increasing.
    Listed(Arc<VecDeque<f64>>),
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
        domain.release_spare_memory();
        Ok(domain)
    }

    /// A domain of one instant and no slice, to [`append`](TimeDomain::append) to.
    ///
    /// # Errors
    /// When the time is not finite.
    pub fn starting_at(start_s: f64) -> Result<TimeDomain, TubeError> {
        Ok(TimeDomain { borders: Borders::Regular(Regular::instant(finite(start_s)?)) })
    }

    /// `count` slices of `step_s` seconds each; border `i` is `start_s + i * step_s`, product and sum each rounded to nearest. Takes no memory.
    ///
    /// # Errors
    /// When a time is not finite, or the step is not positive or too small to be seen next to the times.
    pub fn uniform(start_s: f64, step_s: f64, count: usize) -> Result<TimeDomain, TubeError> {
        let borders = Regular::new(finite(start_s)?, finite(step_s)?, count)?;
        Ok(TimeDomain { borders: Borders::Regular(borders) })
    }

    /// Adds a slice that ends at `end_s`. A uniform domain stays uniform if that is where its next border is.
    ///
    /// # Errors
    /// When the time is not finite or not after the current end; the domain is then unchanged.
    pub fn append(&mut self, end_s: f64) -> Result<(), TubeError> {
        if finite(end_s)? <= self.end_s() {
            return Err(TubeError::Unsorted { previous_s: self.end_s(), next_s: end_s });
        }
        match &mut self.borders {
            Borders::Regular(regular) => {
                if !regular.append(end_s) {
                    let borders_s = self.borders_s().chain([end_s]).collect();
                    self.borders = Borders::Listed(Arc::new(borders_s));
                }
            }
            Borders::Listed(listed_s) => push_sparingly(Arc::make_mut(listed_s), end_s),
        }
        Ok(())
    }

    /// Forgets the `count` oldest slices, or all if there are fewer; the end of the last one always stays.
    pub fn drop_front(&mut self, count: usize) {
        let count = count.min(self.slice_count());
        match &mut self.borders {
            Borders::Regular(regular) => regular.drop_front(count),
            Borders::Listed(listed_s) => match Arc::get_mut(listed_s) {
                Some(own_s) => drop(own_s.drain(..count)),
                None => *listed_s = Arc::new(listed_s.range(count..).copied().collect()),
            },
        }
    }

    /// The same domain, cut at `times_s` too, in any order; times that are borders already change nothing.
    ///
    /// ```
    /// use shoal_tube::TimeDomain;
    ///
    /// let time = TimeDomain::uniform(0.0, 1.0, 2)?.refined([1.25, 0.5, 1.0])?;
    /// assert!(time.borders_s().eq([0.0, 0.5, 1.0, 1.25, 2.0]));
    /// # Ok::<(), shoal_tube::TubeError>(())
    /// ```
    ///
    /// # Errors
    /// When a time is not finite or outside the domain.
    pub fn refined(&self, times_s: impl IntoIterator<Item = f64>) -> Result<TimeDomain, TubeError> {
        let mut cuts_s = Vec::new();
        for time_s in times_s {
            if let Place::Slice(_) = self.place_of(time_s)? {
                cuts_s.push(time_s);
            }
        }
        if cuts_s.is_empty() {
            return Ok(self.clone());
        }
        cuts_s.extend(self.borders_s());
        cuts_s.sort_by(f64::total_cmp);
        cuts_s.dedup();
        TimeDomain::new(cuts_s)
    }

    /// The number of slices.
    #[inline]
    pub fn slice_count(&self) -> usize {
        match &self.borders {
            Borders::Regular(regular) => regular.slice_count(),
            Borders::Listed(listed_s) => listed_s.len() - 1,
        }
    }

    /// The first border, in seconds.
    #[inline]
    pub fn start_s(&self) -> f64 {
        self.border_at(0)
    }

    /// The last border, in seconds.
    #[inline]
    pub fn end_s(&self) -> f64 {
        self.border_at(self.slice_count())
    }

    /// All times of the domain, in seconds.
    pub fn span(&self) -> Interval {
        Interval::spanning(self.start_s(), self.end_s())
    }

    /// Border `index`, in seconds.
    #[inline]
    pub fn border_s(&self, index: usize) -> Option<f64> {
        (index <= self.slice_count()).then(|| self.border_at(index))
    }

    /// The borders, in seconds, from the oldest on.
    pub fn borders_s(&self) -> impl ExactSizeIterator<Item = f64> + DoubleEndedIterator + '_ {
        (0..self.slice_count() + 1).map(|index| self.border_at(index))
    }

    /// The times of one slice, in seconds.
    #[inline]
    pub fn slice_span(&self, index: usize) -> Option<Interval> {
        (index < self.slice_count()).then(|| self.span_at(index))
    }

    /// The length of one slice, in seconds: an enclosure, because the difference of two borders may not be a `f64`.
    #[inline]
    pub fn slice_duration_s(&self, index: usize) -> Option<Interval> {
        (index < self.slice_count()).then(|| self.duration_at(index))
    }

    /// The border or the slice that a time is in.
    ///
    /// # Errors
    /// When the time is not finite or outside the domain.
    #[inline]
    pub fn place_of(&self, time_s: f64) -> Result<Place, TubeError> {
        let (start_s, end_s) = (self.start_s(), self.end_s());
        if finite(time_s)? < start_s || time_s > end_s {
            return Err(TubeError::OutsideDomain { time_s, start_s, end_s });
        }
        let border = self.last_border_up_to(time_s);
        Ok(if self.border_at(border) == time_s { Place::Gate(border) } else { Place::Slice(border) })
    }

    /// The bytes on the heap. Domains that are clones of each other share them.
    pub fn memory_bytes(&self) -> usize {
        match &self.borders {
            Borders::Regular(_) => 0,
            Borders::Listed(listed_s) => size_of::<VecDeque<f64>>() + listed_s.capacity() * size_of::<f64>(),
        }
    }

    /// The slices that `times_s` touches, those that it only touches at its ends left out. `times_s` is in the domain and
    /// longer than an instant.
    #[inline]
    pub(crate) fn slices_over(&self, times_s: Interval) -> Result<Range<usize>, TubeError> {
        let first = match self.place_of(times_s.lower())? {
            Place::Gate(index) | Place::Slice(index) => index,
        };
        let after_last = match self.place_of(times_s.upper())? {
            Place::Gate(index) => index,
            Place::Slice(index) => index + 1,
        };
        Ok(first..after_last)
    }

    /// Border `index`, which the caller knows to exist.
    #[inline]
    pub(crate) fn border_at(&self, index: usize) -> f64 {
        match &self.borders {
            Borders::Regular(regular) => regular.border_s(index),
            Borders::Listed(listed_s) => listed_s[index],
        }
    }

    /// The times of slice `index`, which the caller knows to exist.
    #[inline]
    pub(crate) fn span_at(&self, index: usize) -> Interval {
        Interval::spanning(self.border_at(index), self.border_at(index + 1))
    }

    /// The times of a slice or a gate, which the caller knows to exist.
    #[inline]
    pub(crate) fn span_of(&self, place: Place) -> Interval {
        match place {
            Place::Gate(index) => exactly(self.border_at(index)),
            Place::Slice(index) => self.span_at(index),
        }
    }

    /// All slices, and then all gates.
    pub(crate) fn places(&self) -> impl Iterator<Item = Place> + use<> {
        let count = self.slice_count();
        (0..count).map(Place::Slice).chain((0..=count).map(Place::Gate))
    }

    /// The slice itself, or those on both sides of a gate.
    pub(crate) fn slices_at(&self, place: Place) -> Range<usize> {
        match place {
            Place::Gate(index) => index.saturating_sub(1)..(index + 1).min(self.slice_count()),
            Place::Slice(index) => index..index + 1,
        }
    }

    /// The length of slice `index`, which the caller knows to exist.
    #[inline]
    pub(crate) fn duration_at(&self, index: usize) -> Interval {
        duration_s(self.border_at(index), self.border_at(index + 1))
    }

    pub(crate) fn release_spare_memory(&mut self) {
        if let Borders::Listed(listed_s) = &mut self.borders
            && let Some(own_s) = Arc::get_mut(listed_s)
        {
            own_s.shrink_to_fit();
        }
    }

    /// The start, the step and the number of slices, when the borders are one step apart as in
    /// [`uniform`](TimeDomain::uniform).
    #[cfg(feature = "serde")]
    pub(crate) fn as_uniform(&self) -> Option<(f64, f64, usize)> {
        match &self.borders {
            Borders::Regular(regular) => regular.as_given(),
            Borders::Listed(_) => None,
        }
    }

    /// The index of the last border that is not after a time of the domain.
    ///
    /// Guesses as if all slices were as long as the mean one, from closer and closer borders; what is left between the
    /// borders that were tried is bisected.
    #[inline]
    fn last_border_up_to(&self, time_s: f64) -> usize {
        let last = self.slice_count();
        let slices_per_s = match &self.borders {
            Borders::Regular(regular) => 1.0 / regular.step_s(),
            Borders::Listed(_) => last as f64 / (self.end_s() - self.start_s()),
        };
        // Border `low` is not after the time; border `high`, if there is one, is.
        let (mut low, mut high) = (0, last + 1);
        let (mut known, mut known_s) = (0, self.start_s());
        for _ in 0..GUESSES {
            // A cast of NaN, from a domain of infinite length, gives zero.
            let guess = (known as f64 + (time_s - known_s) * slices_per_s) as usize;
            known = guess.clamp(low, high - 1);
            known_s = self.border_at(known);
            if known_s <= time_s {
                if known == last || time_s < self.border_at(known + 1) {
                    return known;
                }
                low = known + 1;
            } else {
                if self.border_at(known - 1) <= time_s {
                    return known - 1;
                }
                high = known - 1;
            }
        }
        while high - low > 1 {
            let middle = usize::midpoint(low, high);
            if self.border_at(middle) <= time_s { low = middle } else { high = middle }
        }
        low
    }
}

/// Two domains are equal when their borders are. Looks at the borders only if they are not shared.
impl PartialEq for TimeDomain {
    fn eq(&self, other: &TimeDomain) -> bool {
        let shared = match (&self.borders, &other.borders) {
            (Borders::Regular(own), Borders::Regular(others)) => own == others,
            (Borders::Listed(own), Borders::Listed(others)) => Arc::ptr_eq(own, others),
            _ => false,
        };
        shared || (self.slice_count() == other.slice_count() && self.borders_s().eq(other.borders_s()))
    }
}

/// The time itself, as an interval.
#[inline]
pub(crate) fn exactly(time_s: f64) -> Interval {
    Interval::spanning(time_s, time_s)
}

/// The time from one border to the next, in seconds.
#[inline]
pub(crate) fn duration_s(start_s: f64, end_s: f64) -> Interval {
    // The difference of positive numbers is exact if one is at most twice the other (Sterbenz).
    if 0.5 * end_s <= start_s { exactly(end_s - start_s) } else { exactly(end_s) - start_s }
}

fn finite(time_s: f64) -> Result<f64, TubeError> {
    if time_s.is_finite() { Ok(time_s) } else { Err(TubeError::NotATime { time_s }) }
}

#[cfg(test)]
mod tests;
