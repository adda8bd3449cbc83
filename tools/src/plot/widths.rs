//! How wide enclosures are, over time: quantiles over the swarm, and one AUV.

use shoal_bus::message::AuvId;
use shoal_bus::record::rows::{Pair, ReportRow};
use shoal_bus::record::{BATCH_NS, RecordHeader, Row, Topic};
use shoal_bus::time::NS_PER_S;

use super::{Plot, told};
use crate::figure::{Axis, Colour, Entry, Figure, Layer, Panel, Sample};

/// With more spans than this, two become one.
const SPANS_MAX: usize = 200;

/// More points of the one AUV are thinned out, extremes excepted.
const POINTS_MAX: usize = 20_000;

/// Width of a panel, in pixels.
const PANEL_PX: f64 = 430.0;

/// Width of the position box in metres, and of the clock interval in seconds.
type Width = [f64; 2];

/// The widest of each AUV in each span of time; of one AUV, all.
pub struct Widths {
    auv: Option<AuvId>,
    span_ns: i64,
    /// By AUV, then by span; NaN where it reported nothing.
    widest: Vec<Vec<Width>>,
    /// Of the one AUV: at which time in seconds.
    own: Vec<(f64, Width)>,
}

impl Widths {
    /// Of the swarm, and of this AUV.
    pub fn new(auv: Option<u32>) -> Self {
        Self { auv: auv.map(AuvId), span_ns: BATCH_NS, widest: Vec::new(), own: Vec::new() }
    }

    fn widen(&mut self) {
        self.span_ns *= 2;
        for spans in &mut self.widest {
            let wider = spans.chunks(2).map(|pair| {
                pair.iter().fold([f64::NAN; 2], |widest, width| [0, 1].map(|of| widest[of].max(width[of])))
            });
            *spans = wider.collect();
        }
    }

    fn put(&mut self, t_ns: i64, auv: AuvId, width: Width) {
        let at_ns = t_ns.max(0);
        while at_ns / self.span_ns >= SPANS_MAX as i64 {
            self.widen();
        }
        let (auv, span) = (auv.0 as usize, (at_ns / self.span_ns) as usize);
        if self.widest.len() <= auv {
            self.widest.resize_with(auv + 1, Vec::new);
        }
        let spans = &mut self.widest[auv];
        if spans.len() <= span {
            spans.resize(span + 1, [f64::NAN; 2]);
        }
        // Of two numbers, one of which is none, the greatest is the other.
        spans[span] = [0, 1].map(|of| spans[span][of].max(width[of]));
    }

    /// Widths `of` (0 position, 1 clock) all AUVs in a span, sorted.
    fn sorted(&self, span: usize, of: usize) -> Vec<f64> {
        let in_span = self.widest.iter().filter_map(|spans| spans.get(span));
        let mut sorted: Vec<f64> = in_span.map(|width| width[of]).filter(|width| !width.is_nan()).collect();
        sorted.sort_unstable_by(f64::total_cmp);
        sorted
    }

    fn panel(&self, of: usize, label: &str, scale: f64) -> Panel {
        let span_s = self.span_ns as f64 / NS_PER_S as f64;
        let spans = self.widest.iter().map(Vec::len).max().unwrap_or(0);
        let mut lines: [Vec<[f64; 2]>; 5] = Default::default();
        for span in 0..spans {
            let sorted = self.sorted(span, of);
            let middle_s = (span as f64 + 0.5) * span_s;
            for (line, part) in lines.iter_mut().zip(QUANTILES) {
                if let Some(width) = quantile(&sorted, part) {
                    line.push([middle_s, width * scale]);
                }
            }
        }
        let own: Vec<[f64; 2]> = self.own.iter().map(|(at_s, width)| [*at_s, width[of] * scale]).collect();
        let values = lines.iter().flatten().chain(&own).map(|[_, value]| *value);
        let greatest = values.filter(|value| value.is_finite()).fold(0.0, f64::max);
        let [least, low, median, high, most] = lines;
        let between =
            |low: &[[f64; 2]], high: &[[f64; 2]]| low.iter().chain(high.iter().rev()).copied().collect();
        let mut layers = vec![
            Layer::Area { colour: Colour::Pale, corners: between(&least, &most) },
            Layer::Area { colour: Colour::Sky, corners: between(&low, &high) },
            Layer::Line { colour: Colour::Blue, points: median },
        ];
        if self.auv.is_some() {
            layers.push(Layer::Line { colour: Colour::Vermillion, points: own });
        }
        Panel {
            width_px: PANEL_PX,
            x: Axis::new("true time (s)", 0.0, (spans as f64 * span_s).max(span_s)),
            y: Axis::from_zero(label, greatest),
            layers,
        }
    }
}

/// Which parts of the AUVs are drawn.
const QUANTILES: [f64; 5] = [0.0, 0.1, 0.5, 0.9, 1.0];

/// The value that this part of the sorted values does not exceed; the lower of two in the middle.
fn quantile(sorted: &[f64], part: f64) -> Option<f64> {
    let index = (part * sorted.len().saturating_sub(1) as f64).floor() as usize;
    sorted.get(index).copied()
}

/// Width of an interval.
fn width([lower, upper]: &Pair) -> f64 {
    upper.0 - lower.0
}

impl Plot for Widths {
    fn topics(&self) -> &'static [Topic] {
        &[Topic::Reports]
    }

    fn take(&mut self, row: &Row) {
        let Row::Report(row) = row else { return };
        let ReportRow { auv, t_ns, position_m, clock_offset_s, .. } = &**row;
        let widths = [position_m.iter().map(width).fold(0.0, f64::max), width(clock_offset_s)];
        self.put(t_ns.ns(), *auv, widths);
        if self.auv == Some(*auv) {
            self.own.push((t_ns.as_s(), widths));
        }
    }

    fn figure(self: Box<Self>, header: &RecordHeader) -> Result<Figure, String> {
        if self.widest.is_empty() {
            return Err("nothing to show: no AUV of the record reported anything".to_owned());
        }
        let own = self.auv.map(|auv| Ok::<_, String>((auv, told(header, auv)?))).transpose()?;
        let panels = vec![
            self.panel(0, "greatest side of the position box (m)", 1.0),
            self.panel(1, "width of the clock interval (ms)", 1e3),
        ];
        let mut legend = vec![
            Entry::new(Sample::Line(Colour::Blue), "median of the AUVs"),
            Entry::new(Sample::Area(Colour::Sky), "80 % of them, around it"),
            Entry::new(Sample::Area(Colour::Pale), "all, least to greatest"),
        ];
        if let Some((auv, told)) = own {
            legend.push(Entry::new(
                Sample::Line(Colour::Vermillion),
                format!("{} (AUV {auv}), each tick", told.name),
            ));
        }
        let span_s = self.span_ns as f64 / NS_PER_S as f64;
        legend.push(Entry::remark(format!("of each AUV its widest in {span_s} s")));
        let figure = Figure {
            title: "How well the AUVs know where they are, and what time it is".to_owned(),
            subtitle: String::new(),
            panels,
            legend,
        };
        Ok(figure.with_at_most(POINTS_MAX))
    }
}
