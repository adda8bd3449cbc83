//! How good the estimates of each group are, whatever estimator it has: beside the promise, what any estimator can be measured by.

use shoal_bus::message::{Bounds, BoundsBox, Gaussian, Report, box_width};
use shoal_bus::summary::EstimatorLine;
use shoal_scenario::model::{Estimator, Fusion, Scenario};

use crate::body::Vec3;

/// Sums over the reports of one AUV, in the order of its ticks, so that windows do not change their last bits.
#[derive(Clone, Copy, Debug, Default)]
pub struct Accuracy {
    reports: u64,
    contained: u64,
    gaussians: u64,
    nees: f64,
    square_error_m2: f64,
    width_m: f64,
}

impl Accuracy {
    /// Takes in a report: the truth at its tick is `position_m` and, true minus local time, `offset_s`.
    pub fn reported(&mut self, report: &Report, position_m: &Vec3, offset_s: f64) {
        let holds = |bounds: &Bounds, truth: f64| bounds.contains(truth);
        let is_contained = (0..3).all(|axis| holds(&report.position_m[axis], position_m[axis]))
            && holds(&report.clock_offset_s, offset_s);
        self.reports += 1;
        self.contained += u64::from(is_contained);
        let centre_m = report.gaussian.map_or_else(
            || middle(&report.position_m),
            |Gaussian { mean: [x, y, z, _], .. }| Vec3::new(x, y, z),
        );
        self.square_error_m2 += (centre_m - position_m).norm_squared();
        self.width_m += box_width(&report.position_m);
        if let Some(gaussian) = &report.gaussian {
            let truth = [position_m.x, position_m.y, position_m.z, offset_s];
            // A covariance that is none is as wrong as can be.
            self.nees += normalized_error_squared(gaussian, &truth).unwrap_or(f64::INFINITY);
            self.gaussians += 1;
        }
    }
}

/// The part of all reports of these AUVs that held the truth.
pub fn contained_fraction(of: &[Accuracy]) -> f64 {
    let sum = |pick: fn(&Accuracy) -> u64| of.iter().map(pick).sum::<u64>();
    ratio(sum(|auv| auv.contained) as f64, sum(|auv| auv.reports))
}

/// One line for each group of the scenario, from its AUVs in the order of their ids.
pub fn lines(scenario: &Scenario, of: &[Accuracy]) -> Vec<EstimatorLine> {
    let mut lines = Vec::with_capacity(scenario.groups.len());
    let mut others = of;
    for group in &scenario.groups {
        let (own, rest) = others.split_at(others.len().min(group.count as usize));
        others = rest;
        let (estimator, fusion) = name(&group.estimator);
        let whole = |pick: fn(&Accuracy) -> u64| own.iter().map(pick).sum::<u64>();
        let sum = |pick: fn(&Accuracy) -> f64| own.iter().map(pick).sum::<f64>();
        let (reports, gaussians) = (whole(|auv| auv.reports), whole(|auv| auv.gaussians));
        let mut widths_m: Vec<f64> = own
            .iter()
            .filter(|auv| auv.reports > 0)
            .map(|auv| finite(auv.width_m / auv.reports as f64))
            .collect();
        widths_m.sort_by(f64::total_cmp);
        lines.push(EstimatorLine {
            group: group.name.clone(),
            estimator: estimator.to_owned(),
            fusion: fusion.map(str::to_owned),
            auvs: group.count,
            reports,
            contained_fraction: ratio(whole(|auv| auv.contained) as f64, reports),
            nees_mean: (gaussians > 0).then(|| ratio(sum(|auv| auv.nees), gaussians)),
            centre_rms_m: ratio(sum(|auv| auv.square_error_m2), reports).sqrt(),
            width_median_m: widths_m.get(widths_m.len() / 2).copied().unwrap_or(0.0),
        });
    }
    lines
}

fn name(of: &Estimator) -> (&'static str, Option<&'static str>) {
    match of {
        Estimator::Tube(_) => ("tube", None),
        Estimator::Ekf(ekf) => match ekf.fusion {
            Fusion::Independent => ("ekf", Some("independent")),
            Fusion::CovarianceIntersection => ("ekf", Some("covariance-intersection")),
        },
        Estimator::DeadReckoning => ("dead-reckoning", None),
    }
}

fn middle(of: &BoundsBox) -> Vec3 {
    Vec3::from(of.map(|side| side.mid()))
}

/// Zero of nothing.
fn ratio(sum: f64, count: u64) -> f64 {
    if count == 0 { 0.0 } else { finite(sum / count as f64) }
}

/// Summaries are JSON, which has no infinity: what has no bound is the largest number there is.
fn finite(of: f64) -> f64 {
    if of.is_finite() { of } else { f64::MAX }
}

/// The normalized estimation error squared, `e' P^-1 e` with `e` the truth less the mean: for an honest Gaussian it is distributed as
/// chi-square, here with four degrees of freedom, so 4 in the mean (Bar-Shalom, Li and Kirubarajan, Estimation with
/// Applications to Tracking and Navigation, 2001, equation 5.4.2-3). None when the covariance has no inverse.
///
/// By Cholesky, `P = L L'`, it is the square of the solution of `L y = e`.
pub fn normalized_error_squared(gaussian: &Gaussian, truth: &[f64; 4]) -> Option<f64> {
    let mut upper = gaussian.covariance.iter();
    let mut lower = [[0.0; 4]; 4];
    for (row, column) in (0..4).flat_map(|row| (row..4).map(move |column| (row, column))) {
        lower[column][row] = *upper.next()?;
    }
    let mut solved = [0.0; 4];
    let mut squares = 0.0;
    for column in 0..4 {
        for row in column..4 {
            let known: f64 = (0..column).map(|k| lower[row][k] * lower[column][k]).sum();
            let rest = lower[row][column] - known;
            if row > column {
                lower[row][column] = rest / lower[column][column];
            } else if rest > 0.0 {
                lower[row][column] = rest.sqrt();
            } else {
                return None;
            }
        }
        let known: f64 = (0..column).map(|k| lower[column][k] * solved[k]).sum();
        solved[column] = (truth[column] - gaussian.mean[column] - known) / lower[column][column];
        squares += solved[column] * solved[column];
    }
    squares.is_finite().then_some(squares)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// P = L L' with L = [2 . . .; 1 3 . .; 0 1 1 .; 4 0 2 5], so `e = L y` has the square |y|².
    const COVARIANCE: [f64; 10] = [4.0, 2.0, 0.0, 8.0, 10.0, 3.0, 4.0, 2.0, 2.0, 45.0];

    #[test]
    fn the_error_is_measured_in_standard_deviations_of_its_direction() {
        let gaussian = Gaussian { mean: [1.0, 1.0, 1.0, 1.0], covariance: COVARIANCE };
        // L (1, 2, -1, 0.5) = (2, 7, 1, 4.5).
        let squared = normalized_error_squared(&gaussian, &[3.0, 8.0, 2.0, 5.5]).unwrap();
        assert!((squared - 6.25).abs() < 1e-12, "{squared}");
        assert_eq!(normalized_error_squared(&gaussian, &[1.0; 4]), Some(0.0));
        let flat = Gaussian { covariance: [1.0; 10], ..gaussian };
        assert_eq!(normalized_error_squared(&flat, &[1.0; 4]), None);
    }
}
