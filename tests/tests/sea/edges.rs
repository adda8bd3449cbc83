//! Sharp edges: no range, no water, death in mid-flight, broken promises.

use shoal_auv::Auv;
use shoal_bus::chronicle::What;
use shoal_bus::local::Local;
use shoal_bus::lockstep::{Answers, Fleet, Loss};
use shoal_bus::message::AuvId;
use shoal_bus::summary::Summary;
use shoal_bus::time::SimTime;
use shoal_bus::traffic::{Fate, LossReason, SoundPath};
use shoal_channel::channel::Channel;
use shoal_scenario::model::{Controller, CurrentField, Noise, Place, Scenario};
use shoal_scenario::parse;
use shoal_tests::{run_local, run_local_watched, scenario_file};

use crate::runs::{STEADY, random_sea, sea, shown, standing};

#[test]
fn bodies_at_equal_places_hear_each_other_at_once() {
    let place_m = [3.0, -7.0, -20.0];
    for bounces_max in [0, 3] {
        let environment = format!("sea = {{ bounces_max = {bounces_max} }}");
        let modem = "access = { name = \"slotted\", slot_s = 1, guard_range_m = 100 }";
        let scenario = standing(&[place_m; 3], modem, &environment);
        let (shown, summary) = shown(&scenario);
        assert_eq!(summary.containment.violations, 0, "{:?}", summary.containment);
        assert!(summary.pings.heard > 8, "{:?}", summary.pings);
        for passage in shown.heard.iter().filter(|passage| passage.reception.path == SoundPath::Direct) {
            // Commands of a millimetre per second may part them a little.
            assert!(passage.range_m < 0.02 && passage.travel_s < 2e-5, "{passage:?}");
            assert!(passage.reception.level_db.is_finite() && passage.reception.sinr_db.is_finite());
        }
    }
}

#[test]
fn bodies_that_leave_the_water_are_no_trap() {
    for (number, [below_m, above_m]) in [[-100.0, -99.5], [-0.5, 0.0]].into_iter().enumerate() {
        for upwards_m_s in [0.3, -0.3] {
            let mut scenario = random_sea(70 + number as u64, 12.0);
            sea(&mut scenario).bottom_depth_m = 100.0;
            let environment = &mut scenario.environment;
            environment.area_m = [[-300.0, 300.0], [-300.0, 300.0], [-100.0, 0.0]];
            environment.current_m_s = [0.0, 0.0, upwards_m_s];
            environment.current_field = CurrentField::Uniform;
            environment.current_error_m_s = [0.1; 3];
            for group in &mut scenario.groups {
                group.start.place = Place::Region([[-300.0, 300.0], [-300.0, 300.0], [below_m, above_m]]);
                group.controller = Controller::Hold;
                group.kind.pitch_max_rad = 0.0;
                if let Some(layer) = &mut group.modem.physical {
                    layer.source_level_db = 190.0;
                }
            }
            let mut outside = 0;
            let summary = run_local_watched(&scenario, None, Auv::new, |entry| {
                if let What::Truth(truth) = &entry.what {
                    outside += u64::from(!(-100.0..=0.0).contains(&truth.position_m[2]));
                }
            })
            .unwrap();
            assert_eq!(summary.containment.violations, 0, "{:?}", summary.containment.first);
            let strays = (below_m < -50.0) == (upwards_m_s < 0.0);
            assert!(!strays || outside > 10, "{number} {upwards_m_s}: {outside}");
        }
    }
}

/// As `run_local`, but that `dead` is found dead at `at_ns`.
fn run_with_a_death(
    scenario: &Scenario,
    window_ns: i64,
    dead: AuvId,
    at_ns: i64,
) -> (Summary, Vec<(u32, i64, Fate)>) {
    let mut channel = Channel::new(scenario).unwrap();
    let mut fleet = Local::new(Auv::new);
    fleet.born(&channel.born()).unwrap();
    let mut fates = Vec::new();
    while channel.now() < channel.end() {
        // Windows end where it dies.
        let next_ns = if channel.now().ns() < at_ns { at_ns } else { i64::MAX };
        let to = (channel.now() + window_ns).min(channel.end()).min(SimTime::from_ns(next_ns));
        let sensed = channel.advance(to).unwrap();
        let mut answers: Answers = fleet.exchange(&sensed, &mut || {}).unwrap();
        if to.ns() == at_ns {
            answers.losses.push(Loss { auv: dead, reason: "it was meant to".to_owned() });
        }
        channel.accept(sensed, answers);
        for entry in channel.chronicle().unwrap() {
            if let What::Traffic(traffic) = &entry.what {
                fates.push((traffic.from.0, entry.at.ns(), traffic.fate.clone()));
            }
        }
    }
    (channel.summary(), fates)
}

