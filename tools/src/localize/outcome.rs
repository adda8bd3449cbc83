//! How well AUVs were localized: widths, containment, and their table.

use std::fmt::Write as _;

use serde::Serialize;
use shoal_auv::state::State;
use shoal_bus::record::rows::{Pair, Real};

use super::recorded::ToldTick;
use crate::summary_text::grouped;

/// Format of the line that `--json` prints.
pub const LOCALIZE_FORMAT: &str = "shoal.localize/1";

/// Up to so many AUVs have a line of their own in the table.
const LINES_MAX: usize = 12;

/// A position box in metres, and true minus local time in seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Enclosure {
    pub position_m: [[f64; 2]; 3],
    pub clock_offset_s: [f64; 2],
}

impl Enclosure {
    /// Of a row of the record.
    pub fn of(position_m: &[Pair; 3], clock_offset_s: &Pair) -> Self {
        let pair = |pair: Pair| pair.map(|Real(bound)| bound);
        Self { position_m: position_m.map(pair), clock_offset_s: pair(*clock_offset_s) }
    }

    /// Of a state at a tick whose stamp may be off by `stamp_s` seconds.
    pub fn at_stamp(state: &State, stamp_s: f64) -> Self {
        let offset_s = state.offset_s.inflate(stamp_s);
        Self {
            position_m: state.position_m.sides().map(|side| [side.lower(), side.upper()]),
            clock_offset_s: [offset_s.lower(), offset_s.upper()],
        }
    }

    fn holds(&self, truth: &ToldTick) -> bool {
        let within = |[lower, upper]: [f64; 2], value: f64| lower <= value && value <= upper;
        let offset_s = (truth.at.ns() - truth.local.ns()) as f64 * 1e-9;
        (0..3).all(|axis| within(self.position_m[axis], truth.position_m[axis]))
            && within(self.clock_offset_s, offset_s)
    }

    fn widths(&self) -> [f64; 2] {
        let width = |[lower, upper]: [f64; 2]| upper - lower;
        [self.position_m.map(width).into_iter().fold(0.0, f64::max), width(self.clock_offset_s)]
    }
}

/// The three ways to know an AUV at a tick.
#[derive(Clone, Copy, Debug)]
pub struct Pose {
    pub truth: ToldTick,
    /// As it would know itself without any ping.
    pub alone: Enclosure,
    pub offline: Enclosure,
}

/// One width, three ways; absent when nothing was recorded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Widths {
    pub none: Option<f64>,
    pub online: Option<f64>,
    pub offline: Option<f64>,
}

/// Widths of an AUV, or of all of a group.
#[derive(Clone, Debug, Serialize)]
pub struct Line {
    pub name: String,
    pub auvs: usize,
    pub poses: usize,
    pub contained: usize,
    /// How many of its poses the AUV's own reports held.
    pub contained_online: usize,
    /// When nothing was left of an AUV's own enclosure for the first time, in seconds of true time: its log, or what it heard, broke the
    /// bounds, and offline does not promise anything of it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub emptied_s: Option<f64>,
    pub position_width_m: MedianAndEnd,
    pub clock_width_s: MedianAndEnd,
}

/// Over all ticks, and at the last tick of each AUV; medians both.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct MedianAndEnd {
    pub median: Widths,
    pub end: Widths,
}

impl Line {
    /// Of these AUVs' poses.
    pub fn of(name: &str, auvs: &[&[Pose]]) -> Self {
        let poses = || auvs.iter().copied().flatten();
        let ends: Vec<&Pose> = auvs.iter().filter_map(|poses| poses.last()).collect();
        let over = |which: usize| MedianAndEnd {
            median: widths(poses(), which),
            end: widths(ends.iter().copied(), which),
        };
        let held = |online: Option<Enclosure>, truth| online.is_some_and(|online| online.holds(truth));
        Self {
            name: name.to_owned(),
            auvs: auvs.len(),
            poses: poses().count(),
            contained: poses()
                .filter(|pose| pose.alone.holds(&pose.truth) && pose.offline.holds(&pose.truth))
                .count(),
            contained_online: poses().filter(|pose| held(pose.truth.online, &pose.truth)).count(),
            emptied_s: poses()
                .filter(|pose| pose.truth.emptied)
                .map(|pose| pose.truth.at.as_s())
                .min_by(f64::total_cmp),
            position_width_m: over(0),
            clock_width_s: over(1),
        }
    }
}

/// Medians of positions' widths (0) or clocks' (1).
fn widths<'a>(poses: impl Iterator<Item = &'a Pose> + Clone, which: usize) -> Widths {
    let of = |enclosure: &dyn Fn(&Pose) -> Option<Enclosure>| {
        median(poses.clone().filter_map(enclosure).map(|enclosure| enclosure.widths()[which]).collect())
    };
    Widths {
        none: of(&|pose| Some(pose.alone)),
        online: of(&|pose| pose.truth.online),
        offline: of(&|pose| Some(pose.offline)),
    }
}

