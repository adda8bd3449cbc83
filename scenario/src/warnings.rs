//! What a scenario asks of its modems that real ones would not do. It runs, but a person should know.

use std::fmt;

use crate::PING_BYTES;
use crate::environment::norm;
use crate::model::{Group, MediumAccess, Scenario};

/// Something doubtful in a scenario that is good otherwise. Shown as a sentence without a full stop.
#[derive(Clone, Debug, PartialEq)]
pub enum Warning {
    /// More AUVs than the modem can tell apart.
    Extrapolation {
        /// Name of the modem.
        modem: String,
        /// Addresses it has.
        addresses: u32,
        /// AUVs that have it.
        auvs: u32,
    },
    /// Fewer slots than AUVs, though they do not overlap as far as the area reaches.
    SlotsShared {
        /// The group.
        group: String,
        /// Slots of its frame.
        slots: u32,
        /// AUVs of the scenario.
        auvs: u32,
    },
    /// Two groups divide time differently.
    SlotsDiffer {
        /// A group.
        first: String,
        /// The other one.
        second: String,
    },
    /// The AUVs of one band ask for more time than there is.
    Overload {
        /// Centre of the band in Hz.
        centre_hz: f64,
        /// Seconds of packets that are sent per second.
        load: f64,
    },
}

impl fmt::Display for Warning {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Warning::Extrapolation { modem, addresses, auvs } => write!(
                formatter,
                "{auvs} AUVs have the modem `{modem}`, whose addresses end at {addresses}: this swarm is an extrapolation"
            ),
            Warning::SlotsShared { group, slots, auvs } => write!(
                formatter,
                "group `{group}` divides time into {slots} slots for {auvs} AUVs: AUVs that are {slots} apart ping at the same \
                 time"
            ),
            Warning::SlotsDiffer { first, second } => write!(
                formatter,
                "groups `{first}` and `{second}` divide time into different slots, which overlap"
            ),
            Warning::Overload { centre_hz, load } => write!(
                formatter,
                "the AUVs around {centre_hz} Hz send {load:.1} s of packets each second: where all of them hear each other, \
                 pings must collide"
            ),
        }
    }
}

impl Scenario {
    /// What is doubtful about this scenario; most have nothing.
    ///
    /// ```
    /// let text = r#"
    /// name = "shoal"
    /// duration_s = 10
    /// environment.area_m = [[0, 100], [0, 100], [-50, 0]]
    /// [[group]]
    /// name = "a"
    /// count = 20
    /// modem = "seatrac"
    /// "#;
    /// let warnings = shoal_scenario::parse("shoal.toml", text)?.warnings();
    /// assert_eq!(
    ///     warnings[0].to_string(),
    ///     "20 AUVs have the modem `seatrac`, whose addresses end at 15: this swarm is an extrapolation"
    /// );
    /// # Ok::<(), shoal_scenario::ScenarioErrors>(())
    /// ```
    pub fn warnings(&self) -> Vec<Warning> {
        let mut warnings = extrapolations(&self.groups);
        warnings.extend(slots(self));
        warnings.extend(overloads(self));
        warnings
    }
}

fn extrapolations(groups: &[Group]) -> Vec<Warning> {
    let mut warnings = Vec::new();
    for group in groups {
        let (modem, Some(addresses)) = (group.modem.name, group.modem.addresses) else { continue };
        let alike = groups.iter().filter(|other| other.modem.name == modem);
        let auvs = alike.map(|other| other.count).sum();
        let warning = Warning::Extrapolation { modem: modem.to_string(), addresses, auvs };
        if auvs > addresses && !warnings.contains(&warning) {
            warnings.push(warning);
        }
    }
    warnings
}

/// Whether slots are used again on purpose, by AUVs farther apart: the guard range is shorter than the area.
fn uses_slots_again(scenario: &Scenario, access: &MediumAccess) -> bool {
    let diagonal_m = norm(scenario.environment.area_m.map(|[least, greatest]| greatest - least));
    match *access {
        MediumAccess::Slotted { slots, guard_range_m, .. } => {
            slots < scenario.auv_count() && guard_range_m < 0.999 * diagonal_m
        }
        _ => false,
    }
}

fn slots(scenario: &Scenario) -> Vec<Warning> {
    let (groups, auvs) = (&scenario.groups, scenario.auv_count());
    let mut warnings = Vec::new();
    let mut first: Option<(&Group, (i64, u32))> = None;
    for group in groups {
        let MediumAccess::Slotted { slot_ns, slots, .. } = group.modem.access else { continue };
        if slots < auvs && !uses_slots_again(scenario, &group.modem.access) {
            warnings.push(Warning::SlotsShared { group: group.name.clone(), slots, auvs });
        }
        let (earlier, frame) = *first.get_or_insert((group, (slot_ns, slots)));
        if frame != (slot_ns, slots) {
            let (first, second) = (earlier.name.clone(), group.name.clone());
            warnings.push(Warning::SlotsDiffer { first, second });
        }
    }
    warnings
}

/// The bands, by centre and width, whose AUVs, but for those that use slots again, send more than a second of packets each second.
fn overloads(scenario: &Scenario) -> Vec<Warning> {
    let mut bands: Vec<((f64, f64), f64)> = Vec::new();
    for group in &scenario.groups {
        let Some(layer) = &group.modem.physical else { continue };
        let Some(period_s) = mean_period_s(&group.modem.access) else { continue };
        if uses_slots_again(scenario, &group.modem.access) {
            continue;
        }
        let packet_s = group.modem.packet_s(&scenario.environment.level, PING_BYTES);
        let load = f64::from(group.count) * packet_s / period_s;
        let band = (layer.centre_hz, layer.bandwidth_hz);
        match bands.iter_mut().find(|(known, _)| *known == band) {
            Some((_, sum)) => *sum += load,
            None => bands.push((band, load)),
        }
    }
    let over = bands.into_iter().filter(|(_, load)| *load > 1.0);
    over.map(|((centre_hz, _), load)| Warning::Overload { centre_hz, load }).collect()
}

/// Mean time between two pings of an AUV; `None` when it is silent.
fn mean_period_s(access: &MediumAccess) -> Option<f64> {
    let period_ns = match *access {
        MediumAccess::Silent => return None,
        MediumAccess::Periodic { period_ns, .. } | MediumAccess::Csma { period_ns, .. } => period_ns,
        MediumAccess::Aloha { mean_period_ns } => mean_period_ns,
        MediumAccess::Slotted { slot_ns, slots, .. } => slot_ns.saturating_mul(slots.into()),
    };
    Some(period_ns as f64 / 1e9)
}
