//! How far inside the enclosures the truth is, found again from the truth and the reports that a record holds.

use std::collections::{BTreeMap, BTreeSet};

use shoal_bus::message::AuvId;
use shoal_bus::record::Row;
use shoal_bus::record::rows::{Pair, ReportRow, TruthRow};

use super::page::Table;
use crate::summary_text::grouped;

/// Differences of the record's numbers are rounded: a margin that misses by less is none that is missed.
const ROUNDING: f64 = 1e-12;

/// What is checked, and the unit of its margins.
const CHECKS: [(&str, &str); 8] = [
    ("position at a tick, east", "m"),
    ("position at a tick, north", "m"),
    ("position at a tick, up", "m"),
    ("clock at a tick", "s"),
    ("position since the tick before, east", "m"),
    ("position since the tick before, north", "m"),
    ("position since the tick before, up", "m"),
    ("clock since the tick before", "s"),
];

/// The margins of all reports, as far as an AUV promises anything.
#[derive(Default)]
pub struct Margins {
    /// Those that promise nothing.
    exempt: BTreeSet<AuvId>,
    /// The last two truths about each: at the tick, and at the one before.
    truth: BTreeMap<AuvId, [Option<State>; 2]>,
    found: [Found; CHECKS.len()],
}

/// East, north, up in metres, and true minus local time in seconds, at a tick.
#[derive(Clone, Copy)]
struct State {
    t_ns: i64,
    values: [f64; 4],
}

/// What was found of one kind of check.
#[derive(Clone, Copy, Default)]
struct Found {
    checks: u64,
    outside: u64,
    /// The least margin: how far the truth is from the nearer bound, negative outside; whose, and when.
    least: Option<(f64, AuvId, i64)>,
}

impl Found {
    fn check(&mut self, [lower, upper]: Pair, value: f64, auv: AuvId, t_ns: i64) {
        // An empty enclosure holds nothing; one without bounds holds everything.
        let lower = if lower.0.is_nan() { f64::NEG_INFINITY } else { lower.0 };
        let upper = if upper.0.is_nan() { f64::INFINITY } else { upper.0 };
        let margin = (value - lower).min(upper - value);
        self.checks += 1;
        self.outside += u64::from(margin < -ROUNDING);
        if self.least.is_none_or(|(least, ..)| margin < least) {
            self.least = Some((margin, auv, t_ns));
        }
    }
}

impl Margins {
    /// Of all AUVs but those that promise nothing.
    pub fn new(exempt: BTreeSet<AuvId>) -> Self {
        Self { exempt, ..Self::default() }
    }

    /// Takes a row, in the order of the record.
    pub fn take(&mut self, row: &Row) {
        match row {
            Row::Truth(row) if !self.exempt.contains(&row.auv) => self.take_truth(row),
            Row::Report(row) if !self.exempt.contains(&row.auv) => self.take_report(row),
            _ => {}
        }
    }

    fn take_truth(&mut self, row: &TruthRow) {
        let [x, y, z] = row.position_m.map(|side| side.0);
        let clock_s = (row.t_ns.ns() - row.local_ns.ns()) as f64 * 1e-9;
        let state = State { t_ns: row.t_ns.ns(), values: [x, y, z, clock_s] };
        let last = self.truth.entry(row.auv).or_default();
        *last = [Some(state), last[0]];
    }

    fn take_report(&mut self, row: &ReportRow) {
        let auv = row.auv;
        let Some([Some(now), before]) = self.truth.get(&auv).copied() else { return };
        if now.t_ns != row.t_ns.ns() {
            return;
        }
        let [x, y, z] = row.position_m;
        let [slice_x, slice_y, slice_z] = row.slice_position_m;
        let gates = [x, y, z, row.clock_offset_s];
        let slices = [slice_x, slice_y, slice_z, row.slice_clock_offset_s];
        let (at_tick, since) = self.found.split_at_mut(gates.len());
        for (index, found) in at_tick.iter_mut().enumerate() {
            found.check(gates[index], now.values[index], auv, now.t_ns);
        }
        // A slice holds both of its ends, unless a body was born in between.
        for (index, found) in since.iter_mut().enumerate() {
            found.check(slices[index], now.values[index], auv, now.t_ns);
            if let Some(before) = before.filter(|_| row.tick > 0) {
                found.check(slices[index], before.values[index], auv, before.t_ns);
            }
        }
    }

