//! Synthetic missions, of which the truth is known.

use std::f64::consts::PI;

use nalgebra::Vector2;
use proptest::prelude::*;
use shoal_interval::{Interval, IntervalBox};

use super::*;

const BOUNDS: OdometryBounds = OdometryBounds { step_m: 0.05, relative: 0.02, turn_rad: 1e-4 };

const SETTINGS: TubeSettings = TubeSettings {
    odometry: BOUNDS,
    range_m: 2.0,
    window: 16,
    outliers: 4,
    margin: 1,
    precision_m: 0.5,
    smoothed: true,
};

/// A mission with the true positions.
struct Synthetic {
    mission: Mission,
    truth_m: Vec<Vector2<f64>>,
    start_rad: f64,
}

impl Synthetic {
    /// A lawn mower between four beacons. `draws` are in -1..1: errors of odometry and ranges, each at the bound when at one.
    /// Every `outlier_every`th range comes short by a third.
    fn new(poses: usize, draws: &[f64], outlier_every: usize) -> Self {
        let beacons_m = [[0.0, 0.0], [400.0, 20.0], [380.0, 300.0], [-20.0, 310.0]].map(Vector2::from);
        let mut draw = draws.iter().copied().cycle();
        let mut draw = || draw.next().unwrap();
        let start_rad = 0.3;
        let (mut at_m, mut heading_rad) = (Vector2::new(60.0, 60.0), start_rad);
        let (mut truth_m, mut steps, mut ranges) = (vec![at_m], Vec::new(), Vec::new());
        for pose in 1..poses {
            let step =
                Step { forward_m: 4.0, left_m: 0.2, turn_rad: if pose % 40 < 8 { PI / 8.0 } else { 0.0 } };
            at_m += dead_reckoning::displacement_m(&step, heading_rad);
            heading_rad += step.turn_rad;
            truth_m.push(at_m);
            // Each axis at most 0.7 of the longest error.
            let longest_m = 0.7 * (BOUNDS.step_m + 0.99 * BOUNDS.relative * 4.0);
            steps.push(Step {
                forward_m: step.forward_m + longest_m * draw(),
                left_m: step.left_m + longest_m * draw(),
                turn_rad: step.turn_rad + 0.99 * BOUNDS.turn_rad * draw(),
            });
            for beacon in [pose % 4, (pose + 1) % 4] {
                let exact_m = (at_m - beacons_m[beacon]).norm();
                let is_outlier = ranges.len() % outlier_every == outlier_every - 1;
                let range_m = if is_outlier { exact_m / 1.5 } else { exact_m + 2.0 * draw() };
                ranges.push(BeaconRange { pose, beacon, range_m: range_m.max(0.0), sigma_m: 1.0 });
            }
        }
        Self { mission: Mission::new(beacons_m.into(), steps, ranges).unwrap(), truth_m, start_rad }
    }

    fn start(&self) -> Start {
        Start {
            position_m: IntervalBox::centred(&self.truth_m[0], 1.0),
            heading_rad: Interval::centred(self.start_rad, 0.02),
        }
    }

    fn lost(&self, track: &Track) -> Vec<usize> {
        let is_lost = |pose: &usize| !track.poses[*pose].position_m.contains(&self.truth_m[*pose]);
        (0..self.truth_m.len()).filter(is_lost).collect()
    }

    fn rms_m(&self, track: &Track) -> f64 {
        let square = |(pose, truth_m): (&Enclosed, &Vector2<f64>)| (pose.centre_m - truth_m).norm_squared();
        let sum: f64 = track.poses.iter().zip(&self.truth_m).map(square).sum();
        (sum / self.truth_m.len() as f64).sqrt()
    }
}

fn median_width_m(track: &Track) -> f64 {
    let mut widths_m: Vec<f64> = track.poses.iter().map(|pose| pose.position_m.width()).collect();
    widths_m.sort_unstable_by(f64::total_cmp);
    widths_m[widths_m.len() / 2]
}

/// The same draws in every run, between -1 and 1.
fn some_draws() -> Vec<f64> {
    (0..997_u32).map(|n| f64::from(n * 619 % 997) / 498.0 - 1.0).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn the_truth_is_inside_while_the_bounds_hold(
        draws in prop::collection::vec(prop_oneof![-1.0..1.0, Just(-1.0), Just(1.0)], 50..120),
        outlier_every in 17_usize..40,
    ) {
        let synthetic = Synthetic::new(70, &draws, outlier_every);
        // One outlier in any window at most, which is what the margin alone covers.
        for smoothed in [false, true] {
            let track = tube(&synthetic.mission, &synthetic.start(), &TubeSettings { smoothed, ..SETTINGS });
            prop_assert_eq!(synthetic.lost(&track), Vec::<usize>::new());
            prop_assert!(track.emptied.is_empty());
        }
        prop_assert!(synthetic.lost(&dead_reckoning(&synthetic.mission, &synthetic.start(), &BOUNDS)).is_empty());
    }
}

