//! The canonical order of what happened.

use shoal_bus::chronicle::{Entry, What};

use crate::parallel;

/// Sorts entries by (true time, vehicle, kind, index): those of one vehicle, kind and moment keep the order in which they were told,
/// but for pings, which are told by emitter and number.
#[derive(Default)]
pub(super) struct CanonicalOrder {
    keys: Vec<Key>,
}

/// What an entry is sorted by, and where it stands. Packed, so that comparing two is mostly comparing two numbers.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Key {
    /// True time, vehicle and kind.
    moment: u128,
    /// Emitter and number of a ping.
    ping: u64,
    place: u32,
}

impl CanonicalOrder {
    /// Sorts the entries.
    pub(super) fn sort(&mut self, entries: &mut [Entry]) {
        self.keys.clear();
        self.keys.extend((0..).zip(&*entries).map(|(place, entry)| Key::of(entry, place)));
        // No two keys are equal, so there is one order, however it is found.
        parallel::sort(&mut self.keys);
        for place in 0..entries.len() {
            let mut from = self.keys[place].place as usize;
            // What stood at places before this one was moved to where its successor came from.
            while from < place {
                from = self.keys[from].place as usize;
            }
            self.keys[place].place = from as u32;
            entries.swap(place, from);
        }
    }
}

impl Key {
    fn of(entry: &Entry, place: u32) -> Self {
        let &Entry { at, auv, ref what } = entry;
        // The same order without a sign.
        let at = at.ns().wrapping_sub(i64::MIN) as u64;
        let moment = u128::from(at) << 64 | u128::from(auv.0) << 32 | u128::from(what.rank());
        let ping = match what {
            What::Traffic(traffic) => u64::from(traffic.from.0) << 32 | u64::from(traffic.sequence),
            _ => 0,
        };
        Self { moment, ping, place }
    }
}

#[cfg(test)]
mod tests {
    use shoal_bus::message::AuvId;
    use shoal_bus::time::SimTime;

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
