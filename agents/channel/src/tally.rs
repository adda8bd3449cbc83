//! Keeps count: what happened in the window, and what the whole run amounts to.

use std::collections::BTreeSet;

use shoal_bus::chronicle::{Entry, Violation, What};
use shoal_bus::message::{AuvId, Report, box_width};
use shoal_bus::summary::{
    Agents, Containment, Flock, Kidnapped, LostAgent, Misled, Pings, SUMMARY_FORMAT, Summary, ViolationLine,
    Widths,
};
use shoal_bus::time::SimTime;
use shoal_bus::traffic::{Fate, LossReason, Traffic};
use shoal_scenario::model::Scenario;

use crate::accuracy::{self, Accuracy};
use crate::assumption::assumptions;
use crate::body::Vec3;

/// So many violations are told one by one in a summary.
const VIOLATIONS_TOLD: usize = 10;

/// Counts of one run.
pub struct Tally {
    /// What happened since it was last taken, in no particular order.
    pub window: Vec<Entry>,
    wakes: u64,
    checks: u64,
    violations: u64,
    misled: Apart,
    kidnapped: Apart,
    noticed_after_ns: Vec<i64>,
    heard: Vec<u64>,
    first_violations: Vec<(SimTime, AuvId, Violation)>,
    widths: Vec<Option<ReportWidths>>,
    accuracy: Vec<Accuracy>,
    pings: Pings,
    lost: Vec<LostAgent>,
    restarted: Vec<LostAgent>,
}

/// Why a violation is counted apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Excuse {
    /// The AUV was told more that is false than it was to expect.
    Misled,
    /// The AUV was carried elsewhere and has not noticed yet.
    Kidnapped,
}

/// Violations that are counted apart.
#[derive(Default)]
struct Apart {
    auvs: BTreeSet<AuvId>,
    violations: u64,
}

impl Apart {
    fn add(&mut self, auv: AuvId) {
        self.auvs.insert(auv);
        self.violations += 1;
    }
}

/// First and last widths that an AUV reported.
#[derive(Clone, Copy)]
struct ReportWidths {
    first: [f64; 2],
    last: [f64; 2],
}

impl Tally {
    /// Nothing counted yet, for so many AUVs.
    pub fn new(auvs: usize) -> Self {
        Self {
            window: Vec::new(),
            wakes: 0,
            checks: 0,
            violations: 0,
            misled: Apart::default(),
            kidnapped: Apart::default(),
            noticed_after_ns: Vec::new(),
            heard: vec![0; auvs],
            first_violations: Vec::new(),
            widths: vec![None; auvs],
            accuracy: vec![Accuracy::default(); auvs],
            pings: Pings::default(),
            lost: Vec::new(),
            restarted: Vec::new(),
        }
    }

    /// Something happened.
    pub fn happened(&mut self, at: SimTime, auv: AuvId, what: What) {
        self.wakes += u64::from(matches!(what, What::Acted(_)));
        self.window.push(Entry { at, auv, what });
    }

    /// A ping met its fate; `auv` is whose entry it is.
    pub fn traffic(&mut self, auv: AuvId, traffic: Traffic) {
        match traffic.fate {
            Fate::Emitted { beyond_range, .. } => {
                self.pings.emitted += 1;
                self.pings.lost.range += u64::from(beyond_range);
            }
            Fate::Heard { outlier, .. } => {
                self.pings.heard += 1;
                self.heard[auv.0 as usize] += 1;
                self.pings.outliers += u64::from(outlier);
            }
            Fate::Lost { to: None, reason: LossReason::HalfDuplex, .. } => self.pings.lost.unsent += 1,
            Fate::Lost { reason, .. } => {
                let lost = &mut self.pings.lost;
                *match reason {
                    LossReason::Range => &mut lost.range,
                    LossReason::Noise => &mut lost.noise,
                    LossReason::Collision => &mut lost.collision,
                    LossReason::HalfDuplex => &mut lost.half_duplex,
                    LossReason::Shadow => &mut lost.shadow,
                    LossReason::Asleep => &mut lost.asleep,
                    LossReason::Band => &mut lost.band,
                    LossReason::Busy => &mut lost.busy,
                    LossReason::Late => &mut lost.late,
                    LossReason::Dead => &mut lost.dead,
                } += 1;
            }
        }
        self.happened(traffic.at, auv, What::Traffic(traffic));
    }

