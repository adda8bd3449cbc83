//! Follow a circle by the own idea of true time (seed 001, equations 4.45, 5.9 and 5.13).

use nalgebra::Vector3;
use pxfm::f_sincos;
use shoal_bus::message::Sensed;

use super::{Belief, Controller, Steering, towards};

/// Follows `centre + (radius cos a, radius sin a, heave cos(a + heave_phase))`, `a = rate t + phase`.
pub struct Circle {
    /// In metres.
    pub centre_m: Vector3<f64>,
    /// In metres.
    pub radius_m: f64,
    /// In rad/s.
    pub rate_rad_s: f64,
    /// In rad.
    pub phase_rad: f64,
    /// In metres.
    pub heave_m: f64,
    /// In rad.
    pub heave_phase_rad: f64,
}

impl Circle {
    /// Position in metres and velocity in m/s on the circle at a time in seconds.
    fn at(&self, time_s: f64) -> (Vector3<f64>, Vector3<f64>) {
        let angle_rad = self.rate_rad_s * time_s + self.phase_rad;
        let (sin, cos) = f_sincos(angle_rad);
        let (heave_sin, heave_cos) = f_sincos(angle_rad + self.heave_phase_rad);
        let arm_m = Vector3::new(self.radius_m * cos, self.radius_m * sin, self.heave_m * heave_cos);
        let turned_m = Vector3::new(-self.radius_m * sin, self.radius_m * cos, -self.heave_m * heave_sin);
        (self.centre_m + arm_m, turned_m * self.rate_rad_s)
    }
}

impl Controller for Circle {
    fn steer(&mut self, _: &Sensed, belief: &Belief) -> Steering {
        let (target_m, _) = self.at(belief.time_s);
        let (_, velocity_m_s) = self.at(belief.time_s + belief.lead_s);
        // Corrections stay small beside the motion itself.
        let correction_m_s = towards(target_m - belief.position_m, 0.2 * velocity_m_s.norm() + 0.05);
        Steering { velocity_m_s: velocity_m_s + correction_m_s, neighbours: 0 }
    }
}
