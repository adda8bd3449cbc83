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
        let each = order.auvs_per_process.get();
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
