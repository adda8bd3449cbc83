//! At `first + k * period`, as in seed 001.

use shoal_bus::time::LocalTime;

use super::{Booking, MediumAccess, Tick};

/// Pings every so often.
pub struct Periodic {
    next: LocalTime,
    period_ns: i64,
}

impl Periodic {
    /// Pings at `first` and every `period_ns` local nanoseconds after it.
    pub fn new(first: LocalTime, period_ns: i64) -> Self {
        Self { next: first, period_ns: period_ns.max(1) }
    }

    /// The next ping, if this tick is the last that may book it.
    pub fn due(&mut self, tick: &Tick<'_>) -> Option<LocalTime> {
        if self.next < tick.from {
            // Its moment passed before this AUV could book it: at birth, or after ticks were missed.
            let missed = (tick.from - self.next + self.period_ns - 1) / self.period_ns;
            self.next = self.next + missed * self.period_ns;
        }
        if self.next >= tick.until {
            return None;
        }
        let at = self.next;
        self.next = at + self.period_ns;
        Some(at)
    }

    /// The first ping after `at`, which is not after the last one booked.
    pub fn following(&self, at: LocalTime) -> LocalTime {
        let whole_periods = (self.next - at - 1).max(0) / self.period_ns;
        self.next + -whole_periods * self.period_ns
    }
}

impl MediumAccess for Periodic {
    fn book(&mut self, tick: &Tick<'_>, booked: &mut Vec<Booking>) {
        while let Some(at) = self.due(tick) {
            booked.push(Booking { at, listen_ns: 0 });
        }
    }
}
