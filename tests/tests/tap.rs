//! `shoal tap` looks at live runs.

use std::collections::BTreeSet;

use shoal_tests::{Command, Finished, Live, alone, await_that, live_runs};

/// Runs a tap while exactly `own` are live on this host: others may come and go.
fn among(own: &[&Live], tap: &Command) -> Finished {
    let ids: BTreeSet<String> = own.iter().map(|live| live.run_id().unwrap()).collect();
    loop {
        await_that("no other run is live", || live_runs() == ids);
        let finished = tap.finish();
        if live_runs() == ids {
            return finished;
        }
    }
}

#[test]
fn five_events_as_json_and_as_text() {
    let _only_run = alone();
    let mut live = Command::new("run swarm-3 --pace 3 --json").start();
    live.await_pings(3);
    let finished = among(&[&live], &Command::new("tap --count 5 --json")).succeeded();
    let events = finished.json_lines();
    assert_eq!(events.len(), 5);
    for event in &events {
        assert_eq!((&event["format"], &event["topic"]), (&"shoal.tap/1".into(), &"/pings".into()));
        assert!(event["t_ns"].as_i64().unwrap() > 0);
        assert!(event["from"].as_u64().unwrap() < 3 && event["sequence"].is_u64());
        let fields: &[&str] = match event["fate"].as_str().unwrap() {
            "emitted" => &["position_m", "bytes", "box_width_m", "beyond_range"],
            "heard" => &["to", "range_m", "travel_s", "box_width_m"],
            "lost" => &["to", "reason", "range_m"],
            other => panic!("{other}"),
        };
        assert!(fields.iter().all(|field| !event[field].is_null()), "{event}");
    }
    let times: Vec<i64> = events.iter().map(|event| event["t_ns"].as_i64().unwrap()).collect();
    assert!(times.is_sorted(), "{times:?}");

    let text = among(&[&live], &Command::new("tap --count 5")).succeeded().stdout;
    assert_eq!(text.lines().count(), 5);
    for line in text.lines() {
        assert!(line.contains(" s  ") && line.contains("->"), "{line}");
        assert!(["emitted", "heard", "lost"].iter().any(|fate| line.contains(fate)), "{line}");
    }
    live.signal(rustix::process::Signal::INT);
    live.finish().exited(3);
}

#[test]
fn without_a_run_it_says_so() {
    let _no_run = alone();
    let finished = among(&[], &Command::new("tap")).exited(1);
    assert!(finished.stderr.starts_with("error: no run is live on this host"), "{}", finished.stderr);
    assert_eq!(finished.stdout, "");
    among(&[], &Command::new("tap --wait 0.2")).exited(1);
    let finished = Command::new("tap --run 00000000").finish().exited(1);
    assert!(finished.stderr.contains("no live run has the id `00000000`"), "{}", finished.stderr);
    Command::new("tap --wait -1").finish().exited(2);
}

#[test]
fn of_two_runs_it_asks_which() {
    let _only_runs = alone();
    let mut first = Command::new("run swarm-3 --pace 3 --json").start();
    let mut second = Command::new("run six-auvs-3d --pace 3 --json --bus zenoh").start();
    let ids = [first.await_pings(3), second.await_pings(6)];
    let finished = among(&[&first, &second], &Command::new("tap --count 1")).exited(2);
    for named in ["--run", "swarm-3", "six-auvs-3d", &ids[0], &ids[1]] {
        assert!(finished.stderr.contains(named), "{named}: {}", finished.stderr);
    }
    // The name of the scenario will do, where it is only one's.
    let named = ["swarm-3".to_owned(), "six-auvs-3d".to_owned()];
    for (id, auvs) in ids.iter().zip([3, 6]).chain(named.iter().zip([3, 6])) {
        let events = Command::new("tap --count 40 --json --run").with(id).finish().succeeded().json_lines();
        assert_eq!(events.len(), 40);
        assert!(events.iter().all(|event| event["from"].as_u64().unwrap() < auvs), "{events:?}");
    }
    let mut third = Command::new("run swarm-3 --pace 3 --json").start();
    third.await_pings(3);
    let finished = Command::new("tap --run swarm-3").finish().exited(2);
    assert!(finished.stderr.contains("several live runs are of `swarm-3`"), "{}", finished.stderr);
    let finished = Command::new("tap --run swarm-4").finish().exited(1);
    assert!(finished.stderr.contains("did you mean `swarm-3`?"), "{}", finished.stderr);
    for live in [first, second, third] {
        live.signal(rustix::process::Signal::INT);
        live.finish().exited(3);
    }
}

#[test]
fn a_waiting_tap_sees_a_run_from_its_beginning_to_its_end() {
    let _only_run = alone();
    let reference = Command::new("run swarm-3 --duration 12 --bus local").json();
    // Slow enough for a tap to come in time, and each ping is told.
    let mut live = Command::new("run swarm-3 --duration 12 --pace 4 --json").start();
    await_that("the run is there", || live.run_id().is_some());
    let tap = Command::new("tap --json --wait 60 --run").with(live.run_id().unwrap()).start();
    live.children();
    let summary = live.finish().succeeded().json();
    assert_eq!(summary["digest"], reference["digest"]);
    let events = tap.finish().succeeded().json_lines();
    let told = |kind: &str| events.iter().filter(|event| event["fate"] == kind).count() as u64;
    assert_eq!(told("emitted"), reference["pings"]["emitted"].as_u64().unwrap());
    assert_eq!(told("heard"), reference["pings"]["heard"].as_u64().unwrap());
}
