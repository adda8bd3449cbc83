//! One scenario and one seed give one digest and one record, whatever carries them out.

use serde_json::Value;
use shoal_tests::{Command, alone, scenario_file};

const BUSES: [&str; 3] = ["local", "iceoryx2", "zenoh"];

fn digest(arguments: &str) -> String {
    let summary = Command::new(arguments).json();
    assert_eq!((&summary["reproducible"], &summary["containment"]["violations"]), (&true.into(), &0.into()));
    text(&summary["digest"])
}

fn text(value: &Value) -> String {
    value.as_str().unwrap().to_owned()
}

#[test]
fn six_circles_on_every_bus_in_every_window_and_again() {
    let reference = digest("run six-circles --bus local");
    assert!(reference.starts_with("blake3:") && reference.len() == 71, "{reference}");
    for bus in BUSES {
        // 90 is its own: each comes twice.
        for window_ms in ["90", "90", "10", "50", "33.333", "90.909089"] {
            let other = digest(&format!("run six-circles --bus {bus} --window {window_ms}"));
            assert_eq!(other, reference, "{bus} {window_ms}");
        }
    }
}

#[test]
fn auvs_that_share_processes_change_nothing() {
    let _cores = alone();
    for scenario in ["six-circles", "swarm-300 --duration 3"] {
        let reference = digest(&format!("run {scenario} --bus local"));
        for bus in ["iceoryx2", "zenoh"] {
            for each in [7, 1000] {
                let other = digest(&format!("run {scenario} --bus {bus} --auvs-per-process {each}"));
                assert_eq!(other, reference, "{scenario} {bus} {each}");
            }
        }
    }
}

#[test]
fn another_seed_or_mood_gives_another_digest() {
    let mut digests: Vec<String> = ["", "--seed 8", "--noise adversarial", "--duration 59.99"]
        .iter()
        .map(|change| digest(&format!("run six-circles {change}")))
        .collect();
    assert_eq!(digest("run six-circles --seed 7"), digests[0]);
    digests.sort();
    digests.dedup();
    assert_eq!(digests.len(), 4);
}

#[test]
fn the_pace_changes_nothing() {
    for bus in BUSES {
        let reference = digest(&format!("run six-circles --duration 8 --bus {bus} --pace max"));
        assert_eq!(digest(&format!("run six-circles --duration 8 --bus {bus} --pace 4")), reference, "{bus}");
        assert_eq!(digest("run six-circles --duration 8 --bus local"), reference, "{bus}");
    }
}

#[test]
fn a_tap_and_a_record_change_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let reference = digest("run six-circles --bus local");
    for bus in BUSES {
        let record = folder.path().join(format!("{bus}.mcap"));
        let mut live = Command::new("run six-circles --pace 20 --json --record")
            .with(&record)
            .with("--bus")
            .with(bus)
            .start();
        let auvs = if bus == "local" { 0 } else { 6 };
        let id = live.await_pings(auvs);
        let tap = Command::new("tap --json --run").with(&id).start();
        let summary = live.finish().succeeded().json();
        assert_eq!(text(&summary["digest"]), reference, "{bus}");
        // It looked on to the very end.
        let seen = tap.finish().succeeded().json_lines();
        assert!(seen.len() > 10, "{bus}: {seen:?}");
        let info = Command::new("record info --json").with(&record).finish().succeeded().json();
        assert_eq!(text(&info["digest"]), reference);
    }
}

#[test]
fn records_of_equal_runs_are_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let record = |name: &str, arguments: &str| {
        let path = folder.path().join(name);
        Command::new(arguments).with("--record").with(&path).json();
        std::fs::read(path).unwrap()
    };
    for scenario in ["six-circles", "swarm-300 --auvs 30 --duration 7.5"] {
        let reference = record("reference.mcap", &format!("run {scenario} --bus local"));
        for bus in BUSES {
            for window_ms in ["90", "90", "10", "50"] {
                let other = record("other.mcap", &format!("run {scenario} --bus {bus} --window {window_ms}"));
                assert!(other == reference, "{scenario} {bus} {window_ms}");
            }
        }
        let another = record("other.mcap", &format!("run {scenario} --seed 99"));
        assert!(another != reference);
    }
}

#[test]
fn a_small_sea_on_every_bus_and_in_every_window() {
    let run = |bus: &str, window_ms: &str| {
        let command = Command::new("run").with(scenario_file("three-accesses")).and("--bus").with(bus);
        let summary = command.and("--window").with(window_ms).json();
        let (seen, violations) = (&summary["pings"], &summary["containment"]["violations"]);
        assert_eq!((&summary["reproducible"], violations), (&true.into(), &0.into()), "{seen}");
        // All that makes this sea a sea happens in it.
        let some = |count: &Value| count.as_u64().unwrap() > 0;
        assert!(some(&seen["heard"]) && some(&seen["outliers"]), "{seen}");
        for reason in ["collision", "half_duplex", "asleep", "band", "busy"] {
            assert!(some(&seen["lost"][reason]), "{reason}: {seen}");
        }
        text(&summary["digest"])
    };
    let reference = run("local", "90");
    for bus in BUSES {
        for window_ms in ["90", "10", "25", "50"] {
            assert_eq!(run(bus, window_ms), reference, "{bus} {window_ms}");
        }
    }
}

#[test]
fn a_window_that_is_too_long_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let record = folder.path().join("never-written.mcap");
    // The longest is (0.1 s - 2 ns) / 1.1 = 90.909089 ms.
    for window_ms in ["90.90909", "91", "1000"] {
        let command = Command::new("run six-circles --window").with(window_ms).with("--record").with(&record);
        let finished = command.finish().exited(2);
        assert!(finished.stderr.contains(&format!("--window-ms {window_ms}")), "{}", finished.stderr);
        assert!(
            finished.stderr.contains("the longest in whole ms for `six-circles` is"),
            "{}",
            finished.stderr
        );
        assert!(!record.exists());
    }
}

#[test]
fn swarm_300_on_every_bus_and_in_every_window() {
    let _cores = alone();
    let reference = digest("run swarm-300 --bus local");
    for again in 0..2 {
        assert_eq!(digest("run swarm-300 --bus iceoryx2"), reference, "{again}");
    }
    assert_ne!(digest("run swarm-300 --bus local --seed 2"), reference);

    let reference = digest("run swarm-300 --bus local --duration 5");
    for bus in BUSES {
        for window_ms in ["90", "10", "50"] {
            let other = digest(&format!("run swarm-300 --duration 5 --bus {bus} --window {window_ms}"));
            assert_eq!(other, reference, "{bus} {window_ms}");
        }
    }
    assert_eq!(digest("run swarm-300 --duration 5 --pace 4"), reference);

    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    let mut live = Command::new("run swarm-300 --duration 5 --pace 2 --json --record").with(&path).start();
    let id = live.await_pings(300);
    let tap = Command::new("tap --json --count 1000 --run").with(&id).finish().succeeded();
    assert_eq!(tap.json_lines().len(), 1000);
    assert_eq!(text(&live.finish().succeeded().json()["digest"]), reference);
}
