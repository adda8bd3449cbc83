//! Sound at level `sea` as whole runs show it: it keeps the laws of sound, and every ping that is lost is explained.

use std::collections::BTreeMap;

use shoal_auv::Auv;
use shoal_bus::chronicle::What;
use shoal_bus::local::Local;
use shoal_bus::lockstep::{Answers, Fleet, Loss};
use shoal_bus::message::AuvId;
use shoal_bus::summary::Summary;
use shoal_bus::time::SimTime;
use shoal_bus::traffic::{Fate, LossReason, Reception, SoundPath};
use shoal_channel::acoustics::ray::WaterColumn;
use shoal_channel::budget::Link;
use shoal_channel::channel::Channel;
use shoal_channel::water::Water;
use shoal_scenario::model::{
    Controller, CurrentField, Fading, FadingKind, FadingPer, Level, MediumAccess, Noise, Place, Scenario, Sea,
};
use shoal_scenario::parse;
use shoal_tests::{random_sea_scenario, run_local, run_local_watched, scenario_file};

/// One ping at one receiver.
#[derive(Clone, Debug)]
struct Passage {
    from: u32,
    to: u32,
    sequence: u32,
    emitted_ns: i64,
    range_m: f64,
    travel_s: f64,
    reception: Reception,
}

/// What a run showed.
#[derive(Default)]
struct Shown {
    emitted: BTreeMap<(u32, u32), SimTime>,
    places_m: BTreeMap<u32, [f64; 3]>,
    heard: Vec<Passage>,
    lost: Vec<(u32, AuvId, LossReason, Vec<AuvId>)>,
    receptions: Vec<(u32, Reception)>,
}

