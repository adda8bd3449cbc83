//! What became of pings, by range.

use std::collections::{BTreeMap, BTreeSet};

use shoal_bus::record::Row;
use shoal_bus::record::rows::PingRow;
use shoal_bus::traffic::LossReason;

use super::page::Table;
use crate::plot::Fate;
use crate::summary_text::grouped;

/// With more bins than this, two become one.
const BINS_MAX: u64 = 12;

/// Length of a bin at first, in metres.
const BIN_M: u64 = 10;

/// Receptions, by range and fate.
pub struct Fates {
    bin_m: u64,
    /// By bin, then by fate.
    counts: BTreeMap<u64, BTreeMap<Fate, u64>>,
}

impl Default for Fates {
    fn default() -> Self {
        Self { bin_m: BIN_M, counts: BTreeMap::new() }
    }
}

impl Fates {
    /// Takes a row; those that are out of range by far have no row of their own.
    pub fn take(&mut self, row: &Row) {
        let Row::Ping(row) = row else { return };
        let range_m = match row {
            PingRow::Lost { reason: LossReason::Range, .. } => return,
            PingRow::Heard { range_m, .. } | PingRow::Lost { to: Some(_), range_m, .. } => range_m.0,
            _ => return,
        };
        let Some(fate) = Fate::of(row).filter(|_| (0.0..1e12).contains(&range_m)) else { return };
        while range_m as u64 / self.bin_m >= BINS_MAX {
            self.widen();
        }
        let bin = range_m as u64 / self.bin_m;
        *self.counts.entry(bin).or_default().entry(fate).or_default() += 1;
    }

    fn widen(&mut self) {
        let mut counts: BTreeMap<u64, BTreeMap<Fate, u64>> = BTreeMap::new();
        for (bin, of_bin) in &self.counts {
            let wider = counts.entry(bin / 2).or_default();
            of_bin.iter().for_each(|(fate, count)| *wider.entry(*fate).or_default() += count);
        }
        (self.bin_m, self.counts) = (2 * self.bin_m, counts);
    }

    /// A row for each bin, a column for each fate; `None` where nothing came to a receiver.
    pub fn table(&self) -> Option<Table> {
        let fates: BTreeSet<Fate> = self.counts.values().flat_map(|of_bin| of_bin.keys().copied()).collect();
        let last = *self.counts.keys().last()?;
        let mut table = Table::new(&["range"]);
        table.head.extend(fates.iter().map(|fate| fate.name().to_owned()));
        table.head.push("heard of these".to_owned());
        for bin in 0..=last {
            let of_bin = self.counts.get(&bin);
            let count = |fate: &Fate| of_bin.and_then(|counts| counts.get(fate)).copied().unwrap_or(0);
            let all: u64 = fates.iter().map(count).sum();
            let heard = match all {
                0 => "–".to_owned(),
                all => format!("{:.1} %", 100.0 * count(&Fate::Heard) as f64 / all as f64),
            };
            let range = format!("{} m to {} m", grouped(bin * self.bin_m), grouped((bin + 1) * self.bin_m));
            table
                .row([range].into_iter().chain(fates.iter().map(|fate| grouped(count(fate)))).chain([heard]));
        }
        Some(table)
    }
}

#[cfg(test)]
mod tests {
    use shoal_bus::message::AuvId;
    use shoal_bus::record::rows::Real;
    use shoal_bus::time::SimTime;

    use super::*;

    fn lost(range_m: f64, reason: LossReason) -> Row {
        Row::Ping(PingRow::Lost {
            t_ns: SimTime::from_ns(0),
            from: AuvId(0),
            sequence: 0,
            to: Some(AuvId(1)),
            reason,
            range_m: Real(range_m),
            reception: None,
            colliding: vec![],
        })
    }

    #[test]
    fn bins_widen_and_count_everything_that_came_to_a_receiver() {
        let mut fates = Fates::default();
        for range_m in [5.0, 15.0, 115.0, 900.0, f64::NAN] {
            fates.take(&lost(range_m, LossReason::Noise));
        }
        fates.take(&lost(5.0, LossReason::Collision));
        fates.take(&lost(5.0, LossReason::Range));
        let table = fates.table().unwrap();
        assert_eq!(table.head, ["range", "lost in noise", "lost by collision", "heard of these"]);
        assert_eq!(table.rows.len(), 12);
        assert_eq!(table.rows[0], ["0 m to 80 m", "2", "1", "0.0 %"]);
        assert_eq!(table.rows[1], ["80 m to 160 m", "1", "0", "0.0 %"]);
        assert_eq!(table.rows[11], ["880 m to 960 m", "1", "0", "0.0 %"]);
        assert_eq!(table.rows[5][3], "–");
        assert!(Fates::default().table().is_none());
    }
}