#[test]
fn the_dead_are_heard_while_their_sound_flies_and_hear_nothing_themselves() {
    // A kilometre apart: sound takes two thirds of a second, a packet nearly half a second.
    let points_m = [[0.0, 0.0, -50.0], [1_000.0, 0.0, -50.0], [0.0, 1_000.0, -50.0]];
    let modem = "access = { name = \"slotted\", slot_s = 2, guard_range_m = 1500 }";
    let scenario = standing(&points_m, modem, STEADY);
    let (all, _) = shown(&scenario);
    let emitted_ns = all.emitted[&(0, 0)].ns();
    // While the packet still leaves, while all of it flies, while it is being received.
    for after_ns in [100_000_000, 500_000_000, 900_000_000] {
        let at_ns = emitted_ns + after_ns;
        let mut digests = Vec::new();
        for window_ns in [10_000_000, 25_000_000, 90_000_000] {
            let (summary, fates) = run_with_a_death(&scenario, window_ns, AuvId(0), at_ns);
            let from_the_dead = fates
                .iter()
                .filter(|(from, at, fate)| *from == 0 && *at > at_ns && matches!(fate, Fate::Heard { .. }));
            assert_eq!(from_the_dead.count(), 2, "{after_ns} {:?}", summary.pings);
            let to_the_dead: Vec<_> = fates
                .iter()
                .filter(|(_, at, fate)| *at > at_ns && matches!(fate, Fate::Lost { to: Some(AuvId(0)), .. }))
                .collect();
            assert!(!to_the_dead.is_empty());
            for (_, _, fate) in to_the_dead {
                assert!(matches!(fate, Fate::Lost { reason: LossReason::Dead, .. }), "{fate:?}");
            }
            let heard_by_the_dead = fates
                .iter()
                .any(|(_, at, fate)| *at > at_ns && matches!(fate, Fate::Heard { to: AuvId(0), .. }));
            assert!(!heard_by_the_dead);
            let pings = &summary.pings;
            let fates = pings.heard + pings.lost.dead + pings.lost.half_duplex + pings.lost.collision;
            assert_eq!(2 * pings.emitted, fates + pings.in_flight, "{pings:?}");
            digests.push(summary.digest);
        }
        digests.dedup();
        assert_eq!(digests.len(), 1, "{after_ns}");
    }
}

/// The scenario file of this name, at level `sea`.
fn at_sea(name: &str) -> Scenario {
    let text = std::fs::read_to_string(scenario_file(name)).unwrap();
    let text = text.replace("[environment]\n", "[environment]\nlevel = \"sea\"\n");
    let text = match text.contains("modem = ") {
        true => text,
        false => text.replace(
            "[[group]]\n",
            "[[group]]\nmodem = { like = \"evologics-18-34\", access = \"aloha\", ping_period_s = 1 }\n",
        ),
    };
    let text = text.replace("{ ping_period_s = false }", "{ like = \"popoto\", ping_period_s = false }");
    parse(name, &text).unwrap_or_else(|errors| panic!("{}\n{text}", errors.render(false)))
}

#[test]
fn broken_promises_are_caught_at_sea() {
    let pairs = [
        ("halved-clock", "drifters", "report"),
        ("lying-ping", "talkers", "ping"),
        ("empty-set", "talkers", "emptied"),
        ("shifted-truth", "surveyors", "report"),
    ];
    for (broken, kept, enclosure) in pairs {
        let mut scenario = at_sea(broken);
        scenario.noise = Noise::Adversarial;
        let containment = run_local(&scenario, None).containment;
        assert!(containment.violations > 0, "{broken}");
        assert!(
            containment.first.iter().any(|line| line.enclosure == enclosure),
            "{broken}: {:?}",
            containment.first
        );
        let mut scenario = at_sea(kept);
        scenario.noise = Noise::Adversarial;
        let summary = run_local(&scenario, None);
        assert_eq!(summary.containment.violations, 0, "{kept}: {:?}", summary.containment.first);
        assert_eq!(summary.containment.first.len(), 0);
    }
}