fn shown(scenario: &Scenario) -> (Shown, Summary) {
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

fn random_sea(number: u64, duration_s: f64) -> Scenario {
    parse("random.toml", &random_sea_scenario(number, duration_s)).unwrap()
}

fn sea(scenario: &mut Scenario) -> &mut Sea {
    let Level::Sea(sea) = &mut scenario.environment.level else { panic!("made for level sea") };
    sea
}

fn column(scenario: &Scenario) -> WaterColumn {
    Water::new(scenario).unwrap().column.unwrap()
}

/// A random sea in which nobody moves, all have one modem, and nothing fades.
fn still_sea(number: u64) -> Scenario {
    let mut scenario = random_sea(number, 20.0);
    let environment = &mut scenario.environment;
    (environment.current_m_s, environment.current_error_m_s) = ([0.0; 3], [0.0; 3]);
    environment.current_field = CurrentField::Uniform;
    sea(&mut scenario).fading = Fading { kind: FadingKind::Gaussian, per: FadingPer::Packet };
    let area_m = scenario.environment.area_m;
    let mut modem = scenario.groups[0].modem.clone();
    modem.access = MediumAccess::Periodic { period_ns: 5_000_000_000, phase_ns: None };
    modem.duty_cycle = None;
    if let Some(layer) = &mut modem.physical {
        layer.source_level_db = 190.0;
    }
    for group in &mut scenario.groups {
        group.modem = modem.clone();
        group.kind.disturbance_m_s = [0.0; 3];
        group.kind.speed_max_m_s = 1e-12;
        group.start.speed_m_s = 0.0;
        group.controller = Controller::Hold;
        // On the surface, a nanometre of motion decides whether there is water above.
        group.start.place = Place::Region(area_m.map(|[least, most]| {
            let rim_m = 0.01 * (most - least);
            [least + rim_m, most - rim_m]
        }));
    }
    scenario
}

/// Another way's path, and itself for those that are the same backwards.
fn backwards(path: SoundPath) -> SoundPath {
    match path {
        SoundPath::Bounced { first, bounces } if bounces % 2 == 0 => {
            SoundPath::Bounced { first: first.other(), bounces }
        }
        path => path,
    }
}

#[test]
fn still_bodies_hear_each_other_alike_and_as_the_rays_and_the_budget_say() {
    let (mut pairs, mut direct) = (0, 0);
    for number in 0..40 {
        let mut scenario = still_sea(number);
        let (shown, _) = shown(&scenario);
        let water = column(&scenario);
        let physical = scenario.groups[0].modem.physical.unwrap();
        let link = Link::new(sea(&mut scenario), &physical, &physical);
        let mut ways = BTreeMap::new();
        for passage in &shown.heard {
            ways.insert((passage.from, passage.to, passage.reception.path), passage);
            if passage.reception.path != SoundPath::Direct {
                continue;
            }
            direct += 1;
            let (from, to) = (shown.places_m[&passage.from], shown.places_m[&passage.to]);
            let (east_m, north_m) = (to[0] - from[0], to[1] - from[1]);
            let range_m = (east_m * east_m + north_m * north_m).sqrt();
            let Some(ray) = water.direct(-from[2], -to[2], range_m, None) else {
                panic!(
                    "{number}: no ray {from:?} {to:?} {passage:?} {:?} {}",
                    water.profile(),
                    water.bottom_depth_m()
                )
            };
            assert!((ray.travel_s - passage.travel_s).abs() < 2e-9, "{number}: {passage:?} {ray:?}");
            let level_db = link.level_db(ray.length_m, 0.0);
            assert!((level_db - passage.reception.level_db).abs() < 1e-6, "{number}: {passage:?} {level_db}");
            assert!((passage.reception.doppler - 1.0).abs() < 1e-12);
        }
        for (&(from, to, path), there) in &ways {
            let Some(back) = ways.get(&(to, from, backwards(path))) else { continue };
            pairs += 1;
            // Each is rounded up to a whole nanosecond; bounced paths are found to a microsecond.
            let near_s = if path == SoundPath::Direct { 1.1e-9 } else { 1e-6 };
            assert!((there.travel_s - back.travel_s).abs() < near_s, "{number}: {there:?} {back:?}");
            assert!((there.reception.level_db - back.reception.level_db).abs() < 1e-6, "{there:?} {back:?}");
            assert!((there.range_m - back.range_m).abs() < 1e-9);
        }
    }
    println!("{pairs} pairs of ways, {direct} direct passages");
    assert!(pairs > 300 && direct > 500, "{pairs} {direct}");
}

#[test]
fn nobody_hears_before_sound_can_be_there_or_louder_than_the_source() {
    let mut heard = 0;
    for number in 0..120 {
        let mut scenario = random_sea(500 + number, 20.0);
        let gaussian = matches!(sea(&mut scenario).fading.kind, FadingKind::Gaussian)
            || sea(&mut scenario).fading.per == FadingPer::Bit;
        let (shown, _) = shown(&scenario);
        let (_, fastest_m_s) = column(&scenario).profile().speed_bounds_m_s(f64::NEG_INFINITY, f64::INFINITY);
        let mut last_ns = BTreeMap::new();
        heard += shown.heard.len();
        let mut in_order = shown.heard.clone();
        in_order.sort_by_key(|passage| (passage.from, passage.sequence, passage.to));
        for passage in &in_order {
            // A nanosecond of travel and what the receiver moves in it.
            let soonest_s = passage.range_m / fastest_m_s - 3e-9;
            assert!(passage.travel_s >= soonest_s && passage.travel_s >= 0.0, "{number}: {passage:?}");
            // A ping overtakes nothing that takes the same path.
            let arrived_ns = passage.emitted_ns + (passage.travel_s * 1e9).round() as i64;
            let key = (passage.from, passage.to, passage.reception.path);
            if let Some(before_ns) = last_ns.insert(key, arrived_ns) {
                assert!(before_ns < arrived_ns, "{number}: {passage:?} overtook");
            }
        }
        let mut source_db = Vec::new();
        for group in &scenario.groups {
            let level_db = group.modem.physical.unwrap().source_level_db;
            source_db.extend((0..group.count).map(|_| level_db));
        }
        for (from, reception) in &shown.receptions {
            let Reception { level_db, sinr_db, doppler, .. } = *reception;
            assert!(
                level_db.is_finite() && sinr_db.is_finite() && (0.9..1.1).contains(&doppler),
                "{reception:?}"
            );
            // Fading lifts a packet by 16 dB at most: one in 2^53 gets more.
            let luck_db = if gaussian { 0.0 } else { 18.7 };
            assert!(level_db <= source_db[*from as usize] + luck_db, "{number}: {from} {reception:?}");
        }
    }
    assert!(heard > 3_000, "{heard}");
}

/// A scenario of AUVs that stay where these points are, with perfect clocks, sensors and modems that all ping at these
/// local times, all by `modem` lines.
fn standing(points_m: &[[f64; 3]], modem: &str, environment: &str, more: &str) -> Scenario {
    let text = format!(
        r#"
name = "standing"
duration_s = 8
{more}
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

const STEADY: &str =
    "sea = { fading = \"gaussian\", bounces_max = 0, spreading_exponent = 2, surface_loss_db = 20 }";

/// So many places on a circle around the middle.
fn around(count: usize, radius_m: f64) -> Vec<[f64; 3]> {
    (0..count)
        .map(|index| {
            let angle_rad = 2.0 * std::f64::consts::PI * index as f64 / count as f64;
            let (sin, cos) = pxfm::f_sincos(angle_rad);
            [radius_m * cos, radius_m * sin, -50.0]
        })
        .collect()
}

#[test]
fn packets_equally_loud_at_once_are_all_lost_to_each_other() {
    for count in [2, 3, 7, 20] {
        let mut points_m = around(count, 400.0);
        points_m.push([0.0, 0.0, -50.0]);
        let middle = AuvId(count as u32);
        // As many bits as the band has hertz: nothing is gained by spreading.
        let modem = "ping_period_s = 4\nping_phase_s = 1\nbit_rate_bit_s = 16000\ncoding_gain_db = 0";
        let mut scenario = standing(&points_m, modem, STEADY, "");
        let mut silent = scenario.groups[0].clone();
        // The one in the middle only listens: emitting it would be deaf.
        silent.modem.access = MediumAccess::Silent;
        silent.name = "ear".to_owned();
        silent.count = 1;
        scenario.groups[0].count = count as u32;
        if let Place::Points(points) = &mut silent.start.place {
            points.drain(..count);
        }
        scenario.groups.push(silent);
        let (shown, summary) = shown(&scenario);
        let in_the_middle: Vec<_> = shown.lost.iter().filter(|lost| lost.1 == middle).collect();
        assert_eq!(in_the_middle.len(), 2 * count, "{:?}", summary.pings);
        for (from, _, reason, colliding) in in_the_middle {
            assert_eq!(*reason, LossReason::Collision);
            let others: Vec<_> = (0..count as u32).filter(|other| other != from).map(AuvId).collect();
            assert_eq!(colliding, &others, "{from}");
        }
        // The others emit at once too: neighbours are deaf before the first sound is there.
        assert!(count < 20 || summary.pings.lost.half_duplex > 0, "{:?}", summary.pings);
    }
}

#[test]
fn the_loudest_by_far_is_captured_and_the_faint_are_lost_to_it() {
    // 30 m away and 600 m away: 26 dB and more between them; the far one begins first and is overtaken.
    let points_m = [[30.0, 0.0, -50.0], [600.0, 0.0, -50.0], [0.0, 0.0, -50.0]];
    let mut scenario = standing(&points_m, "ping_period_s = 4\nping_phase_s = 1", STEADY, "");
    let near = scenario.groups[0].clone();
    let single = |index: usize, phase_ns: Option<i64>| {
        let mut group = near.clone();
        group.name = format!("g{index}");
        group.count = 1;
        group.start.place = Place::Points(vec![points_m[index]]);
        group.modem.access = match phase_ns {
            Some(phase_ns) => MediumAccess::Periodic { period_ns: 4_000_000_000, phase_ns: Some(phase_ns) },
            None => MediumAccess::Silent,
        };
        group
    };
    // Half a second into the far one's packet at the middle.
    scenario.groups = vec![single(0, Some(1_500_000_000)), single(1, Some(1_000_000_000)), single(2, None)];
    let (shown, _) = shown(&scenario);
    let heard: Vec<_> = shown.heard.iter().filter(|passage| passage.to == 2).collect();
    assert!(heard.len() == 2 && heard.iter().all(|passage| passage.from == 0), "{heard:?}");
    let lost: Vec<_> = shown.lost.iter().filter(|lost| lost.1 == AuvId(2)).collect();
    assert_eq!(lost.len(), 2);
    for lost in lost {
        assert_eq!((lost.0, lost.2, lost.3.as_slice()), (1, LossReason::Collision, [AuvId(0)].as_slice()));
    }
}

#[test]
fn who_emits_is_deaf_and_who_sleeps_hears_nothing() {
    let points_m = [[0.0, 0.0, -50.0], [150.0, 0.0, -50.0]];
    // 0.1 s apart, packets of 0.454 s.
    let scenario = standing(&points_m, "ping_period_s = 4\nping_phase_s = 1", STEADY, "");
    let (shown_deaf, summary) = shown(&scenario);
    assert!(shown_deaf.heard.is_empty());
    assert_eq!(summary.pings.lost.half_duplex, 4);
    assert!(shown_deaf.lost.iter().all(|lost| lost.2 == LossReason::HalfDuplex), "{:?}", summary.pings);

    // Awake for the first second of every four: both emit in the third.
    let asleep = "ping_period_s = 4\nping_phase_s = 1\nduty_cycle = { period_s = 4, awake_s = 1 }";
    let mut scenario = standing(&points_m, asleep, STEADY, "");
    let mut other = scenario.groups[0].clone();
    scenario.groups[0].count = 1;
    other.name = "other".to_owned();
    other.count = 1;
    for (group, (index, phase_ns)) in
        [&mut scenario.groups[0], &mut other].into_iter().zip([(0, 2_000_000_000), (1, 3_100_000_000)])
    {
        group.start.place = Place::Points(vec![points_m[index]]);
        group.modem.access = MediumAccess::Periodic { period_ns: 4_000_000_000, phase_ns: Some(phase_ns) };
    }
    scenario.groups.push(other);
    let (_, summary) = shown(&scenario);
    assert_eq!((summary.pings.heard, summary.pings.lost.asleep), (0, summary.pings.emitted));
    // The same a second and a half later, when they listen.
    for (group, phase_ns) in scenario.groups.iter_mut().zip([4_050_000_000, 8_000_000_000]) {
        group.modem.access = MediumAccess::Periodic { period_ns: 4_000_000_000, phase_ns: Some(phase_ns) };
    }
    let (_, summary) = shown(&scenario);
    assert_eq!((summary.pings.emitted, summary.pings.heard), (1, 1), "{:?}", summary.pings);
}

#[test]
fn bodies_at_equal_places_hear_each_other_at_once() {
    let place_m = [3.0, -7.0, -20.0];
    for bounces_max in [0, 3] {
        let environment = format!("sea = {{ bounces_max = {bounces_max} }}");
        let modem = "access = { name = \"slotted\", slot_s = 1, guard_range_m = 100 }";
        let scenario = standing(&[place_m; 3], modem, &environment, "");
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
        channel.accept(answers);
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
    let scenario = standing(&points_m, modem, STEADY, "");
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
