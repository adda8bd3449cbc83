//! Who takes part, how far they are heard, and where: the first message to the page.

use serde::Serialize;
use shoal_bus::record::RecordHeader;
use shoal_scenario::{Level, MediumAccess, Scenario};

/// What the page must know before it can show a moment.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Cast {
    /// Version of what is said over the web socket.
    format: &'static str,
    /// Name of the scenario.
    scenario: String,
    /// One line about it.
    summary: String,
    seed: u64,
    /// Whether the run is still going on.
    pub live: bool,
    /// Length of the run in seconds, if the scenario can be read.
    duration_s: Option<f64>,
    /// `[[west, east], [south, north], [bottom, top]]` of the mission in metres, if the scenario can be read.
    area_m: Option<[[f64; 2]; 3]>,
    /// How fast wavefronts grow, in m/s.
    sound_speed_m_s: f64,
    /// Whether pings are heard up to a sharp range: links are pairs in range then, and pairs that heard each other else.
    ideal: bool,
    groups: Vec<CastGroup>,
    /// By AUV.
    names: Vec<String>,
    /// By AUV: index of its group.
    group_of: Vec<u16>,
    /// By AUV: length of its body in metres.
    length_m: Vec<f64>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
struct CastGroup {
    name: String,
    /// Others hear it up to this range, at level `ideal`.
    range_m: Option<f64>,
    /// True seconds between its pings, about.
    ping_period_s: Option<f64>,
}

/// Where no scenario says it.
const SOUND_SPEED_M_S: f64 = 1500.0;

impl Cast {
    /// The cast of a run. A scenario that this version cannot read costs ranges and area, nothing else.
    pub fn new(header: &RecordHeader, live: bool) -> Self {
        let scenario = shoal_scenario::parse(&header.scenario_name, &header.scenario_text).ok();
        let ideal = scenario.as_ref().is_some_and(|of| of.environment.level == Level::Ideal);
        let groups_end = header.auvs.iter().map(|auv| usize::from(auv.group) + 1).max().unwrap_or(0);
        let mut groups: Vec<CastGroup> = (0..groups_end)
            .map(|index| CastGroup {
                name: String::new(),
                range_m: range_m(scenario.as_ref(), index).filter(|_| ideal),
                ping_period_s: ping_period_s(scenario.as_ref(), index),
            })
            .collect();
        for auv in &header.auvs {
            if let Some(group) = groups.get_mut(usize::from(auv.group)) {
                group.name.clone_from(&auv.group_name);
            }
        }
        Self {
            format: "shoal.view/1",
            scenario: header.scenario_name.clone(),
            summary: scenario.as_ref().map_or(String::new(), |of| of.summary.clone()),
            seed: header.seed,
            live,
            duration_s: scenario.as_ref().map(|of| of.duration_ns as f64 * 1e-9),
            area_m: scenario.as_ref().map(|of| of.environment.area_m),
            sound_speed_m_s: scenario.as_ref().map_or(SOUND_SPEED_M_S, |of| of.environment.sound_speed_m_s),
            ideal,
            groups,
            names: header.auvs.iter().map(|auv| auv.name.clone()).collect(),
            group_of: header.auvs.iter().map(|auv| auv.group).collect(),
            length_m: header.auvs.iter().map(|auv| auv.length_m).collect(),
        }
    }

    /// How many AUVs take part.
    pub fn auvs(&self) -> usize {
        self.names.len()
    }

    /// Whether links are pairs that heard each other.
    pub fn needs_receptions(&self) -> bool {
        !self.ideal
    }
}

fn range_m(scenario: Option<&Scenario>, group: usize) -> Option<f64> {
    Some(scenario?.groups.get(group)?.modem.range_m)
}

fn ping_period_s(scenario: Option<&Scenario>, group: usize) -> Option<f64> {
    let period_ns = match scenario?.groups.get(group)?.modem.access {
        MediumAccess::Silent => return None,
        MediumAccess::Periodic { period_ns, .. } | MediumAccess::Csma { period_ns, .. } => period_ns as f64,
        MediumAccess::Aloha { mean_period_ns } => mean_period_ns as f64,
        MediumAccess::Slotted { slot_ns, slots, .. } => slot_ns as f64 * f64::from(slots),
    };
    Some(period_ns * 1e-9)
}

#[cfg(test)]
mod tests;
