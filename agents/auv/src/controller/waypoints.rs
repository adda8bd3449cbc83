//! Visit points in turn.

use nalgebra::Vector3;
use shoal_bus::message::Sensed;

use super::{Belief, Controller, Steering, towards};

/// Visits points in turn; after the last it stays there, or begins again.
pub struct Waypoints {
    points_m: Vec<Vector3<f64>>,
    speed_m_s: f64,
    reach_m: f64,
    repeat: bool,
    next: usize,
}

impl Waypoints {
    /// The route over `points_m`, in metres, at `speed_m_s`; a point counts as reached within `reach_m`.
    pub fn new(points_m: Vec<[f64; 3]>, speed_m_s: f64, reach_m: f64, repeat: bool) -> Self {
        Self {
            points_m: points_m.into_iter().map(Vector3::from).collect(),
            speed_m_s,
            reach_m,
            repeat,
            next: 0,
        }
    }
}

impl Controller for Waypoints {
    fn steer(&mut self, _: &Sensed, belief: &Belief) -> Steering {
        let Some(mut target_m) = self.points_m.get(self.next).copied() else { return Steering::default() };
        if (target_m - belief.position_m).norm() <= self.reach_m {
            let last = self.next + 1 == self.points_m.len();
            self.next = match (last, self.repeat) {
                (false, _) => self.next + 1,
                (true, true) => 0,
                (true, false) => self.next,
            };
            target_m = self.points_m[self.next];
        }
        let gap_m = target_m - belief.position_m;
        let arriving = self.next + 1 == self.points_m.len() && !self.repeat;
        let velocity_m_s = if arriving {
            towards(gap_m, self.speed_m_s)
        } else {
            gap_m.try_normalize(1e-9).unwrap_or_default() * self.speed_m_s
        };
        Steering { velocity_m_s, neighbours: 0 }
    }
}
