//! Keeps count: what the whole run amounts to.

mod counts;

use shoal_bus::chronicle::{Violation, What};
use shoal_bus::message::{AuvId, Report, box_width};
use shoal_bus::summary::{
    Agents, Containment, Flock, Kidnapped, LostAgent, Misled, Pings, SUMMARY_FORMAT, Summary, ViolationLine,
    Widths,
};
use shoal_bus::time::SimTime;
use shoal_scenario::model::{Controller, Scenario};

use crate::accuracy::{self, Accuracy};
use crate::assumption::assumptions;
use crate::body::Vec3;

pub use self::counts::{Counts, Excuse};

/// Counts of one run.
pub struct Tally {
    /// What all of the swarm comes to.
    pub counts: Counts,
    /// One for each AUV.
    pub scores: Vec<Score>,
    lost: Vec<LostAgent>,
    restarted: Vec<LostAgent>,
}

/// What one AUV was told of pings.
pub struct ToldPings {
    /// Pings that arrived and were decoded.
    pub heard: u64,
    /// Windows of pings that it was told, and how many of them kept to what it assumes.
    pub windows: (u64, u64),
}

/// What the reports of one AUV come to.
#[derive(Clone, Copy, Default)]
pub struct Score {
    widths: Option<ReportWidths>,
    accuracy: Accuracy,
    /// Where it is to stay, if it is.
    station_m: Option<Vec3>,
    /// How far from it it was at its first and last tick.
    off_station_m: Option<[f64; 2]>,
}

/// First and last widths that an AUV reported.
#[derive(Clone, Copy)]
struct ReportWidths {
    first: [f64; 2],
    last: [f64; 2],
}

impl Score {
    /// The AUV reported what it believes; the truth at its tick is `position_m` and, true minus local time, `offset_s`.
    pub fn reported(&mut self, report: &Report, position_m: &Vec3, offset_s: f64) {
        self.accuracy.reported(report, position_m, offset_s);
        if let Some(station_m) = &self.station_m {
            let now_m = (position_m - station_m).norm();
            self.off_station_m.get_or_insert([now_m; 2])[1] = now_m;
        }
        // An unbounded report counts as the widest number there is: summaries are JSON, which has no infinity.
        let widths = [box_width(&report.position_m), report.clock_offset_s.width()];
        let now = widths.map(|width| if width.is_finite() { width } else { f64::MAX });
        self.widths.get_or_insert(ReportWidths { first: now, last: now }).last = now;
    }
}

impl Tally {
    /// Nothing counted yet, of the AUVs of this scenario.
    pub fn new(scenario: &Scenario) -> Self {
        let scores = scenario.groups.iter().flat_map(|group| {
            let keeps = matches!(group.controller, Controller::Station { .. });
            let station_m = move |index| group.start.place.point_m(index).filter(|_| keeps).map(Vec3::from);
            (0..group.count).map(move |index| Score { station_m: station_m(index), ..Score::default() })
        });
        Self { counts: Counts::default(), scores: scores.collect(), lost: Vec::new(), restarted: Vec::new() }
    }

    /// An AUV is gone.
    pub fn lost(&mut self, at: SimTime, auv: AuvId, name: &str, reason: &str) {
        let (name, reason) = (name.to_owned(), reason.to_owned());
        self.lost.push(LostAgent { auv: auv.0, name, time_s: at.as_s(), reason: reason.clone() });
        self.lost.sort_by_key(|lost| lost.auv);
        self.counts.happened(at, auv, What::Ended(reason));
    }

    /// An AUV that was lost is born again.
    pub fn restarted(&mut self, at: SimTime, auv: AuvId) {
        let last = self.lost.iter().rfind(|lost| lost.auv == auv.0);
        self.restarted.extend(last.map(|lost| LostAgent { time_s: at.as_s(), ..lost.clone() }));
        self.restarted.sort_by_key(|restarted| restarted.auv);
    }

