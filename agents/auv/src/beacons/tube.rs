//! The tube of poses: forward, and back and forth to a fixed point.

use shoal_interval::IntervalBox;

use super::course::{Course, OdometryBounds};
use super::window::{Reach, agreed, contradicting};
use super::{Enclosed, Mission, Start, Track};

/// What the tube estimator believes of the measurements, and how hard it works.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TubeSettings {
    /// How wrong odometry may be.
    pub odometry: OdometryBounds,
    /// How wrong a range may be that is no outlier, in metres.
    pub range_m: f64,
    /// So many successive ranges are looked at together, carried to one pose by odometry.
    pub window: usize,
    /// At most so many of them are outliers; otherwise the assumption has failed, and the search begins anew.
    pub outliers: usize,
    /// So many outliers are tolerated beyond the least number that explains a window: some agree with the rest by chance.
    pub margin: usize,
    /// How fine the plane is searched, in metres.
    pub precision_m: f64,
    /// Whether to look back from the end: every pose then profits from all ranges.
    pub smoothed: bool,
}

/// Sweeps back and forth end when one narrows no box by more than this part of its width.
const STOPPING_RATIO: f64 = 0.02;

/// And after so many in any case.
const MOST_SWEEPS: usize = 10;

/// Encloses every pose: odometry carries the enclosure on, and the ranges of a window contract it, all but a few outliers.
///
/// The true position is inside as long as odometry and ranges keep the bounds of the settings, with no more outliers in each window
/// than the least number that explains it plus the margin. Where even [`TubeSettings::outliers`] explain nothing, the pose is listed in
/// [`Track::emptied`], and the enclosure begins anew with what the window allows in the whole [area](Mission::area_m).
///
/// Source: seed 001, sections 2.4.5 and 5.3; seed 004 (robust observer).
pub fn tube(mission: &Mission, start: &Start, settings: &TubeSettings) -> Track {
    let course = Course::new(mission, start, &settings.odometry);
    let mut sweep = Sweep { mission, course: &course, settings, emptied: Vec::new(), boxes_m: Vec::new() };
    sweep.forward(start);
    if settings.smoothed {
        sweep.smooth();
    }
    let Sweep { boxes_m, emptied, .. } = sweep;
    let rejected = boxes_m
        .iter()
        .enumerate()
        .flat_map(|(pose, position_m)| contradicting(*position_m, pose, mission, settings))
        .collect();
    let poses = boxes_m.into_iter().map(|position_m| Enclosed { centre_m: position_m.mid(), position_m });
    Track { poses: poses.collect(), rejected, emptied }
}

struct Sweep<'a> {
    mission: &'a Mission,
    course: &'a Course,
    settings: &'a TubeSettings,
    boxes_m: Vec<IntervalBox<2>>,
    emptied: Vec<usize>,
}

impl Sweep<'_> {
    /// From the first pose to the last, with nothing but what was measured by then.
    fn forward(&mut self, start: &Start) {
        let mut position_m = start.position_m;
        for pose in 0..self.mission.pose_count() {
            if pose > 0 {
                position_m += self.course.step_m(pose - 1);
            }
            position_m = match self.agreed(position_m, pose, Reach::Past) {
                Some(agreed_m) => agreed_m,
                None => {
                    self.emptied.push(pose);
                    let area_m = self.mission.area_m();
                    self.agreed(area_m, pose, Reach::Past).unwrap_or(area_m)
                }
            };
            self.boxes_m.push(position_m);
        }
    }

    /// Backward and forward until nothing moves any more.
    fn smooth(&mut self) {
        let mut searched_m = vec![IntervalBox::ENTIRE; self.boxes_m.len()];
        for _ in 0..MOST_SWEEPS {
            let before = self.boxes_m.clone();
            for (pose, searched_m) in searched_m.iter_mut().enumerate().rev() {
                self.narrow(pose, searched_m);
            }
            for (pose, searched_m) in searched_m.iter_mut().enumerate() {
                self.narrow(pose, searched_m);
            }
            if !before.iter().zip(&self.boxes_m).any(|(old_m, new_m)| is_narrower(new_m, old_m)) {
                break;
            }
        }
    }

    /// Contracts one pose by its neighbours and by the ranges around it. What would leave nothing is not believed.
    /// The ranges have nothing new to say about `searched_m`, what they left the last time.
    fn narrow(&mut self, pose: usize, searched_m: &mut IntervalBox<2>) {
        let mut position_m = self.boxes_m[pose];
        let mut meet = |other_m: Option<IntervalBox<2>>| {
            let both_m = other_m.map_or(position_m, |other_m| position_m & other_m);
            if !both_m.is_empty() {
                position_m = both_m;
            }
        };
        meet(self.boxes_m.get(pose + 1).map(|next_m| *next_m - self.course.step_m(pose)));
        meet(pose.checked_sub(1).map(|last| self.boxes_m[last] + self.course.step_m(last)));
        if is_narrower(&position_m, searched_m) {
            position_m = self.agreed(position_m, pose, Reach::Around).unwrap_or(position_m);
            *searched_m = position_m;
        }
        self.boxes_m[pose] = position_m;
    }

    fn agreed(&self, position_m: IntervalBox<2>, pose: usize, reach: Reach) -> Option<IntervalBox<2>> {
        agreed(position_m, pose, reach, self.mission, self.course, self.settings)
    }
}

/// Whether a box has become narrower than it was by so much that it is worth going on.
fn is_narrower(now_m: &IntervalBox<2>, before_m: &IntervalBox<2>) -> bool {
    (0..2).any(|axis| now_m[axis].width() < (1.0 - STOPPING_RATIO) * before_m[axis].width())
}
