//! Processes that die, stall or are told to stop: the run goes on or ends cleanly, and says what happened.

use std::path::Path;

use rustix::process::Signal;
use shoal_tests::{Command, await_that};

const BUSES: [&str; 2] = ["iceoryx2", "zenoh"];

#[test]
fn a_killed_auv_is_named_and_the_run_goes_on() {
    for bus in BUSES {
        let mut live = Command::new("run six-circles --pace 15 --json --bus").with(bus).start();
        live.await_pings(6);
        live.auvs()[&3].signal(Signal::KILL);
        let finished = live.finish().exited(3);
        let summary = finished.json();
        assert_eq!(summary["reproducible"], false);
        assert_eq!(summary["sim_s"], 60.0);
        assert_eq!(summary["processes"], 7);
        let lost = summary["agents"]["lost"].as_array().unwrap();
        assert_eq!(lost.len(), 1, "{lost:?}");
        assert_eq!((&lost[0]["auv"], &lost[0]["name"]), (&3.into(), &"deep-0".into()));
        assert!(lost[0]["reason"].as_str().unwrap().contains("killed by signal 9"), "{lost:?}");
        let time_s = lost[0]["time_s"].as_f64().unwrap();
        assert!(time_s > 0.0 && time_s < 60.0, "{lost:?}");
        // The five others lived on to the end: fifty ticks a second each, clocks within 10 %.
        assert!(summary["wakes"].as_u64().unwrap() > 5 * 50 * 60 * 9 / 10, "{}", summary["wakes"]);
        assert_eq!(summary["containment"]["violations"], 0);
    }
}

#[test]
fn a_killed_process_is_the_loss_of_all_its_auvs() {
    for bus in BUSES {
        let mut live =
            Command::new("run six-circles --pace 15 --auvs-per-process 2 --json --bus").with(bus).start();
        live.await_pings(6);
        live.auvs()[&3].signal(Signal::KILL);
        let summary = live.finish().exited(3).json();
        assert_eq!((&summary["sim_s"], &summary["processes"]), (&60.0.into(), &4.into()));
        let lost = summary["agents"]["lost"].as_array().unwrap();
        assert!(lost.iter().map(|lost| &lost["auv"]).eq([2, 3]), "{lost:?}");
        assert!(lost.iter().all(|lost| lost["reason"].as_str().unwrap().contains("killed by signal 9")));
        assert_eq!(summary["containment"]["violations"], 0);
    }
}

#[test]
fn the_lost_are_named_for_people_too() {
    let mut live = Command::new("run six-circles --pace 15 --quiet").start();
    live.await_pings(6);
    let auvs = live.auvs();
    auvs[&0].signal(Signal::KILL);
    auvs[&5].signal(Signal::TERM);
    let text = live.finish().exited(3).stdout;
    let named = |name: &str, how: &str| {
        assert!(
            text.lines().any(|line| line.contains("lost") && line.contains(name) && line.contains(how)),
            "{text}"
        );
    };
    named("surface-0 (AUV 0)", "killed by signal 9");
    named("deep-2 (AUV 5)", "killed by signal 15");
    assert!(text.contains("NOT reproducible"), "{text}");
}

#[test]
fn even_without_any_auv_the_run_ends() {
    for bus in BUSES {
        let mut live = Command::new("run six-circles --pace 15 --json --bus").with(bus).start();
        live.await_pings(6);
        live.auvs().values().for_each(|auv| auv.signal(Signal::KILL));
        let summary = live.finish().exited(3).json();
        assert_eq!(summary["agents"]["lost"].as_array().unwrap().len(), 6);
        assert_eq!(summary["sim_s"], 60.0);
    }
}

#[test]
fn on_crash_abort_ends_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let scenario = folder.path().join("abort.toml");
    let text = Command::new("scenarios six-circles").finish().succeeded().stdout;
    std::fs::write(&scenario, text.replace("\nseed = 7", "\nseed = 7\non_crash = \"abort\"")).unwrap();
    let mut live = Command::new("run --pace 5 --json").with(&scenario).start();
    live.await_pings(6);
    live.auvs()[&2].signal(Signal::KILL);
    let finished = live.finish().exited(3);
    assert!(finished.stderr.contains("aborted: AUV 2 ended"), "{}", finished.stderr);
    assert!(finished.json()["sim_s"].as_f64().unwrap() < 60.0);
}

#[test]
fn a_stopped_auv_is_waited_for_and_changes_nothing() {
    let reference = Command::new("run six-circles --bus local").json();
    for bus in BUSES {
        let mut live = Command::new("run six-circles --pace 15 --json --bus").with(bus).start();
        let id = live.await_pings(6);
        let auv = live.auvs()[&4];
        auv.signal(Signal::STOP);
        // Nothing crosses the water while one is waited for, however long that takes.
        std::thread::sleep(std::time::Duration::from_millis(1_500));
        assert!(live.launcher().is_alive(), "{id}");
        auv.signal(Signal::CONT);
        assert_eq!(live.finish().succeeded().json()["digest"], reference["digest"], "{bus}");
    }
}

