//! Where the last pings that one AUV heard let it be: a ring around each emitter, and the sub-paving of what lies in all of them.
//!
//! A record holds boxes, which are what is left of such a set when it is told in the fewest numbers. Here the set is found again from
//! what the AUV was told: a ping heard at local time s from a box `[p]` emitted in `[a]` travelled a range in `[c] ([t](s) - [a])`.
//! Each ring is widened by all that may be wrong of it: by the diagonal of `[p]`, by what the clock may have drifted since, and by
//! how far the body may have gone. The depth is taken from the report.

use std::collections::VecDeque;

use nalgebra::Vector2;
use shoal_bus::message::{AuvId, Born, Bounds, BoundsBox, Sense};
use shoal_bus::ping::{Payload, Ping};
use shoal_bus::record::rows::{Pair, ReportRow, TruthRow};
use shoal_bus::record::{RecordHeader, Row, Topic};
use shoal_interval::paving::{Options, Paving as Parts, pave};
use shoal_interval::separator::{Ring, q_intersection};
use shoal_interval::{Interval, IntervalBox};

use super::{Plot, moment_ns, told};
use crate::figure::{Axis, Colour, Entry, Figure, Layer, Mark, Panel, Sample, Shape};

/// So many of the last pings are drawn.
const PINGS_MAX: usize = 12;

/// Width and height of the panel, in pixels.
const PANEL_PX: [f64; 2] = [560.0, 420.0];

/// Boxes are not cut finer than this part of the map.
const PRECISION: f64 = 1.0 / 256.0;

/// Sums and products of the record's numbers are rounded by less than this, in metres.
const ROUNDING_M: f64 = 1e-6;

const TRUTH: Mark = Mark::new(Shape::Cross, Colour::Black);
const EMITTER: Mark = Mark::new(Shape::Triangle, Colour::Vermillion);

/// What one AUV heard until a moment.
pub struct Paving {
    auv: AuvId,
    until_ns: i64,
    born: Option<Box<Born>>,
    truth: Option<TruthRow>,
    report: Option<Box<ReportRow>>,
    heard: VecDeque<Heard>,
}

/// A ping, with the report that was the last one then.
struct Heard {
    stamp_ns: i64,
    ping: Ping,
    report: Box<ReportRow>,
}

/// All places that a ping allows, seen from above.
struct Range {
    centre_m: [f64; 2],
    radius_m: [f64; 2],
}

impl Paving {
    /// Of this AUV at this true time in seconds; at the end of the record unless given.
    pub fn new(auv: u32, at_s: Option<f64>) -> Self {
        Self {
            auv: AuvId(auv),
            until_ns: moment_ns(at_s),
            born: None,
            truth: None,
            report: None,
            heard: VecDeque::new(),
        }
    }

    fn hear(&mut self, stamp_ns: i64, ping: Ping) {
        let Some(report) = self.report.clone() else { return };
        if self.heard.len() == PINGS_MAX {
            self.heard.pop_front();
        }
        self.heard.push_back(Heard { stamp_ns, ping, report });
    }
}

/// Bound of the speed over ground in m/s, in any direction.
fn fastest_m_s(born: &Born) -> f64 {
    let norm = |of: &BoundsBox| {
        of.iter()
            .map(|side| side.lower.abs().max(side.upper.abs()))
            .map(|part| part * part)
            .sum::<f64>()
            .sqrt()
    };
    born.body.speed_m_s + norm(&born.body.current_m_s) + norm(&born.body.disturbance_m_s)
}

