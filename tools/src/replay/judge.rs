//! Recorded and replayed answers, compared tick by tick.

use std::collections::{BTreeMap, VecDeque};

use serde::Serialize;
use serde_json::Value;
use shoal_bus::message::{AuvId, Born, Estimator};
use shoal_bus::record::rows::{Pair, Real, ReportRow, TruthRow};
use shoal_bus::time::{LocalTime, NS_PER_S, SimTime};

use super::tape::Telling;
use crate::record::compare::differences;
use crate::record::diff::plain;

/// So many first divergences are told while they happen.
const TOLD_MAX: usize = 20;

/// An answer whose counterpart does not come within so many ticks has none.
const WAITING_MAX: usize = 1_000;

/// Where an AUV began to answer otherwise.
#[derive(Clone, Debug, Serialize)]
pub struct First {
    pub t_s: f64,
    pub tick: u64,
    pub field: String,
    pub recorded: Value,
    pub replayed: Value,
}

/// Widths of one kind of enclosure, recorded and replayed, over the same ticks.
#[derive(Clone, Copy, Debug, Default)]
pub struct Widths {
    recorded: f64,
    replayed: f64,
    /// Ticks at which both are finite.
    pub ticks: u64,
    pub wider: u64,
    pub narrower: u64,
}

impl Widths {
    fn take(&mut self, recorded: f64, replayed: f64) {
        if recorded.is_finite() && replayed.is_finite() {
            self.recorded += recorded;
            self.replayed += replayed;
            self.ticks += 1;
            self.wider += u64::from(replayed > recorded);
            self.narrower += u64::from(replayed < recorded);
        }
    }

    pub fn add(&mut self, other: &Self) {
        self.recorded += other.recorded;
        self.replayed += other.replayed;
        self.ticks += other.ticks;
        self.wider += other.wider;
        self.narrower += other.narrower;
    }

    /// Mean widths, recorded and replayed.
    pub fn means(&self) -> Option<[f64; 2]> {
        (self.ticks > 0).then(|| [self.recorded, self.replayed].map(|sum| sum / self.ticks as f64))
    }
}

/// What was found of one AUV.
#[derive(Clone, Debug, Default)]
pub struct Found {
    pub answers: u64,
    pub differing: u64,
    pub first: Option<First>,
    pub position: Widths,
    pub clock: Widths,
    /// Ticks whose truth is recorded, and at how many of them the recorded and the replayed enclosure held it.
    pub checks: u64,
    pub held: [u64; 2],
    /// Ticks at which the recorded enclosure held the truth and the replayed one did not.
    pub lost: u64,
    /// Ticks at which the replayed one was empty.
    pub emptied: [u64; 2],
    pub promises: bool,
}

/// Compares.
pub struct Judge {
    from: SimTime,
    quiet: bool,
    names: Vec<String>,
    pub auvs: BTreeMap<AuvId, Found>,
    /// Widths of all, by simulated second.
    pub seconds: BTreeMap<i64, [Widths; 2]>,
    /// Replayed answers whose counterparts have not come yet, by AUV.
    waiting: BTreeMap<AuvId, VecDeque<ReportRow>>,
    told: usize,
    /// The last time compared.
    pub until: Option<SimTime>,
}

impl Judge {
    pub fn new(born: &[Born], names: &[String], from: Option<SimTime>, quiet: bool) -> Self {
        let found = |born: &Born| {
            // A Kalman filter states what is likely, and promises nothing.
            let promises = !matches!(born.orders.estimator, Estimator::Ekf(_));
            (born.auv, Found { promises, ..Found::default() })
        };
        Self {
            from: from.unwrap_or(SimTime::from_ns(i64::MIN)),
            quiet,
            names: names.to_vec(),
            auvs: born.iter().map(found).collect(),
            seconds: BTreeMap::new(),
            waiting: BTreeMap::new(),
            told: 0,
            until: None,
        }
    }

