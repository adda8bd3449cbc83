//! What became of the pings, over time: bars, one upon the other.

use std::collections::BTreeMap;

use shoal_bus::record::rows::PingRow;
use shoal_bus::record::{BATCH_NS, RecordHeader, Row, Topic};
use shoal_bus::time::NS_PER_S;
use shoal_bus::traffic::LossReason;

use super::Plot;
use super::fate::Fate;
use crate::figure::{Axis, Entry, Figure, Layer, Panel, Sample};
use crate::summary_text::grouped;

/// More bars than this are made wider.
const BARS_MAX: u64 = 100;

/// Counts of fates in bars of equal duration.
pub struct Losses {
    /// Duration of a bar.
    bar_ns: i64,
    /// By fate, then by bar.
    counts: BTreeMap<Fate, BTreeMap<u64, u64>>,
    /// Receptions out of range, which a figure has no room for.
    beyond_range: u64,
    /// Pings that never left.
    unsent: u64,
    emitted: u64,
}

impl Default for Losses {
    fn default() -> Self {
        Self { bar_ns: BATCH_NS, counts: BTreeMap::new(), beyond_range: 0, unsent: 0, emitted: 0 }
    }
}

impl Losses {
    fn count(&mut self, t_ns: i64, fate: Fate) {
        let at_ns = t_ns.max(0);
        while at_ns / self.bar_ns >= BARS_MAX as i64 {
            self.widen();
        }
        let bar = (at_ns / self.bar_ns) as u64;
        *self.counts.entry(fate).or_default().entry(bar).or_default() += 1;
    }

    /// From 0.1 s to 0.2 s, 1 s, 2 s, 10 s and so on.
    fn widen(&mut self) {
        let mut decade_ns = BATCH_NS;
        while decade_ns * 10 <= self.bar_ns {
            decade_ns *= 10;
        }
        let factor: u64 = if self.bar_ns == decade_ns { 2 } else { 5 };
        self.bar_ns *= factor as i64;
        for counts in self.counts.values_mut() {
            let mut wider = BTreeMap::new();
            for (bar, count) in &*counts {
                *wider.entry(bar / factor).or_default() += count;
            }
            *counts = wider;
        }
    }

    fn last_bar(&self) -> u64 {
        self.counts.values().filter_map(|counts| counts.keys().last()).copied().max().unwrap_or(0)
    }
}

impl Plot for Losses {
    fn topics(&self) -> &'static [Topic] {
        &[Topic::Pings]
    }

    fn take(&mut self, row: &Row) {
        let Row::Ping(row) = row else { return };
        match row {
            PingRow::Emitted { beyond_range, .. } => {
                self.emitted += 1;
                self.beyond_range += u64::from(*beyond_range);
            }
            PingRow::Lost { to: None, .. } => self.unsent += 1,
            PingRow::Lost { reason: LossReason::Range, .. } => self.beyond_range += 1,
            PingRow::Lost { t_ns, .. } | PingRow::Heard { t_ns, .. } => {
                if let Some(fate) = Fate::of(row) {
                    self.count(t_ns.ns(), fate);
                }
            }
        }
    }

    fn figure(self: Box<Self>, _: &RecordHeader) -> Result<Figure, String> {
        if self.counts.is_empty() {
            let (emitted, beyond) = (self.emitted, self.beyond_range);
            return Err(format!(
                "nothing to show: of {emitted} pings emitted, none came within range of another AUV ({beyond} \
                 receptions out of range)"
            ));
        }
        let bar_s = self.bar_ns as f64 / NS_PER_S as f64;
        let mut heights = vec![0_u64; self.last_bar() as usize + 1];
        let (mut layers, mut legend) = (Vec::new(), Vec::new());
        for (fate, counts) in &self.counts {
            let colour = fate.mark().colour;
            let mut bars = Vec::new();
            for (&bar, &count) in counts {
                let height = &mut heights[bar as usize];
                let from_s = bar as f64 * bar_s;
                let rate = |count: u64| count as f64 / bar_s;
                bars.push([from_s, from_s + bar_s, rate(*height), rate(*height + count)]);
                *height += count;
            }
            layers.push(Layer::Bars { colour, bars });
            let total: u64 = counts.values().sum();
            legend.push(Entry::new(Sample::Area(colour), format!("{}: {}", fate.name(), grouped(total))));
        }
        // The uppermost bar comes first in the legend, as in the figure.
        legend.reverse();
        legend.push(Entry::remark("not drawn:"));
        legend.push(Entry::remark(format!("out of range: {}", grouped(self.beyond_range))));
        legend.push(Entry::remark(format!("never left: {}", grouped(self.unsent))));
        legend.push(Entry::remark(format!("pings emitted: {}", grouped(self.emitted))));
        let greatest = heights.iter().copied().max().unwrap_or(0) as f64 / bar_s;
        let end_s = heights.len() as f64 * bar_s;
        let panel = Panel {
            width_px: 640.0,
            x: Axis::new("true time (s)", 0.0, end_s),
            y: Axis::from_zero("receptions per second", greatest),
            layers,
        };
        Ok(Figure {
            title: "What became of the pings at their receivers".to_owned(),
            subtitle: String::new(),
            panels: vec![panel],
            legend,
        })
    }
}
