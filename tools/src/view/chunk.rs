//! One simulated second `[k, k + 1)` of a run, gathered from the rows of its record in their order.

mod layout;

use std::collections::BTreeMap;

use shoal_bus::message::AuvId;
use shoal_bus::record::Row;
use shoal_bus::record::rows::{FlockRow, Pair, PingRow, ReportRow, TruthRow};
use shoal_bus::time::{NS_PER_S, SimTime};
use shoal_bus::traffic::LossReason;

pub use layout::{FATES, ROW_BYTES, TrackPart};

/// Rows may come this much after others that are later: those of one batch of a record come topic by topic.
const DISORDER_NS: i64 = shoal_bus::record::BATCH_NS;

/// A row beyond this second is not believed.
const LAST_SECOND: i64 = 1 << 30;

/// An AUV at one of its ticks.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    t_ns: i64,
    tick: u64,
    position_m: [f64; 3],
    heading_rad: f64,
    pitch_rad: f64,
    /// True minus local time.
    clock_offset_s: f64,
    /// Absent when it answered nothing.
    belief: Option<Belief>,
}

/// What an AUV believed at a tick.
#[derive(Clone, Debug, PartialEq)]
struct Belief {
    position_m: [[f64; 2]; 3],
    clock_offset_s: [f64; 2],
    slice_position_m: [[f64; 2]; 3],
    slice_clock_offset_s: [f64; 2],
    neighbours: u16,
    contractions: u16,
    emptied: bool,
    /// Whether it holds the truth, in position and clock.
    holds: bool,
}

/// A ping that left a modem.
#[derive(Clone, Debug, PartialEq)]
struct Emission {
    t_ns: i64,
    from: u32,
    position_m: [f64; 3],
}

/// A second in the making.
#[derive(Clone, Debug)]
struct Open {
    /// By AUV.
    samples: Vec<Vec<Sample>>,
    emissions: Vec<Emission>,
    /// When the second AUV last heard the first, for links where ranges are not sharp.
    heard: BTreeMap<(u32, u32), i64>,
    /// By receiver, by fate: heard, then the reasons of losses.
    fates: Vec<[u32; FATES]>,
    /// Of all pings, with those beyond range.
    totals: [u64; FATES],
    flock: Option<FlockRow>,
}

/// A second, as the page reads it.
#[derive(Clone, Debug, PartialEq)]
pub struct Chunk {
    /// Which second.
    pub second: u32,
    /// Everything that is seen of all AUVs.
    pub scene: Vec<u8>,
    /// What is charted of each AUV.
    pub tracks: Vec<u8>,
    /// A line about the swarm for the charts, as JSON.
    pub figures: String,
}

/// Gathers rows into seconds.
pub struct Gatherer {
    auvs: usize,
    receptions: bool,
    open: BTreeMap<u32, Open>,
    /// By AUV: its last sample before the seconds that are open.
    before: Vec<Option<Sample>>,
    /// Seconds before this one are closed.
    closed: u32,
}

impl Gatherer {
    /// For a run of so many AUVs; with who heard whom, or without.
    pub fn new(auvs: usize, receptions: bool) -> Self {
        Self { auvs, receptions, open: BTreeMap::new(), before: vec![None; auvs], closed: 0 }
    }

    /// Takes the next row, and hands over the seconds that are complete by then.
    pub fn take(&mut self, row: &Row, done: &mut dyn FnMut(Chunk)) {
        let at = match row {
            Row::Truth(row) => self.truth(row),
            Row::Report(row) => self.report(row),
            Row::Ping(row) => self.ping(row),
            Row::Flock(row) => self.flock(row),
            Row::Header(_)
            | Row::Sensed { .. }
            | Row::Born(_)
            | Row::Offline(_)
            | Row::Poses(_)
            | Row::Log(_)
            | Row::Summary(_) => None,
        };
        if let Some(at) = at {
            while let Some(entry) = self.open.first_entry() {
                if (i64::from(*entry.key()) + 1) * NS_PER_S + DISORDER_NS >= at.ns() {
                    break;
                }
                let (second, open) = entry.remove_entry();
                done(self.close(second, open));
            }
        }
    }

    /// Hands over what is left, complete or not.
    pub fn finish(mut self, done: &mut dyn FnMut(Chunk)) {
        while let Some((second, open)) = self.open.pop_first() {
            done(self.close(second, open));
        }
    }

    fn close(&mut self, second: u32, open: Open) -> Chunk {
        let chunk = layout::chunk(second, &open, &self.before, self.receptions);
        for (before, samples) in self.before.iter_mut().zip(open.samples) {
            *before = samples.into_iter().next_back().or(before.take());
        }
        self.closed = second + 1;
        chunk
    }