/// The ring that a ping leaves of the plane at the AUV's last tick, whose local time is `now_ns`.
fn range(born: &Born, heard: &Heard, now_ns: i64) -> Option<Range> {
    let Heard { stamp_ns, ping, report } = heard;
    let drift = born.clock.drift;
    let report_ns = report.local_ns?.ns();
    // By how much true minus local time may have changed between the reception and the report.
    let apart_s = (report_ns - stamp_ns).abs() as f64 * 1e-9;
    let slack_s =
        drift / (1.0 - drift) * apart_s + born.modem.timestamp_s + 2e-9 + 1e-9 * born.clock.stamp_ns as f64;
    let stamp_s = *stamp_ns as f64 * 1e-9;
    let [offset_lower, offset_upper] = report.clock_offset_s;
    let received_s = [stamp_s + offset_lower.0 - slack_s, stamp_s + offset_upper.0 + slack_s];
    let sound = born.modem.sound_speed_m_s;
    let least_m = (sound.lower * (received_s[0] - ping.emission_s.upper)).max(0.0);
    let greatest_m = sound.upper * (received_s[1] - ping.emission_s.lower);
    let moved = |ns: i64| fastest_m_s(born) * ns.abs() as f64 * 1e-9 / (1.0 - drift);
    // How far above or below the emitter it was.
    let [_, _, z] = report.position_m;
    let [.., emitter_z] = ping.position_m;
    let sway_m = moved(report_ns - stamp_ns);
    let above_m = [z[0].0 - emitter_z.upper - sway_m, z[1].0 - emitter_z.lower + sway_m];
    let highest_m = above_m[0].abs().max(above_m[1].abs());
    let lowest_m =
        if above_m[0] <= 0.0 && above_m[1] >= 0.0 { 0.0 } else { above_m[0].abs().min(above_m[1].abs()) };
    let leg = |range_m: f64, height_m: f64| (range_m * range_m - height_m * height_m).max(0.0).sqrt();
    let [x, y, _] = ping.position_m;
    let middle = |side: Bounds| 0.5 * side.lower + 0.5 * side.upper;
    let half = |side: Bounds| 0.5 * (side.upper - side.lower);
    let wider_m = (half(x) * half(x) + half(y) * half(y)).sqrt() + moved(now_ns - stamp_ns) + ROUNDING_M;
    let radius_m = [(leg(least_m, highest_m) - wider_m).max(0.0), leg(greatest_m, lowest_m) + wider_m];
    let is_finite = radius_m.iter().all(|radius_m| radius_m.is_finite());
    is_finite.then_some(Range { centre_m: [middle(x), middle(y)], radius_m })
}

/// `[least, greatest]` of what is to be shown along an axis: the report, and all that every ring reaches.
fn reach(of_report: Pair, ranges: &[Range], axis: usize) -> [f64; 2] {
    let least =
        ranges.iter().map(|range| range.centre_m[axis] - range.radius_m[1]).fold(f64::NEG_INFINITY, f64::max);
    let greatest =
        ranges.iter().map(|range| range.centre_m[axis] + range.radius_m[1]).fold(f64::INFINITY, f64::min);
    let [lower, upper] = of_report.map(|bound| bound.0);
    // Rings that have nothing in common leave the report.
    if least <= greatest { [least.min(lower), greatest.max(upper)] } else { [lower, upper] }
}

fn bars(boxes: &[IntervalBox<2>]) -> Vec<[f64; 4]> {
    boxes.iter().map(|part| [part[0].lower(), part[0].upper(), part[1].lower(), part[1].upper()]).collect()
}

