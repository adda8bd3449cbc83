//! The tubes of one AUV's clock and position: online, and where they were reconstructed, without pings and offline (seed 001,
//! figures 5.9, 5.11 and 6.7).

use shoal_bus::message::AuvId;
use shoal_bus::record::rows::{OfflineRow, Pair, ReportRow, TruthRow};
use shoal_bus::record::{RecordHeader, Row, Topic};

use super::Plot;
use crate::figure::{Axis, Colour, Entry, Figure, Layer, Panel, Sample};

/// More points of a bound are thinned out, extremes excepted.
const POINTS_MAX: usize = 20_000;

/// Width of a panel, in pixels.
const PANEL_PX: f64 = 430.0;

/// A row of panels each: what the axis says, what that is less the truth, and how many of its units are one of the record's.
const COORDINATES: [(&str, &str, f64); 4] = [
    ("x, east (m)", "x − truth (m)", 1.0),
    ("y, north (m)", "y − truth (m)", 1.0),
    ("z, up (m)", "z − truth (m)", 1.0),
    ("clock: true − local time (ms)", "clock − truth (ms)", 1e3),
];

const SLICES: (&str, Colour) = ("slices: hold it since the tick before", Colour::Sky);
const GATES: (&str, Colour) = ("gates: hold it at the ticks", Colour::Blue);

/// The widest first.
const RECONSTRUCTED: [(&str, Colour); 3] =
    [("(1) no pings", Colour::Pale), ("(2) online", Colour::Sky), ("(3) offline", Colour::Blue)];

/// Bounds of x, y and z in metres, and of true minus local time in seconds.
type Gate = [[f64; 2]; 4];

/// What is kept of one AUV, each by true time in nanoseconds.
pub struct Tubes {
    auv: AuvId,
    /// x, y and z in metres, true minus local time in seconds.
    truth: Vec<(i64, [f64; 4])>,
    /// Gate, and slice since the tick before.
    online: Vec<(i64, [Gate; 2])>,
    /// Without pings, and with all that is known after the run.
    offline: Vec<(i64, [Gate; 2])>,
}

fn gate(position_m: &[Pair; 3], clock_s: &Pair) -> Gate {
    let [x, y, z] = position_m;
    [x, y, z, clock_s].map(|pair| pair.map(|bound| bound.0))
}

impl Tubes {
    /// The tubes of this AUV.
    pub fn new(auv: u32) -> Self {
        Self { auv: AuvId(auv), truth: Vec::new(), online: Vec::new(), offline: Vec::new() }
    }

    fn take_truth(&mut self, row: &TruthRow) {
        let [x, y, z] = row.position_m.map(|side| side.0);
        let clock_s = (row.t_ns.ns() - row.local_ns.ns()) as f64 * 1e-9;
        self.truth.push((row.t_ns.ns(), [x, y, z, clock_s]));
    }

    fn take_report(&mut self, row: &ReportRow) {
        let gates = [
            gate(&row.position_m, &row.clock_offset_s),
            gate(&row.slice_position_m, &row.slice_clock_offset_s),
        ];
        self.online.push((row.t_ns.ns(), gates));
    }

    /// What is drawn, the widest first: bounds over time of each, with its colour.
    fn layers(&self, coordinate: usize, is_relative: bool) -> Vec<Layer> {
        let scale = COORDINATES[coordinate].2;
        let truth = &self.truth;
        let origin = move |t_ns: i64| match is_relative {
            false => Some(0.0),
            true => find(truth, t_ns).map(|values| values[coordinate]),
        };
        let gates = |of: &[(i64, [Gate; 2])], which: usize| -> Vec<[f64; 3]> {
            let one = |(t_ns, gates): &(i64, [Gate; 2])| {
                let origin = origin(*t_ns)?;
                let [lower, upper] = gates[which][coordinate].map(|bound| (bound - origin) * scale);
                Some([seconds(*t_ns), lower, upper])
            };
            of.iter().filter_map(one).collect()
        };
        let tubes = if self.offline.is_empty() {
            let slices = if is_relative { Vec::new() } else { steps(&gates(&self.online, 1)) };
            vec![(SLICES.1, slices), (GATES.1, gates(&self.online, 0))]
        } else {
            let [(_, alone), (_, online), (_, offline)] = RECONSTRUCTED;
            vec![
                (alone, gates(&self.offline, 0)),
                (online, gates(&self.online, 0)),
                (offline, gates(&self.offline, 1)),
            ]
        };
        let area = |(colour, bounds): (Colour, Vec<[f64; 3]>)| {
            let lower = bounds.iter().map(|[at_s, lower, _]| [*at_s, *lower]);
            let upper = bounds.iter().rev().map(|[at_s, _, upper]| [*at_s, *upper]);
            Layer::Area { colour, corners: lower.chain(upper).collect() }
        };
        let line = truth.iter().filter_map(|(t_ns, values)| {
            Some([seconds(*t_ns), (values[coordinate] - origin(*t_ns)?) * scale])
        });
        let line = Layer::Line { colour: Colour::Black, points: line.collect() };
        tubes.into_iter().map(area).chain([line]).collect()
    }