    /// The second that holds `at`; none that is over, or unlikely.
    fn at(&mut self, at: SimTime) -> Option<&mut Open> {
        let second = at.ns().div_euclid(NS_PER_S);
        let second = u32::try_from(second).ok().filter(|_| second < LAST_SECOND)?;
        let auvs = self.auvs;
        (second >= self.closed).then(|| self.open.entry(second).or_insert_with(|| Open::new(auvs)))
    }

    fn truth(&mut self, row: &TruthRow) -> Option<SimTime> {
        let samples = self.at(row.t_ns)?.samples.get_mut(index(row.auv))?;
        samples.push(Sample {
            t_ns: row.t_ns.ns(),
            tick: row.tick,
            position_m: row.position_m.map(|metres| metres.0),
            heading_rad: row.heading_rad.0,
            pitch_rad: row.pitch_rad.0,
            // Both are within centuries of zero.
            clock_offset_s: row.t_ns.ns().saturating_sub(row.local_ns.ns()) as f64 * 1e-9,
            belief: None,
        });
        Some(row.t_ns)
    }

    /// What an AUV answered comes after the truth at its tick, in the same batch.
    fn report(&mut self, row: &ReportRow) -> Option<SimTime> {
        let samples = self.at(row.t_ns)?.samples.get_mut(index(row.auv))?;
        let sample = samples.iter_mut().rev().find(|sample| sample.tick == row.tick)?;
        let belief = Belief {
            position_m: row.position_m.map(ends),
            clock_offset_s: ends(row.clock_offset_s),
            slice_position_m: row.slice_position_m.map(ends),
            slice_clock_offset_s: ends(row.slice_clock_offset_s),
            neighbours: row.neighbours,
            contractions: row.contractions,
            emptied: row.emptied.is_some(),
            holds: false,
        };
        sample.belief = Some(Belief { holds: belief.holds(sample), ..belief });
        Some(row.t_ns)
    }

    fn ping(&mut self, row: &PingRow) -> Option<SimTime> {
        let receptions = self.receptions;
        match row {
            PingRow::Emitted { t_ns, from, position_m, beyond_range, .. } => {
                let open = self.at(*t_ns)?;
                let position_m = position_m.map(|metres| metres.0);
                open.emissions.push(Emission { t_ns: t_ns.ns(), from: from.0, position_m });
                add(&mut open.totals, LossReason::Range as usize + 1, u64::from(*beyond_range));
                Some(*t_ns)
            }
            PingRow::Heard { t_ns, from, to, .. } => {
                let open = self.at(*t_ns)?;
                if receptions {
                    open.heard.insert((from.0, to.0), t_ns.ns());
                }
                open.fate(Some(*to), 0);
                Some(*t_ns)
            }
            PingRow::Lost { t_ns, to, reason, .. } => {
                self.at(*t_ns)?.fate(*to, *reason as usize + 1);
                Some(*t_ns)
            }
        }
    }

    /// Figures at a whole second are those of the second before it.
    fn flock(&mut self, row: &FlockRow) -> Option<SimTime> {
        let at = SimTime::from_ns((row.t_ns.ns() - 1).max(0));
        self.at(at)?.flock = Some(*row);
        Some(at)
    }
}

impl Open {
    fn new(auvs: usize) -> Self {
        Self {
            samples: vec![Vec::new(); auvs],
            emissions: Vec::new(),
            heard: BTreeMap::new(),
            fates: vec![[0; FATES]; auvs],
            totals: [0; FATES],
            flock: None,
        }
    }

    fn fate(&mut self, to: Option<AuvId>, fate: usize) {
        add(&mut self.totals, fate, 1);
        let of = to.and_then(|to| self.fates.get_mut(index(to))).and_then(|fates| fates.get_mut(fate));
        if let Some(count) = of {
            *count = count.saturating_add(1);
        }
    }
}

impl Belief {
    /// The truth is inside; a clock reads whole nanoseconds, so that the true offset is up to one less than what it says.
    fn holds(&self, truth: &Sample) -> bool {
        let inside = |[lower, upper]: [f64; 2], truth: f64, error: f64| {
            lower - error <= truth && truth <= upper + error
        };
        let in_box = self.position_m.iter().zip(truth.position_m).all(|(side, at)| inside(*side, at, 0.0));
        in_box && inside(self.clock_offset_s, truth.clock_offset_s, 1e-9)
    }

    /// The longest side of the box.
    fn width_m(&self) -> f64 {
        self.position_m.iter().map(|[lower, upper]| upper - lower).fold(0.0, f64::max)
    }
}

fn add(totals: &mut [u64; FATES], fate: usize, count: u64) {
    if let Some(total) = totals.get_mut(fate) {
        *total += count;
    }
}

fn ends(of: Pair) -> [f64; 2] {
    of.map(|end| end.0)
}

fn index(auv: AuvId) -> usize {
    usize::try_from(auv.0).unwrap_or(usize::MAX)
}

#[cfg(test)]
mod tests;
