//! What an AUV's sensors say: the truth plus an error drawn inside the stated bound, each value checked against it.

use pxfm::f_sincos;
use shoal_bus::message::{AuvId, Bounds, Event, Measured, Sense};
use shoal_bus::time::{LocalTime, SimTime};
use shoal_scenario::model::{Noise, Sensors as SensorsModel};

use crate::body::{Attitude, Pose, Vec3};
use crate::draw::{Draws, Purpose};

/// What is added to every stated error bound: more than the rounding of the simulator's own arithmetic, for numbers as large
/// as `magnitude`.
pub fn rounding(magnitude: f64) -> f64 {
    1e-8 + 1e-15 * magnitude.abs()
}

/// One AUV's sensors.
pub struct Sensors {
    model: SensorsModel,
    bottom_depth_m: f64,
    inertial: Draws,
    dvl: Draws,
    depth: Draws,
    gnss: Draws,
    next_fix: LocalTime,
}

impl Sensors {
    /// The sensors of an AUV over a bottom at this depth (positive down); `first_fix` is when its satellite receiver first
    /// tries.
    pub fn new(
        model: &SensorsModel,
        bottom_depth_m: f64,
        (seed, auv, noise): (u64, AuvId, Noise),
        first_fix: LocalTime,
    ) -> Self {
        let draws = |purpose| Draws::new(seed, purpose, auv, noise);
        Self {
            model: model.clone(),
            bottom_depth_m,
            inertial: draws(Purpose::Inertial),
            dvl: draws(Purpose::Dvl),
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
        self.over_ground(stamp, pose, events);
        if let Some(error_m) = self.model.depth_error_m {
            let depth_m = measured(&mut self.depth, -pose.position_m.z, error_m);
            events.push(Event { stamp, sense: Sense::Depth { depth_m } });
        }
        self.fix(stamp, t, pose, events);
    }

    /// The velocity over ground, while the log sees the bottom.
    fn over_ground(&mut self, stamp: LocalTime, pose: &Pose, events: &mut Vec<Event>) {
        let Some(dvl) = &self.model.dvl else { return };
        let altitude_m = self.bottom_depth_m + pose.position_m.z;
        if !(0.0..=dvl.altitude_max_m).contains(&altitude_m) {
            return;
        }
        let velocity_m_s = body_axes(&pose.attitude)
            .map(|axis| measured(&mut self.dvl, axis.dot(&pose.ground_velocity_m_s), dvl.velocity_error_m_s));
        events.push(Event { stamp, sense: Sense::Dvl { velocity_m_s } });
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

/// The axes of a body that does not roll, as unit vectors: forward, to port, and up.
///
/// Up is `forward x port` written out.
fn body_axes(attitude: &Attitude) -> [Vec3; 3] {
    let (sin_heading, cos_heading) = f_sincos(attitude.heading_rad);
    let (sin_pitch, cos_pitch) = f_sincos(attitude.pitch_rad);
    [
        Vec3::new(cos_pitch * cos_heading, cos_pitch * sin_heading, sin_pitch),
        Vec3::new(-sin_heading, cos_heading, 0.0),
        Vec3::new(-sin_pitch * cos_heading, -sin_pitch * sin_heading, cos_pitch),
    ]
}

/// The truth with a drawn error, and the bound that is stated for it.
pub(crate) fn measured(draws: &mut Draws, truth: f64, bound: f64) -> Measured {
    let value = truth + draws.error(bound);
    let error = bound + rounding(truth.abs() + bound);
    assert!(
        (value - truth).abs() < error,
        "the channel drew {value} for {truth}, outside the ±{error} it states"
    );
    Measured { value, error }
}

#[cfg(test)]
mod tests;
