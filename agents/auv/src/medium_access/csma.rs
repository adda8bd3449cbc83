//! Listen before talk (carrier sense multiple access, non-persistent: Kleinrock and Tobagi, IEEE Trans. Commun. 23, 1975).
//! The modem listens; the AUV hears at a later tick that its ping was held back, and tries again.

use shoal_bus::message::Sense;
use shoal_bus::time::LocalTime;

use super::gaps::Gaps;
use super::periodic::Periodic;
use super::{Booking, MediumAccess, Tick};

/// Pings every so often, but not while others are heard.
pub struct Csma {
    schedule: Periodic,
    listen_ns: i64,
    backoff: Gaps,
    retry: Option<LocalTime>,
}

impl Csma {
    /// Pings by `schedule` when the medium was quiet for `listen_ns`, else again after gaps of `backoff_ns` on average.
    pub fn new(schedule: Periodic, listen_ns: i64, backoff_ns: i64, entropy: u64) -> Self {
        Self { schedule, listen_ns, backoff: Gaps::new(backoff_ns, entropy), retry: None }
    }

    /// Puts off what was held back; gives it up where the schedule's next ping comes first.
    fn put_off(&mut self, held: LocalTime, tick: &Tick<'_>) {
        // From the first moment that can be booked: AUVs that were held back together must not come back together.
        let again = tick.from + self.backoff.next_ns();
        self.retry = (again < self.schedule.following(held)).then_some(again);
    }
}

impl MediumAccess for Csma {
    fn book(&mut self, tick: &Tick<'_>, booked: &mut Vec<Booking>) {
        for event in &tick.sensed.events {
            if event.sense == Sense::Held {
                self.put_off(event.stamp, tick);
            }
        }
        let listen_ns = self.listen_ns;
        if let Some(at) = self.retry.take_if(|retry| *retry < tick.until)
            && at >= tick.from
        {
            booked.push(Booking { at, listen_ns });
        }
        while let Some(at) = self.schedule.due(tick) {
            booked.push(Booking { at, listen_ns });
        }
    }
}
