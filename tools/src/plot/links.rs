//! Who hears whom: in the second before a moment, on the map and as a table, and how many over time.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use shoal_bus::message::AuvId;
use shoal_bus::record::rows::PingRow;
use shoal_bus::record::{BATCH_NS, RecordHeader, Row, Topic};
use shoal_bus::time::NS_PER_S;

use super::groups::{groups, mark};
use super::{Plot, moment_ns};
use crate::figure::{Axis, Colour, Entry, Figure, Layer, Mark, Panel, Sample, Shape};

/// Width and height of a panel, in pixels.
const MAP_PX: [f64; 2] = [420.0, 420.0];

/// Who heard whom in each second, and in the one before a moment.
pub struct Links {
    /// In nanoseconds of true time.
    until_ns: i64,
    /// East and north of everyone at the last tick until then, in metres.
    places: BTreeMap<AuvId, [f64; 2]>,
    /// The receptions of the second before: when, emitter, receiver.
    recent: VecDeque<(i64, AuvId, AuvId)>,
    /// Time of the last tick.
    last_ns: i64,
    /// The pairs of the second that is under way.
    second: i64,
    pairs: BTreeSet<(AuvId, AuvId)>,
    receptions: u64,
    /// Second, pairs and receptions of every second that has ended.
    counts: Vec<[f64; 3]>,
}

impl Links {
    /// In the second before this true time in seconds; at the end of the record unless given.
    pub fn new(at_s: Option<f64>) -> Self {
        Self {
            until_ns: moment_ns(at_s),
            places: BTreeMap::new(),
            recent: VecDeque::new(),
            last_ns: 0,
            second: 0,
            pairs: BTreeSet::new(),
            receptions: 0,
            counts: Vec::new(),
        }
    }

    fn heard(&mut self, t_ns: i64, from: AuvId, to: AuvId) {
        if t_ns <= self.until_ns {
            while self.recent.front().is_some_and(|(at_ns, ..)| *at_ns <= t_ns - NS_PER_S) {
                self.recent.pop_front();
            }
            self.recent.push_back((t_ns, from, to));
        }
        let second = t_ns.div_euclid(NS_PER_S);
        while self.second < second {
            self.end_second();
        }
        self.pairs.insert((from, to));
        self.receptions += 1;
    }

    fn end_second(&mut self) {
        self.counts.push([self.second as f64, self.pairs.len() as f64, self.receptions as f64]);
        self.pairs.clear();
        (self.receptions, self.second) = (0, self.second + 1);
    }

    fn map(&self, header: &RecordHeader, pairs: &BTreeSet<(AuvId, AuvId)>) -> Panel {
        let place = |auv: AuvId| self.places.get(&auv).copied();
        let mut layers: Vec<Layer> = Vec::new();
        for is_mutual in [false, true] {
            let wanted = |(from, to): &&(AuvId, AuvId)| pairs.contains(&(*to, *from)) == is_mutual;
            // One line for both ways.
            let ends = |(from, to): &(AuvId, AuvId)| {
                (!is_mutual || from < to).then_some([place(*from)?, place(*to)?])
            };
            let ends = pairs.iter().filter(wanted).filter_map(ends).collect();
            layers.push(Layer::Segments { colour: colour(is_mutual), ends });
        }
        for (group, _) in groups(header) {
            let is_of = |auv: &AuvId| header.auvs.get(auv.0 as usize).is_some_and(|told| told.group == group);
            let points = self.places.iter().filter(|(auv, _)| is_of(auv)).map(|(_, place)| *place).collect();
            layers.push(Layer::Marks { mark: mark(group), points });
        }
        let bound = |axis: usize, of: fn(f64, f64) -> f64, start: f64| {
            self.places.values().map(|place| place[axis]).filter(|value| value.is_finite()).fold(start, of)
        };
        let least = [0, 1].map(|axis| bound(axis, f64::min, f64::INFINITY));
        let greatest = [0, 1].map(|axis| bound(axis, f64::max, f64::NEG_INFINITY));
        let [x, y] = Axis::map(["x, east (m)", "y, north (m)"], least, greatest, MAP_PX);
        Panel { width_px: MAP_PX[0], x, y, layers }
    }

