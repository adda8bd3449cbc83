//! Trajectories reconstructed after the run: never without the truth, never wider than box by box online, the same in any order.

use std::collections::BTreeMap;

use shoal_auv::Auv;
use shoal_auv::offline::{Booked, Reconstruction, Recorded, Trajectory};
use shoal_bus::chronicle::{Truth, What};
use shoal_bus::message::{Born, Bounds, Estimator, Report, box_width};
use shoal_bus::summary::Summary;
use shoal_channel::channel::Channel;
use shoal_scenario::model::{Estimator as EstimatorOrders, Noise, Scenario};
use shoal_tests::{library_scenario, random_scenario, random_sea_scenario, run_local_watched};

/// What happened to one AUV at one tick: the true time and the rest of the truth, and what it believed.
type Told = (f64, Truth, Report);

/// A run as its record would tell it.
struct Run {
    recorded: Vec<Recorded>,
    ticks: Vec<BTreeMap<u64, Told>>,
    summary: Summary,
}

fn run(scenario: &Scenario) -> Run {
    let born: Vec<Born> = Channel::new(scenario).unwrap().born();
    let mut ticks = vec![BTreeMap::new(); born.len()];
    let mut truths = vec![None; born.len()];
    let mut recorded: Vec<Recorded> =
        born.into_iter().map(|born| Recorded { born, sensed: Vec::new(), booked: Vec::new() }).collect();
    let summary = run_local_watched(scenario, None, Auv::new, |entry| {
        let auv = entry.auv.0 as usize;
        match &entry.what {
            What::Truth(truth) => truths[auv] = Some((entry.at.as_s(), *truth)),
            What::Sensed(sensed) => recorded[auv].sensed.push(sensed.clone()),
            What::Acted(acted) => {
                let (at_s, truth) = truths[auv].unwrap();
                ticks[auv].insert(acted.tick, (at_s, truth, acted.report.clone()));
                let booked = acted.pings.iter().map(|ping| Booked { at: ping.at, frame: ping.frame });
                recorded[auv].booked.extend(booked);
            }
            _ => {}
        }
    })
    .unwrap();
    Run { recorded, ticks, summary }
}

fn forward(trajectories: &mut [Trajectory], sweep: &(dyn Fn(&mut Trajectory) + Sync)) {
    trajectories.iter_mut().for_each(sweep);
}

fn solved(run: &Run) -> Reconstruction {
    let mut reconstruction = Reconstruction::new(&run.recorded);
    while reconstruction.round(&forward) {}
    reconstruction
}

fn short(name: &str, duration_s: f64, noise: Noise) -> Scenario {
    let mut scenario = library_scenario(name);
    scenario.duration_ns = scenario.duration_ns.min((duration_s * 1e9) as i64);
    scenario.noise = noise;
    // Offline contracts box by box; what several rings say together can be tighter.
    for group in &mut scenario.groups {
        if let EstimatorOrders::Tube(tube) = &mut group.estimator {
            tube.rings = 0;
        }
    }
    scenario
}

/// Fails unless every state at a tick holds the truth and is no wider than what the AUV knew then. The median widths of
/// boxes, alone, online and offline, are returned.
#[track_caller]
fn check(name: &str, run: &Run, reconstruction: &Reconstruction) -> [f64; 3] {
    let mut widths_m = [const { Vec::new() }; 3];
    for (auv, trajectory) in reconstruction.trajectories().iter().enumerate() {
        let stamp_s = run.recorded[auv].born.clock.stamp_ns as f64 * 1e-9;
        assert_eq!(trajectory.ticks().len(), run.recorded[auv].sensed.len());
        for tick in trajectory.ticks() {
            let Some((at_s, truth, report)) = run.ticks[auv].get(&tick.tick) else { continue };
            let place = format!("{name}, AUV {auv}, tick {}", tick.tick);
            let offset_s = at_s - tick.stamp.as_s();
            for (which, state) in [&tick.alone, &tick.state].into_iter().enumerate() {
                for axis in 0..3 {
                    let holds = state.position_m[axis].contains(truth.position_m[axis]);
                    assert!(
                        holds,
                        "{place} {which}: {} in {}",
                        truth.position_m[axis], state.position_m[axis]
                    );
                }
                let clock = state.offset_s.inflate(stamp_s);
                assert!(clock.contains(offset_s), "{place} {which}: {offset_s} in {clock}");
            }
            // What a Kalman filter believes may be narrower than what is certain.
            let is_tube = matches!(run.recorded[auv].born.orders.estimator, Estimator::Tube(_));
            let wider =
                |offline: f64, online: Bounds| is_tube && offline > online.width() * (1.0 + 1e-9) + 1e-5;
            for axis in 0..3 {
                let (offline, online) = (tick.state.position_m[axis], report.position_m[axis]);
                assert!(!wider(offline.width(), online), "{place}: {offline} wider than {online:?}");
            }
            let offline = tick.state.offset_s.inflate(stamp_s);
            assert!(!wider(offline.width(), report.clock_offset_s), "{place}: {offline}");
            let widths =
                [tick.alone.position_m.width(), box_width(&report.position_m), tick.state.position_m.width()];
            widths_m.iter_mut().zip(widths).for_each(|(all, one)| all.push(one));
        }
    }
    widths_m.map(|mut widths| {
        widths.sort_by(f64::total_cmp);
        widths[widths.len() / 2]
    })
}

