//! Time division on drifting clocks: no two packets ever meet, whatever the clocks, and more is heard than by any other rule.

use std::collections::BTreeMap;

use shoal_auv::Auv;
use shoal_bus::chronicle::What;
use shoal_bus::summary::{Pings, Summary};
use shoal_bus::traffic::{Fate, LossReason, Traffic};
use shoal_scenario::model::{Clock, MediumAccess, Noise, Scenario};
use shoal_scenario::presets::CLOCKS;
use shoal_scenario::{PING_BYTES, load, parse};
use shoal_tests::{run_local, run_local_watched};

/// The library's scenario with another medium access, as `--set group.modem.access` makes it, for 100 s.
fn crowded_band(access: &str) -> Scenario {
    let (source, text) = load("crowded-band").expect("the library has it");
    let periodic = "\naccess = \"periodic\"\n";
    assert!(text.contains(periodic), "the scenario names its medium access");
    let text = text.replace(periodic, &format!("\naccess = \"{access}\"\n"));
    let mut scenario = parse(&source, &text).unwrap_or_else(|errors| panic!("{}", errors.render(false)));
    scenario.duration_ns = 100_000_000_000;
    scenario
}

/// Twelve AUVs that move about within 300 m, each with a slot of a fifth of a second more than a packet and its way need.
fn crowd(clock: &str, seed: u64, noise: Noise) -> Scenario {
    let text = format!(
        r#"
name = "crowd"
seed = {seed}
duration_s = 60

[environment]
area_m = [[0, 200], [0, 200], [-100, 0]]
level = "sea"
sound_speed_error_m_s = 3
current_m_s = [0.3, 0, 0]

[environment.sea]
sound_speed = "summer-thermocline"
fading = "gaussian"
bounces_max = 0
bottom_depth_m = 200

[[group]]
name = "crowd"
count = 12
clock = {clock}
controller = {{ name = "waypoints", points_m = [[20, 20, -20], [180, 20, -80], [180, 180, -20], [20, 180, -80]], speed_m_s = 2 }}
modem = {{ like = "evologics-18-34", access = {{ name = "slotted", slot_s = 0.95, guard_range_m = 300 }} }}
start = {{ region_m = [[20, 180], [20, 180], [-80, -20]], box_width_m = 10 }}
"#
    );
    let mut scenario = parse("crowd.toml", &text).unwrap_or_else(|errors| panic!("{}", errors.render(false)));
    scenario.noise = noise;
    scenario
}

/// As [`crowd`], half of it with quartzes that were set by hand: off by up to 0.4 s, twice what a slot can spare.
fn half_astray(seed: u64, noise: Noise) -> Scenario {
    let mut scenario = crowd("\"tcxo\"", seed, noise);
    let mut astray = scenario.groups[0].clone();
    astray.name = "astray".to_owned();
    astray.clock = Clock { drift_bound: 5e-5, wander_fraction: 0.5, offset_bound_s: 0.4 };
    scenario.groups[0].count = 6;
    astray.count = 6;
    // Theirs are the first slots: nobody has told them the time yet.
    scenario.groups.insert(0, astray);
    scenario
}

/// Runs it, and checks that every packet was alone wherever it was heard or lost.
fn never_collides(scenario: &Scenario, name: &str, mut watch: impl FnMut(&Traffic)) -> Summary {
    let mut farthest_m = 0.0_f64;
    let summary = run_local_watched(scenario, None, Auv::new, |entry| {
        let What::Traffic(traffic) = &entry.what else { return };
        watch(traffic);
        match &traffic.fate {
            Fate::Heard { range_m, .. } => farthest_m = farthest_m.max(*range_m),
            Fate::Lost { range_m, reason, colliding, .. } => {
                farthest_m = farthest_m.max(*range_m);
                let disturbed = matches!(reason, LossReason::Collision | LossReason::HalfDuplex);
                assert!(!disturbed && colliding.is_empty(), "{name}: {traffic:?}");
            }
            Fate::Emitted { .. } => {}
        }
    })
    .unwrap();
    assert!(farthest_m < 300.0, "{name}: the guard range was {farthest_m} m too short");
    assert_eq!(summary.containment.violations, 0, "{name}");
    summary
}

