//! What an AUV's sensors say: the truth plus an error drawn inside the stated bound, each value checked against it.

use shoal_bus::message::{AuvId, Bounds, Event, Measured, Sense};
use shoal_bus::time::{LocalTime, SimTime};
use shoal_scenario::model::{Noise, Sensors as SensorsModel};

use crate::body::Pose;
use crate::draw::{Draws, Purpose};

/// What is added to every stated error bound: more than the rounding of the simulator's own arithmetic, for numbers as large
/// as `magnitude`.
pub fn rounding(magnitude: f64) -> f64 {
    1e-8 + 1e-15 * magnitude.abs()
}

/// One AUV's sensors.
pub struct Sensors {
    model: SensorsModel,
    inertial: Draws,
    depth: Draws,
    gnss: Draws,
    next_fix: LocalTime,
}

impl Sensors {
    /// The sensors of `auv`; `first_fix` is when its satellite receiver first tries.
    pub fn new(model: &SensorsModel, seed: u64, auv: AuvId, noise: Noise, first_fix: LocalTime) -> Self {
        let draws = |purpose| Draws::new(seed, purpose, auv, noise);
        Self {
            model: model.clone(),
            inertial: draws(Purpose::Inertial),
            depth: draws(Purpose::Depth),
            gnss: draws(Purpose::Gnss),
            next_fix: first_fix,
        }
    }

    /// What they say at a tick, stamped `stamp`, at true time `t`.
    pub fn sense(&mut self, stamp: LocalTime, t: SimTime, pose: &Pose, events: &mut Vec<Event>) {
        let attitude = &pose.attitude;
        let inertial = &mut self.inertial;
        events.push(Event {
            stamp,
            sense: Sense::Inertial {
                heading_rad: measured(inertial, attitude.heading_rad, self.model.heading_error_rad),
                pitch_rad: measured(inertial, attitude.pitch_rad, self.model.pitch_error_rad),
                speed_m_s: measured(inertial, attitude.speed_m_s, self.model.speed_error_m_s),
            },
        });
        if let Some(error_m) = self.model.depth_error_m {
            let depth_m = measured(&mut self.depth, -pose.position_m.z, error_m);
            events.push(Event { stamp, sense: Sense::Depth { depth_m } });
        }
        self.fix(stamp, t, pose, events);
    }

    fn fix(&mut self, stamp: LocalTime, t: SimTime, pose: &Pose, events: &mut Vec<Event>) {
        let Some(gnss) = self.model.gnss.as_ref().filter(|_| stamp >= self.next_fix) else { return };
        let missed = (stamp - self.next_fix) / gnss.period_ns;
        self.next_fix = self.next_fix + (missed + 1) * gnss.period_ns;
        if pose.position_m.z <= -gnss.depth_max_m {
            return;
        }
        let mut around = |truth: f64, error: f64| {
            let Measured { value, error } = measured(&mut self.gnss, truth, error);
            Bounds::new(value - error, value + error)
        };
        let position_m =
            std::array::from_fn(|axis| around(pose.position_m[axis], gnss.position_error_m[axis]));
        let time_s = around(t.as_s(), gnss.time_error_s);
        events.push(Event { stamp, sense: Sense::Gnss { position_m, time_s } });
    }
}

/// The truth with a drawn error, and the bound that is stated for it.
fn measured(draws: &mut Draws, truth: f64, bound: f64) -> Measured {
    let value = truth + draws.error(bound);
    let error = bound + rounding(truth.abs() + bound);
    assert!(
        (value - truth).abs() < error,
        "the channel drew {value} for {truth}, outside the ±{error} it states"
    );
    Measured { value, error }
}
