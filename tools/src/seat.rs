//! Seats: which process carries which AUVs.

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
    pub fn of_run(order: &Order, scenario: &Scenario) -> Vec<Self> {
        Self::seated(scenario, order.auvs_per_process.get())
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
}
