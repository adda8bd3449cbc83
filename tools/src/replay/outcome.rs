//! What came of a replay.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde::Serialize;
use shoal_bus::lockstep::Loss;

use super::judge::{First, Found, Judge, Widths};
use super::tape::Tape;
use super::{Carrier, ReplayArgs};
use crate::record::diff::plain;
use crate::summary_text::grouped;

/// Format of the line that `--json` prints.
pub const REPLAY_FORMAT: &str = "shoal.replay/1";

/// Up to so many AUVs have a line of their own in the text.
const LINES_MAX: usize = 12;

/// So many spans of time are told of.
const SPANS: i64 = 10;

/// What came of a replay: one line of JSON.
#[derive(Debug, Serialize)]
pub struct Outcome {
    format: &'static str,
    scenario: String,
    seed: u64,
    /// The estimator that took the place of the recorded one.
    #[serde(skip_serializing_if = "Option::is_none")]
    estimator: Option<String>,
    bus: &'static str,
    auvs: usize,
    diverged: bool,
    /// AUVs with an answer that differs.
    auvs_diverged: usize,
    answers: u64,
    differing_answers: u64,
    until_s: Option<f64>,
    position_width_m: Compared,
    clock_width_s: Compared,
    containment: Containment,
    over_time: Vec<Span>,
    each: Vec<Line>,
    lost: Vec<Lost>,
}

/// Mean widths over the same ticks, and at how many of them the replayed enclosure is wider or narrower.
#[derive(Debug, Default, Serialize)]
struct Compared {
    recorded_mean: Option<f64>,
    replayed_mean: Option<f64>,
    wider: u64,
    narrower: u64,
}

impl Compared {
    fn new(of: &Widths) -> Self {
        let means = of.means();
        Self {
            recorded_mean: means.map(|[recorded, _]| recorded),
            replayed_mean: means.map(|[_, replayed]| replayed),
            wider: of.wider,
            narrower: of.narrower,
        }
    }
}

/// How often enclosures held the recorded truth at the ticks.
#[derive(Debug, Default, Serialize)]
struct Containment {
    checks: u64,
    recorded_held: u64,
    replayed_held: u64,
    /// Ticks at which the replayed one lost what the recorded one held.
    newly_lost: u64,
    /// The same of estimators that promise to hold it.
    broken_promises: u64,
}

/// A span of time.
#[derive(Debug, Serialize)]
struct Span {
    from_s: i64,
    to_s: i64,
    position_width_m: Compared,
    clock_width_s: Compared,
}

/// One AUV.
#[derive(Debug, Serialize)]
struct Line {
    auv: u32,
    name: String,
    answers: u64,
    differing: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    first: Option<First>,
    position_width_m: Compared,
    clock_width_s: Compared,
    checks: u64,
    recorded_held: u64,
    replayed_held: u64,
    recorded_emptied: u64,
    replayed_emptied: u64,
}

#[derive(Debug, Serialize)]
struct Lost {
    auv: u32,
    reason: String,
}

impl Outcome {
    pub fn new(args: &ReplayArgs, tape: &Tape, judge: Judge, losses: &[Loss]) -> Self {
        let mut containment = Containment::default();
        let (mut position, mut clock) = (Widths::default(), Widths::default());
        let (mut answers, mut differing_answers) = (0, 0);
        let mut each = Vec::new();
        for (auv, found) in &judge.auvs {
            let Found { checks, held, lost, .. } = *found;
            containment.checks += checks;
            containment.recorded_held += held[0];
            containment.replayed_held += held[1];
            containment.newly_lost += lost;
            containment.broken_promises += if found.promises { lost } else { 0 };
            position.add(&found.position);
            clock.add(&found.clock);
            answers += found.answers;
            differing_answers += found.differing;
            each.push(Line {
                auv: auv.0,
                name: tape.names().get(auv.0 as usize).cloned().unwrap_or_default(),
                answers: found.answers,
                differing: found.differing,
                first: found.first.clone(),
                position_width_m: Compared::new(&found.position),
                clock_width_s: Compared::new(&found.clock),
                checks,
                recorded_held: held[0],
                replayed_held: held[1],
                recorded_emptied: found.emptied[0],
                replayed_emptied: found.emptied[1],
            });
        }
        Self {
            format: REPLAY_FORMAT,
            scenario: tape.says("scenario"),
            seed: tape.says("seed").parse().unwrap_or_default(),
            estimator: args.estimator.clone(),
            bus: match args.bus {
                Carrier::Local => "local",
                Carrier::Iceoryx2 => "iceoryx2",
            },
            auvs: judge.auvs.len(),
            diverged: differing_answers > 0,
            auvs_diverged: each.iter().filter(|line| line.first.is_some()).count(),
            answers,
            differing_answers,
            until_s: judge.until.map(|until| until.as_s()),
            position_width_m: Compared::new(&position),
            clock_width_s: Compared::new(&clock),
            containment,
            over_time: spans(&judge.seconds),
            each,
            lost: losses.iter().map(|loss| Lost { auv: loss.auv.0, reason: loss.reason.clone() }).collect(),
        }
    }

    /// Whether any answer differs.
    pub fn diverged(&self) -> bool {
        self.diverged
    }

    /// Whether an estimator that promises to hold the truth lost it where the recorded one held it.
    pub fn broke_promises(&self) -> bool {
        self.containment.broken_promises > 0
    }