    fn over_time(&self, end_s: f64) -> Panel {
        let line =
            |which: usize| self.counts.iter().map(move |count| [count[0] + 0.5, count[which]]).collect();
        let greatest =
            self.counts.iter().flat_map(|[_, pairs, receptions]| [*pairs, *receptions]).fold(0.0, f64::max);
        Panel {
            width_px: MAP_PX[0],
            x: Axis::new("true time (s)", 0.0, end_s),
            y: Axis::from_zero("in each second", greatest),
            layers: vec![
                Layer::Line { colour: Colour::Orange, points: line(2) },
                Layer::Line { colour: Colour::Purple, points: line(1) },
            ],
        }
    }
}

/// Of links in one way, and in both.
fn colour(is_mutual: bool) -> Colour {
    if is_mutual { Colour::Grey } else { Colour::Orange }
}

/// Everyone that is heard, over everyone that hears.
fn matrix(auvs: usize, pairs: &BTreeSet<(AuvId, AuvId)>) -> Panel {
    let points = pairs.iter().map(|(from, to)| [f64::from(to.0), f64::from(from.0)]).collect();
    let axis = |label: &str| Axis::new(label, -1.0, auvs as f64);
    Panel {
        width_px: MAP_PX[0],
        x: axis("hears (AUV)"),
        y: axis("is heard (AUV)"),
        layers: vec![Layer::Marks { mark: HEARD, points }],
    }
}

const HEARD: Mark = Mark::new(Shape::Square, Colour::Blue);

impl Plot for Links {
    fn topics(&self) -> &'static [Topic] {
        &[Topic::Ticks, Topic::Pings]
    }

    fn take(&mut self, row: &Row) {
        match row {
            Row::Truth(row) => {
                self.last_ns = row.t_ns.ns();
                if row.t_ns.ns() <= self.until_ns {
                    let [x, y, _] = row.position_m;
                    self.places.insert(row.auv, [x.0, y.0]);
                }
            }
            Row::Ping(PingRow::Heard { t_ns, from, to, .. }) => self.heard(t_ns.ns(), *from, *to),
            _ => {}
        }
    }

    fn figure(mut self: Box<Self>, header: &RecordHeader) -> Result<Figure, String> {
        let last_ns = match self.recent.back() {
            Some((last_ns, ..)) => *last_ns,
            None => return Err("nothing to show: nobody heard anything until then".to_owned()),
        };
        // A second that was cut short says nothing, unless there is no other.
        if self.counts.is_empty() || self.last_ns >= (self.second + 1) * NS_PER_S - BATCH_NS {
            self.end_second();
        }
        let until_ns = if self.until_ns == i64::MAX { last_ns } else { self.until_ns };
        let from_ns = until_ns.saturating_sub(NS_PER_S);
        let recent = self.recent.iter().filter(|(at_ns, ..)| *at_ns > from_ns);
        let pairs: BTreeSet<(AuvId, AuvId)> = recent.map(|(_, from, to)| (*from, *to)).collect();
        let mutual = pairs.iter().filter(|(from, to)| from < to && pairs.contains(&(*to, *from))).count();
        let until_s = until_ns as f64 * 1e-9;
        let end_s = self.counts.len().max(1) as f64;
        let mut legend: Vec<Entry> = groups(header)
            .into_iter()
            .map(|(group, name)| Entry::new(Sample::Mark(mark(group)), name))
            .collect();
        legend.extend([
            Entry::new(Sample::Line(colour(true)), format!("hear each other: {mutual} pairs")),
            Entry::new(
                Sample::Line(colour(false)),
                format!("one hears the other: {}", pairs.len() - 2 * mutual),
            ),
            Entry::new(Sample::Mark(HEARD), format!("heard once or more: {}", pairs.len())),
            Entry::remark("over time:"),
            Entry::new(Sample::Line(Colour::Orange), "receptions"),
            Entry::new(Sample::Line(Colour::Purple), "who heard whom, each pair once"),
        ]);
        let panels = vec![self.map(header, &pairs), matrix(header.auvs.len(), &pairs), self.over_time(end_s)];
        Ok(Figure {
            title: format!("Who hears whom, in the second before {until_s:.3} s and over time"),
            subtitle: String::new(),
            panels,
            legend,
        })
    }
}