#[test]
fn slotted_packets_never_meet_whatever_the_clock() {
    let offset =
        |offset_s: f64| format!("{{ drift_bound = 1e-4, wander_fraction = 1, offset_bound_s = {offset_s} }}");
    let named = CLOCKS.iter().map(|(name, _)| format!("\"{name}\""));
    let clocks = named.chain([offset(0.02), offset(0.05), "{ drift_bound = 5e-4 }".to_owned()]);
    for clock in clocks {
        for (seed, noise) in [(1, Noise::Uniform), (2, Noise::Adversarial)] {
            let summary = never_collides(&crowd(&clock, seed, noise), &clock, |_| {});
            // Five frames of 11.4 s, each AUV heard by eleven others.
            assert!(summary.pings.heard > 4 * 12 * 11, "{clock}: {:?}", summary.pings);
        }
    }
}

#[test]
fn clocks_that_are_off_speak_once_others_have_told_them_the_time() {
    for (seed, noise) in [(1, Noise::Uniform), (2, Noise::Adversarial), (3, Noise::Adversarial)] {
        let scenario = half_astray(seed, noise);
        let mut first_ns = BTreeMap::new();
        never_collides(&scenario, "half astray", |traffic| {
            first_ns.entry(traffic.from.0).or_insert(traffic.at.ns());
        });
        let frame_ns = 12 * 950_000_000;
        for auv in 0..12 {
            // Those who know the time speak in the first frame, the others in the second.
            let frame = first_ns[&auv] / frame_ns;
            assert_eq!(frame, if auv < 6 { 1 } else { 0 }, "{auv} {noise:?}: {first_ns:?}");
        }
    }
}

#[test]
fn a_clock_that_is_not_known_well_enough_keeps_silent() {
    // A slot is a fifth of a second longer than needed; these clocks are off by a quarter at the start.
    let clock = "{ drift_bound = 1e-6, offset_bound_s = 0.25 }";
    let scenario = crowd(clock, 1, Noise::Adversarial);
    let MediumAccess::Slotted { slot_ns, guard_range_m, .. } = scenario.groups[0].modem.access else {
        panic!("made for slots")
    };
    let packet_s = scenario.groups[0].modem.packet_s(&scenario.environment.level, PING_BYTES);
    assert!(slot_ns as f64 * 1e-9 - packet_s - guard_range_m / 1450.0 < 0.5);
    assert_eq!(run_local(&scenario, None).pings.emitted, 0);
}

/// Part of the pings that could be heard, one for each pair, that were.
fn delivery(pings: &Pings, auvs: u32) -> f64 {
    pings.heard as f64 / (pings.emitted * u64::from(auvs - 1)) as f64
}

#[test]
fn in_a_crowded_band_slots_beat_chance_and_habit() {
    let [slotted, aloha, periodic] = ["slotted", "aloha", "periodic"].map(|name| {
        let summary = run_local(&crowded_band(name), None);
        assert_eq!(summary.containment.violations, 0, "{name}: {:?}", summary.containment.first);
        let delivered = delivery(&summary.pings, summary.auvs);
        println!("{name}: {delivered:.3} of {} pings, {:?}", summary.pings.emitted, summary.pings.lost);
        assert!(summary.pings.emitted > 60, "{name}");
        (delivered, summary)
    });
    assert_eq!(slotted.1.pings.lost.collision + slotted.1.pings.lost.half_duplex, 0, "{:?}", slotted.1.pings);
    assert!(
        slotted.0 > aloha.0 + 0.2 && slotted.0 > periodic.0 + 0.2,
        "{} {} {}",
        slotted.0,
        aloha.0,
        periodic.0
    );
    for (_, other) in [&aloha, &periodic] {
        assert!(other.pings.lost.collision > 1_000, "{:?}", other.pings);
    }
}
