//! What is known of each AUV.

use std::collections::BTreeMap;

use serde_json::json;
use shoal_bus::message::AuvId;
use shoal_bus::record::Row;
use shoal_bus::record::rows::PingRow;
use shoal_bus::tap::Cast;
use shoal_bus::time::SimTime;
use shoal_bus::traffic::LossReason;

use crate::table::Table;
use crate::tap::args::Sort;
use crate::tap::source::Window;
use crate::tap::text::{box_width_m, clock_width_s};

/// Why pings are lost, with columns of their own; the others share one.
const REASONS: [(LossReason, &str); 4] = [
    (LossReason::Range, "range"),
    (LossReason::Noise, "noise"),
    (LossReason::Collision, "collision"),
    (LossReason::HalfDuplex, "half-duplex"),
];

/// Titles of the columns; `>` for those that stand at the right.
pub const TITLES: [&str; 14] = [
    ">auv",
    "name",
    ">box m",
    ">clock ms",
    ">neighbours",
    ">emitted",
    ">heard",
    ">lost",
    ">range",
    ">noise",
    ">collision",
    ">half-duplex",
    ">other",
    "state",
];

/// One AUV.
#[derive(Clone, Debug, Default)]
pub struct Line {
    name: String,
    box_m: Option<f64>,
    clock_s: Option<f64>,
    neighbours: u16,
    emitted: u64,
    heard: u64,
    lost: [u64; REASONS.len()],
    lost_otherwise: u64,
    state: &'static str,
}

/// All AUVs, in the order asked for.
pub struct Roster {
    lines: BTreeMap<AuvId, Line>,
    pub sort: Sort,
    pub is_reversed: bool,
    pub at: SimTime,
    pub heard: u64,
    pub lost: u64,
}

impl Roster {
    pub fn new(sort: Sort) -> Self {
        let (lines, is_reversed) = (BTreeMap::new(), false);
        Self { lines, sort, is_reversed, at: SimTime::ZERO, heard: 0, lost: 0 }
    }

    pub fn is_empty(&self) -> bool {
        self.lines.is_empty()
    }

    pub fn len(&self) -> usize {
        self.lines.len()
    }

    /// Takes in what has happened.
    pub fn take(&mut self, window: &Window, cast: Option<&Cast>) {
        self.at = self.at.max(window.to);
        if self.lines.is_empty()
            && let Some(cast) = cast
        {
            let line = |name: &String| Line { name: name.clone(), state: "alive", ..Line::default() };
            let named = (0..).map(AuvId).zip(cast.header.auvs.iter().map(|auv| line(&auv.name)));
            self.lines = named.collect();
        }
        for row in &window.rows {
            match row {
                Row::Report(report) => {
                    let line = self.lines.entry(report.auv).or_default();
                    line.box_m = Some(box_width_m(report));
                    line.clock_s = Some(clock_width_s(report));
                    line.neighbours = report.neighbours;
                    line.state = if report.emptied.is_some() { "emptied" } else { "alive" };
                }
                Row::Ping(ping) => self.ping(ping),
                Row::Log(log) if log.message.starts_with("the AUV is lost") => {
                    if let Some(line) = self.lines.values_mut().find(|line| line.name == log.name) {
                        line.state = "lost";
                    }
                }
                _ => {}
            }
        }
    }

    fn ping(&mut self, ping: &PingRow) {
        match ping {
            PingRow::Emitted { from, .. } => self.lines.entry(*from).or_default().emitted += 1,
            PingRow::Heard { to, .. } => {
                self.heard += 1;
                self.lines.entry(*to).or_default().heard += 1;
            }
            // One that never left is its emitter's loss.
            PingRow::Lost { from, to, reason, .. } => {
                self.lost += 1;
                let line = self.lines.entry(to.unwrap_or(*from)).or_default();
                match REASONS
                    .iter()
                    .position(|(of_column, _)| of_column == reason)
                    .and_then(|k| line.lost.get_mut(k))
                {
                    Some(count) => *count += 1,
                    None => line.lost_otherwise += 1,
                }
            }
        }
    }

    /// The AUVs in order.
    pub fn sorted(&self) -> Vec<(AuvId, &Line)> {
        let mut lines: Vec<(AuvId, &Line)> = self.lines.iter().map(|(auv, line)| (*auv, line)).collect();
        // Widest first, what is not known behind.
        let widest = |width: Option<f64>| -width.unwrap_or(-1.0);
        match self.sort {
            Sort::Auv => {}
            Sort::Box => lines.sort_by(|(_, a), (_, b)| widest(a.box_m).total_cmp(&widest(b.box_m))),
            Sort::Clock => lines.sort_by(|(_, a), (_, b)| widest(a.clock_s).total_cmp(&widest(b.clock_s))),
            Sort::Neighbours => lines.sort_by_key(|(_, line)| line.neighbours),
            Sort::Heard => lines.sort_by_key(|(_, line)| line.heard),
            Sort::Lost => lines.sort_by_key(|(_, line)| std::cmp::Reverse(line.all_lost())),
        }
        if self.is_reversed {
            lines.reverse();
        }
        lines
    }

    /// The time, and the AUVs as a table of so many columns.
    pub fn table(&self, columns: Option<usize>) -> String {
        let mut table = Table::new(&TITLES);
        self.sorted().into_iter().for_each(|(auv, line)| table.push(line.cells(auv)));
        format!("{:.3} s\n{}\n", self.at.as_s(), table.render(columns))
    }

    /// The AUVs as JSON lines.
    pub fn json_lines(&self) -> String {
        let line = |(auv, line): (AuvId, &Line)| {
            let mut lost: serde_json::Map<String, serde_json::Value> = REASONS
                .iter()
                .zip(line.lost)
                .map(|((reason, _), count)| (reason.name().to_owned(), count.into()))
                .collect();
            lost.insert("other".to_owned(), line.lost_otherwise.into());
            let line = json!({ "format": "shoal.tap.top/1", "t_s": self.at.as_s(), "auv": auv, "name": line.name,
                "box_width_m": line.box_m, "clock_width_s": line.clock_s, "neighbours": line.neighbours,
                "emitted": line.emitted, "heard": line.heard, "lost": lost, "state": line.state });
            format!("{line}\n")
        };
        self.sorted().into_iter().map(line).collect()
    }
}

impl Line {
    fn all_lost(&self) -> u64 {
        self.lost.iter().sum::<u64>() + self.lost_otherwise
    }

    pub fn is_alive(&self) -> bool {
        self.state == "alive"
    }

    /// One cell for each of [`TITLES`].
    pub fn cells(&self, auv: AuvId) -> [String; TITLES.len()] {
        let width = |width: Option<f64>, factor: f64, digits: usize| {
            width.map_or("-".to_owned(), |width| format!("{:.digits$}", width * factor))
        };
        let [range, noise, collision, half_duplex] = self.lost.map(|count| count.to_string());
        [
            auv.to_string(),
            self.name.clone(),
            width(self.box_m, 1.0, 1),
            width(self.clock_s, 1e3, 2),
            self.neighbours.to_string(),
            self.emitted.to_string(),
            self.heard.to_string(),
            self.all_lost().to_string(),
            range,
            noise,
            collision,
            half_duplex,
            self.lost_otherwise.to_string(),
            self.state.to_owned(),
        ]
    }
}
