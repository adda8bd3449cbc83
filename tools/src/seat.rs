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
}

impl Seat {
    /// The seats of a run, in the order of their AUVs: every AUV has one.
    pub fn of_run(order: &Order, scenario: &Scenario) -> Vec<Self> {
        let (count, each) = (scenario.auv_count(), order.auvs_per_process.get());
        let seat = |first: u32| Self { auvs: first..count.min(first.saturating_add(each)) };
        (0..count).step_by(each as usize).map(seat).collect()
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
