//! When an AUV pings, as it is told.

use shoal_bus::message::{AuvId, MediumAccess};
use shoal_bus::ping::FRAME_BYTES;
use shoal_bus::time::LocalTime;
use shoal_scenario::model::{self, Group, Scenario};

use crate::draw::Draws;
use crate::water::Water;

/// The time within which the first ping is drawn, in local nanoseconds; `None` where nothing is drawn.
pub fn drawn_within_ns(access: &model::MediumAccess) -> Option<i64> {
    match *access {
        model::MediumAccess::Silent | model::MediumAccess::Slotted { .. } => None,
        model::MediumAccess::Periodic { period_ns, .. } | model::MediumAccess::Csma { period_ns, .. } => {
            Some(period_ns)
        }
        model::MediumAccess::Aloha { mean_period_ns } => Some(mean_period_ns),
    }
}

/// What `auv` of `group` is told; `drawn` is its first ping where the scenario states none, `draws` has made all other draws.
pub fn orders(
    scenario: &Scenario,
    group: &Group,
    water: &Water,
    auv: AuvId,
    drawn: LocalTime,
    draws: &mut Draws,
) -> MediumAccess {
    match group.modem.access {
        model::MediumAccess::Silent => MediumAccess::Silent,
        model::MediumAccess::Periodic { period_ns, phase_ns } => {
            MediumAccess::Periodic { first: phase_ns.map_or(drawn, LocalTime::from_ns), period_ns }
        }
        model::MediumAccess::Aloha { mean_period_ns } => {
            MediumAccess::Aloha { first: drawn, mean_period_ns, entropy: draws.entropy() }
        }
        model::MediumAccess::Slotted { slot_ns, slots, guard_range_m } => {
            let packet_s = group.modem.packet_s(&scenario.environment.level, FRAME_BYTES as u16);
            MediumAccess::Slotted {
                slot_ns,
                slots,
                // A frame without slots has none to give.
                slot: auv.0.checked_rem(slots).unwrap_or(0),
                packet_ns: nanoseconds(packet_s),
                propagation_ns: nanoseconds(guard_range_m / water.told_sound_speed_m_s.lower),
            }
        }
        model::MediumAccess::Csma { period_ns, listen_ns, backoff_ns } => {
            MediumAccess::Csma { first: drawn, period_ns, listen_ns, backoff_ns, entropy: draws.entropy() }
        }
    }
}

/// Whole nanoseconds, no less than so many seconds.
fn nanoseconds(seconds: f64) -> i64 {
    (seconds * 1e9 * (1.0 + f64::EPSILON)).ceil() as i64
}

#[cfg(test)]
mod tests;
