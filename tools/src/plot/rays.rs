//! Which way sound goes: speed of sound over depth, and rays that leave a source in many directions.

use std::collections::BTreeSet;

use shoal_bus::record::rows::PingRow;
use shoal_bus::record::{RecordHeader, Row, Topic};
use shoal_channel::acoustics::ray::{Direction, WaterColumn, Waypoint};

use super::Plot;
use super::water::water;
use super::way::Way;
use crate::figure::{Axis, Colour, Entry, Figure, Layer, Mark, Panel, Sample, Shape, Turn};

/// Rays leave with these slopes, up and down: to 1 in 5, which is 11.3 degrees.
const STEEPEST: f64 = 0.2;

/// Rays on each side of the horizontal one.
const RAYS: i32 = 20;

/// So often rays are followed past a boundary: further bounces would hide the rest.
const BOUNCES: u32 = 1;

/// How far to follow rays when no ping says it, in depths of the water.
const RANGE_DEPTHS: f64 = 10.0;

/// What the record says of where rays should begin and end.
pub struct Rays {
    depth_m: Option<f64>,
    range_m: Option<f64>,
    is_range_given: bool,
}

impl Rays {
    /// Rays from this depth as far as this range, in metres; from the record's pings where nothing is given.
    pub fn new(depth_m: Option<f64>, range_m: Option<f64>) -> Self {
        Self { depth_m, range_m, is_range_given: range_m.is_some() }
    }
}

impl Plot for Rays {
    fn topics(&self) -> &'static [Topic] {
        &[Topic::Pings]
    }

    fn take(&mut self, row: &Row) {
        match row {
            Row::Ping(PingRow::Emitted { position_m, .. }) => {
                self.depth_m.get_or_insert(-position_m[2].0);
            }
            Row::Ping(PingRow::Heard { range_m, .. } | PingRow::Lost { to: Some(_), range_m, .. })
                if !self.is_range_given && range_m.0.is_finite() =>
            {
                self.range_m = Some(self.range_m.unwrap_or(0.0).max(range_m.0));
            }
            _ => {}
        }
    }

    fn figure(self: Box<Self>, header: &RecordHeader) -> Result<Figure, String> {
        let Some(column) = water(header)?.column else {
            return Err(
                "nothing to show: at level `ideal` the speed of sound is the same everywhere, and rays are straight"
                    .to_owned(),
            );
        };
        let bottom_m = column.bottom_depth_m();
        let depth_m = self.depth_m.ok_or("nobody pinged: give the depth of the source with --depth-m")?;
        if !(0.0..=bottom_m).contains(&depth_m) {
            return Err(format!(
                "a source at a depth of {depth_m} m is not in this water, which is {bottom_m} m deep"
            ));
        }
        let range_m = self.range_m.filter(|range_m| *range_m > 0.0).unwrap_or(RANGE_DEPTHS * bottom_m);
        if !range_m.is_finite() {
            return Err(format!("rays cannot be followed for {range_m} m"));
        }
        let pieces = fan(&column, depth_m, range_m);
        let layer = |(way, turns): (Way, Vec<Turn>)| Layer::Arcs { colour: way.colour(), turns };
        let source = Layer::Marks { mark: SOURCE, points: vec![[0.0, depth_m]] };
        let depth_axis = |label: &str| Axis::new(label, bottom_m, 0.0);
        let rays = Panel {
            width_px: 640.0,
            x: Axis::new("horizontal range (m)", 0.0, range_m),
            y: depth_axis("depth (m)"),
            layers: pieces.iter().cloned().map(layer).chain([source]).collect(),
        };
        let ways: BTreeSet<Way> = pieces.iter().map(|(way, _)| *way).collect();
        let entry = |way: Way| Entry::new(Sample::Line(way.colour()), way.name());
        let mut legend: Vec<Entry> = ways.into_iter().map(entry).collect();
        legend.push(Entry::new(Sample::Mark(SOURCE), format!("source, {depth_m:.1} m deep")));
        legend.push(Entry::remark(format!("{} rays, slopes to 1 in {:.0}", 2 * RAYS + 1, 1.0 / STEEPEST)));
        Ok(Figure {
            title: "Which way sound goes".to_owned(),
            subtitle: String::new(),
            panels: vec![speeds(&column, depth_axis("depth (m)")), rays],
            legend,
        })
    }
}

const SOURCE: Mark = Mark::new(Shape::Diamond, Colour::Black);

/// Speed of sound over depth.
fn speeds(column: &WaterColumn, y: Axis) -> Panel {
    let profile = column.profile();
    let bottom_m = column.bottom_depth_m();
    let inside = |depth_m: &f64| 0.0 < *depth_m && *depth_m < bottom_m;
    let inner = profile.nodes().iter().map(|node| node.depth_m).filter(inside);
    let depths_m = [0.0].into_iter().chain(inner).chain([bottom_m]);
    let points = depths_m.map(|depth_m| [profile.speed_m_s(depth_m), depth_m]).collect();
    let (slowest_m_s, fastest_m_s) = profile.speed_bounds_m_s(0.0, bottom_m);
    Panel {
        width_px: 180.0,
        x: Axis::around("sound speed (m/s)", slowest_m_s, fastest_m_s),
        y,
        layers: vec![Layer::Line { colour: Colour::Black, points }],
    }
}

/// The pieces of rays of equally spaced slopes, those with bounces first, so that they lie behind the others.
fn fan(column: &WaterColumn, depth_m: f64, range_m: f64) -> Vec<(Way, Vec<Turn>)> {
    let mut pieces = Vec::new();
    for index in -RAYS..=RAYS {
        let slope = STEEPEST * f64::from(index) / f64::from(RAYS);
        let cos = 1.0 / (1.0 + slope * slope).sqrt();
        let ray = column.trace(depth_m, Direction { cos, sin: slope * cos }, range_m, BOUNCES);
        pieces.extend(between_bounces(&ray));
    }
    pieces.sort_by_key(|(way, _)| std::cmp::Reverse(*way));
    pieces
}

/// The pieces of a ray from bounce to bounce.
fn between_bounces(ray: &[Waypoint]) -> Vec<(Way, Vec<Turn>)> {
    let mut pieces = vec![(Way::Direct, Vec::new())];
    let mut before: Option<&Waypoint> = None;
    for at in ray {
        let is_bounce = before.is_some_and(|before| {
            before.range_m == at.range_m
                && before.direction.sin == -at.direction.sin
                && at.direction.sin != 0.0
        });
        let way = pieces.last().map_or(Way::Direct, |(way, _)| *way);
        if is_bounce {
            pieces.push((way.bounced(at.direction.sin < 0.0), Vec::new()));
        }
        if let Some((_, turns)) = pieces.last_mut() {
            // Depth grows downwards, the sine upwards.
            let direction = [at.direction.cos, -at.direction.sin];
            turns.push(Turn { at: [at.range_m, at.depth_m], direction });
        }
        before = Some(at);
    }
    pieces
}
