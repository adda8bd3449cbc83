//! The modem: books pings when medium access says so, and fills them with a prediction of the own position for the moment
//! of emission, rounded outwards: as intervals, or as a Gaussian if that is what the AUV believes in.

use shoal_bus::message::{AuvId, Born, PlannedPing, Sensed, Wake};
use shoal_bus::ping::{Frame, FrameError, GaussianPing, Ping};
use shoal_bus::time::LocalTime;
use shoal_interval::Interval;

use crate::bounds::{bounds, bounds_box};
use crate::estimator::Prediction;
use crate::medium_access::{self, Booking, MediumAccess, Tick};

/// Books pings at the last tick that may book them.
pub struct Modem {
    auv: AuvId,
    wake: Wake,
    access: Box<dyn MediumAccess>,
    sequence: u8,
}

impl Modem {
    /// The modem of a newborn.
    pub fn new(born: &Born) -> Self {
        let access = medium_access::ordered(&born.orders.access);
        Self { auv: born.auv, wake: born.wake, access, sequence: 0 }
    }

    /// The pings that this tick is the last to book; asked once at every tick. `true_time_s` encloses the true time in seconds at a
    /// local time to come.
    pub fn due(&mut self, sensed: &Sensed, true_time_s: &dyn Fn(LocalTime) -> Interval) -> Vec<Booking> {
        let mut booked = Vec::new();
        self.access.book(&Tick::new(sensed, &self.wake, true_time_s), &mut booked);
        booked
    }

    /// The ping that says what is predicted for its emission. One that does not fit a frame is not sent: better silent than wrong.
    pub fn plan(&mut self, booking: Booking, prediction: &Prediction) -> Option<PlannedPing> {
        let frame = self.frame(prediction).ok()?;
        self.sequence = self.sequence.wrapping_add(1);
        Some(PlannedPing { at: booking.at, listen_ns: booking.listen_ns, frame })
    }

    fn frame(&self, prediction: &Prediction) -> Result<Frame, FrameError> {
        if let Some(belief) = &prediction.gaussian {
            let [x, y, z, emission_s] = belief.mean;
            return GaussianPing {
                sender: self.auv,
                sequence: self.sequence,
                emission_s,
                position_m: [x, y, z],
                covariance: belief.covariance,
                velocity_m_s: prediction.velocity_m_s.mid().into(),
            }
            .encode();
        }
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