    /// An enclosure was checked; a violation with an excuse is counted apart.
    pub fn check(&mut self, auv: AuvId, at: SimTime, violation: Option<Violation>, excuse: Option<Excuse>) {
        self.checks += 1;
        let Some(violation) = violation else { return };
        match excuse {
            Some(Excuse::Misled) => return self.misled.add(auv),
            Some(Excuse::Kidnapped) => return self.kidnapped.add(auv),
            None => {}
        }
        self.violations += 1;
        self.first_violations.push((at, auv, violation));
        self.first_violations.sort_by_key(|&(at, auv, _)| (at, auv));
        self.first_violations.truncate(VIOLATIONS_TOLD);
        self.happened(at, auv, What::Violation(violation));
    }

    /// A kidnapped AUV noticed it, so many nanoseconds later.
    pub fn noticed(&mut self, after_ns: i64) {
        self.noticed_after_ns.push(after_ns);
    }

    /// An AUV reported what it believes; the truth at its tick is `position_m` and, true minus local time, `offset_s`.
    pub fn reported(&mut self, auv: AuvId, report: &Report, position_m: &Vec3, offset_s: f64) {
        self.accuracy[auv.0 as usize].reported(report, position_m, offset_s);
        // An unbounded report counts as the widest number there is: summaries are JSON, which has no infinity.
        let widths = [box_width(&report.position_m), report.clock_offset_s.width()];
        let now = widths.map(|width| if width.is_finite() { width } else { f64::MAX });
        let slot = &mut self.widths[auv.0 as usize];
        slot.get_or_insert(ReportWidths { first: now, last: now }).last = now;
    }

    /// An AUV is gone.
    pub fn lost(&mut self, at: SimTime, auv: AuvId, name: &str, reason: &str) {
        let (name, reason) = (name.to_owned(), reason.to_owned());
        self.lost.push(LostAgent { auv: auv.0, name, time_s: at.as_s(), reason: reason.clone() });
        self.lost.sort_by_key(|lost| lost.auv);
        self.happened(at, auv, What::Ended(reason));
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
        windows: &[(u64, u64)],
    ) -> Summary {
        let widths = |which: usize| {
            let pick = |of: fn(&ReportWidths) -> [f64; 2]| -> Vec<f64> {
                self.widths.iter().flatten().map(|widths| of(widths)[which]).collect()
            };
            let (first, last) = (pick(|widths| widths.first), pick(|widths| widths.last));
            let end_max = last.iter().fold(0.0_f64, |a, &b| a.max(b));
            Widths { start_median: median(first), end_median: median(last), end_max }
        };
        Summary {
            format: SUMMARY_FORMAT.to_owned(),
            scenario: scenario.name.clone(),
            seed: scenario.seed,
            bus: None,
            reproducible: self.lost.is_empty() && now.ns() >= scenario.duration_ns,
            auvs: self.widths.len() as u32,
            processes: None,
            sim_s: now.as_s(),
            wall_s: None,
            startup_s: None,
            real_time_factor: None,
            wakes: self.wakes,
            digest,
            containment: self.containment(scenario, windows),
            estimators: accuracy::lines(scenario, &self.accuracy),
            position_width_m: widths(0),
            clock_width_s: widths(1),
            pings: Pings { in_flight, ..self.pings },
            flock,
            agents: Agents { lost: self.lost.clone(), restarted: self.restarted.clone() },
            memory: None,
            timings: None,
            free_run: None,
        }
    }

    fn containment(&self, scenario: &Scenario, windows: &[(u64, u64)]) -> Containment {
        let line = |&(at, auv, violation): &(SimTime, AuvId, Violation)| ViolationLine {
            auv: auv.0,
            name: name_of(scenario, auv),
            time_s: at.as_s(),
            enclosure: violation.enclosure.name().to_owned(),
            coordinate: violation.coordinate.name().to_owned(),
            margin: violation.margin.is_finite().then_some(violation.margin),
            unit: violation.coordinate.unit().to_owned(),
        };
        let first = self.first_violations.iter().map(line).collect();
        let Apart { auvs, violations } = &self.misled;
        let misled = Misled { auvs: auvs.len() as u32, violations: *violations };
        let kidnapped = (!scenario.faults.is_empty()).then(|| Kidnapped {
            kidnappings: scenario.faults.len() as u32,
            noticed: self.noticed_after_ns.len() as u32,
            noticed_after_s: self.noticed_after_ns.iter().max().map(|&after_ns| after_ns as f64 * 1e-9),
            violations: self.kidnapped.violations,
        });
        let (checks, violations) = (self.checks, self.violations);
        let assumptions = assumptions(scenario, &self.heard, windows, &self.accuracy);
        Containment { checks, violations, first, misled, kidnapped, assumptions }
    }
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
