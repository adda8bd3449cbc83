//! An extended Kalman filter of the pose, the probabilistic opponent of the tube.

use nalgebra::{Matrix3, RowVector3, Vector2, Vector3};
use shoal_interval::{Interval, IntervalBox};

use super::dead_reckoning::displacement_m;
use super::{BeaconRange, Enclosed, Mission, Start, Step, Track};

/// What the filter believes of the measurements: standard deviations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EkfSettings {
    /// Of a step's displacement along each axis, in metres, whatever its length.
    pub step_m: f64,
    /// What is added to it for each metre that the step is long.
    pub relative: f64,
    /// Of a step's turn, in radians.
    pub turn_rad: f64,
    /// Of a range, in metres; as the data state it unless given.
    pub sigma_m: Option<f64>,
    /// Ranges that surprise by more than so many standard deviations are rejected; none are unless given.
    pub gate: Option<f64>,
}

/// Filters a mission, pose by pose. The enclosures are three standard deviations either way, which is a belief and no bound.
///
/// The state is `(x, y, heading)`; a range to a beacon is linearized at the prediction, one after the other.
/// Source: Thrun, Burgard and Fox, *Probabilistic robotics*, 2005, sections 3.3 and 7.4.
pub fn ekf(mission: &Mission, start: &Start, settings: &EkfSettings) -> Track {
    let mut filter = Filter::new(start);
    let mut track = Track::default();
    for pose in 0..mission.pose_count() {
        if let Some(step) = pose.checked_sub(1).and_then(|last| mission.steps().get(last)) {
            filter.predict(step, settings);
        }
        for index in mission.ranges_at(pose) {
            let range = &mission.ranges()[index];
            if !filter.update(range, &mission.beacons_m()[range.beacon], settings) {
                track.rejected.push(index);
            }
        }
        track.poses.push(filter.enclosed());
    }
    track
}

/// Mean and covariance of `(x, y, heading)`, in metres and radians.
struct Filter {
    mean: Vector3<f64>,
    covariance: Matrix3<f64>,
}

impl Filter {
    /// The bounds of the start are taken for three standard deviations.
    fn new(start: &Start) -> Self {
        let sides = [start.position_m[0], start.position_m[1], start.heading_rad];
        let [x, y, heading] = sides.map(|side| side.mid());
        let variance = sides.map(|side| side.radius() * side.radius() / 9.0);
        Self {
            mean: Vector3::new(x, y, heading),
            covariance: Matrix3::from_diagonal(&Vector3::from(variance)),
        }
    }

    fn predict(&mut self, step: &Step, settings: &EkfSettings) {
        let way_m = displacement_m(step, self.mean[2]);
        let turned = Matrix3::new(1.0, 0.0, -way_m[1], 0.0, 1.0, way_m[0], 0.0, 0.0, 1.0);
        self.mean += Vector3::new(way_m[0], way_m[1], step.turn_rad);
        let step_m = settings.step_m + settings.relative * step.length_m();
        let noise = Vector3::new(step_m * step_m, step_m * step_m, settings.turn_rad * settings.turn_rad);
        self.covariance = turned * self.covariance * turned.transpose() + Matrix3::from_diagonal(&noise);
    }

    /// Takes in a range; whether it passed the gate.
    fn update(&mut self, range: &BeaconRange, beacon_m: &Vector2<f64>, settings: &EkfSettings) -> bool {
        let from_beacon_m = Vector2::new(self.mean[0] - beacon_m[0], self.mean[1] - beacon_m[1]);
        let predicted_m = from_beacon_m.norm();
        if predicted_m == 0.0 {
            // On top of the beacon, a range has no direction.
            return false;
        }
        let slope = RowVector3::new(from_beacon_m[0] / predicted_m, from_beacon_m[1] / predicted_m, 0.0);
        let sigma_m = settings.sigma_m.unwrap_or(range.sigma_m);
        let covered = self.covariance * slope.transpose();
        let variance_m2 = (slope * covered)[0] + sigma_m * sigma_m;
        let surprise_m = range.range_m - predicted_m;
        if settings.gate.is_some_and(|gate| surprise_m * surprise_m > gate * gate * variance_m2) {
            return false;
        }
        let gain = covered / variance_m2;
        self.mean += gain * surprise_m;
        // Joseph's form stays symmetric and positive.
        let kept = Matrix3::identity() - gain * slope;
        self.covariance =
            kept * self.covariance * kept.transpose() + gain * (sigma_m * sigma_m) * gain.transpose();
        true
    }

    fn enclosed(&self) -> Enclosed {
        let side = |axis: usize| {
            Interval::centred(self.mean[axis], 3.0 * self.covariance[(axis, axis)].max(0.0).sqrt())
        };
        Enclosed {
            centre_m: Vector2::new(self.mean[0], self.mean[1]),
            position_m: IntervalBox::from([side(0), side(1)]),
        }
    }
}
