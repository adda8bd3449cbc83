//! However many threads work on a swarm, and however time is cut into windows, the same happens.

#![cfg(feature = "parallel")]

#[path = "../benches/swarm/mod.rs"]
mod swarm;

use shoal_bus::lockstep::Answers;
use shoal_bus::time::SimTime;
use shoal_channel::channel::Channel;
use shoal_scenario::model::{FalseArrivals, Fault, MediumAccess, Scenario};

use self::swarm::{Mind, scenario};

/// Enough AUVs for several pieces of work, one of which is short.
const AUVS: u32 = 150;
const END_NS: i64 = 2_500_000_000;

/// The digest and all other figures of a run.
fn run(scenario: &Scenario, window_ns: i64, threads: usize) -> String {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| {
        let mut channel = Channel::new(scenario).unwrap();
        let mut minds: Vec<Mind> = channel.born().iter().map(|born| Mind::new(born, true)).collect();
        let mut told = 0;
        while channel.now().ns() < END_NS {
            let to = SimTime::from_ns((channel.now().ns() + window_ns).min(END_NS));
            let sensed = channel.advance(to).unwrap();
            let acted = sensed.iter().map(|batch| minds[batch.auv.0 as usize].answer(batch)).collect();
            channel.accept(sensed, Answers { acted, losses: Vec::new() });
            told += channel.chronicle().unwrap().len();
        }
        let summary = channel.summary();
        assert!(told > 0 && summary.pings.heard > 500, "{:?}", summary.pings);
        let (digest, pings, checked) = (summary.digest, summary.pings, summary.containment);
        format!("{told} {digest} {pings:?} {checked:?} {:?} {:?}", summary.flock, summary.estimators)
    })
}

fn is_the_same_for_all(scenario: &Scenario) {
    let alone = run(scenario, 199_000_000, 1);
    for (window_ns, threads) in [(199_000_000, 2), (199_000_000, 8), (23_000_001, 1), (23_000_001, 8)] {
        assert_eq!(run(scenario, window_ns, threads), alone, "{threads} threads, windows of {window_ns} ns");
    }
}

#[test]
fn threads_and_windows_change_nothing_at_level_ideal() {
    let mut scenario = scenario("ideal", AUVS, 0.1);
    // Someone is carried through the swarm while sound flies, and modems mistake one arrival in ten.
    let to_m = [100.0, 100.0, -500.0];
    scenario.faults = vec![Fault::Kidnap { auv: 70, at_ns: 1_234_567_890, to_m }];
    scenario.groups[0].modem.outliers = FalseArrivals { rate: 0.1, delay_s: 0.3 };
    is_the_same_for_all(&scenario);
}

#[test]
fn threads_and_windows_change_nothing_at_level_sea() {
    is_the_same_for_all(&scenario("sea", AUVS, 0.1));
}

#[test]
fn threads_and_windows_change_nothing_for_those_who_listen_before_they_talk() {
    let mut scenario = scenario("sea", AUVS, 0.1);
    scenario.groups[0].modem.access =
        MediumAccess::Csma { period_ns: 500_000_000, listen_ns: 20_000_000, backoff_ns: 1 };
    is_the_same_for_all(&scenario);
}
