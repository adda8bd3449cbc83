//! AUVs that are lost and born again in the middle of a run: their new minds never lose the truth either.

use shoal_auv::Auv;
use shoal_bus::chronicle::What;
use shoal_bus::local::Local;
use shoal_bus::lockstep::{Fleet, Loss};
use shoal_bus::message::AuvId;
use shoal_bus::summary::Summary;
use shoal_bus::time::SimTime;
use shoal_channel::channel::Channel;
use shoal_scenario::{Overrides, Scenario};
use shoal_tests::library_scenario;

/// A run of `scenario` in which each of `lives` is lost at the first time, in seconds, and born again at the second. Also how often the AUV
/// has answered since.
fn run(scenario: &Scenario, lives: &[(u32, f64, f64)]) -> (Summary, Vec<u64>) {
    let ns = |s: f64| SimTime::from_ns((s * 1e9) as i64);
    let mut channel = Channel::new(scenario).unwrap();
    let mut fleet = Local::new(Auv::new);
    fleet.born(&channel.born()).unwrap();
    let mut answered = vec![0; lives.len()];
    while channel.now() < channel.end() {
        let (from, to) = (channel.now(), (channel.now() + scenario.window_ns).min(channel.end()));
        let is_now = |at: f64| from <= ns(at) && ns(at) < to;
        let sensed = channel.advance(to).unwrap();
        let mut answers = fleet.exchange(&sensed, &mut || {}).unwrap();
        for &(auv, _, _) in lives.iter().filter(|life| is_now(life.1)) {
            answers.acted.retain(|batch| batch.auv != AuvId(auv));
            answers.losses.push(Loss { auv: AuvId(auv), reason: "test".into() });
        }
        channel.accept(sensed, answers);
        let again: Vec<AuvId> =
            lives.iter().filter(|life| is_now(life.2)).map(|life| AuvId(life.0)).collect();
        for entry in channel.chronicle().unwrap() {
            for ((auv, _, born), answered) in lives.iter().zip(&mut answered) {
                *answered += u64::from(
                    entry.auv == AuvId(*auv) && entry.at >= ns(*born) && matches!(entry.what, What::Acted(_)),
                );
            }
        }
        let born = channel.revive(&again);
        assert_eq!(born.iter().map(|born| born.auv).collect::<Vec<_>>(), again);
        for born in &born {
            let until_tick = born.wake.first_tick - born.birth;
            assert!((1..=born.wake.period_ns).contains(&until_tick), "{until_tick}");
        }
        fleet.born(&born).unwrap();
    }
    channel.chronicle().unwrap();
    (channel.summary(), answered)
}

fn check(name: &str, auvs: Option<u32>, duration_s: f64, noise: &str, lives: &[(u32, f64, f64)]) {
    let noise = Some(noise.parse().unwrap());
    let overrides = Overrides { auvs, duration_s: Some(duration_s), noise, ..Overrides::default() };
    let scenario = overrides.apply(library_scenario(name)).unwrap();
    let (summary, answered) = run(&scenario, lives);
    let containment = &summary.containment;
    assert_eq!(containment.violations, 0, "{name}: {:?}", containment.first);
    assert!(containment.checks > 0 && !summary.reproducible);
    let restarted: Vec<(u32, bool)> = summary
        .agents
        .restarted
        .iter()
        .zip(&summary.agents.lost)
        .map(|(again, lost)| (again.auv, again.time_s >= lost.time_s && again.reason == "test"))
        .collect();
    let mut expected: Vec<(u32, bool)> = lives.iter().map(|life| (life.0, true)).collect();
    expected.sort_unstable();
    assert_eq!(restarted, expected, "{name}");
    assert!(answered.iter().all(|&answered| answered > 10), "{name}: {answered:?}");
}

#[test]
fn new_minds_hold_the_truth() {
    for noise in ["uniform", "adversarial"] {
        check("six-circles", None, 30.0, noise, &[(1, 4.0, 9.0), (4, 10.0, 10.5), (1, 15.0, 16.0)]);
        check("swarm-300", Some(12), 12.0, noise, &[(3, 2.0, 2.05), (7, 3.0, 6.0)]);
    }
}

#[test]
fn new_minds_hold_the_truth_in_the_sea_and_where_kidnappers_put_them() {
    // AUV 4 is carried away at 20 s.
    check("kidnapped", None, 60.0, "uniform", &[(0, 5.0, 15.0), (4, 15.0, 25.0)]);
    check("thermocline", Some(8), 40.0, "uniform", &[(2, 5.0, 12.0)]);
    check("sweep-16", None, 30.0, "uniform", &[(5, 5.0, 9.0)]);
}
