//! Carrier sense: when the water was loud enough here to hold an own ping back.

use std::collections::VecDeque;

use shoal_bus::time::SimTime;

/// What a modem that listens before it talks remembers.
#[derive(Debug)]
pub(super) struct Carrier {
    /// Power of all others together from which on the medium is busy.
    threshold: f64,
    /// How far back it remembers, in nanoseconds.
    memory_ns: i64,
    /// Since when it has been busy with others without a break.
    since: Option<SimTime>,
    /// When it was busy before, and when it itself emits.
    past: VecDeque<(SimTime, SimTime)>,
}

impl Carrier {
    /// A memory of so many nanoseconds.
    pub(super) fn new(threshold: f64, memory_ns: i64) -> Self {
        Self { threshold, memory_ns, since: None, past: VecDeque::new() }
    }

    /// Whether it remembers at all.
    pub(super) fn is_on(&self) -> bool {
        self.memory_ns > 0
    }

    /// From `at` on, others together are received with `power`.
    pub(super) fn others(&mut self, at: SimTime, power: f64) {
        match (self.since, power >= self.threshold) {
            (None, true) => self.since = Some(at),
            (Some(since), false) => {
                self.since = None;
                self.past.push_back((since, at));
            }
            _ => {}
        }
    }

    /// It emits itself.
    pub(super) fn own(&mut self, start: SimTime, end: SimTime) {
        self.past.push_back((start, end));
    }

    /// Forgets what ended too long before `now`.
    pub(super) fn forget(&mut self, now: SimTime) {
        while self.past.front().is_some_and(|&(_, end)| now - end > self.memory_ns) {
            self.past.pop_front();
        }
    }

    /// Whether the medium was busy at any moment of `[since, until)`.
    pub(super) fn busy(&self, since: SimTime, until: SimTime) -> bool {
        self.since.is_some_and(|start| start < until)
            || self.past.iter().any(|&(start, end)| start < until && end > since)
    }
}