#[test]
fn no_trajectory_loses_the_truth_or_is_wider_than_online() {
    for (name, duration_s) in [
        ("two-circles", 3.0),
        ("six-circles", 30.0),
        ("six-auvs-3d", 30.0),
        ("sea-trial", 10.0),
        ("thermocline", 30.0),
        ("crowded-band", 10.0),
        ("data-incest", 20.0),
        ("swarm-3", 20.0),
        ("swarm-300", 1.0),
        ("swarm-1000", 1.0),
    ] {
        for noise in [Noise::Uniform, Noise::Adversarial] {
            let run = run(&short(name, duration_s, noise));
            let reconstruction = solved(&run);
            let widths_m = check(name, &run, &reconstruction);
            assert_eq!(reconstruction.dropped(), 0, "{name}");
            println!(
                "{name} {noise:?}: {widths_m:.3?} m, {} rounds, {:?} pings",
                reconstruction.rounds(),
                reconstruction.pings()
            );
        }
    }
}

#[test]
fn the_order_of_sweeps_does_not_matter() {
    let run = run(&short("six-circles", 25.0, Noise::Uniform));
    let backward = |trajectories: &mut [Trajectory], sweep: &(dyn Fn(&mut Trajectory) + Sync)| {
        trajectories.iter_mut().rev().for_each(sweep);
    };
    let side_by_side = |trajectories: &mut [Trajectory], sweep: &(dyn Fn(&mut Trajectory) + Sync)| {
        std::thread::scope(|scope| {
            trajectories.iter_mut().for_each(|trajectory| drop(scope.spawn(move || sweep(trajectory))));
        });
    };
    let states = |reconstruction: &Reconstruction| {
        let ticks = reconstruction.trajectories().iter().flat_map(Trajectory::ticks);
        format!("{} {:?}", reconstruction.rounds(), ticks.collect::<Vec<_>>())
    };
    let expected = states(&solved(&run));
    let mut other = Reconstruction::new(&run.recorded);
    while other.round(&backward) {}
    assert!(states(&other) == expected);
    let mut other = Reconstruction::new(&run.recorded);
    while other.round(&side_by_side) {}
    assert!(states(&other) == expected);
}

/// Echoes are no part of the bounds: the truth may be lost where nothing contradicts them, but it all comes to an end.
#[test]
fn echoes_are_dropped_where_they_leave_nothing() {
    let run = run(&short("surface-bounce", 200.0, Noise::Uniform));
    let reconstruction = solved(&run);
    println!(
        "{:?} pings, {} dropped, {} restarts",
        reconstruction.pings(),
        reconstruction.dropped(),
        reconstruction.restarts()
    );
    assert!(reconstruction.pings().0 > 100);
    let ticks = reconstruction.trajectories().iter().flat_map(Trajectory::ticks);
    assert!(ticks.into_iter().all(|tick| !tick.state.is_empty()));
}

/// Whatever estimators, clocks, seas and modems are drawn: where nothing false was said, nothing is dropped and the truth is in every
/// state, and all comes to an end in any case. `SHOAL_RANDOM_SCENARIOS` sets how many are drawn.
#[test]
fn random_records_hold_the_truth() {
    let count =
        std::env::var("SHOAL_RANDOM_SCENARIOS").ok().and_then(|count| count.parse().ok()).unwrap_or(40);
    let (mut states, mut tied, mut honest) = (0, 0, 0);
    for number in 0..count {
        let draw: fn(u64, f64) -> String =
            if number % 2 == 0 { random_scenario } else { random_sea_scenario };
        let text = draw(3_000_000 + number, 6.0);
        let scenario = shoal_scenario::parse("random.toml", &text).unwrap();
        let run = run(&scenario);
        let reconstruction = solved(&run);
        let is_deceived = run.summary.pings.outliers > 0 || run.summary.containment.kidnapped.is_some();
        assert!(is_deceived || reconstruction.dropped() == 0, "{} dropped\n{text}", reconstruction.dropped());
        tied += reconstruction.pings().0;
        honest += u32::from(!is_deceived);
        for (auv, trajectory) in reconstruction.trajectories().iter().enumerate() {
            let stamp_s = run.recorded[auv].born.clock.stamp_ns as f64 * 1e-9;
            for tick in trajectory.ticks() {
                assert!(!tick.state.is_empty());
                let Some((at_s, truth, _)) = run.ticks[auv].get(&tick.tick).filter(|_| !is_deceived) else {
                    continue;
                };
                let offset_s = at_s - tick.stamp.as_s();
                for state in [&tick.alone, &tick.state] {
                    states += 1;
                    let holds = (0..3).all(|axis| state.position_m[axis].contains(truth.position_m[axis]))
                        && state.offset_s.inflate(stamp_s).contains(offset_s);
                    assert!(
                        holds,
                        "AUV {auv}, tick {}: {truth:?}, {offset_s} in {state:?}\n{text}",
                        tick.tick
                    );
                }
            }
        }
    }
    println!(
        "{states} states hold the truth, {tied} pings tied, in {honest} of {count} records nothing is false"
    );
    assert!(
        states > 100 * count && tied > count as usize && 4 * u64::from(honest) > count,
        "too dull to prove anything"
    );
}
