//! How far packets stand out of noise and interference, over range.

use std::collections::BTreeMap;

use shoal_bus::record::rows::{PingRow, ReceptionRow};
use shoal_bus::record::{RecordHeader, Row, Topic};

use super::Plot;
use super::fate::{Fate, by_fate};
use super::thinned::Thinned;
use crate::figure::{Axis, Entry, Figure, Panel};
use crate::summary_text::grouped;

/// Range and ratio of every packet that arrived.
#[derive(Default)]
pub struct Sinr {
    /// By fate: range in metres, ratio in dB.
    series: BTreeMap<Fate, Thinned>,
    /// Receptions without a ratio.
    unknown: u64,
}

impl Plot for Sinr {
    fn topics(&self) -> &'static [Topic] {
        &[Topic::Pings]
    }

    fn take(&mut self, row: &Row) {
        let Row::Ping(row) = row else { return };
        let (PingRow::Heard { range_m, reception, .. } | PingRow::Lost { range_m, reception, .. }) = row
        else {
            return;
        };
        match (Fate::of(row), reception) {
            (Some(fate), Some(ReceptionRow { sinr_db, .. })) if sinr_db.0.is_finite() => {
                self.series.entry(fate).or_default().push([range_m.0, sinr_db.0]);
            }
            (Some(_), _) => self.unknown += 1,
            (None, _) => {}
        }
    }

    fn figure(self: Box<Self>, _: &RecordHeader) -> Result<Figure, String> {
        let unknown = self.unknown;
        if self.series.is_empty() {
            return Err(format!(
                "nothing to show: none of {unknown} receptions has a ratio of signal to noise; there is one at level `sea`"
            ));
        }
        let mut farthest_m = 0.0_f64;
        let (mut least_db, mut greatest_db) = (f64::INFINITY, f64::NEG_INFINITY);
        for [range_m, sinr_db] in self.series.values().flat_map(Thinned::points) {
            farthest_m = farthest_m.max(*range_m);
            least_db = least_db.min(*sinr_db);
            greatest_db = greatest_db.max(*sinr_db);
        }
        let (layers, mut legend) = by_fate(&self.series);
        legend.push(Entry::remark(format!("without a ratio, not drawn: {}", grouped(unknown))));
        let panel = Panel {
            width_px: 640.0,
            x: Axis::from_zero("range (m)", farthest_m),
            y: Axis::around("signal over noise and interference (dB)", least_db, greatest_db),
            layers,
        };
        Ok(Figure {
            title: "How far packets stand out of noise and interference".to_owned(),
            subtitle: String::new(),
            panels: vec![panel],
            legend,
        })
    }
}