    /// What the run amounts to at `now`.
    pub fn summary(
        &self,
        scenario: &Scenario,
        now: SimTime,
        digest: String,
        flock: Flock,
        in_flight: u64,
        told: &[ToldPings],
    ) -> Summary {
        let widths = |which: usize| {
            let pick = |of: fn(&ReportWidths) -> [f64; 2]| -> Vec<f64> {
                self.scores.iter().filter_map(|score| score.widths).map(|widths| of(&widths)[which]).collect()
            };
            over(pick(|widths| widths.first), pick(|widths| widths.last))
        };
        let off_m: Vec<[f64; 2]> = self.scores.iter().filter_map(|score| score.off_station_m).collect();
        let off = |which: usize| off_m.iter().map(|off_m| off_m[which]).collect();
        Summary {
            format: SUMMARY_FORMAT.to_owned(),
            scenario: scenario.name.clone(),
            seed: scenario.seed,
            bus: None,
            reproducible: self.lost.is_empty() && now.ns() >= scenario.duration_ns,
            auvs: self.scores.len() as u32,
            processes: None,
            sim_s: now.as_s(),
            wall_s: None,
            startup_s: None,
            real_time_factor: None,
            wakes: self.counts.wakes,
            digest,
            containment: self.containment(scenario, told),
            estimators: accuracy::lines(scenario, &self.accuracy()),
            position_width_m: widths(0),
            clock_width_s: widths(1),
            off_station_m: (!off_m.is_empty()).then(|| over(off(0), off(1))),
            pings: Pings { in_flight, ..self.counts.pings },
            flock,
            agents: Agents { lost: self.lost.clone(), restarted: self.restarted.clone() },
            memory: None,
            timings: None,
            free_run: None,
        }
    }

    fn containment(&self, scenario: &Scenario, told: &[ToldPings]) -> Containment {
        let counts = &self.counts;
        let line = |&(at, auv, violation): &(SimTime, AuvId, Violation)| ViolationLine {
            auv: auv.0,
            name: name_of(scenario, auv),
            time_s: at.as_s(),
            enclosure: violation.enclosure.name().to_owned(),
            coordinate: violation.coordinate.name().to_owned(),
            margin: violation.margin.is_finite().then_some(violation.margin),
            unit: violation.coordinate.unit().to_owned(),
        };
        let first = counts.first_violations.iter().map(line).collect();
        let counts::Apart { auvs, violations } = &counts.misled;
        let misled = Misled { auvs: auvs.len() as u32, violations: *violations };
        let kidnapped = (!scenario.faults.is_empty()).then(|| Kidnapped {
            kidnappings: scenario.faults.len() as u32,
            noticed: counts.noticed_after_ns.len() as u32,
            noticed_after_s: counts.noticed_after_ns.iter().max().map(|&after_ns| after_ns as f64 * 1e-9),
            violations: counts.kidnapped.violations,
        });
        let (checks, violations) = (counts.checks, counts.violations);
        let heard: Vec<u64> = told.iter().map(|told| told.heard).collect();
        let windows: Vec<(u64, u64)> = told.iter().map(|told| told.windows).collect();
        let assumptions = assumptions(scenario, &heard, &windows, &self.accuracy());
        Containment { checks, violations, first, misled, kidnapped, assumptions }
    }

    fn accuracy(&self) -> Vec<Accuracy> {
        self.scores.iter().map(|score| score.accuracy).collect()
    }
}

/// First and last of each AUV.
fn over(first: Vec<f64>, last: Vec<f64>) -> Widths {
    let end_max = last.iter().fold(0.0_f64, |a, &b| a.max(b));
    Widths { start_median: median(first), end_median: median(last), end_max }
}

/// `GROUP-k` for the k-th AUV of its group.
fn name_of(scenario: &Scenario, auv: AuvId) -> String {
    let mut index = auv.0;
    for group in &scenario.groups {
        if index < group.count {
            return format!("{}-{index}", group.name);
        }
        index -= group.count;
    }
    format!("auv-{auv}")
}

/// The upper median; zero of nothing.
fn median(mut of: Vec<f64>) -> f64 {
    of.sort_by(f64::total_cmp);
    of.get(of.len() / 2).copied().unwrap_or(0.0)
}
