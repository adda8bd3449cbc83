//! How good the estimates of each group are, over time: how often the truth is inside, and how much a Gaussian trusts itself.

use std::collections::BTreeMap;

use shoal_bus::message::{AuvId, Gaussian};
use shoal_bus::record::rows::{Pair, ReportRow, TruthRow};
use shoal_bus::record::{BATCH_NS, RecordHeader, Row, Topic};
use shoal_bus::time::NS_PER_S;
use shoal_channel::accuracy::normalized_error_squared;

use super::Plot;
use crate::figure::{Axis, Colour, Entry, Figure, Layer, Panel, Sample};

/// With more spans than this, two become one.
const SPANS_MAX: i64 = 200;

/// Width of a panel, in pixels.
const PANEL_PX: f64 = 300.0;

/// Of one group after the other.
const COLOURS: [Colour; 8] = [
    Colour::Blue,
    Colour::Vermillion,
    Colour::Green,
    Colour::Orange,
    Colour::Purple,
    Colour::Sky,
    Colour::Black,
    Colour::Grey,
];

/// What a panel shows: label, value of a span, and a line to compare with.
type Measure = (&'static str, fn(&Sums) -> Option<f64>, Option<f64>);

const MEASURES: [Measure; 4] = [
    ("truth inside (%)", |of| of.mean(100.0 * of.contained as f64), None),
    ("√(NEES / 4), 1 when honest", Sums::overconfidence, Some(1.0)),
    ("error of the centre, RMS (m)", |of| of.mean(of.square_error_m2).map(f64::sqrt), None),
    ("width of the box, mean (m)", |of| of.mean(of.width_m), None),
];

/// Sums over spans of equal duration.
pub struct Estimators {
    span_ns: i64,
    /// By AUV, then by span.
    sums: BTreeMap<AuvId, BTreeMap<i64, Sums>>,
    /// The last truth about each.
    truth: BTreeMap<AuvId, TruthRow>,
}

impl Default for Estimators {
    fn default() -> Self {
        Self { span_ns: BATCH_NS, sums: BTreeMap::new(), truth: BTreeMap::new() }
    }
}

/// Sums over reports.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    reports: u64,
    contained: u64,
    gaussians: u64,
    nees: f64,
    square_error_m2: f64,
    width_m: f64,
}

impl Sums {
    /// What one report is worth, beside the truth at its tick.
    fn of(report: &ReportRow, truth: &TruthRow) -> Self {
        let position_m = truth.position_m.map(|side| side.0);
        let offset_s = (truth.t_ns.ns() - truth.local_ns.ns()) as f64 * 1e-9;
        let holds = |[lower, upper]: Pair, value: f64| lower.0 <= value && value <= upper.0;
        let is_contained = (0..3).all(|axis| holds(report.position_m[axis], position_m[axis]))
            && holds(report.clock_offset_s, offset_s);
        let gaussian = report.gaussian.as_ref().map(|row| Gaussian {
            mean: row.mean.map(|real| real.0),
            covariance: row.covariance.map(|real| real.0),
        });
        let centre_m = gaussian.as_ref().map_or_else(
            || report.position_m.map(|[lower, upper]| 0.5 * lower.0 + 0.5 * upper.0),
            |Gaussian { mean: [x, y, z, _], .. }| [*x, *y, *z],
        );
        let errors_m: [f64; 3] = std::array::from_fn(|axis| centre_m[axis] - position_m[axis]);
        let [x, y, z] = position_m;
        Self {
            reports: 1,
            contained: u64::from(is_contained),
            gaussians: u64::from(gaussian.is_some()),
            // A covariance that is none is as wrong as can be.
            nees: gaussian.map_or(0.0, |gaussian| {
                normalized_error_squared(&gaussian, &[x, y, z, offset_s]).unwrap_or(f64::INFINITY)
            }),
            square_error_m2: errors_m.iter().map(|error_m| error_m * error_m).sum(),
            width_m: report
                .position_m
                .map(|[lower, upper]| upper.0 - lower.0)
                .into_iter()
                .fold(0.0, f64::max),
        }
    }

    fn add(&mut self, other: &Self) {
        self.reports += other.reports;
        self.contained += other.contained;
        self.gaussians += other.gaussians;
        self.nees += other.nees;
        self.square_error_m2 += other.square_error_m2;
        self.width_m += other.width_m;
    }

    fn mean(&self, sum: f64) -> Option<f64> {
        (self.reports > 0).then(|| sum / self.reports as f64)
    }

