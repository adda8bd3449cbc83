//! How good an estimate is.

use std::fmt::Write;

use serde::Serialize;
use shoal_auv::beacons::Track;

use super::files::{Dataset, ReferencePose};
use crate::summary_text::grouped;

/// What one estimator achieved; as JSON, `shoal.localize/1`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// `shoal.localize/1`.
    pub format: &'static str,
    /// Who estimated.
    pub estimator: &'static str,
    /// How many poses there are.
    pub poses: usize,
    /// Part of the poses at which the reference is inside the enclosure.
    pub contained_fraction: Option<f64>,
    /// The longer side of the enclosures, in the median.
    pub width_median_m: f64,
    /// And at most.
    pub width_max_m: f64,
    /// Root of the mean square distance between centre and reference.
    pub centre_rms_m: Option<f64>,
    /// The greatest such distance.
    pub centre_max_m: Option<f64>,
    /// How many ranges the estimate rests on.
    pub ranges_used: usize,
    /// How many it took for outliers.
    pub ranges_rejected: usize,
    /// How often the assumptions contradicted each other, and the search began anew.
    pub emptied: usize,
    /// Without looking back from the end; only beside an estimate that does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub online: Option<Box<Report>>,
}

impl Report {
    /// Compares a track with the reference, if there is one.
    pub fn new(estimator: &'static str, track: &Track, uses_ranges: bool, dataset: &Dataset) -> Self {
        let mut widths_m: Vec<f64> = track.poses.iter().map(|pose| pose.position_m.width()).collect();
        widths_m.sort_unstable_by(f64::total_cmp);
        let poses = track.poses.len();
        let reference = dataset.reference.as_deref();
        let errors_m = reference.map(|reference| errors_m(track, reference));
        let part = |count: usize| count as f64 / poses as f64;
        let ranges = if uses_ranges { dataset.mission.ranges().len() } else { 0 };
        Self {
            format: "shoal.localize/1",
            estimator,
            poses,
            contained_fraction: reference
                .map(|reference| part((0..poses).filter(|&pose| is_inside(track, reference, pose)).count())),
            // There is at least one pose.
            width_median_m: widths_m[poses / 2],
            width_max_m: widths_m[poses - 1],
            centre_rms_m: errors_m.as_deref().map(|errors_m| {
                (errors_m.iter().map(|error| error * error).sum::<f64>() / poses as f64).sqrt()
            }),
            centre_max_m: errors_m.map(|errors_m| errors_m.into_iter().fold(0.0, f64::max)),
            ranges_used: ranges - track.rejected.len(),
            ranges_rejected: track.rejected.len(),
            emptied: track.emptied.len(),
            online: None,
        }
    }

    /// A few lines for people; `name` is what to call the estimator.
    pub fn text(&self, name: &str) -> String {
        let mut text = format!("{name}\n");
        // Writing to a string does not fail.
        if let Some(contained) = self.contained_fraction {
            let _ = writeln!(
                text,
                "  containment  {:.2} % of {} poses",
                100.0 * contained,
                grouped(self.poses as u64)
            );
        }
        let _ = writeln!(
            text,
            "  width        {:.2} m in the median, {:.2} m at most",
            self.width_median_m, self.width_max_m
        );
        if let (Some(rms_m), Some(max_m)) = (self.centre_rms_m, self.centre_max_m) {
            let _ = writeln!(text, "  error        {rms_m:.2} m root mean square, {max_m:.2} m at most");
        }
        let _ = writeln!(
            text,
            "  ranges       {} used, {} rejected",
            grouped(self.ranges_used as u64),
            grouped(self.ranges_rejected as u64)
        );
        if self.emptied > 0 {
            let _ = writeln!(text, "  emptied      {} times: the bounds contradict each other", self.emptied);
        }
        text
    }
}

/// Distance between centre and reference at each pose, in metres.
pub fn errors_m(track: &Track, reference: &[ReferencePose]) -> Vec<f64> {
    track
        .poses
        .iter()
        .zip(reference)
        .map(|(pose, reference)| (pose.centre_m - reference.position_m).norm())
        .collect()
}

fn is_inside(track: &Track, reference: &[ReferencePose], pose: usize) -> bool {
    track.poses[pose].position_m.contains(&reference[pose].position_m)
}
