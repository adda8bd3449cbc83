//! What was measured on a mission, and what an estimator makes of it.

use std::ops::Range;

use nalgebra::Vector2;
use shoal_interval::{Interval, IntervalBox};

/// What odometry says of the way from one pose to the next, in the frame of the body at the first of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Along the heading, in metres.
    pub forward_m: f64,
    /// To the left of it, in metres.
    pub left_m: f64,
    /// Change of heading, counter-clockwise, in radians.
    pub turn_rad: f64,
}

impl Step {
    /// How long the way is, in metres.
    pub fn length_m(&self) -> f64 {
        (self.forward_m * self.forward_m + self.left_m * self.left_m).sqrt()
    }
}

/// A measured distance between the vehicle at a pose and a beacon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeaconRange {
    /// Number of the pose.
    pub pose: usize,
    /// Number of the beacon.
    pub beacon: usize,
    /// The distance, in metres.
    pub range_m: f64,
    /// Its standard deviation as the sensor states it, in metres.
    pub sigma_m: f64,
}

/// Why measurements are no mission.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MissionError {
    /// A number is infinite or not a number, a range negative, or a standard deviation not positive.
    #[error("{what} {index} has a number that is none, or out of its domain")]
    BadNumber {
        /// `beacon`, `step` or `range`.
        what: &'static str,
        /// Which of them, from zero.
        index: usize,
    },
    /// A range names a pose or a beacon that there is not.
    #[error("range {index} names a pose or a beacon that is not there")]
    Unknown {
        /// Which range, from zero.
        index: usize,
    },
    /// The poses of the ranges do not rise.
    #[error("range {index} belongs to an earlier pose than the one before it")]
    OutOfOrder {
        /// Which range, from zero.
        index: usize,
    },
}

/// Odometry, beacons and ranges of one vehicle.
///
/// ```
/// use nalgebra::Vector2;
/// use shoal_auv::beacons::{BeaconRange, Mission, Step};
///
/// let east = Step { forward_m: 2.0, left_m: 0.0, turn_rad: 0.0 };
/// let range = BeaconRange { pose: 1, beacon: 0, range_m: 98.0, sigma_m: 1.0 };
/// let mission = Mission::new(vec![Vector2::new(100.0, 0.0)], vec![east], vec![range])?;
/// assert_eq!(mission.pose_count(), 2);
/// # Ok::<(), shoal_auv::beacons::MissionError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Mission {
    beacons_m: Vec<Vector2<f64>>,
    steps: Vec<Step>,
    ranges: Vec<BeaconRange>,
}

impl Mission {
    /// A mission of one pose more than there are `steps`; `ranges` are in the order of their poses.
    ///
    /// # Errors
    /// [`MissionError`], when a number is none, or a range belongs nowhere.
    pub fn new(
        beacons_m: Vec<Vector2<f64>>,
        steps: Vec<Step>,
        ranges: Vec<BeaconRange>,
    ) -> Result<Self, MissionError> {
        let bad = |what, index| Err(MissionError::BadNumber { what, index });
        if let Some(index) = beacons_m.iter().position(|at| !at.iter().all(|side| side.is_finite())) {
            return bad("beacon", index);
        }
        let is_bad = |step: &Step| {
            ![step.forward_m, step.left_m, step.turn_rad].iter().all(|number| number.is_finite())
        };
        if let Some(index) = steps.iter().position(is_bad) {
            return bad("step", index);
        }
        let mut last_pose = 0;
        for (index, range) in ranges.iter().enumerate() {
            let stated = range.sigma_m > 0.0 && range.sigma_m.is_finite();
            if !(range.range_m >= 0.0 && range.range_m.is_finite() && stated) {
                return bad("range", index);
            }
            if range.pose > steps.len() || range.beacon >= beacons_m.len() {
                return Err(MissionError::Unknown { index });
            }
            if range.pose < last_pose {
                return Err(MissionError::OutOfOrder { index });
            }
            last_pose = range.pose;
        }
        Ok(Self { beacons_m, steps, ranges })
    }

    /// How many poses there are.
    pub fn pose_count(&self) -> usize {
        self.steps.len() + 1
    }

    /// Where the beacons are, in metres.
    pub fn beacons_m(&self) -> &[Vector2<f64>] {
        &self.beacons_m
    }

    /// From each pose to the next.
    pub fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// All ranges, in the order of their poses.
    pub fn ranges(&self) -> &[BeaconRange] {
        &self.ranges
    }

    /// Which ranges belong to a pose.
    pub fn ranges_at(&self, pose: usize) -> Range<usize> {
        let first = self.ranges.partition_point(|range| range.pose < pose);
        let end = self.ranges.partition_point(|range| range.pose <= pose);
        first..end
    }

    /// Where the vehicle can be if it hears a beacon at all, in metres: no farther from some beacon than the longest range says.
    pub fn area_m(&self) -> IntervalBox<2> {
        let longest_m = self.ranges.iter().map(|range| range.range_m).fold(0.0, f64::max);
        let around = |at: &Vector2<f64>| IntervalBox::centred(at, longest_m);
        self.beacons_m.iter().map(around).fold(IntervalBox::EMPTY, |hull, area| hull | area)
    }
}

/// What is known of the first pose.
#[derive(Clone, Copy, Debug)]
pub struct Start {
    /// Position, in metres.
    pub position_m: IntervalBox<2>,
    /// Heading, counter-clockwise from the x axis, in radians.
    pub heading_rad: Interval,
}

/// What an estimator says of one pose.
#[derive(Clone, Copy, Debug)]
pub struct Enclosed {
    /// Its best guess of the position, in metres.
    pub centre_m: Vector2<f64>,
    /// Where it claims the vehicle to be, in metres.
    pub position_m: IntervalBox<2>,
}

/// What an estimator makes of a mission.
#[derive(Clone, Debug, Default)]
pub struct Track {
    /// One for each pose.
    pub poses: Vec<Enclosed>,
    /// The ranges, by number, that it takes for outliers.
    pub rejected: Vec<usize>,
    /// The poses at which its assumptions contradicted each other, and it began anew from the whole area.
    pub emptied: Vec<usize>,
}
