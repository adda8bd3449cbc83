//! Pure ALOHA: whoever has something to say says it, at random (Abramson, "The ALOHA system", AFIPS 1970).

use shoal_bus::time::LocalTime;

use super::gaps::Gaps;
use super::{Booking, MediumAccess, Tick};

/// Pings with exponential gaps, whatever others do.
pub struct Aloha {
    next: LocalTime,
    gaps: Gaps,
}

impl Aloha {
    /// Pings from `first` on, `mean_period_ns` local nanoseconds apart on average: the first one comes a gap after `first`.
    pub fn new(first: LocalTime, mean_period_ns: i64, entropy: u64) -> Self {
        let mut gaps = Gaps::new(mean_period_ns, entropy);
        Self { next: first + gaps.next_ns(), gaps }
    }
}

impl MediumAccess for Aloha {
    fn book(&mut self, tick: &Tick<'_>, booked: &mut Vec<Booking>) {
        if self.next < tick.from {
            // Its moment passed before this AUV could book it. Exponential gaps have no memory: the wait begins again.
            self.next = tick.from + self.gaps.next_ns();
        }
        while self.next < tick.until {
            booked.push(Booking { at: self.next, listen_ns: 0 });
            self.next = self.next + self.gaps.next_ns();
        }
    }
}
