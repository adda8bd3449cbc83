//! Stay in one place.

use nalgebra::Vector3;
use shoal_bus::message::Sensed;

use super::{Belief, Controller, Steering, towards};

/// Greatest speed of station keeping, in m/s.
const SPEED_M_S: f64 = 1.0;

/// Holds a point.
pub struct Hold {
    /// The point in metres.
    pub target_m: Vector3<f64>,
}

impl Controller for Hold {
    fn steer(&mut self, _: &Sensed, belief: &Belief) -> Steering {
        Steering { velocity_m_s: towards(self.target_m - belief.position_m, SPEED_M_S), neighbours: 0 }
    }
}