    fn panel(&self, coordinate: usize, is_relative: bool) -> Panel {
        let (label, relative, _) = COORDINATES[coordinate];
        let layers = self.layers(coordinate, is_relative);
        let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
        for layer in &layers {
            let (Layer::Area { corners: points, .. } | Layer::Line { points, .. }) = layer else { continue };
            for [_, value] in points.iter().filter(|[_, value]| value.is_finite()) {
                least = least.min(*value);
                greatest = greatest.max(*value);
            }
        }
        let first_s = self.truth.first().map_or(0.0, |(t_ns, _)| seconds(*t_ns)).min(0.0);
        let last_s = self.truth.last().map_or(0.0, |(t_ns, _)| seconds(*t_ns));
        Panel {
            width_px: PANEL_PX,
            x: Axis::new("true time (s)", first_s, last_s.max(first_s + 0.1)),
            y: Axis::around(if is_relative { relative } else { label }, least, greatest),
            layers,
        }
    }
}

impl Plot for Tubes {
    fn topics(&self) -> &'static [Topic] {
        &[Topic::Ticks, Topic::Reports, Topic::Offline]
    }

    fn take(&mut self, row: &Row) {
        match row {
            Row::Truth(row) if row.auv == self.auv => self.take_truth(row),
            Row::Report(row) if row.auv == self.auv => self.take_report(row),
            Row::Offline(row) if row.auv == self.auv => {
                let OfflineRow { alone_position_m, alone_clock_offset_s, position_m, clock_offset_s, .. } =
                    row;
                let gates = [gate(alone_position_m, alone_clock_offset_s), gate(position_m, clock_offset_s)];
                self.offline.push((row.t_ns.ns(), gates));
            }
            _ => {}
        }
    }

    fn figure(self: Box<Self>, header: &RecordHeader) -> Result<Figure, String> {
        let told = super::told(header, self.auv)?;
        if self.online.is_empty() {
            return Err(format!("nothing to show: AUV {} reported nothing", self.auv));
        }
        let panels = (0..COORDINATES.len())
            .flat_map(|coordinate| [false, true].map(|is_relative| self.panel(coordinate, is_relative)));
        let is_online = self.offline.is_empty();
        let names = if is_online { [SLICES, GATES].to_vec() } else { RECONSTRUCTED.to_vec() };
        let mut legend: Vec<Entry> =
            names.into_iter().map(|(name, colour)| Entry::new(Sample::Area(colour), name)).collect();
        legend.push(Entry::new(Sample::Line(Colour::Black), "truth"));
        if is_online {
            legend.push(Entry::remark("right: gates, less the truth"));
        }
        let how = if is_online { "" } else { ": without pings, online, offline" };
        let figure = Figure {
            title: format!("What {} (AUV {}) knows of position and time{how}", told.name, self.auv),
            subtitle: String::new(),
            panels: panels.collect(),
            legend,
        };
        Ok(figure.with_at_most(POINTS_MAX))
    }
}

fn seconds(t_ns: i64) -> f64 {
    t_ns as f64 * 1e-9
}

fn find<T: Copy>(of: &[(i64, T)], t_ns: i64) -> Option<T> {
    let index = of.binary_search_by_key(&t_ns, |(at_ns, _)| *at_ns).ok()?;
    of.get(index).map(|(_, value)| *value)
}

/// Bounds that hold from the one before on: each twice, at the beginning of its slice and at its end.
fn steps(bounds: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let step = |pair: &[[f64; 3]]| match pair {
        [[from_s, ..], [to_s, lower, upper]] => vec![[*from_s, *lower, *upper], [*to_s, *lower, *upper]],
        _ => Vec::new(),
    };
    bounds.windows(2).flat_map(step).collect()
}
