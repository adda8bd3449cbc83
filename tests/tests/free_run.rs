//! `shoal run --free-run`: real time with deadlines. Nobody waits for an AUV that is late, and no enclosure loses the truth by it.

use std::time::{Duration, Instant};

use rustix::process::Signal;
use serde_json::Value;
use shoal_auv::Auv;
use shoal_bus::local::Local;
use shoal_bus::lockstep::{Answers, Batch, Fleet};
use shoal_bus::time::SimTime;
use shoal_channel::channel::Channel;
use shoal_tests::{Command, library_scenario};

/// Six AUVs for some seconds, in real time.
const RUN: &str = "run six-circles --free-run --json --set group.control_period_s=0.1 --set group.reaction_s=0.2 \
    --set group.modem.ping_period_s=1 --window-ms 25";

/// The AUVs that missed deadlines, and how many each.
fn late(summary: &Value) -> Vec<(u64, u64)> {
    let late = summary["free_run"]["late"].as_array().unwrap().iter();
    late.map(|auv| (auv["auv"].as_u64().unwrap(), auv["misses"].as_u64().unwrap())).collect()
}

fn stopped_for_a_second(bus: &str) {
    let _alone = shoal_tests::alone();
    let mut live = Command::new(RUN).and("--duration 8 --bus").with(bus).start();
    live.await_pings(6);
    let victim = live.auvs()[&2];
    victim.signal(Signal::STOP);
    std::thread::sleep(Duration::from_secs(1));
    victim.signal(Signal::CONT);
    let began = Instant::now();
    let summary = live.finish().succeeded().json();
    assert!(began.elapsed() > Duration::from_secs(3), "it ran faster than real time");
    assert_eq!(summary["containment"]["violations"], 0, "{summary}");
    assert_eq!((&summary["reproducible"], &summary["sim_s"]), (&false.into(), &8.0.into()));
    assert_eq!(summary["agents"]["lost"].as_array().unwrap().len(), 0);
    // It woke ten times while it was stopped, the last two times it was in time after all; a busy machine may have made others late.
    let misses = late(&summary).iter().find(|(auv, _)| *auv == 2).map_or(0, |(_, misses)| *misses);
    assert!(misses >= 7, "{summary}");
    let worst_s = summary["free_run"]["worst_s"].as_f64().unwrap();
    assert!(worst_s > 0.5, "{summary}");
    let lag_s = summary["free_run"]["lag_max_s"].as_f64().unwrap();
    if lag_s < 0.05 {
        assert!(misses <= 12, "{summary}");
        // What else runs on the machine may hold up another one now and then.
        assert!(late(&summary).iter().all(|(auv, others)| *auv == 2 || 2 * others < misses), "{summary}");
    }
}

#[test]
fn an_auv_that_is_stopped_misses_its_deadlines_and_nobody_else_does_in_shared_memory() {
    stopped_for_a_second("iceoryx2");
}

#[test]
fn an_auv_that_is_stopped_misses_its_deadlines_and_nobody_else_does_over_zenoh() {
    stopped_for_a_second("zenoh");
}

#[test]
fn the_dead_are_noticed_even_while_they_are_late() {
    let _alone = shoal_tests::alone();
    let mut live = Command::new(RUN).and("--duration 6").start();
    live.await_pings(6);
    let victim = live.auvs()[&4];
    victim.signal(Signal::STOP);
    std::thread::sleep(Duration::from_millis(500));
    victim.signal(Signal::KILL);
    let summary = live.finish().exited(3).json();
    assert_eq!(summary["agents"]["lost"][0]["auv"], 4);
    assert_eq!(summary["containment"]["violations"], 0);
}

