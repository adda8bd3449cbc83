//! The tubes of one AUV's clock and abscissa: without pings, online, and offline (seed 001, figure 5.9).

use shoal_bus::message::AuvId;
use shoal_bus::record::rows::{OfflineRow, Pair};
use shoal_bus::record::{RecordHeader, Row, Topic};

use super::Plot;
use crate::figure::{Axis, Colour, Entry, Figure, Layer, Panel, Sample};

/// No tube of a figure has more gates.
const GATES_MAX: usize = 2_000;

/// Width of a panel, in pixels.
const PANEL_PX: f64 = 330.0;

/// How tubes are drawn, the widest first.
const TUBES: [(&str, Colour); 3] =
    [("(1) no pings", Colour::Pale), ("(2) online", Colour::Sky), ("(3) offline", Colour::Blue)];

/// What is kept of one AUV.
pub struct Tubes {
    auv: AuvId,
    truth: Vec<Truth>,
    /// By tick.
    online: Vec<(u64, Gate)>,
    offline: Vec<(u64, [Gate; 2])>,
}

struct Truth {
    tick: u64,
    at_s: f64,
    /// True minus local time in seconds, x in metres.
    values: [f64; 2],
}

/// Bounds of true minus local time in seconds, and of x in metres.
type Gate = [[f64; 2]; 2];

impl Tubes {
    /// The tubes of this AUV.
    pub fn new(auv: u32) -> Self {
        Self { auv: AuvId(auv), truth: Vec::new(), online: Vec::new(), offline: Vec::new() }
    }
}

impl Plot for Tubes {
    fn topics(&self) -> &'static [Topic] {
        &[Topic::Ticks, Topic::Reports, Topic::Offline]
    }

    fn take(&mut self, row: &Row) {
        let gate = |clock: Pair, x: Pair| [clock, x].map(|pair| pair.map(|bound| bound.0));
        match row {
            Row::Truth(row) if row.auv == self.auv => self.truth.push(Truth {
                tick: row.tick,
                at_s: row.t_ns.as_s(),
                values: [(row.t_ns.ns() - row.local_ns.ns()) as f64 * 1e-9, row.position_m[0].0],
            }),
            Row::Report(row) if row.auv == self.auv => {
                self.online.push((row.tick, gate(row.clock_offset_s, row.position_m[0])));
            }
            Row::Offline(row) if row.auv == self.auv => {
                let OfflineRow { alone_position_m, alone_clock_offset_s, position_m, clock_offset_s, .. } =
                    row;
                let alone = gate(*alone_clock_offset_s, alone_position_m[0]);
                self.offline.push((row.tick, [alone, gate(*clock_offset_s, position_m[0])]));
            }
            _ => {}
        }
    }

    fn figure(self: Box<Self>, header: &RecordHeader) -> Result<Figure, String> {
        let Some(told) = header.auvs.get(self.auv.0 as usize) else {
            return Err(format!(
                "there is no AUV {}: the record has {}, counted from 0",
                self.auv,
                header.auvs.len()
            ));
        };
        if self.offline.is_empty() {
            return Err(format!(
                "nothing is reconstructed of AUV {}: run `shoal localize RECORD --offline` and plot the file that it writes",
                self.auv
            ));
        }
        let every = self.truth.len().div_ceil(GATES_MAX).max(1);
        let mut shown = Vec::new();
        for truth in self.truth.iter().step_by(every) {
            let online = find(&self.online, truth.tick);
            let offline = find(&self.offline, truth.tick);
            if let (Some(online), Some([alone, offline])) = (online, offline) {
                shown.push((truth, [alone, online, offline]));
            }
        }
        let panels = [false, true].into_iter().flat_map(|is_relative| {
            let shown = &shown;
            [("true − local time (ms)", 1e3), ("x (m)", 1.0)].into_iter().enumerate().map(
                move |(which, (label, scale))| {
                    let label = if is_relative { format!("{label}, minus truth") } else { label.to_owned() };
                    panel(shown, which, scale, is_relative, label)
                },
            )
        });
        let mut legend: Vec<Entry> =
            TUBES.iter().map(|(name, colour)| Entry::new(Sample::Area(*colour), *name)).collect();
        legend.push(Entry::new(Sample::Line(Colour::Black), "truth"));
        if every > 1 {
            legend.push(Entry::remark(format!("1 in {every} ticks drawn")));
        }
        Ok(Figure {
            title: format!(
                "What is known of {} (AUV {}): without pings, online, offline",
                told.name, self.auv
            ),
            subtitle: String::new(),
            panels: panels.collect(),
            legend,
        })
    }
}

fn find<T: Copy>(of: &[(u64, T)], tick: u64) -> Option<T> {
    let index = of.binary_search_by_key(&tick, |(tick, _)| *tick).ok()?;
    of.get(index).map(|(_, value)| *value)
}

/// Clock (0) or x (1).
fn panel(shown: &[(&Truth, [Gate; 3])], which: usize, scale: f64, is_relative: bool, label: String) -> Panel {
    let origin = |truth: &Truth| if is_relative { truth.values[which] } else { 0.0 };
    let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
    let mut layers = Vec::new();
    for (tube, (_, colour)) in TUBES.iter().enumerate() {
        let bound = |side: usize| {
            move |(truth, gates): &(&Truth, [Gate; 3])| {
                [truth.at_s, (gates[tube][which][side] - origin(truth)) * scale]
            }
        };
        let (lower, upper) = (shown.iter().map(bound(0)), shown.iter().map(bound(1)));
        let corners: Vec<[f64; 2]> = lower.chain(upper.rev()).collect();
        for [_, value] in corners.iter().filter(|[_, value]| value.is_finite()) {
            least = least.min(*value);
            greatest = greatest.max(*value);
        }
        layers.push(Layer::Area { colour: *colour, corners });
    }
    let truth = shown.iter().map(|(truth, _)| [truth.at_s, (truth.values[which] - origin(truth)) * scale]);
    layers.push(Layer::Line { colour: Colour::Black, points: truth.collect() });
    let last_s = shown.last().map_or(0.0, |(truth, _)| truth.at_s);
    Panel {
        width_px: PANEL_PX,
        x: Axis::from_zero("true time (s)", last_s),
        y: Axis::around(label, least, greatest),
        layers,
    }
}
