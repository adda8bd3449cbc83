//! What AUVs are still to be told.

use std::collections::BTreeMap;

use shoal_bus::lockstep::Batch;
use shoal_bus::message::{AuvId, Sensed};

/// So many ticks at most are told at once: an answer to more would be long to wait for, and too long for some transports.
const BATCH_MAX: usize = 500;

/// Batches that wait for their AUVs to be ready.
#[derive(Default)]
pub struct Backlog {
    /// Sorted by AUV, of at most [`BATCH_MAX`] ticks each.
    next: Vec<Batch<Sensed>>,
    /// What comes after that.
    later: BTreeMap<AuvId, Vec<Sensed>>,
}

impl Backlog {
    /// Adds the batches of a window, sorted by AUV.
    pub fn add(&mut self, sensed: Vec<Batch<Sensed>>) {
        if self.next.is_empty() && self.later.is_empty() {
            self.next = sensed;
            return;
        }
        for Batch { auv, items } in sensed {
            self.later.entry(auv).or_default().extend(items);
        }
    }

    /// What can be told, sorted by AUV; what is taken out of it has been told.
    pub fn ready(&mut self) -> &mut Vec<Batch<Sensed>> {
        let Self { next, later } = self;
        later.retain(|&auv, items| {
            let place = match next.binary_search_by_key(&auv, |batch| batch.auv) {
                Ok(place) => place,
                Err(place) => {
                    next.insert(place, Batch { auv, items: Vec::new() });
                    place
                }
            };
            let batch = &mut next[place].items;
            let count = items.len().min(BATCH_MAX.saturating_sub(batch.len()));
            batch.extend(items.drain(..count));
            !items.is_empty()
        });
        next
    }

    /// There is nobody left to be told.
    pub fn forget(&mut self, auv: AuvId) {
        self.next.retain(|batch| batch.auv != auv);
        self.later.remove(&auv);
    }
}

#[cfg(test)]
mod tests {
    use shoal_bus::time::LocalTime;

    use super::*;

    fn window(auvs: &[u32], ticks: std::ops::Range<u64>) -> Vec<Batch<Sensed>> {
        let items: Vec<Sensed> = ticks
            .map(|tick| Sensed { tick, stamp: LocalTime::from_ns(tick as i64), events: Vec::new() })
            .collect();
        auvs.iter().map(|auv| Batch { auv: AuvId(*auv), items: items.clone() }).collect()
    }

    fn ticks(batch: &Batch<Sensed>) -> Vec<u64> {
        batch.items.iter().map(|sensed| sensed.tick).collect()
    }

    #[test]
    fn nothing_is_lost_and_each_keeps_its_order() {
        let mut backlog = Backlog::default();
        let mut told = BTreeMap::<AuvId, Vec<u64>>::new();
        for round in 0..400_u64 {
            backlog.add(window(&[0, 3, 7], 3 * round..3 * round + 3));
            let ready = backlog.ready();
            assert!(ready.is_sorted_by_key(|batch| batch.auv));
            // One is always ready, one every ninth time, one not for a long time.
            ready.retain(|batch| {
                let is_ready = [true, round % 9 == 8, round > 390][batch.auv.0 as usize / 3];
                if is_ready {
                    assert!(batch.items.len() <= BATCH_MAX);
                    told.entry(batch.auv).or_default().extend(ticks(batch));
                }
                !is_ready
            });
        }
        backlog.forget(AuvId(3));
        assert!(backlog.ready().is_empty());
        for auv in [0, 7] {
            assert!(told[&AuvId(auv)].iter().copied().eq(0..1200), "{auv}");
        }
        assert!(told[&AuvId(3)].iter().copied().eq(0..1188));
    }
}
