//! Runs at level `sea`, and what they show.

use std::collections::BTreeMap;

use shoal_auv::Auv;
use shoal_bus::chronicle::What;
use shoal_bus::message::AuvId;
use shoal_bus::summary::Summary;
use shoal_bus::time::SimTime;
use shoal_bus::traffic::{Fate, LossReason, Reception};
use shoal_scenario::model::{Level, Scenario, Sea};
use shoal_scenario::parse;
use shoal_tests::{random_sea_scenario, run_local_watched};

/// One ping at one receiver.
#[derive(Clone, Debug)]
pub struct Passage {
    pub from: u32,
    pub to: u32,
    pub sequence: u32,
    pub emitted_ns: i64,
    pub range_m: f64,
    pub travel_s: f64,
    pub reception: Reception,
}

/// What a run showed.
#[derive(Default)]
pub struct Shown {
    pub emitted: BTreeMap<(u32, u32), SimTime>,
    pub places_m: BTreeMap<u32, [f64; 3]>,
    pub heard: Vec<Passage>,
    pub lost: Vec<(u32, AuvId, LossReason, Vec<AuvId>)>,
    pub receptions: Vec<(u32, Reception)>,
}

/// Carries a scenario out.
pub fn shown(scenario: &Scenario) -> (Shown, Summary) {
    let mut shown = Shown::default();
    let summary = run_local_watched(scenario, None, Auv::new, |entry| match &entry.what {
        What::Truth(truth) => {
            shown.places_m.entry(entry.auv.0).or_insert(truth.position_m);
        }
        What::Traffic(traffic) => {
            let (from, sequence) = (traffic.from.0, traffic.sequence);
            match &traffic.fate {
                Fate::Emitted { .. } => _ = shown.emitted.insert((from, sequence), traffic.at),
                Fate::Heard { to, range_m, travel_s, reception: Some(reception), .. } => {
                    let emitted_ns = shown.emitted[&(from, sequence)].ns();
                    let (to, reception) = (to.0, *reception);
                    let (range_m, travel_s) = (*range_m, *travel_s);
                    shown.heard.push(Passage {
                        from,
                        to,
                        sequence,
                        emitted_ns,
                        range_m,
                        travel_s,
                        reception,
                    });
                    shown.receptions.push((from, reception));
                }
                Fate::Lost { to: Some(to), reason, reception, colliding, .. } => {
                    shown.lost.push((from, *to, *reason, colliding.clone()));
                    shown.receptions.extend(reception.map(|reception| (from, reception)));
                }
                _ => {}
            }
        }
        _ => {}
    })
    .unwrap();
    (shown, summary)
}

/// The random sea with this number.
pub fn random_sea(number: u64, duration_s: f64) -> Scenario {
    parse("random.toml", &random_sea_scenario(number, duration_s)).unwrap()
}

/// The sea of a scenario at level `sea`.
pub fn sea(scenario: &mut Scenario) -> &mut Sea {
    let Level::Sea(sea) = &mut scenario.environment.level else { panic!("made for level sea") };
    sea
}

/// Water in which nothing fades or bounces, for [`standing`].
pub const STEADY: &str =
    "sea = { fading = \"gaussian\", bounces_max = 0, spreading_exponent = 2, surface_loss_db = 20 }";

/// AUVs that stay at these points and have perfect clocks, with more lines about their modem and the environment.
pub fn standing(points_m: &[[f64; 3]], modem: &str, environment: &str) -> Scenario {
    let text = format!(
        r#"
name = "standing"
duration_s = 8
[environment]
area_m = [[-2000, 2000], [-2000, 2000], [-100, 0]]
level = "sea"
{environment}
[[group]]
name = "still"
count = {}
clock = "ideal"
controller = "hold"
[group.kind]
speed_max_m_s = 0.001
acceleration_max_m_s2 = 0.1
turn_rate_max_rad_s = 0.1
pitch_max_rad = 0.1
disturbance_m_s = [0, 0, 0]
length_m = 1
[group.start]
points_m = {points_m:?}
box_width_m = 1
[group.modem]
like = "evologics-18-34"
{modem}
"#,
        points_m.len()
    );
    parse("standing.toml", &text).unwrap_or_else(|errors| panic!("{}\n{text}", errors.render(false)))
}
