//! Seats: which process carries which AUVs.

use std::collections::BTreeMap;
use std::ops::Range;

use shoal_bus::message::AuvId;
use shoal_scenario::Scenario;

use crate::launch::Order;

/// A process of AUVs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Seat {
    /// Ids of those that it carries; never empty.
    pub auvs: Range<u32>,
    /// The program of the user's that its only AUV is; `None` for Shoal's own.
    pub command: Option<Vec<String>>,
}

impl Seat {
    /// The seats of a run, in the order of their AUVs: every AUV has one.
    ///
    /// Where other hosts carry them, only programs of the user's have seats here.
    pub fn of_run(order: &Order, scenario: &Scenario) -> Vec<Self> {
        let mut seats = Self::seated(scenario, order.auvs_per_process.get());
        seats.retain(|seat| order.hosts.is_none() || seat.command.is_some());
        seats
    }

    fn seated(scenario: &Scenario, each: u32) -> Vec<Self> {
        let mut seats: Vec<Self> = Vec::new();
        let mut first = 0;
        for group in &scenario.groups {
            let end = first + group.count;
            for auv in first..end {
                match seats.last_mut() {
                    // Groups share processes, but never with a program of the user's.
                    Some(Self { auvs, command: None })
                        if group.command.is_none() && auvs.len() < each as usize =>
                    {
                        auvs.end = auv + 1;
                    }
                    _ => seats.push(Self { auvs: auv..auv + 1, command: group.command.clone() }),
                }
            }
            first = end;
        }
        seats
    }

    /// The seats of these AUVs of Shoal's own, so many in each at most, in the order of their ids.
    pub fn of(auvs: &[AuvId], each: u32) -> Vec<Self> {
        let mut ids: Vec<u32> = auvs.iter().map(|auv| auv.0).collect();
        ids.sort_unstable();
        let runs = ids.chunk_by(|one, next| one + 1 == *next);
        let seats = runs.flat_map(|run| run.chunks(each.max(1) as usize));
        let seat =
            |ids: &[u32]| Some(Self { auvs: *ids.first()?..ids.last()?.saturating_add(1), command: None });
        seats.filter_map(seat).collect()
    }

    /// The AUVs of each seat, in the order of the first of each in `wake_order`.
    pub fn in_wake_order(seats: &[Self], wake_order: &[AuvId]) -> Vec<Vec<AuvId>> {
        let place: BTreeMap<AuvId, usize> = wake_order.iter().copied().zip(0..).collect();
        let mut processes: Vec<Vec<AuvId>> = seats.iter().map(Self::ids).collect();
        processes.sort_by_key(|auvs| auvs.iter().filter_map(|auv| place.get(auv)).min());
        processes
    }

    /// Their ids.
    pub fn ids(&self) -> Vec<AuvId> {
        self.auvs.clone().map(AuvId).collect()
    }

    /// Whom it carries, in words.
    pub fn name(&self) -> String {
        name(&self.auvs)
    }
}

/// These AUVs in words, as a process of theirs calls itself in the common log.
pub fn name(auvs: &Range<u32>) -> String {
    match auvs.len() {
        1 => format!("AUV {}", auvs.start),
        _ => format!("AUVs {}..{}", auvs.start, auvs.end),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn programs_of_the_user_sit_alone() {
        let text = "name = \"mixed\"\nduration_s = 1\nenvironment.area_m = [[0, 99], [0, 99], [-9, 0]]\n\
            [[group]]\nname = \"a\"\ncount = 1\n[[group]]\nname = \"b\"\ncount = 4\n\
            [[group]]\nname = \"c\"\ncount = 2\ncommand = [\"c\"]\n[[group]]\nname = \"d\"\ncount = 3\n";
        let scenario = shoal_scenario::parse("mixed.toml", text).unwrap();
        let seats = |each: u32| {
            let seats = Seat::seated(&scenario, each);
            seats.into_iter().map(|seat| (seat.auvs, seat.command.is_some())).collect::<Vec<_>>()
        };
        let expected = [(0..3, false), (3..5, false), (5..6, true), (6..7, true), (7..10, false)];
        assert_eq!(seats(3), expected);
        assert_eq!(seats(1).len(), 10);
    }

    #[test]
    fn any_auvs_have_seats() {
        let of = |ids: &[u32], each| {
            let auvs: Vec<AuvId> = ids.iter().copied().map(AuvId).collect();
            Seat::of(&auvs, each).into_iter().map(|seat| seat.auvs).collect::<Vec<_>>()
        };
        assert_eq!(of(&[], 3), []);
        assert_eq!(of(&[7, 5, 6], 1), [5..6, 6..7, 7..8]);
        assert_eq!(of(&[7, 5, 6, 8, 20], 3), [5..8, 8..9, 20..21]);
    }

    #[test]
    fn seats_wake_with_the_first_of_theirs() {
        let seats = Seat::of(&[0, 1, 2, 3].map(AuvId), 2);
        let processes = Seat::in_wake_order(&seats, &[3, 0, 1, 2].map(AuvId));
        assert_eq!(processes, [[2, 3].map(AuvId), [0, 1].map(AuvId)]);
    }
}
