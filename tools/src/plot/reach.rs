//! Where pings are heard and where they are lost, over range and depth of the receiver: shadow zones show.

use std::collections::BTreeMap;

use shoal_bus::record::rows::PingRow;
use shoal_bus::record::{RecordHeader, Row, Topic};
use shoal_bus::traffic::LossReason;

use super::Plot;
use super::depths::Depths;
use super::fate::{Fate, by_fate};
use super::thinned::Thinned;
use crate::figure::{Axis, Entry, Figure, Panel};
use crate::summary_text::grouped;

/// Range and receiver's depth of every ping that reached a receiver.
#[derive(Default)]
pub struct Reach {
    depths: Depths<(Fate, f64)>,
    found: Found,
    out_of_range: u64,
}

/// What has been found, by fate: range and depth in metres.
#[derive(Default)]
struct Found(BTreeMap<Fate, Thinned>);

impl Found {
    fn put(&mut self, (fate, range_m): (Fate, f64), depth_m: f64) {
        self.0.entry(fate).or_default().push([range_m, depth_m]);
    }
}

impl Plot for Reach {
    fn topics(&self) -> &'static [Topic] {
        &[Topic::Ticks, Topic::Pings]
    }

    fn take(&mut self, row: &Row) {
        let Self { depths, found, .. } = self;
        let mut put = |what, depth_m| found.put(what, depth_m);
        match row {
            Row::Truth(row) => depths.tick(row, &mut put),
            Row::Ping(PingRow::Emitted { beyond_range, .. }) => self.out_of_range += u64::from(*beyond_range),
            Row::Ping(PingRow::Lost { reason: LossReason::Range, .. }) => self.out_of_range += 1,
            Row::Ping(PingRow::Heard { t_ns, to, range_m, .. }) => {
                depths.ask(*to, t_ns.ns(), (Fate::Heard, range_m.0), &mut put);
            }
            Row::Ping(PingRow::Lost { t_ns, to: Some(to), range_m, reason, .. }) => {
                depths.ask(*to, t_ns.ns(), (Fate::Lost(*reason), range_m.0), &mut put);
            }
            _ => {}
        }
    }

    fn figure(self: Box<Self>, _: &RecordHeader) -> Result<Figure, String> {
        let Self { mut depths, mut found, out_of_range } = *self;
        depths.end(&mut |what, depth_m| found.put(what, depth_m));
        if found.0.is_empty() {
            return Err(format!(
                "nothing to show: no ping came within range of a receiver ({out_of_range} out of range)"
            ));
        }
        let (mut farthest_m, mut deepest_m) = (0.0_f64, 0.0_f64);
        let mut shallowest_m = 0.0_f64;
        for [range_m, depth_m] in found.0.values().flat_map(Thinned::points) {
            farthest_m = farthest_m.max(*range_m);
            deepest_m = deepest_m.max(*depth_m);
            shallowest_m = shallowest_m.min(*depth_m);
        }
        let (layers, mut legend) = by_fate(&found.0);
        legend.push(Entry::remark(format!("out of range, not drawn: {}", grouped(out_of_range))));
        let panel = Panel {
            width_px: 640.0,
            x: Axis::from_zero("range (m)", farthest_m),
            y: Axis { first: shallowest_m, ..Axis::from_zero("depth of the receiver (m)", deepest_m) }
                .reversed(),
            layers,
        };
        Ok(Figure {
            title: "Where pings are heard".to_owned(),
            subtitle: String::new(),
            panels: vec![panel],
            legend,
        })
    }
}
