//! Odometry with its errors, as sets.
//!
//! The frame is that of dead reckoning, which the true one is turned against by the error of the heading. Ways in this frame stay
//! as narrow as the odometry is good; the turn, which most ways share, is made once at the end.

use shoal_interval::{Interval, IntervalBox, IntervalMatrix};

use super::{Mission, Start};

/// How wrong odometry may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OdometryBounds {
    /// Longest error of a step's displacement, in metres, whatever its length.
    pub step_m: f64,
    /// What is added to it for each metre that the step is long.
    pub relative: f64,
    /// Greatest error of a step's turn, in radians. It adds up.
    pub turn_rad: f64,
}

/// A mission's odometry, as sets.
pub(super) struct Course {
    /// Displacement of each step in the frame of dead reckoning, in metres.
    steps_m: Vec<IntervalBox<2>>,
    /// Error of the heading at the first pose, in radians.
    start_error_rad: Interval,
    turn_rad: f64,
}

impl Course {
    /// What odometry says when it is as good as `bounds`, with the heading at the start.
    pub fn new(mission: &Mission, start: &Start, bounds: &OdometryBounds) -> Self {
        let middle_rad = start.heading_rad.mid();
        let mut heading_rad = Interval::spanning(middle_rad, middle_rad);
        let steps_m = mission
            .steps()
            .iter()
            .map(|step| {
                let exactly = |number| Interval::spanning(number, number);
                let body_m = IntervalBox::from([exactly(step.forward_m), exactly(step.left_m)]);
                let step_m =
                    turned(body_m, heading_rad).inflate(bounds.step_m + bounds.relative * step.length_m());
                heading_rad += exactly(step.turn_rad);
                step_m
            })
            .collect();
        let start_error_rad = start.heading_rad - Interval::spanning(middle_rad, middle_rad);
        Self { steps_m, start_error_rad, turn_rad: bounds.turn_rad }
    }

    /// Error of the heading at a pose, in radians: the angle from the frame of dead reckoning to the true one.
    pub fn heading_error_rad(&self, pose: usize) -> Interval {
        self.start_error_rad.inflate(self.turned_since_rad(pose))
    }

    /// True displacement from a pose to the next, in metres.
    pub fn step_m(&self, pose: usize) -> IntervalBox<2> {
        turned(self.steps_m[pose], self.heading_error_rad(pose))
    }

    /// True displacements from `pose` to those after it, the next one first, with their numbers.
    pub fn ahead(&self, pose: usize) -> impl Iterator<Item = (usize, IntervalBox<2>)> {
        let error_rad = self.heading_error_rad(pose);
        let mut way_m = IntervalBox::from([Interval::ZERO; 2]);
        (pose..self.steps_m.len()).map(move |at| {
            way_m += self.seen_from(at, at - pose);
            (at + 1, turned(way_m, error_rad))
        })
    }

    /// True displacements from `pose` to those before it, the last one first, with their numbers.
    pub fn behind(&self, pose: usize) -> impl Iterator<Item = (usize, IntervalBox<2>)> {
        let error_rad = self.heading_error_rad(pose);
        let mut way_m = IntervalBox::from([Interval::ZERO; 2]);
        (0..pose).rev().map(move |at| {
            way_m -= self.seen_from(at, pose - at);
            (at, turned(way_m, error_rad))
        })
    }

    /// A step in a frame of dead reckoning that agrees with the true one at a pose so many steps away.
    fn seen_from(&self, step: usize, away: usize) -> IntervalBox<2> {
        turned(self.steps_m[step], Interval::ZERO.inflate(self.turned_since_rad(away)))
    }

    fn turned_since_rad(&self, steps: usize) -> f64 {
        // Less than 2^53 steps are exact; the product's last bit is made up for.
        steps as f64 * self.turn_rad * (1.0 + f64::EPSILON)
    }
}

/// A box turned by an angle in radians.
fn turned(vector_m: IntervalBox<2>, angle_rad: Interval) -> IntervalBox<2> {
    if angle_rad == Interval::ZERO {
        return vector_m;
    }
    IntervalMatrix::rotation_2d(angle_rad) * vector_m
}
