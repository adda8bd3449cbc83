//! What an AUV was told that is false, beside what it was to expect: how far its promise reaches.
//!
//! An AUV that assumes at most q wrong of any m pings in a row promises to hold the truth for as long as that is so, however many are
//! wrong in all. One that assumes nothing promises it until the first wrong ping, and one that heeds no pings, always.

use std::collections::VecDeque;

use shoal_bus::message::Estimator;
use shoal_bus::time::SimTime;

/// The pings that an AUV was told, in the order in which it was told.
#[derive(Debug)]
pub struct Exposure {
    window: usize,
    /// None when no number of wrong pings is too many.
    tolerated: Option<usize>,
    last: VecDeque<bool>,
    windows: u64,
    windows_kept: u64,
    /// True time of the tick at which it had been told too many, once it has.
    pub broken_since: Option<SimTime>,
    /// The same of former lives, and when each ended.
    past: Vec<(SimTime, SimTime)>,
    /// True time of the tick at which it was told the first, once it was.
    pub deceived_since: Option<SimTime>,
}

impl Exposure {
    /// Nothing told yet.
    pub fn new(estimator: &Estimator) -> Self {
        let (window, tolerated) = match estimator {
            Estimator::Tube(settings) => settings.outliers.map_or((1, Some(0)), |assumed| {
                // Who searches for the number ignores the fewest that leave something, and the margin: no more is sure to be ignored.
                let sure = assumed.margin.map_or(assumed.tolerated, |margin| margin.min(assumed.tolerated));
                (usize::from(assumed.window.max(1)), Some(usize::from(sure)))
            }),
            Estimator::Ekf(_) | Estimator::DeadReckoning => (1, None),
        };
        Self {
            window,
            tolerated,
            last: VecDeque::with_capacity(window),
            windows: 0,
            windows_kept: 0,
            broken_since: None,
            past: Vec::new(),
            deceived_since: None,
        }
    }

    /// A new mind takes the place of the old one, told nothing yet.
    pub fn begin_again(&mut self, now: SimTime) {
        self.last.clear();
        self.past.extend(self.broken_since.take().map(|since| (since, now)));
        self.deceived_since = None;
    }

    /// Whether it had been told too many by its tick at `tick`, in the life that this tick belongs to.
    pub fn is_broken_at(&self, tick: SimTime) -> bool {
        self.broken_since.is_some_and(|since| since <= tick)
            || self.past.iter().any(|&(since, ended)| since <= tick && tick < ended)
    }

    /// It is told one more ping at its tick at `tick`.
    pub fn told(&mut self, is_false: bool, tick: SimTime) {
        if self.last.len() == self.window {
            self.last.pop_front();
        }
        self.last.push_back(is_false);
        if is_false {
            self.deceived_since.get_or_insert(tick);
        }
        let wrong = self.last.iter().filter(|wrong| **wrong).count();
        let is_kept = self.tolerated.is_none_or(|tolerated| wrong <= tolerated);
        self.windows += 1;
        self.windows_kept += u64::from(is_kept);
        if !is_kept {
            self.broken_since.get_or_insert(tick);
        }
    }

    /// Windows that ended with a ping told, and how many of them kept to the assumption.
    pub fn windows(&self) -> (u64, u64) {
        (self.windows, self.windows_kept)
    }
}

#[cfg(test)]
mod tests {
    use shoal_bus::message::{Outliers, TubeSettings};

    use super::*;

    fn told(estimator: &Estimator, pings: &str) -> (Option<i64>, Option<i64>, (u64, u64)) {
        let mut exposure = Exposure::new(estimator);
        for (index, ping) in pings.chars().enumerate() {
            exposure.told(ping == 'x', SimTime::from_ns(index as i64));
        }
        let ns = |at: Option<SimTime>| at.map(SimTime::ns);
        (ns(exposure.broken_since), ns(exposure.deceived_since), exposure.windows())
    }

    fn assuming(window: u16, tolerated: u16, margin: Option<u16>) -> Estimator {
        let outliers = Some(Outliers { window, tolerated, margin });
        Estimator::Tube(TubeSettings { outliers, ..TubeSettings::forward(0) })
    }

    #[test]
    fn the_promise_ends_with_the_assumption() {
        let two_of_four = assuming(4, 2, None);
        // Four wrong ones, never three of four in a row.
        assert_eq!(told(&two_of_four, ".xx..xx."), (None, Some(1), (8, 8)));
        assert_eq!(told(&two_of_four, "xx.x...."), (Some(3), Some(0), (8, 7)));
        // Windows not yet full count as well.
        assert_eq!(told(&two_of_four, "xxx"), (Some(2), Some(0), (3, 2)));
        assert_eq!(told(&assuming(4, 2, Some(1)), ".xx."), (Some(2), Some(1), (4, 2)));
    }

    #[test]
    fn who_assumes_nothing_is_covered_until_the_first_and_who_heeds_none_always() {
        assert_eq!(told(&Estimator::Tube(TubeSettings::forward(0)), "..x."), (Some(2), Some(2), (4, 3)));
        assert_eq!(told(&Estimator::DeadReckoning, "..x."), (None, Some(2), (4, 4)));
    }
}
