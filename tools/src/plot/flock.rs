//! How the swarm moves and holds together, over time.

use shoal_bus::record::rows::FlockRow;
use shoal_bus::record::{RecordHeader, Row, Topic};

use super::Plot;
use crate::figure::{Axis, Colour, Entry, Figure, Layer, Panel, Sample};

/// Width of a panel, in pixels.
const PANEL_PX: f64 = 300.0;

/// With more points than so many, every other one goes.
const POINTS_MAX: usize = 2_000;

/// What a panel shows: its label, and lines with their meanings.
type Measure = (&'static str, &'static [Curve]);

/// A line: colour, meaning, value at a moment.
type Curve = (Colour, &'static str, fn(&FlockRow) -> Option<f64>);

const MEASURES: [Measure; 5] = [
    (
        "least separation (m)",
        &[(Colour::Blue, "least distance between two bodies since the second before", |row| {
            row.flock.min_separation_m
        })],
    ),
    (
        "polarization, 0 to 1",
        &[(Colour::Green, "polarization: length of the mean direction", |row| Some(row.flock.polarization))],
    ),
    (
        "algebraic connectivity",
        &[(Colour::Vermillion, "algebraic connectivity: 0 when the swarm falls apart", |row| {
            row.flock.algebraic_connectivity
        })],
    ),
    // Apart: one is about one when the other is about hundreds.
    (
        "connected components",
        &[(Colour::Purple, "connected components", |row| Some(f64::from(row.flock.components)))],
    ),
    (
        "AUVs in the largest component",
        &[(Colour::Orange, "AUVs in the largest component", |row| {
            Some(f64::from(row.flock.largest_component))
        })],
    ),
];

/// The moments that are drawn.
pub struct Flock {
    /// Every so many-th moment is kept.
    stride: usize,
    seen: usize,
    moments: Vec<FlockRow>,
    last: Option<FlockRow>,
}

impl Default for Flock {
    fn default() -> Self {
        Self { stride: 1, seen: 0, moments: Vec::new(), last: None }
    }
}

impl Plot for Flock {
    fn topics(&self) -> &'static [Topic] {
        &[Topic::Flock]
    }

    fn take(&mut self, row: &Row) {
        let Row::Flock(row) = row else { return };
        if self.seen.is_multiple_of(self.stride) {
            self.moments.push(*row);
        } else if let (Some(kept), Some(metres)) = (self.moments.last_mut(), row.flock.min_separation_m) {
            // The closest meeting is not to be thinned out.
            let least_m = &mut kept.flock.min_separation_m;
            *least_m = Some(least_m.map_or(metres, |least_m| least_m.min(metres)));
        }
        self.seen += 1;
        self.last = Some(*row);
        if self.moments.len() > POINTS_MAX {
            self.stride *= 2;
            self.moments = self.moments.chunks(2).map(both).collect();
        }
    }

    fn figure(self: Box<Self>, _: &RecordHeader) -> Result<Figure, String> {
        let Some(last) = self.last else {
            return Err("nothing to show: the record has no `/flock`; an earlier version wrote it".to_owned());
        };
        let end_s = last.t_ns.as_s().max(1.0);
        let (mut panels, mut legend) = (Vec::new(), Vec::new());
        for (label, curves) in MEASURES {
            let mut greatest: f64 = 0.0;
            let mut layers = Vec::new();
            for &(colour, meaning, value) in curves {
                let points: Vec<[f64; 2]> =
                    self.moments.iter().filter_map(|row| Some([row.t_ns.as_s(), value(row)?])).collect();
                greatest = points.iter().fold(greatest, |greatest, [_, value]| greatest.max(*value));
                layers.push(Layer::Line { colour, points });
                legend.push(Entry::new(Sample::Line(colour), meaning));
            }
            panels.push(Panel {
                width_px: PANEL_PX,
                x: Axis::new("true time (s)", 0.0, end_s),
                y: Axis::from_zero(label, greatest),
                layers,
            });
        }
        let (count, at_s) = (last.flock.collisions, last.t_ns.as_s());
        let plural = if count == 1 { "" } else { "s" };
        legend.push(Entry::remark(format!("{count} collision{plural} until {at_s} s")));
        legend.push(Entry::remark("linked: each in range of the other"));
        Ok(Figure {
            title: "How the swarm moves and holds together".to_owned(),
            subtitle: String::new(),
            panels,
            legend,
        })
    }
}

/// One moment for one or two: the first, with the least separation of both.
fn both(moments: &[FlockRow]) -> FlockRow {
    let least_m = moments.iter().filter_map(|row| row.flock.min_separation_m).reduce(f64::min);
    let mut first = moments[0];
    first.flock.min_separation_m = least_m;
    first
}

#[cfg(test)]
mod tests {
    use shoal_bus::time::SimTime;

    use super::*;

    fn row(second: i64, min_separation_m: f64) -> Row {
        let flock = shoal_bus::summary::Flock {
            polarization: 0.5,
            min_separation_m: Some(min_separation_m),
            algebraic_connectivity: Some(second as f64),
            components: 2,
            largest_component: 7,
            ..Default::default()
        };
        Row::Flock(FlockRow { t_ns: SimTime::from_ns(second * 1_000_000_000), flock })
    }

    fn figure(rows: impl Iterator<Item = Row>) -> Result<Figure, String> {
        let mut flock = Box::new(Flock::default());
        rows.for_each(|row| flock.take(&row));
        let (scenario_name, scenario_text) = ("a".into(), String::new());
        flock.figure(&RecordHeader { scenario_name, seed: 1, scenario_text, auvs: vec![] })
    }

    #[test]
    fn long_runs_are_thinned_but_their_closest_meeting_stays() {
        let closest = |second: i64| if second == 7_777 { 1.5 } else { 30.0 };
        let figure = figure((0..10_000).map(|second| row(second, closest(second)))).unwrap();
        let points = |panel: usize, layer: usize| {
            let Layer::Line { points, .. } = &figure.panels[panel].layers[layer] else { panic!() };
            points.clone()
        };
        assert!((POINTS_MAX / 2..=POINTS_MAX).contains(&points(0, 0).len()));
        assert_eq!(points(0, 0).iter().map(|[_, y]| *y).fold(99.0, f64::min), 1.5);
        assert!(points(2, 0).iter().all(|[x, y]| x == y));
        assert!(points(3, 0).iter().all(|[_, y]| *y == 2.0) && points(4, 0).iter().all(|[_, y]| *y == 7.0));
        assert_eq!(figure.panels[0].x.last, 9_999.0);
    }

    #[test]
    fn a_record_without_a_flock_says_so() {
        assert!(figure(std::iter::empty()).unwrap_err().starts_with("nothing to show"));
    }
}