#[test]
fn an_interrupt_still_sums_up() {
    for (bus, signal) in [
        ("iceoryx2", Signal::INT),
        ("zenoh", Signal::INT),
        ("local", Signal::INT),
        ("iceoryx2", Signal::TERM),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let record = folder.path().join("cut-short.mcap");
        let mut live = Command::new("run six-circles --pace 5 --json --bus")
            .with(bus)
            .with("--record")
            .with(&record)
            .start();
        live.await_pings(if bus == "local" { 0 } else { 6 });
        live.signal(signal);
        let summary = live.finish().exited(3).json();
        let sim_s = summary["sim_s"].as_f64().unwrap();
        assert!(sim_s > 0.0 && sim_s < 60.0, "{sim_s}");
        assert_eq!(summary["reproducible"], false);
        assert_eq!(summary["containment"]["violations"], 0);
        assert_eq!(summary["agents"]["lost"], serde_json::json!([]));
        // The record was ended properly.
        let info = Command::new("record info --json").with(&record).finish().succeeded().json();
        assert_eq!(info["digest"], summary["digest"]);
        assert_eq!(info["reproducible"], false);
    }
}

#[test]
fn an_interrupt_while_all_wait_for_one_still_sums_up() {
    for bus in BUSES {
        let mut live = Command::new("run six-circles --pace 15 --json --bus").with(bus).start();
        live.await_pings(6);
        live.auvs()[&1].signal(Signal::STOP);
        std::thread::sleep(std::time::Duration::from_millis(300));
        live.signal(Signal::INT);
        let summary = live.finish().exited(3).json();
        assert!(summary["sim_s"].as_f64().unwrap() < 60.0);
    }
}

#[test]
fn when_the_channel_is_killed_the_run_fails_with_a_sentence() {
    for bus in BUSES {
        let folder = tempfile::tempdir().unwrap();
        let record = folder.path().join("torn.mcap");
        let mut live = Command::new("run six-circles --pace 5 --json --bus")
            .with(bus)
            .with("--record")
            .with(&record)
            .start();
        live.await_pings(6);
        let readable = || Command::new("record info --json").with(&record).finish();
        // The record reaches the disk as the run goes on.
        await_that("a second is recorded", || {
            readable().json()["truncated"]["readable_until_s"].as_f64() > Some(1.0)
        });
        live.channel().unwrap().signal(Signal::KILL);
        let finished = live.finish().exited(1);
        assert!(
            finished
                .stderr
                .contains("error: the channel's process ended in the middle of the run: killed by signal 9"),
            "{}",
            finished.stderr
        );
        assert_eq!(finished.stdout, "");
        // What it has is readable, and said to be incomplete.
        let info = readable().exited(3).json();
        assert!(info["truncated"]["readable_until_s"].as_f64().unwrap() >= 1.0, "{info}");
        assert!(info["digest"].is_null());
    }
}

#[test]
fn a_damaged_record_is_told_apart() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    Command::new("run six-circles --record").with(path("whole.mcap")).json();
    let whole = std::fs::read(path("whole.mcap")).unwrap();
    let info = |name: &str, bytes: &[u8]| {
        std::fs::write(path(name), bytes).unwrap();
        Command::new("record info").with(path(name)).finish()
    };
    info("again.mcap", &whole).succeeded();
    let half = info("half.mcap", &whole[..whole.len() / 2]).exited(3);
    assert!(half.stdout.contains("truncated"), "{}", half.stdout);
    info("almost.mcap", &whole[..whole.len() - 1]).exited(3);

    let refused = |name: &str, bytes: &[u8]| {
        let finished = info(name, bytes).exited(1);
        assert!(
            finished.stderr.starts_with("error: ") && finished.stderr.contains(name),
            "{}",
            finished.stderr
        );
        assert_eq!(finished.stdout, "");
    };
    refused("garbage.mcap", b"this is not a record\n");
    refused("empty.mcap", b"");
    let mut flipped = whole.clone();
    flipped[whole.len() / 2] ^= 0x10;
    refused("flipped.mcap", &flipped);
    let missing = Command::new("record info").with(Path::new("/nowhere/run.mcap")).finish().exited(1);
    assert!(missing.stderr.contains("/nowhere/run.mcap"), "{}", missing.stderr);
    let unwritable = Command::new("run six-circles --record /nowhere/run.mcap").finish().exited(1);
    assert!(unwritable.stderr.contains("/nowhere/run.mcap"), "{}", unwritable.stderr);
}
