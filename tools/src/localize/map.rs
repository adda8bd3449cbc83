//! The figure: where the vehicle was, and how well that is known over the mission.

use shoal_auv::beacons::{Enclosed, Track};

use super::files::Dataset;
use super::report::{Report, errors_m};
use crate::figure::{Axis, Colour, Entry, Figure, Layer, Mark, Panel, Sample, Shape};

const REFERENCE: Colour = Colour::Black;
const ESTIMATE: Colour = Colour::Blue;
const ENCLOSURE: Colour = Colour::Sky;
const BEACON: Mark = Mark::new(Shape::Triangle, Colour::Green);
const REJECTED: Mark = Mark::new(Shape::Cross, Colour::Vermillion);

/// So many enclosures are drawn on the map: more would hide each other.
const ENCLOSURES: usize = 60;

/// Draws a track.
pub fn figure(dataset: &Dataset, track: &Track, report: &Report, title: &str) -> Figure {
    let reference = dataset.reference.is_some();
    let mut legend = vec![
        Entry::new(Sample::Line(ESTIMATE), "centre of the enclosure, its error"),
        Entry::new(Sample::Line(ENCLOSURE), "enclosure, its width"),
        Entry::new(Sample::Mark(BEACON), "beacon"),
        Entry::new(Sample::Mark(REJECTED), "where and when a range was rejected"),
    ];
    if reference {
        legend.insert(0, Entry::new(Sample::Line(REFERENCE), "reference"));
    }
    let remark = |text: String| Entry::remark(text);
    legend.extend(report.contained_fraction.map(|part| remark(format!("contained {:.2} %", 100.0 * part))));
    legend.push(remark(format!("width {:.1} m (median)", report.width_median_m)));
    legend.extend(report.centre_rms_m.map(|rms_m| remark(format!("error {rms_m:.2} m (RMS)"))));
    legend.push(remark(format!("{} ranges rejected", report.ranges_rejected)));
    Figure {
        title: title.to_owned(),
        subtitle: format!(
            "{} poses, {} ranges to {} beacons ({})",
            report.poses,
            dataset.mission.ranges().len(),
            dataset.beacon_ids.len(),
            dataset.beacon_ids.join(", ")
        ),
        panels: vec![map(dataset, track), over_poses(dataset, track)],
        legend,
    }
}

fn map(dataset: &Dataset, track: &Track) -> Panel {
    let mission = &dataset.mission;
    let mut layers: Vec<Layer> = track
        .poses
        .iter()
        .step_by(track.poses.len().div_ceil(ENCLOSURES))
        .map(|pose| Layer::Line { colour: ENCLOSURE, points: rim(pose) })
        .collect();
    let beacons: Vec<[f64; 2]> = mission.beacons_m().iter().map(|at| [at[0], at[1]]).collect();
    let centres: Vec<[f64; 2]> = track.poses.iter().map(centre).collect();
    let mut seen = [beacons.as_slice(), &centres].concat();
    if let Some(reference) = &dataset.reference {
        let points: Vec<[f64; 2]> =
            reference.iter().map(|pose| [pose.position_m[0], pose.position_m[1]]).collect();
        seen.extend_from_slice(&points);
        layers.push(Layer::Line { colour: REFERENCE, points });
    }
    let rejected = track.rejected.iter().map(|&index| centre(&track.poses[mission.ranges()[index].pose]));
    let rejected = rejected.collect();
    layers.push(Layer::Line { colour: ESTIMATE, points: centres });
    layers.push(Layer::Marks { mark: REJECTED, points: rejected });
    layers.push(Layer::Marks { mark: BEACON, points: beacons });
    // As high as a panel is, so that a metre is as long both ways.
    let [x, y] = square(&seen);
    Panel { width_px: 420.0, x: Axis::new("x (m)", x[0], x[1]), y: Axis::new("y (m)", y[0], y[1]), layers }
}

fn over_poses(dataset: &Dataset, track: &Track) -> Panel {
    let over = |values: Vec<f64>| -> Vec<[f64; 2]> {
        values.into_iter().enumerate().map(|(pose, value)| [pose as f64, value]).collect()
    };
    let widths: Vec<f64> = track.poses.iter().map(|pose| pose.position_m.width()).collect();
    let mut most_m = widths.iter().copied().fold(0.0, f64::max);
    let mut layers = vec![Layer::Line { colour: ENCLOSURE, points: over(widths) }];
    if let Some(reference) = &dataset.reference {
        let errors_m = errors_m(track, reference);
        most_m = errors_m.iter().copied().fold(most_m, f64::max);
        layers.push(Layer::Line { colour: ESTIMATE, points: over(errors_m) });
    }
    let rejected = track.rejected.iter().map(|&index| [dataset.mission.ranges()[index].pose as f64, 0.0]);
    layers.push(Layer::Marks { mark: REJECTED, points: rejected.collect() });
    Panel {
        width_px: 420.0,
        x: Axis::from_zero("pose", track.poses.len() as f64),
        y: Axis::around("width, error (m)", 0.0, most_m),
        layers,
    }
}

fn centre(pose: &Enclosed) -> [f64; 2] {
    [pose.centre_m[0], pose.centre_m[1]]
}

/// Around a box, from corner to corner.
fn rim(pose: &Enclosed) -> Vec<[f64; 2]> {
    let [x, y] = [pose.position_m[0], pose.position_m[1]];
    let (left, right, low, high) = (x.lower(), x.upper(), y.lower(), y.upper());
    vec![[left, low], [right, low], [right, high], [left, high], [left, low]]
}

/// Sides of a square around points, with some room.
fn square(points: &[[f64; 2]]) -> [[f64; 2]; 2] {
    let side = |axis: usize| {
        points.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], point| {
            [least.min(point[axis]), most.max(point[axis])]
        })
    };
    let sides = [side(0), side(1)];
    let half = 0.54 * sides.iter().map(|[least, most]| most - least).fold(1.0, f64::max);
    sides.map(|[least, most]| {
        let middle = 0.5 * (least + most);
        [middle - half, middle + half]
    })
}
