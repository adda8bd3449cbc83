//! When to ping, and what to say: a prediction of the own position for the moment of emission, rounded outwards.

use shoal_bus::message::{AuvId, Born, PingSchedule, PlannedPing, Sensed, Wake};
use shoal_bus::ping::{Frame, FrameError, Ping};
use shoal_bus::time::LocalTime;

use crate::bounds::{bounds, bounds_box};
use crate::estimator::Prediction;

/// Books pings at the last tick that may book them.
pub struct Modem {
    auv: AuvId,
    wake: Wake,
    schedule: Option<PingSchedule>,
    next: LocalTime,
    sequence: u16,
}

impl Modem {
    /// The modem of a newborn.
    pub fn new(born: &Born) -> Self {
        let schedule = born.orders.ping;
        let next = schedule.map_or(LocalTime::ZERO, |schedule| schedule.first);
        Self { auv: born.auv, wake: born.wake, schedule, next, sequence: 0 }
    }

    /// The local time of the next ping, if this tick is the last that may book it.
    pub fn due(&mut self, sensed: &Sensed) -> Option<LocalTime> {
        let schedule = self.schedule?;
        let earliest = sensed.stamp + self.wake.reaction_ns;
        if self.next < earliest {
            // Its moment passed before this AUV could book it: at birth, or after ticks were missed.
            let missed = (earliest - self.next + schedule.period_ns - 1) / schedule.period_ns;
            self.next = self.next + missed * schedule.period_ns;
        }
        if self.next >= earliest + self.wake.period_ns {
            return None;
        }
        let at = self.next;
        self.next = at + schedule.period_ns;
        Some(at)
    }

    /// The ping that says what is predicted for `at`. One that does not fit a frame is not sent: better silent than wrong.
    pub fn plan(&mut self, at: LocalTime, prediction: &Prediction) -> Option<PlannedPing> {
        let frame = self.frame(prediction).ok()?;
        self.sequence = self.sequence.wrapping_add(1);
        Some(PlannedPing { at, frame })
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
