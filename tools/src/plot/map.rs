//! Where everyone is at one moment, and where everyone believes to be: bodies, boxes, and the sound on its way.

use std::collections::BTreeMap;

use shoal_bus::message::AuvId;
use shoal_bus::record::rows::{PingRow, ReportRow, TruthRow};
use shoal_bus::record::{RecordHeader, Row, Topic};

use super::groups::{colour, groups, mark};
use super::water::water;
use super::{Plot, moment_ns};
use crate::figure::{Axis, Colour, Entry, Figure, Layer, Panel, Sample};

/// Width and height of the plan, in pixels.
const PLAN_PX: [f64; 2] = [560.0, 420.0];

/// Width of the view from the south, in pixels.
const SIDE_PX: f64 = 430.0;

/// Sound that left longer ago, in nanoseconds, is out of the water.
const OLDEST_NS: i64 = 20_000_000_000;

/// Everyone at the last tick until a moment.
pub struct Map {
    /// In nanoseconds of true time.
    until_ns: i64,
    truth: BTreeMap<AuvId, TruthRow>,
    boxes: BTreeMap<AuvId, Box<ReportRow>>,
    /// By emitter and sequence number.
    sound: BTreeMap<(AuvId, u32), Wave>,
}

/// A ping on its way.
#[derive(Clone, Copy)]
struct Wave {
    left_ns: i64,
    from_m: [f64; 3],
    /// Someone was still to be reached.
    is_under_way: bool,
}

impl Map {
    /// Everyone at this true time in seconds; at the end of the record unless given.
    pub fn new(at_s: Option<f64>) -> Self {
        Self {
            until_ns: moment_ns(at_s),
            truth: BTreeMap::new(),
            boxes: BTreeMap::new(),
            sound: BTreeMap::new(),
        }
    }

    fn take_ping(&mut self, row: &PingRow) {
        match *row {
            PingRow::Emitted { t_ns, from, sequence, position_m, .. } if t_ns.ns() <= self.until_ns => {
                self.sound.retain(|_, wave| t_ns.ns() - wave.left_ns < OLDEST_NS);
                let from_m = position_m.map(|side| side.0);
                let wave = Wave { left_ns: t_ns.ns(), from_m, is_under_way: false };
                self.sound.insert((from, sequence), wave);
            }
            PingRow::Heard { t_ns, from, sequence, .. }
            | PingRow::Lost { t_ns, from, sequence, to: Some(_), .. }
                if t_ns.ns() > self.until_ns =>
            {
                if let Some(wave) = self.sound.get_mut(&(from, sequence)) {
                    wave.is_under_way = true;
                }
            }
            _ => {}
        }
    }

    /// What belongs to a group, seen from above (0, 1) or from the south (0, 2).
    fn layers_of(&self, header: &RecordHeader, group: u16, axes: [usize; 2]) -> [Layer; 2] {
        let is_of = |auv: &AuvId| header.auvs.get(auv.0 as usize).is_some_and(|told| told.group == group);
        let box_of = |row: &ReportRow| {
            let [[left, right], [low, high]] = axes.map(|axis| row.position_m[axis].map(|bound| bound.0));
            [left, right, low, high]
        };
        let boxes = self.boxes.iter().filter(|(auv, _)| is_of(auv)).map(|(_, row)| box_of(row));
        let points = self.truth.iter().filter(|(auv, _)| is_of(auv));
        let point = |row: &TruthRow| axes.map(|axis| row.position_m[axis].0);
        [
            Layer::Boxes { colour: colour(group), boxes: boxes.collect() },
            Layer::Marks { mark: mark(group), points: points.map(|(_, row)| point(row)).collect() },
        ]
    }

    fn reach(&self, axis: usize) -> [f64; 2] {
        let truth = self.truth.values().map(|row| row.position_m[axis].0);
        let boxes = self.boxes.values().flat_map(|row| row.position_m[axis].map(|bound| bound.0));
        let finite = truth.chain(boxes).filter(|value| value.is_finite());
        finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, greatest], value| {
            [least.min(value), greatest.max(value)]
        })
    }
}