    /// Takes what was answered then and now in one batch.
    pub fn take(&mut self, telling: &Telling, replayed: Vec<(AuvId, Vec<ReportRow>)>) {
        for (auv, rows) in replayed {
            let waiting = self.waiting.entry(auv).or_default();
            waiting.extend(rows);
            while waiting.len() > WAITING_MAX {
                waiting.pop_front();
            }
        }
        let truth: BTreeMap<(AuvId, u64), &TruthRow> =
            telling.truth.iter().map(|row| ((row.auv, row.tick), row)).collect();
        for recorded in &telling.reports {
            let waiting = self.waiting.entry(recorded.auv).or_default();
            while waiting.front().is_some_and(|row| row.tick < recorded.tick) {
                waiting.pop_front();
            }
            if waiting.front().is_none_or(|row| row.tick != recorded.tick) {
                continue;
            }
            let Some(mut replayed) = waiting.pop_front() else { continue };
            // In a free run an answer may stand in a later batch than its tick, and without its local time.
            (replayed.t_ns, replayed.local_ns) = (recorded.t_ns, recorded.local_ns);
            if recorded.t_ns >= self.from {
                let truth = truth.get(&(recorded.auv, recorded.tick)).copied();
                self.compare(recorded, &replayed, truth);
            }
        }
    }

    fn compare(&mut self, recorded: &ReportRow, replayed: &ReportRow, truth: Option<&TruthRow>) {
        let Some(found) = self.auvs.get_mut(&recorded.auv) else { return };
        self.until = self.until.max(Some(recorded.t_ns));
        found.answers += 1;
        // What is not finite equals nothing, itself included, unless it is put into JSON.
        let differs = recorded != replayed && {
            let [one, other] = [recorded, replayed].map(|row| serde_json::to_value(row).unwrap_or_default());
            let first = differences(&one, &other, 1).into_iter().next();
            if let (None, Some(first)) = (&found.first, &first) {
                found.first = Some(First {
                    t_s: recorded.t_ns.as_s(),
                    tick: recorded.tick,
                    field: first.field.clone(),
                    recorded: first.a.clone(),
                    replayed: first.b.clone(),
                });
                self.told += 1;
                if !self.quiet && self.told <= TOLD_MAX {
                    let name = self.names.get(recorded.auv.0 as usize).map_or("-", String::as_str);
                    eprintln!(
                        "{:10.3} s  AUV {} ({name}) answers otherwise: {} {}, recorded {}",
                        recorded.t_ns.as_s(),
                        recorded.auv,
                        first.field,
                        plain(&first.b),
                        plain(&first.a)
                    );
                }
            }
            first.is_some()
        };
        found.differing += u64::from(differs);
        let second = self.seconds.entry(recorded.t_ns.ns().div_euclid(NS_PER_S)).or_default();
        let widths = [
            [width(&recorded.position_m), width(&replayed.position_m)],
            [width(&[recorded.clock_offset_s]), width(&[replayed.clock_offset_s])],
        ];
        for ([recorded, replayed], (of_auv, of_all)) in
            widths.into_iter().zip([&mut found.position, &mut found.clock].into_iter().zip(second))
        {
            of_auv.take(recorded, replayed);
            of_all.take(recorded, replayed);
        }
        found.emptied[0] += u64::from(recorded.emptied.is_some());
        found.emptied[1] += u64::from(replayed.emptied.is_some());
        if let Some(truth) = truth {
            let held = [recorded, replayed].map(|row| holds(row, truth));
            found.checks += 1;
            found.held[0] += u64::from(held[0]);
            found.held[1] += u64::from(held[1]);
            found.lost += u64::from(held[0] && !held[1]);
        }
    }

    /// How things are, in a few words.
    pub fn in_short(&self) -> String {
        let diverged = self.auvs.values().filter(|found| found.first.is_some()).count();
        let mut all = Widths::default();
        if let Some((_, [position, _])) = self.seconds.last_key_value() {
            all.add(position);
        }
        let widths = all.means().map_or_else(String::new, |[recorded, replayed]| {
            format!(", boxes {replayed:.3} m wide, recorded {recorded:.3} m")
        });
        format!("{diverged} of {} AUVs answer otherwise{widths}", self.auvs.len())
    }
}

/// The width of a box is that of its widest side.
fn width(sides: &[Pair]) -> f64 {
    let side = |[lower, upper]: &Pair| {
        if lower.0.is_finite() && upper.0.is_finite() { upper.0 - lower.0 } else { f64::INFINITY }
    };
    sides.iter().map(side).fold(0.0, f64::max)
}