    fn nees_mean(&self) -> Option<f64> {
        (self.gaussians > 0).then(|| self.nees / self.gaussians as f64)
    }

    /// By what factor errors are greater than the Gaussian expects: of four dimensions, so NEES is 4 when it is honest.
    fn overconfidence(&self) -> Option<f64> {
        self.nees_mean().map(|nees| (nees / 4.0).sqrt())
    }
}

impl Estimators {
    fn add(&mut self, t_ns: i64, auv: AuvId, of: &Sums) {
        let at_ns = t_ns.max(0);
        while at_ns / self.span_ns >= SPANS_MAX {
            self.span_ns *= 2;
            for spans in self.sums.values_mut() {
                let mut wider: BTreeMap<i64, Sums> = BTreeMap::new();
                spans.iter().for_each(|(span, sums)| wider.entry(span / 2).or_default().add(sums));
                *spans = wider;
            }
        }
        self.sums.entry(auv).or_default().entry(at_ns / self.span_ns).or_default().add(of);
    }

    /// By group, then by span.
    fn groups<'a>(&self, header: &'a RecordHeader) -> BTreeMap<u16, (&'a str, BTreeMap<i64, Sums>)> {
        let mut groups: BTreeMap<u16, (&str, BTreeMap<i64, Sums>)> = BTreeMap::new();
        for (auv, spans) in &self.sums {
            let Some(told) = header.auvs.get(auv.0 as usize) else { continue };
            let (_, of_group) = groups.entry(told.group).or_insert((&told.group_name, BTreeMap::new()));
            spans.iter().for_each(|(span, sums)| of_group.entry(*span).or_default().add(sums));
        }
        groups
    }
}

impl Plot for Estimators {
    fn topics(&self) -> &'static [Topic] {
        &[Topic::Ticks, Topic::Reports]
    }

    fn take(&mut self, row: &Row) {
        match row {
            Row::Truth(row) => {
                self.truth.insert(row.auv, row.clone());
            }
            Row::Report(row) => {
                // The truth at a tick comes before what was answered.
                if let Some(truth) = self.truth.get(&row.auv).filter(|truth| truth.tick == row.tick) {
                    let sums = Sums::of(row, truth);
                    self.add(row.t_ns.ns(), row.auv, &sums);
                }
            }
            _ => {}
        }
    }

    fn figure(self: Box<Self>, header: &RecordHeader) -> Result<Figure, String> {
        let groups = self.groups(header);
        if groups.is_empty() {
            return Err("nothing to show: no AUV of the record reported anything".to_owned());
        }
        let span_s = self.span_ns as f64 / NS_PER_S as f64;
        let last = groups.values().filter_map(|(_, spans)| spans.keys().last()).max().copied().unwrap_or(0);
        let end_s = (last + 1) as f64 * span_s;
        let coloured = || groups.values().zip(COLOURS.iter().cycle().copied());
        let (mut panels, mut legend) = (Vec::new(), Vec::new());
        for (label, value, compared) in MEASURES {
            let mut layers = Vec::new();
            let mut greatest = compared.unwrap_or(0.0);
            if let Some(at) = compared {
                let points = vec![[0.0, at], [end_s, at]];
                layers.push(Layer::Line { colour: Colour::Grey, points });
            }
            for ((_, spans), colour) in coloured() {
                let middle_s = |span: i64| (span as f64 + 0.5) * span_s;
                let points: Vec<[f64; 2]> =
                    spans.iter().filter_map(|(span, sums)| Some([middle_s(*span), value(sums)?])).collect();
                let finite = points.iter().map(|[_, value]| *value).filter(|value| value.is_finite());
                greatest = finite.fold(greatest, f64::max);
                layers.push(Layer::Line { colour, points });
            }
            panels.push(Panel {
                width_px: PANEL_PX,
                x: Axis::new("true time (s)", 0.0, end_s),
                y: Axis::from_zero(label, greatest),
                layers,
            });
        }
        for ((name, spans), colour) in coloured() {
            let mut all = Sums::default();
            spans.values().for_each(|sums| all.add(sums));
            let inside = 100.0 * all.contained as f64 / all.reports as f64;
            let nees = all.nees_mean().map_or_else(String::new, |nees| format!(", NEES {nees:.1}"));
            legend.push(Entry::new(Sample::Line(colour), format!("{name}: {inside:.2} %{nees}")));
        }
        legend.push(Entry::remark(format!("means over {span_s} s and a group")));
        Ok(Figure {
            title: "How good the estimates of each group are".to_owned(),
            subtitle: String::new(),
            panels,
            legend,
        })
    }
}