impl Plot for Paving {
    fn topics(&self) -> &'static [Topic] {
        &[Topic::Born, Topic::Ticks, Topic::Reports, Topic::Sensed]
    }

    fn take(&mut self, row: &Row) {
        match row {
            Row::Born(born) if born.auv == self.auv => self.born = Some(born.clone()),
            Row::Truth(row) if row.auv == self.auv && row.t_ns.ns() <= self.until_ns => {
                self.truth = Some(row.clone());
            }
            Row::Report(row) if row.auv == self.auv && row.t_ns.ns() <= self.until_ns => {
                self.report = Some(row.clone());
            }
            Row::Sensed { at, auv, sensed } if *auv == self.auv && at.ns() <= self.until_ns => {
                for event in &sensed.events {
                    if let Sense::Heard { frame } = &event.sense
                        && let Ok(Payload::Intervals(ping)) = Payload::decode(frame)
                    {
                        self.hear(event.stamp.ns(), ping);
                    }
                }
            }
            _ => {}
        }
    }

    fn figure(self: Box<Self>, header: &RecordHeader) -> Result<Figure, String> {
        let name = &told(header, self.auv)?.name;
        let (Some(born), Some(truth), Some(report)) = (&self.born, &self.truth, &self.report) else {
            return Err(format!("nothing to show: the record does not tell what {name} knew until then"));
        };
        let now_ns = report.local_ns.ok_or("nothing to show: the last report has no local time")?.ns();
        let ranges: Vec<Range> = self.heard.iter().filter_map(|heard| range(born, heard, now_ns)).collect();
        if ranges.is_empty() {
            return Err(format!(
                "nothing to show: {name} heard no ping until then, and a set without measurements is no more than its box"
            ));
        }
        let [x_reach, y_reach] = [0, 1].map(|axis| reach(report.position_m[axis], &ranges, axis));
        let [x, y] = Axis::map(
            ["x, east (m)", "y, north (m)"],
            [x_reach[0], y_reach[0]],
            [x_reach[1], y_reach[1]],
            PANEL_PX,
        );
        let Solved { parts, wrong } = solve(&ranges, [&x, &y])?;
        let [[left, right], [low, high]] =
            [0, 1].map(|axis: usize| report.position_m[axis].map(|bound| bound.0));
        let mut layers = vec![
            Layer::Bars { colour: Colour::Sky, bars: bars(parts.inner()) },
            Layer::Bars { colour: Colour::Yellow, bars: bars(parts.boundary()) },
        ];
        for range in &ranges {
            let circles =
                range.radius_m.map(|radius_m| Layer::circle(Colour::Grey, range.centre_m, radius_m));
            layers.extend(circles);
        }
        let [true_x, true_y, _] = truth.position_m;
        layers.extend([
            Layer::Boxes { colour: Colour::Blue, boxes: vec![[left, right, low, high]] },
            Layer::Marks { mark: EMITTER, points: ranges.iter().map(|range| range.centre_m).collect() },
            Layer::Marks { mark: TRUTH, points: vec![[true_x.0, true_y.0]] },
        ]);
        let pings = ranges.len();
        let mut legend = vec![
            Entry::new(Sample::Area(Colour::Sky), "proved to be in all rings"),
            Entry::new(Sample::Area(Colour::Yellow), "undecided"),
            Entry::new(Sample::Line(Colour::Grey), format!("rings of the last {pings} pings heard")),
            Entry::new(Sample::Mark(EMITTER), "middle of an emitter's box"),
            Entry::new(Sample::Line(Colour::Blue), "box that it reported"),
            Entry::new(Sample::Mark(TRUTH), "truth"),
        ];
        if wrong > 0 {
            legend.push(Entry::remark(format!("in all rings but {wrong}: fewer leave nothing")));
        }
        legend.push(Entry::remark("white: no place, as far as these pings tell"));
        let at_s = report.t_ns.as_s();
        Ok(Figure {
            title: format!("Where the last pings let {name} (AUV {}) be, at {at_s:.3} s", self.auv),
            subtitle: String::new(),
            panels: vec![Panel { width_px: PANEL_PX[0], x, y, layers }],
            legend,
        })
    }
}

/// The set of places, and the fewest pings that must be wrong for there to be one.
struct Solved {
    parts: Parts<2>,
    wrong: usize,
}

fn solve(ranges: &[Range], axes: [&Axis; 2]) -> Result<Solved, String> {
    let wrong = |error: &dyn std::fmt::Display| format!("the set cannot be paved: {error}");
    let interval = |lower: f64, upper: f64| Interval::new(lower, upper).map_err(|error| wrong(&error));
    let ring = |range: &Range| {
        let [x, y] = range.centre_m;
        Ok(Ring::new(Vector2::new(x, y), interval(range.radius_m[0], range.radius_m[1])?))
    };
    let rings: Vec<Ring<2>> = ranges.iter().map(ring).collect::<Result<_, String>>()?;
    let [x, y] = axes;
    let initial = IntervalBox::from([interval(x.first, x.last)?, interval(y.first, y.last)?]);
    let options = Options::new((x.last - x.first) * PRECISION);
    let mut wrong_pings = 0;
    loop {
        let parts = pave(&q_intersection(&rings[..], wrong_pings), initial, &options)
            .map_err(|error| wrong(&error))?;
        // As many wrong ones as there are leave everything.
        if !parts.proves_empty() || wrong_pings >= rings.len() {
            return Ok(Solved { parts, wrong: wrong_pings });
        }
        wrong_pings += 1;
    }
}
