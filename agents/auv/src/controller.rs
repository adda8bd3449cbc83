//! How an AUV steers: from what it believes to a desired velocity. Beliefs are middles of enclosures here; the guarantee is
//! the estimator's business.

mod circle;
mod hold;
mod reynolds;
mod waypoints;

use nalgebra::Vector3;
use shoal_bus::message::{BoundsBox, Controller as Orders, Sensed};

/// What a controller steers by, at one tick.
#[derive(Clone, Copy, Debug)]
pub struct Belief {
    /// Middle of the true-time interval, in seconds.
    pub time_s: f64,
    /// Middle of the position box, in metres.
    pub position_m: Vector3<f64>,
    /// Width of the position box, in metres.
    pub box_width_m: f64,
    /// Middle of the velocity over ground, in m/s.
    pub velocity_m_s: Vector3<f64>,
    /// From the tick to the middle of the time during which the answer will act, in seconds.
    pub lead_s: f64,
}

/// A way to steer.
pub trait Controller: Send {
    /// The desired velocity over ground in m/s, and how many neighbours it heeds.
    fn steer(&mut self, sensed: &Sensed, belief: &Belief) -> Steering;
}

/// What a controller wants.
#[derive(Clone, Copy, Debug, Default)]
pub struct Steering {
    /// Desired velocity over ground, in m/s.
    pub velocity_m_s: Vector3<f64>,
    /// How many neighbours it heeds.
    pub neighbours: u16,
}

/// The controller that these orders ask for.
pub fn ordered(orders: &Orders, prior_position_m: &BoundsBox, area_m: &BoundsBox) -> Box<dyn Controller> {
    match orders.clone() {
        Orders::Hold => {
            let target_m = Vector3::from(prior_position_m.map(|side| side.mid()));
            Box::new(hold::Hold { target_m })
        }
        Orders::Circle { centre_m, radius_m, rate_rad_s, phase_rad, heave_m, heave_phase_rad } => {
            let centre_m = Vector3::from(centre_m);
            Box::new(circle::Circle { centre_m, radius_m, rate_rad_s, phase_rad, heave_m, heave_phase_rad })
        }
        Orders::Waypoints { points_m, speed_m_s, reach_m, repeat } => {
            Box::new(waypoints::Waypoints::new(points_m, speed_m_s, reach_m, repeat))
        }
        Orders::Reynolds { speed_m_s, separation, cohesion, alignment, margin_m, forget_ns, trusts } => {
            let rules =
                reynolds::Rules { speed_m_s, separation, cohesion, alignment, margin_m, forget_ns, trusts };
            Box::new(reynolds::Reynolds::new(rules, *area_m))
        }
    }
}

/// A velocity that closes a gap: proportional to it, at most `speed_m_s`.
fn towards(gap_m: Vector3<f64>, speed_m_s: f64) -> Vector3<f64> {
    /// Closes a gap in this many seconds when the speed allows.
    const CLOSING_S: f64 = 2.0;
    (gap_m / CLOSING_S).cap_magnitude(speed_m_s)
}