    /// The tables for people.
    pub fn text(&self) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _infallible = self.write(&mut text);
        text
    }

    fn write(&self, text: &mut String) -> std::fmt::Result {
        let with = self.estimator.as_ref().map_or_else(String::new, |estimator| format!(" with {estimator}"));
        let until = self.until_s.map_or_else(String::new, |until_s| format!(" up to {until_s:.3} s"));
        writeln!(
            text,
            "{}, seed {}, replayed on {}{with}: {} AUVs, {} answers{until}",
            self.scenario,
            self.seed,
            self.bus,
            self.auvs,
            grouped(self.answers)
        )?;
        if !self.diverged {
            writeln!(text, "every answer is the recorded one")?;
            return self.write_losses(text);
        }
        writeln!(
            text,
            "{} answers of {} AUVs differ from the recorded ones",
            grouped(self.differing_answers),
            self.auvs_diverged
        )?;
        let mut diverged: Vec<&Line> = self.each.iter().filter(|line| line.first.is_some()).collect();
        diverged.sort_by(|one, other| one.begins_s().total_cmp(&other.begins_s()));
        let names = || diverged.iter().take(LINES_MAX);
        let name_width = names().map(|line| line.name.chars().count()).max().unwrap_or(0).max(4);
        let fields = || names().filter_map(|line| line.first.as_ref());
        let field_width = fields().map(|first| first.field.len()).max().unwrap_or(0);
        writeln!(text, "\nfirst difference of each")?;
        for line in names() {
            let Some(first) = &line.first else { continue };
            writeln!(
                text,
                "{:name_width$}  {:>10.3} s  {:field_width$}  {}, recorded {}",
                line.name,
                first.t_s,
                first.field,
                plain(&first.replayed),
                plain(&first.recorded)
            )?;
        }
        if let Some(more @ 1..) = diverged.len().checked_sub(LINES_MAX) {
            writeln!(text, "and {more} AUVs more: --json tells of all")?;
        }
        writeln!(
            text,
            "\n{:>15}  {:^31}  {:^31}\n{:>15}  {:>10} {:>10} {:>9}  {:>10} {:>10} {:>9}",
            "",
            "position box, mean width (m)",
            "clock interval, mean width (ms)",
            "time (s)",
            "recorded",
            "replayed",
            "change",
            "recorded",
            "replayed",
            "change"
        )?;
        for Span { from_s, to_s, position_width_m, clock_width_s } in &self.over_time {
            write!(text, "{:>15}", format!("{from_s} to {to_s}"))?;
            writeln!(text, "{}{}", position_width_m.columns(1.0), clock_width_s.columns(1e3))?;
        }
        write!(text, "{:>15}", "all")?;
        writeln!(text, "{}{}", self.position_width_m.columns(1.0), self.clock_width_s.columns(1e3))?;
        let Compared { wider, narrower, .. } = &self.position_width_m;
        writeln!(text, "boxes are wider at {} ticks, narrower at {}", grouped(*wider), grouped(*narrower))?;
        let Containment { checks, recorded_held, replayed_held, newly_lost, broken_promises } =
            &self.containment;
        let part = |held: &u64| 100.0 * *held as f64 / (*checks).max(1) as f64;
        writeln!(
            text,
            "holds the truth: replayed {:.4} %, recorded {:.4} % of {} ticks",
            part(replayed_held),
            part(recorded_held),
            grouped(*checks)
        )?;
        if *broken_promises > 0 {
            writeln!(
                text,
                "VIOLATED: the truth was lost at {} ticks where the recorded enclosure held it",
                grouped(*newly_lost)
            )?;
        }
        self.write_losses(text)
    }

    fn write_losses(&self, text: &mut String) -> std::fmt::Result {
        self.lost
            .iter()
            .try_for_each(|Lost { auv, reason }| writeln!(text, "AUV {auv} was lost in the replay: {reason}"))
    }
}

impl Line {
    fn begins_s(&self) -> f64 {
        self.first.as_ref().map_or(f64::INFINITY, |first| first.t_s)
    }
}

impl Compared {
    fn columns(&self, scale: f64) -> String {
        match (self.recorded_mean, self.replayed_mean) {
            (Some(recorded), Some(replayed)) => {
                let change = if recorded > 0.0 {
                    format!("{:+.2} %", 100.0 * (replayed / recorded - 1.0))
                } else {
                    "-".to_owned()
                };
                format!("  {:>10.4} {:>10.4} {change:>9}", recorded * scale, replayed * scale)
            }
            _ => format!("  {:>10} {:>10} {:>9}", "-", "-", "-"),
        }
    }
}

/// The seconds in a few spans of the same length.
fn spans(seconds: &BTreeMap<i64, [Widths; 2]>) -> Vec<Span> {
    let (Some((first, _)), Some((last, _))) = (seconds.first_key_value(), seconds.last_key_value()) else {
        return Vec::new();
    };
    let length = (last - first + SPANS) / SPANS;
    let mut spans: BTreeMap<i64, [Widths; 2]> = BTreeMap::new();
    for (second, [position, clock]) in seconds {
        let [of_position, of_clock] = spans.entry((second - first) / length).or_default();
        of_position.add(position);
        of_clock.add(clock);
    }
    let span = |(index, [position, clock]): (i64, [Widths; 2])| {
        let from_s = first + index * length;
        Span {
            from_s,
            to_s: (from_s + length).min(last + 1),
            position_width_m: Compared::new(&position),
            clock_width_s: Compared::new(&clock),
        }
    };
    spans.into_iter().map(span).collect()
}