#[test]
fn a_channel_that_is_held_up_lags_and_goes_on() {
    let _alone = shoal_tests::alone();
    let mut live = Command::new(RUN).and("--duration 6").start();
    live.await_pings(6);
    let channel = live.channel().unwrap();
    channel.signal(Signal::STOP);
    std::thread::sleep(Duration::from_secs(1));
    channel.signal(Signal::CONT);
    let summary = live.finish().succeeded().json();
    let free_run = &summary["free_run"];
    assert!(free_run["lag_max_s"].as_f64().unwrap() > 0.8, "{free_run}");
    // Nobody could answer in time what was asked too late.
    assert_eq!(late(&summary).len(), 6, "{free_run}");
    assert_eq!((&summary["sim_s"], &summary["containment"]["violations"]), (&6.0.into(), &0.into()));
}

#[test]
fn free_runs_follow_the_clock_and_refuse_what_makes_no_sense() {
    let summary = Command::new("run six-circles --free-run --pace 20 --duration 20 --bus local").json();
    assert!(summary["wall_s"].as_f64().unwrap() >= 0.99, "{summary}");
    assert_eq!(summary["containment"]["violations"], 0);
    let lockstep = Command::new("run six-circles --duration 2 --bus local").json();
    assert_eq!((&lockstep["free_run"], &lockstep["reproducible"]), (&Value::Null, &true.into()));
    let refused = Command::new("run six-circles --free-run --pace max").finish().exited(2);
    assert!(refused.stderr.contains("follows the wall clock"), "{}", refused.stderr);
    let refused = Command::new("run swarm-3 --free-run --window-ms 150").finish().exited(2);
    assert!(refused.stderr.contains("--window-ms is too long for --free-run"), "{}", refused.stderr);
}

/// Minds that are late now and then, by whole windows, and clocks and sounds as in the library: whatever comes late is as true
/// as it was.
#[test]
fn whatever_comes_late_is_true() {
    for (name, auvs, seconds) in [("swarm-300", 24, 8), ("six-circles", 6, 20), ("sweep-16", 16, 30)] {
        let scenario = library_scenario(name);
        let overrides = shoal_scenario::Overrides {
            auvs: Some(auvs),
            duration_s: Some(f64::from(seconds)),
            ..Default::default()
        };
        let scenario = overrides.apply(scenario).unwrap();
        let mut channel = Channel::new(&scenario).unwrap();
        let mut fleet = Local::new(Auv::new);
        fleet.born(&channel.born()).unwrap();
        let mut waiting: Vec<Batch<_>> = Vec::new();
        for window in 0_u64.. {
            if channel.now() >= channel.end() {
                break;
            }
            let to = (channel.now() + channel.lookahead_ns() / 4).min(channel.end());
            let sensed = channel.advance(to).unwrap();
            for Batch { auv, items } in sensed.clone() {
                match waiting.iter_mut().find(|batch: &&mut Batch<_>| batch.auv == auv) {
                    Some(batch) => batch.items.extend(items),
                    None => waiting.push(Batch { auv, items }),
                }
            }
            waiting.sort_by_key(|batch| batch.auv);
            // A third of them is up to forty windows late at a time.
            let is_late = |auv: u32| (u64::from(auv) * 7 + window / 40).is_multiple_of(3);
            let (late, ready) = waiting.into_iter().partition(|batch| is_late(batch.auv.0));
            waiting = late;
            let answers: Answers = fleet.exchange(&ready, &mut || {}).unwrap();
            channel.accept_late(sensed, answers, to);
            let since = channel.chronicle().unwrap().iter().map(|entry| entry.at).min();
            assert!(
                since.is_none_or(|since| since >= to + -channel.lookahead_ns()),
                "the chronicle goes on in time"
            );
        }
        let summary = channel.summary();
        let free_run = summary.free_run.as_ref().unwrap();
        assert!(free_run.deadline_misses > 50, "{name}: {free_run:?}");
        assert_eq!(summary.containment.violations, 0, "{name}: {:?}", summary.containment.first);
        assert!(summary.containment.checks > 1000 && channel.now() == SimTime::from_ns(scenario.duration_ns));
    }
}
