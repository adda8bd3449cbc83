//! The canonical order of what happened.

use shoal_bus::chronicle::{Entry, What};
use shoal_bus::message::AuvId;
use shoal_bus::time::SimTime;

use crate::parallel;

/// Sorts entries by (true time, vehicle, kind, index): those of one vehicle, kind and moment keep the order in which they were told,
/// but for pings, which are told by emitter and number.
#[derive(Default)]
pub(super) struct CanonicalOrder {
    keys: Vec<Key>,
}

/// What an entry is sorted by, and where it stands.
type Key = (SimTime, AuvId, u8, u32, u32, u32);

impl CanonicalOrder {
    /// Sorts the entries.
    pub(super) fn sort(&mut self, entries: &mut [Entry]) {
        self.keys.clear();
        self.keys.extend((0..).zip(&*entries).map(|(index, entry)| key(entry, index)));
        // No two keys are equal, so there is one order, however it is found.
        parallel::sort(&mut self.keys);
        for place in 0..entries.len() {
            let mut from = self.keys[place].5 as usize;
            // What stood at places before this one was moved to where its successor came from.
            while from < place {
                from = self.keys[from].5 as usize;
            }
            self.keys[place].5 = from as u32;
            entries.swap(place, from);
        }
    }
}

fn key(entry: &Entry, index: u32) -> Key {
    let (from, sequence) = match &entry.what {
        What::Traffic(traffic) => (traffic.from.0, traffic.sequence),
        _ => (0, 0),
    };
    (entry.at, entry.auv, entry.what.rank(), from, sequence, index)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_is_that_of_a_stable_sort_by_time_vehicle_kind_and_ping() {
        let mut state = 1_u64;
        let mut draw = |below: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) % below
        };
        for count in [0, 1, 2, 50, 9_000] {
            let entries: Vec<Entry> = (0..count)
                .map(|number| Entry {
                    at: SimTime::from_ns(draw(20) as i64),
                    auv: AuvId(draw(5) as u32),
                    what: What::Ended(number.to_string()),
                })
                .collect();
            let mut expected = entries.clone();
            expected.sort_by_key(|entry| (entry.at, entry.auv));
            let mut sorted = entries;
            CanonicalOrder::default().sort(&mut sorted);
            assert_eq!(sorted, expected);
        }
    }
}
