//! Answers that come too late, counted: where AUVs run freely, nobody waits for them.

use shoal_bus::summary::{FreeRun, LateAuv};
use shoal_bus::time::SimTime;

use crate::vehicle::Vehicle;

/// So much of the past is remembered for answers that are late, in nanoseconds: neighbours in older ones are not checked.
const REMEMBERED_NS: i64 = 10_000_000_000;

/// The deadlines of all AUVs: the answer to a tick at local time s must be in when its clock reads s + R.
#[derive(Default)]
pub struct Deadlines {
    /// By AUV.
    of: Vec<Missed>,
}

/// What one AUV missed.
#[derive(Clone, Copy, Default)]
struct Missed {
    misses: u64,
    worst_ns: i64,
    /// Ticks before this one are counted, or were answered in time.
    next_tick: u64,
}

impl Deadlines {
    /// Counts the ticks whose deadline has passed at true time `by`, each once. Call it before their answers are taken.
    pub fn judge(&mut self, vehicles: &mut [Vehicle], by: SimTime) {
        self.of.resize(vehicles.len(), Missed::default());
        for (vehicle, missed) in vehicles.iter_mut().zip(&mut self.of) {
            let Vehicle { answered, clock, born, .. } = vehicle;
            if answered.is_empty() {
                continue;
            }
            let local = clock.read(by);
            for tick in answered.iter() {
                let late_ns = local.ns() - (tick.stamp + born.wake.reaction_ns).ns();
                if late_ns <= 0 {
                    break;
                }
                missed.worst_ns = missed.worst_ns.max(late_ns);
                if tick.index >= missed.next_tick {
                    missed.misses += 1;
                    missed.next_tick = tick.index + 1;
                }
            }
        }
    }

    /// What was missed, for a summary.
    pub fn summary(&self, vehicles: &[Vehicle]) -> FreeRun {
        let late = vehicles.iter().zip(&self.of).filter(|(_, missed)| missed.misses > 0);
        let line = |(vehicle, missed): (&Vehicle, &Missed)| LateAuv {
            auv: vehicle.born.auv.0,
            name: vehicle.born.name.clone(),
            misses: missed.misses,
            worst_s: missed.worst_ns as f64 * 1e-9,
        };
        FreeRun {
            deadline_misses: self.of.iter().map(|missed| missed.misses).sum(),
            worst_s: self.of.iter().map(|missed| missed.worst_ns).max().unwrap_or(0) as f64 * 1e-9,
            late: late.map(line).collect(),
            lag_max_s: 0.0,
        }
    }
}

/// The past that answers yet to come may ask for begins here: with the oldest tick that waits for one.
pub fn remembered_from(vehicles: &[Vehicle], now: SimTime) -> SimTime {
    let waiting = vehicles.iter().filter_map(|vehicle| vehicle.answered.front());
    let oldest = waiting.map(|tick| tick.at).min().unwrap_or(now);
    oldest.clamp(now + -REMEMBERED_NS, now)
}

#[cfg(test)]
mod tests;