fn median(mut of: Vec<f64>) -> Option<f64> {
    of.sort_by(f64::total_cmp);
    of.get(of.len() / 2).copied()
}

/// What came of it all: one line of JSON.
#[derive(Clone, Debug, Serialize)]
pub struct Outcome {
    pub format: &'static str,
    pub estimator: &'static str,
    pub scenario: String,
    pub seed: u64,
    pub poses: usize,
    /// Part of the poses that box and clock interval hold.
    pub contained_fraction: f64,
    pub width_median_m: Option<f64>,
    /// Root of the mean square of the distance from the boxes' centres to the truth.
    pub centre_rms_m: Option<f64>,
    /// Pings that contracted both ends.
    pub ranges_used: usize,
    /// Pings of which only what they say was known, as their emission is not in the record.
    pub ranges_by_payload: usize,
    /// Pings that left nothing.
    pub ranges_rejected: usize,
    /// Ticks at which an AUV's own log, depth or fix contradicted its bounds.
    pub contradictions: u32,
    pub rounds: u32,
    /// How often all was begun again without rejected pings.
    pub restarts: u32,
    pub threads: usize,
    pub solve_s: f64,
    pub all: Line,
    pub groups: Vec<Line>,
    pub each: Vec<Line>,
}

/// Distance of centres from the truth, in metres; none when there are no bounded poses.
pub fn centre_rms_m(poses: &[Vec<Pose>]) -> Option<f64> {
    let squares = poses.iter().flatten().map(|pose| {
        let off = |axis: usize| {
            let [lower, upper] = pose.offline.position_m[axis];
            0.5 * lower + 0.5 * upper - pose.truth.position_m[axis]
        };
        (0..3).map(|axis| off(axis) * off(axis)).sum::<f64>()
    });
    let count = squares.clone().count();
    let mean = squares.sum::<f64>() / count.max(1) as f64;
    (count > 0 && mean.is_finite()).then(|| mean.sqrt())
}

impl Outcome {
    /// Whether all hold the truth of whom it is promised: not of those who found themselves that something breaks the bounds.
    pub fn keeps_promises(&self) -> bool {
        self.each.iter().all(|line| line.contained == line.poses || line.emptied_s.is_some())
    }

    /// The table for people.
    pub fn text(&self) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{}, seed {}: {} AUVs, {} ticks, {} pings ({} rejected)\n{} rounds, {:.2} s on {} threads{}",
            self.scenario,
            self.seed,
            self.each.len(),
            grouped(self.poses as u64),
            grouped((self.ranges_used + self.ranges_by_payload) as u64),
            self.ranges_rejected,
            self.rounds,
            self.solve_s,
            self.threads,
            if self.restarts > 0 {
                format!(", begun again {} times without rejected pings", self.restarts)
            } else {
                String::new()
            },
        );
        let lines = if self.each.len() <= LINES_MAX { &self.each } else { &self.groups };
        let name_width = lines.iter().map(|line| line.name.chars().count()).max().unwrap_or(0).max(4);
        for (title, decimals, scale, of) in [
            (
                "width of the position box (m)",
                3,
                1.0,
                (|line| &line.position_width_m) as fn(&Line) -> &MedianAndEnd,
            ),
            ("width of the clock interval (ms)", 4, 1e3, |line| &line.clock_width_s),
        ] {
            let _ = writeln!(
                text,
                "\n{title}\n{:name_width$}  {:^32}  {:^32}",
                "", "median over time", "at the end"
            );
            let _ = write!(text, "{:name_width$}", "");
            for _ in 0..2 {
                let _ = write!(text, "  {:>10} {:>10} {:>10}", "no pings", "online", "offline");
            }
            text.push('\n');
            for line in lines.iter().chain((lines.len() > 1).then_some(&self.all)) {
                let _ = write!(text, "{:name_width$}", line.name);
                for Widths { none, online, offline } in [of(line).median, of(line).end] {
                    let number = |width: Option<f64>| {
                        width.map_or("-".to_owned(), |width| format!("{:.decimals$}", width * scale))
                    };
                    let _ =
                        write!(text, "  {:>10} {:>10} {:>10}", number(none), number(online), number(offline));
                }
                text.push('\n');
            }
        }
        let held = |count: usize| 100.0 * count as f64 / self.poses.max(1) as f64;
        let _ = writeln!(
            text,
            "\nholds the truth: offline {:.4} % of {} ticks, online {:.4} %",
            held(self.all.contained),
            grouped(self.poses as u64),
            held(self.all.contained_online)
        );
        for line in self.each.iter().filter(|line| line.contained < line.poses) {
            let (name, lost) = (&line.name, grouped((line.poses - line.contained) as u64));
            let _ = match line.emptied_s {
                Some(at_s) => writeln!(
                    text,
                    "counted apart: {name} lost the truth at {lost} ticks: something broke its bounds, for its own enclosure emptied at \
                     {at_s:.2} s, and offline believes its log all the same"
                ),
                None => writeln!(text, "violated: {name} lost the truth at {lost} ticks"),
            };
        }
        text
    }
}