    /// How many comparisons did not hold, of how many.
    pub fn outside(&self) -> (u64, u64) {
        let sum = |of: fn(&Found) -> u64| self.found.iter().map(of).sum();
        (sum(|found| found.outside), sum(|found| found.checks))
    }

    /// A row for each kind; `name` tells what an AUV is called.
    pub fn table(&self, name: impl Fn(AuvId) -> String) -> Table {
        let mut table = Table::new(&["enclosure", "checked", "truth outside", "least margin", "of", "at"]);
        for (found, (what, unit)) in self.found.iter().zip(CHECKS) {
            let (margin, auv, at) = match found.least {
                Some((margin, auv, t_ns)) => {
                    // At most rounding.
                    let margin = if margin.abs() <= ROUNDING { 0.0 } else { margin };
                    let margin = in_unit(margin, unit);
                    (margin, name(auv), format!("{:.3} s", t_ns as f64 * 1e-9))
                }
                None => ("–".to_owned(), "–".to_owned(), "–".to_owned()),
            };
            table.row([what.to_owned(), grouped(found.checks), grouped(found.outside), margin, auv, at]);
        }
        table
    }
}

/// Three significant digits.
pub fn significant(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return if value.is_finite() { "0".to_owned() } else { "unbounded".to_owned() };
    }
    let size = value.abs();
    let mut decimals = 2_usize;
    let mut limit = 1.0;
    while size < limit && decimals < 15 {
        decimals += 1;
        limit *= 0.1;
    }
    let spare = if size >= 100.0 { 2 } else { usize::from(size >= 10.0) };
    format!("{value:.*}", decimals.saturating_sub(spare))
}

/// Three significant digits in the unit, or in thousandths of it as small as needed.
pub fn in_unit(value: f64, unit: &str) -> String {
    let mut scaled = value;
    for prefix in ["", "m", "µ"] {
        if scaled == 0.0 || scaled.abs() >= 1.0 || !scaled.is_finite() {
            return format!("{} {prefix}{unit}", significant(scaled));
        }
        scaled *= 1e3;
    }
    format!("{} n{unit}", significant(scaled))
}

#[cfg(test)]
mod tests {
    use shoal_bus::record::rows::Real;

    use super::*;

    #[test]
    fn margins_are_distances_to_the_nearer_bound() {
        let mut found = Found::default();
        let pair = |lower, upper| [Real(lower), Real(upper)];
        found.check(pair(0.0, 10.0), 4.0, AuvId(1), 5);
        found.check(pair(0.0, 10.0), 9.0, AuvId(2), 6);
        found.check(pair(f64::NAN, 10.0), -1e9, AuvId(3), 7);
        assert_eq!((found.checks, found.outside, found.least), (3, 0, Some((1.0, AuvId(2), 6))));
        found.check(pair(0.0, 10.0), 10.5, AuvId(4), 8);
        assert_eq!((found.outside, found.least), (1, Some((-0.5, AuvId(4), 8))));
    }

    #[test]
    fn numbers_have_three_digits() {
        let texts =
            [0.0, 1.2345, 12.345, 123.45, 12345.0, 0.012345, -0.00012345, f64::INFINITY].map(significant);
        let lengths = [0.0, 12.34, 0.01234, -1.5e-6, 2.6e-8, 1e-10].map(|value| in_unit(value, "m"));
        assert_eq!(lengths, ["0 m", "12.3 m", "12.3 mm", "-1.50 µm", "26.0 nm", "0.100 nm"]);
        assert_eq!(texts, ["0", "1.23", "12.3", "123", "12345", "0.0123", "-0.000123", "unbounded"]);
    }
}