impl Plot for Map {
    fn topics(&self) -> &'static [Topic] {
        &[Topic::Ticks, Topic::Reports, Topic::Pings]
    }

    fn take(&mut self, row: &Row) {
        match row {
            Row::Truth(row) if row.t_ns.ns() <= self.until_ns => {
                self.truth.insert(row.auv, row.clone());
            }
            Row::Report(row) if row.t_ns.ns() <= self.until_ns => {
                self.boxes.insert(row.auv, row.clone());
            }
            Row::Ping(row) => self.take_ping(row),
            _ => {}
        }
    }

    fn figure(self: Box<Self>, header: &RecordHeader) -> Result<Figure, String> {
        let last_ns = self.truth.values().map(|row| row.t_ns.ns()).max();
        let first_ns = self.truth.values().map(|row| row.t_ns.ns()).min();
        let (Some(first_ns), Some(last_ns)) = (first_ns, last_ns) else {
            return Err("nothing to show: no AUV has ticked until then".to_owned());
        };
        // Beyond the end of the record, the last thing that is known.
        let now_ns = if self.until_ns == i64::MAX { last_ns } else { self.until_ns };
        let groups = groups(header);
        let layers = |axes: [usize; 2]| -> Vec<Layer> {
            let of_groups = groups.iter().map(|(group, _)| self.layers_of(header, *group, axes));
            // All boxes first, so that the bodies lie upon them.
            let (boxes, bodies): (Vec<Layer>, Vec<Layer>) =
                of_groups.map(|[boxes, bodies]| (boxes, bodies)).unzip();
            boxes.into_iter().chain(bodies).collect()
        };
        let under_way: Vec<&Wave> = self.sound.values().filter(|wave| wave.is_under_way).collect();
        let mut plan_layers = Vec::new();
        if !under_way.is_empty() {
            let water = water(header)?;
            for wave in &under_way {
                let speed_m_s = water
                    .column
                    .as_ref()
                    .map_or(water.sound_speed_m_s, |column| column.profile().speed_m_s(-wave.from_m[2]));
                let radius_m = speed_m_s * (now_ns - wave.left_ns) as f64 * 1e-9;
                plan_layers.push(Layer::circle(Colour::Grey, [wave.from_m[0], wave.from_m[1]], radius_m));
            }
        }
        plan_layers.extend(layers([0, 1]));
        let [x_reach, y_reach, z_reach] = [0, 1, 2].map(|axis| self.reach(axis));
        let [x, y] = Axis::map(
            ["x, east (m)", "y, north (m)"],
            [x_reach[0], y_reach[0]],
            [x_reach[1], y_reach[1]],
            PLAN_PX,
        );
        let side = Panel {
            width_px: SIDE_PX,
            x: Axis::around("x, east (m)", x_reach[0], x_reach[1]),
            y: Axis::around("z, up (m)", z_reach[0], z_reach[1]),
            layers: layers([0, 2]),
        };
        let mut legend: Vec<Entry> = groups
            .iter()
            .map(|(group, name)| Entry::new(Sample::Mark(mark(*group)), format!("{name}: body, in its box")))
            .collect();
        if !under_way.is_empty() {
            let count = under_way.len();
            legend.push(Entry::new(Sample::Line(Colour::Grey), format!("ping under way: {count}")));
        }
        legend.push(Entry::remark("left from above, right from the south"));
        legend.push(Entry::remark("each at its last tick, which was"));
        legend.push(Entry::remark(format!(
            "{:.3} s to {:.3} s ago",
            seconds(now_ns - last_ns),
            seconds(now_ns - first_ns)
        )));
        Ok(Figure {
            title: format!("Where the AUVs are and where they believe to be, at {:.3} s", seconds(now_ns)),
            subtitle: String::new(),
            panels: vec![Panel { width_px: PLAN_PX[0], x, y, layers: plan_layers }, side],
            legend,
        })
    }
}

fn seconds(ns: i64) -> f64 {
    ns as f64 * 1e-9
}
