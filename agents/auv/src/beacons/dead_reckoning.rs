//! Odometry alone.

use nalgebra::Vector2;

use super::course::{Course, OdometryBounds};
use super::{Enclosed, Mission, Start, Track};

/// Adds up odometry from the middle of `start`; the enclosures hold the truth as long as odometry keeps its bounds, and only grow.
pub fn dead_reckoning(mission: &Mission, start: &Start, bounds: &OdometryBounds) -> Track {
    let course = Course::new(mission, start, bounds);
    let mut centre_m = start.position_m.mid();
    let mut heading_rad = start.heading_rad.mid();
    let mut poses = vec![Enclosed { centre_m, position_m: start.position_m }];
    let start_m = start.position_m;
    let mut position_m = start_m;
    for (pose, step) in mission.steps().iter().enumerate() {
        centre_m += displacement_m(step, heading_rad);
        heading_rad += step.turn_rad;
        position_m += course.step_m(pose);
        poses.push(Enclosed { centre_m, position_m });
    }
    Track { poses, ..Track::default() }
}

/// A step as it looks under a heading, in metres.
pub(super) fn displacement_m(step: &super::Step, heading_rad: f64) -> Vector2<f64> {
    let (sin, cos) = pxfm::f_sincos(heading_rad);
    Vector2::new(cos * step.forward_m - sin * step.left_m, sin * step.forward_m + cos * step.left_m)
}