/// Whether position box and clock interval hold the truth at the tick.
fn holds(row: &ReportRow, truth: &TruthRow) -> bool {
    // What is not finite in a record is `null`, and not bounded.
    let within = |[lower, upper]: Pair, value: f64| {
        (lower.0.is_nan() || lower.0 <= value) && (upper.0.is_nan() || value <= upper.0)
    };
    let offset_s = offset_s(truth.t_ns, truth.local_ns);
    let axes = row.position_m.iter().zip(truth.position_m);
    axes.into_iter().all(|(side, Real(value))| within(*side, value)) && within(row.clock_offset_s, offset_s)
}

fn offset_s(at: SimTime, local: LocalTime) -> f64 {
    (at.ns() - local.ns()) as f64 * 1e-9
}

#[cfg(test)]
mod tests {
    use shoal_bus::message::{Acted, Bounds, Report, Setpoint, Slice};

    use super::*;

    const NS: i64 = 1_000_000_000;

    /// A report at whole seconds of a box around the origin, so wide.
    fn row(tick: u64, width: f64) -> ReportRow {
        let side = Bounds::new(-0.5 * width, 0.5 * width);
        let (position_m, clock_offset_s) = ([side; 3], Bounds::new(-1e-3, 1e-3));
        let report = Report {
            position_m,
            clock_offset_s,
            slice: Slice { position_m, clock_offset_s },
            emptied: None,
            neighbours: 0,
            contractions: 0,
            rejected: 0,
            around: Vec::new(),
            components: 1,
            gaussian: None,
        };
        let acted = Acted { tick, setpoint: Setpoint::default(), pings: Vec::new(), report };
        let at = tick as i64 * NS;
        ReportRow::new(SimTime::from_ns(at), AuvId(0), Some(LocalTime::from_ns(at)), &acted)
    }

    fn truth(tick: u64) -> TruthRow {
        let at = tick as i64 * NS;
        TruthRow {
            auv: AuvId(0),
            tick,
            t_ns: SimTime::from_ns(at),
            local_ns: LocalTime::from_ns(at),
            position_m: [Real(1.0); 3],
            velocity_m_s: [Real(0.0); 3],
            heading_rad: Real(0.0),
            pitch_rad: Real(0.0),
        }
    }

    fn judge() -> Judge {
        let mut judge = Judge::new(&[], &[], None, true);
        judge.auvs.insert(AuvId(0), Found { promises: true, ..Found::default() });
        judge
    }

    fn batch(reports: Vec<ReportRow>) -> Telling {
        let truth = reports.iter().map(|row| truth(row.tick)).collect();
        let mut telling = Telling::default();
        (telling.reports, telling.truth) = (reports, truth);
        telling
    }

    #[test]
    fn what_differs_is_counted_and_the_first_is_named() {
        let mut judge = judge();
        let recorded = vec![row(1, 4.0), row(2, 4.0), row(3, f64::INFINITY), row(4, 4.0)];
        let replayed = vec![row(1, 4.0), row(2, 5.0), row(3, f64::INFINITY), row(4, 1.0)];
        judge.take(&batch(recorded), vec![(AuvId(0), replayed)]);
        let found = &judge.auvs[&AuvId(0)];
        assert_eq!((found.answers, found.differing), (4, 2));
        let first = found.first.as_ref().unwrap();
        assert_eq!((first.t_s, first.tick, first.field.as_str()), (2.0, 2, "position_m[0][0]"));
        assert_eq!((found.position.ticks, found.position.wider, found.position.narrower), (3, 1, 1));
        assert_eq!(found.position.means().map(|means| means.map(|mean| mean * 3.0)), Some([12.0, 10.0]));
        // The truth is a metre off on each axis: a box of one metre has lost it, an unbounded one holds everything.
        assert_eq!((found.checks, found.held, found.lost), (4, [4, 3], 1));
    }

    #[test]
    fn an_answer_waits_for_its_counterpart() {
        let mut judge = judge();
        judge.take(&batch(Vec::new()), vec![(AuvId(0), vec![row(1, 4.0), row(2, 4.0), row(3, 4.0)])]);
        assert_eq!(judge.auvs[&AuvId(0)].answers, 0);
        // The second was never answered in the run.
        judge.take(&batch(vec![row(1, 4.0), row(3, 4.0)]), Vec::new());
        assert_eq!((judge.auvs[&AuvId(0)].answers, judge.auvs[&AuvId(0)].differing), (2, 0));
    }
}
