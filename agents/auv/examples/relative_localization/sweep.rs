//! Vehicles that sweep an area by the motion of seed 002, equation (5.2), and what they measure of each other.

use nalgebra::Vector2;
use shoal_interval::{Interval, IntervalBox};

/// The step h of equation (5.2), in seconds.
pub const STEP_S: f64 = 0.5;
/// The command u_v of every vehicle, in m/s, and the greatest u_omega, in rad/s. The seed gives neither.
pub const SPEED_M_S: f64 = 1.5;
const TURN_RATE_RAD_S: f64 = 0.2;
/// The noise of equation (5.2): how far a displacement may be from what the commands say, per axis and second, in m/s.
const COMMAND_ERROR_M_S: f64 = 0.02;
/// Noise of the measurements (seed 002, figures 5.7 to 5.9), in metres and rad.
const RANGE_ERROR_M: f64 = 5.0;
const BEARING_ERROR_RAD: f64 = 0.1;
/// Noise of the compass, in rad.
const COMPASS_ERROR_RAD: f64 = 0.01;
/// Added to stated bounds, for the rounding of the simulation.
const ROUNDING: f64 = 1e-9;

/// One vehicle.
#[derive(Clone, Debug)]
pub struct Vehicle {
    pub at_m: Vector2<f64>,
    pub heading_rad: f64,
    lanes_m: Vec<Vector2<f64>>,
    next: usize,
}

impl Vehicle {
    /// Sweeps a strip of a rectangle with this corner far from the origin to and fro: in lanes along x, northwards, or along y,
    /// westwards.
    pub fn sweeping(along_x: bool, corner_m: Vector2<f64>, strip_m: [f64; 2], apart_m: f64) -> Self {
        let [first_m, width_m] = strip_m;
        let mut lanes_m = Vec::new();
        let mut across_m = 0.0;
        while across_m < width_m {
            let far_m = if along_x { corner_m.x } else { corner_m.y };
            let ends_m = if lanes_m.len() % 4 == 0 { [0.0, far_m] } else { [far_m, 0.0] };
            lanes_m.extend(ends_m.map(|along_m| match along_x {
                true => Vector2::new(along_m, first_m + across_m),
                false => Vector2::new(corner_m.x - first_m - across_m, along_m),
            }));
            across_m += apart_m;
        }
        let heading_rad = if along_x { 0.0 } else { std::f64::consts::FRAC_PI_2 };
        Self { at_m: lanes_m[0], heading_rad, lanes_m, next: 1 }
    }

    /// Goes on for one step and gives the displacement in metres: at full speed, turning towards the end of the lane.
    fn go(&mut self, dice: &mut Dice) -> Vector2<f64> {
        let goal_m = self.lanes_m[self.next] - self.at_m;
        if goal_m.norm() < 3.0 * SPEED_M_S {
            self.next = (self.next + 1) % self.lanes_m.len();
        }
        let (sin, cos) = pxfm::f_sincos(self.heading_rad);
        let off_rad = pxfm::f_atan2(cos * goal_m.y - sin * goal_m.x, cos * goal_m.x + sin * goal_m.y);
        let noise_m = Vector2::new(dice.error(COMMAND_ERROR_M_S), dice.error(COMMAND_ERROR_M_S)) * STEP_S;
        let moved_m = Vector2::new(cos, sin) * (SPEED_M_S * STEP_S) + noise_m;
        self.heading_rad += off_rad.clamp(-TURN_RATE_RAD_S * STEP_S, TURN_RATE_RAD_S * STEP_S);
        self.at_m += moved_m;
        moved_m
    }
}

/// What the commands of a vehicle say of one step: its displacement, in metres.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    pub commanded_m: IntervalBox<2>,
}

/// All vehicles for one step.
pub fn step(vehicles: &mut [Vehicle], dice: &mut Dice) -> Vec<Step> {
    let mut steps = Vec::new();
    for vehicle in vehicles {
        let (sin, cos) = pxfm::f_sincos(vehicle.heading_rad);
        let said_m = Vector2::new(cos, sin) * (SPEED_M_S * STEP_S);
        vehicle.go(dice);
        steps
            .push(Step { commanded_m: IntervalBox::centred(&said_m, COMMAND_ERROR_M_S * STEP_S + ROUNDING) });
    }
    steps
}

/// What is known of a neighbour's step without its commands: its greatest speed.
pub fn unknown_step_m() -> IntervalBox<2> {
    let farthest_m = (SPEED_M_S + 2.0 * COMMAND_ERROR_M_S) * STEP_S + ROUNDING;
    IntervalBox::from([Interval::centred(0.0, farthest_m); 2])
}

/// What one vehicle measures of another: its range in metres and its bearing in rad, from its own nose plus its own compass.
pub fn measure(from: &Vehicle, to: &Vehicle, dice: &mut Dice) -> (Interval, Interval) {
    let apart_m = to.at_m - from.at_m;
    let bearing_rad = pxfm::f_atan2(apart_m.y, apart_m.x);
    let around = |truth: f64, error: f64, dice: &mut Dice| {
        Interval::centred(truth + dice.error(error), error + ROUNDING)
    };
    let range_m = around(apart_m.norm(), RANGE_ERROR_M, dice);
    let nose_rad = around(bearing_rad - from.heading_rad, BEARING_ERROR_RAD, dice);
    let compass_rad = around(from.heading_rad, COMPASS_ERROR_RAD, dice);
    (range_m, nose_rad + compass_rad)
}

/// Uniform draws that repeat (SplitMix64).
pub struct Dice(pub u64);

impl Dice {
    fn error(&mut self, bound: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let unit = ((bits ^ (bits >> 31)) >> 11) as f64 / (1u64 << 53) as f64;
        (2.0 * unit - 1.0) * bound
    }
}
