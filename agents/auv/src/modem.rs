//! When to ping, and what to say: a prediction of the own position for the moment of emission, rounded outwards.

use shoal_bus::message::{AuvId, Born, MediumAccess, PlannedPing, Sensed, Wake};
use shoal_bus::ping::{Frame, FrameError, Ping};
use shoal_bus::time::LocalTime;

use crate::bounds::{bounds, bounds_box};
use crate::estimator::Prediction;

/// Books pings at the last tick that may book them.
pub struct Modem {
    auv: AuvId,
    wake: Wake,
    access: MediumAccess,
    next: LocalTime,
    sequence: u8,
}

impl Modem {
    /// The modem of a newborn.
    pub fn new(born: &Born) -> Self {
        let access = born.orders.access;
        let next = match access {
            MediumAccess::Periodic { first, .. } => first,
            _ => LocalTime::ZERO,
        };
        Self { auv: born.auv, wake: born.wake, access, next, sequence: 0 }
    }

    /// The local time of the next ping, if this tick is the last that may book it.
    pub fn due(&mut self, sensed: &Sensed) -> Option<LocalTime> {
        let MediumAccess::Periodic { period_ns, .. } = self.access else { return None };
        let earliest = sensed.stamp + self.wake.reaction_ns;
        if self.next < earliest {
            // Its moment passed before this AUV could book it: at birth, or after ticks were missed.
            let missed = (earliest - self.next + period_ns - 1) / period_ns;
            self.next = self.next + missed * period_ns;
        }
        if self.next >= earliest + self.wake.period_ns {
            return None;
        }
        let at = self.next;
        self.next = at + period_ns;
        Some(at)
    }

    /// The ping that says what is predicted for `at`. One that does not fit a frame is not sent: better silent than wrong.
    pub fn plan(&mut self, at: LocalTime, prediction: &Prediction) -> Option<PlannedPing> {
        let frame = self.frame(prediction).ok()?;
        self.sequence = self.sequence.wrapping_add(1);
        Some(PlannedPing { at, listen_ns: 0, frame })
    }

    fn frame(&self, prediction: &Prediction) -> Result<Frame, FrameError> {
        Ping {
            sender: self.auv,
            sequence: self.sequence,
            emission_s: bounds(prediction.time_s),
            position_m: bounds_box(&prediction.position_m),
            velocity_m_s: bounds_box(&prediction.velocity_m_s),
        }
        .encode()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn modem(first_ns: i64, period_ns: i64) -> Modem {
        let access = MediumAccess::Periodic { first: LocalTime::from_ns(first_ns), period_ns };
        let wake = Wake { first_tick: LocalTime::ZERO, period_ns: 100, reaction_ns: 250 };
        Modem { auv: AuvId(0), wake, access, next: LocalTime::from_ns(first_ns), sequence: 0 }
    }

    /// All bookings over ticks 0, 100, ..., as (tick, ping).
    fn bookings(mut modem: Modem) -> Vec<(i64, i64)> {
        let mut booked = Vec::new();
        for tick in 0..40i64 {
            let stamp = LocalTime::from_ns(100 * tick);
            let sensed = Sensed { tick: tick as u64, stamp, events: Vec::new() };
            while let Some(at) = modem.due(&sensed) {
                booked.push((stamp.ns(), at.ns()));
            }
        }
        booked
    }

    #[test]
    fn every_ping_is_booked_once_at_the_last_tick_that_may() {
        let booked = bookings(modem(1_000, 330));
        assert_eq!(booked[0], (700, 1_000));
        for (index, &(tick, at)) in booked.iter().enumerate() {
            assert_eq!(at, 1_000 + 330 * index as i64);
            assert!((tick + 250..tick + 350).contains(&at), "ping at {at} booked at {tick}");
        }
        // Several pings between two ticks are all booked at the one before.
        assert!(bookings(modem(1_000, 40)).iter().filter(|(tick, _)| *tick == 1_000).count() >= 2);
    }

    #[test]
    fn pings_that_could_not_be_booked_are_left_out() {
        assert_eq!(bookings(modem(10, 300))[0], (0, 310));
    }
}