#[test]
fn ranges_make_it_narrow_and_looking_back_narrower() {
    let synthetic = Synthetic::new(120, &some_draws(), 17);
    let start = synthetic.start();
    let drifting = dead_reckoning(&synthetic.mission, &start, &BOUNDS);
    let online = tube(&synthetic.mission, &start, &TubeSettings { smoothed: false, ..SETTINGS });
    let both_ways = tube(&synthetic.mission, &start, &SETTINGS);
    let [drifting_m, online_m, both_ways_m] = [&drifting, &online, &both_ways].map(median_width_m);
    assert!(
        online_m < 0.5 * drifting_m && both_ways_m < 0.95 * online_m,
        "{drifting_m} {online_m} {both_ways_m}"
    );
    assert!(both_ways_m < 6.0, "{both_ways_m}");
    // Every outlier is found, and nothing else.
    let outliers: Vec<usize> = (16..synthetic.mission.ranges().len()).step_by(17).collect();
    assert_eq!(both_ways.rejected, outliers);
}

#[test]
fn a_gate_saves_the_filter() {
    let synthetic = Synthetic::new(150, &some_draws(), 17);
    let settings =
        EkfSettings { step_m: 0.05, relative: 0.02, turn_rad: 1e-4, sigma_m: None, gate: Some(4.0) };
    let gated = ekf(&synthetic.mission, &synthetic.start(), &settings);
    let open = ekf(&synthetic.mission, &synthetic.start(), &EkfSettings { gate: None, ..settings });
    let (gated_m, open_m) = (synthetic.rms_m(&gated), synthetic.rms_m(&open));
    assert!(gated_m < 1.5 && open_m > 5.0 * gated_m, "{gated_m} {open_m}");
    assert!(open.rejected.is_empty() && gated.rejected.len() >= 17);
}

#[test]
fn broken_promises_are_told() {
    let synthetic = Synthetic::new(100, &some_draws(), 2);
    let track = tube(&synthetic.mission, &synthetic.start(), &SETTINGS);
    assert!(!track.emptied.is_empty());
    assert!(track.poses.iter().all(|pose| !pose.position_m.is_empty()));
}

#[test]
fn an_unknown_start_is_found() {
    let synthetic = Synthetic::new(60, &some_draws(), 30);
    let anywhere = Start { position_m: synthetic.mission.area_m(), heading_rad: Interval::spanning(-PI, PI) };
    let search = HeadingSearch { precision_rad: 0.1 };
    let heading_rad = search_heading(&synthetic.mission, &anywhere, &SETTINGS, &search);
    assert!(heading_rad.contains(synthetic.start_rad) && heading_rad.width() < 0.7, "{heading_rad}");
    let track = tube(&synthetic.mission, &Start { heading_rad, ..anywhere }, &SETTINGS);
    assert_eq!(synthetic.lost(&track), Vec::<usize>::new());
    assert!(median_width_m(&track) < 30.0, "{}", median_width_m(&track));
}

#[test]
fn no_mission() {
    let step = Step { forward_m: 1.0, left_m: 0.0, turn_rad: 0.0 };
    let range = BeaconRange { pose: 1, beacon: 0, range_m: 1.0, sigma_m: 1.0 };
    let with = |step, ranges: &[BeaconRange]| {
        Mission::new(vec![Vector2::zeros()], vec![step], ranges.to_vec()).err()
    };
    assert_eq!(with(step, &[range]), None);
    let bad = Step { turn_rad: f64::NAN, ..step };
    assert_eq!(with(bad, &[]), Some(MissionError::BadNumber { what: "step", index: 0 }));
    let bad_range = Some(MissionError::BadNumber { what: "range", index: 0 });
    for (range_m, sigma_m) in [(f64::INFINITY, 1.0), (-1.0, 1.0), (1.0, 0.0), (1.0, f64::NAN)] {
        assert_eq!(with(step, &[BeaconRange { range_m, sigma_m, ..range }]), bad_range);
    }
    assert_eq!(with(step, &[BeaconRange { pose: 2, ..range }]), Some(MissionError::Unknown { index: 0 }));
    assert_eq!(with(step, &[BeaconRange { beacon: 1, ..range }]), Some(MissionError::Unknown { index: 0 }));
    let early = BeaconRange { pose: 0, ..range };
    assert_eq!(with(step, &[range, early]), Some(MissionError::OutOfOrder { index: 1 }));
}
