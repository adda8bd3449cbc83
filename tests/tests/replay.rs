//! `shoal replay`: today's minds and what was recorded.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::sync::OnceLock;

use serde_json::Value;
use shoal_tests::{Command, Finished, shoal};

struct Fixture {
    folder: tempfile::TempDir,
    summary: Value,
}

fn fixture() -> &'static Fixture {
    static FIXTURE: OnceLock<Fixture> = OnceLock::new();
    FIXTURE.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.mcap");
        let run = "run six-circles --duration 12 --bus local --record";
        let summary = Command::new(run).with(&path).json();
        Fixture { folder, summary }
    })
}

impl Fixture {
    fn record(&self) -> PathBuf {
        self.folder.path().join("run.mcap")
    }
}

fn replay(arguments: &str, record: &Path) -> Finished {
    Command::new("replay").with(record).and(arguments).finish()
}

#[test]
fn the_same_minds_answer_the_same() {
    let fixture = fixture();
    for bus in ["iceoryx2", "local", "iceoryx2 --auvs-per-process 4"] {
        let told = replay(&format!("--json --bus {bus}"), &fixture.record()).succeeded().json();
        assert_eq!(
            (&told["diverged"], &told["answers"]),
            (&false.into(), &fixture.summary["wakes"]),
            "{told}"
        );
        assert_eq!(told["containment"]["replayed_held"], fixture.summary["wakes"]);
    }
    let text = replay("", &fixture.record()).succeeded().stdout;
    insta::assert_snapshot!("replay_same", text);
    let part = replay("--json --from 3 --to 6 --auv deep-1 --auv 0", &fixture.record()).succeeded().json();
    assert_eq!(part["auvs"], 2);
    assert!((298..=304).contains(&part["answers"].as_u64().unwrap()), "{part}");
}

#[test]
fn another_estimator_is_seen_to_differ() {
    let record = fixture().record();
    let finished = replay("--estimator ekf --quiet", &record).exited(1);
    insta::assert_snapshot!("replay_ekf", finished.stdout);
    assert_eq!(finished.stderr, "");
    let told = replay("--estimator dead-reckoning --json", &record).exited(1);
    assert!(told.stderr.contains("answers otherwise: "), "{told:?}");
    let told = told.json();
    assert_eq!(told["estimator"], "dead-reckoning");
    // Without pings nothing is narrower, and the truth is still inside.
    assert_eq!(told["position_width_m"]["narrower"], 0);
    assert!(told["position_width_m"]["wider"].as_u64().unwrap() > 0);
    assert_eq!(told["containment"]["newly_lost"], 0);
    let first =
        &told["each"].as_array().unwrap().iter().find(|auv| auv["first"].is_object()).unwrap()["first"];
    assert!(first["t_s"].as_f64().unwrap() > 0.0 && first["recorded"] != first["replayed"], "{first}");
    let tube = Command::new("replay --json --bus local --quiet --estimator")
        .with(r#"{ name = "tube", rings = 0 }"#)
        .with(&record)
        .finish();
    assert!([Some(0), Some(1)].contains(&tube.code()), "{tube:?}");
}

#[test]
fn what_is_missing_ends_the_comparison() {
    let fixture = fixture();
    let bytes = std::fs::read(fixture.record()).unwrap();
    let file = |name: &str, bytes: &[u8]| {
        let path = fixture.folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };
    let cut = file("cut.mcap", &bytes[..bytes.len() / 2]);
    let finished = replay("--json", &cut).exited(3);
    assert!(finished.stderr.contains("it was cut"), "{finished:?}");
    let told = finished.json();
    assert!(
        told["diverged"] == false && told["answers"].as_u64() < fixture.summary["wakes"].as_u64(),
        "{told}"
    );

    let mut damaged = bytes.clone();
    let middle = bytes.len() / 2;
    damaged[middle..middle + 50].fill(1);
    let finished = replay("--json", &file("hole.mcap", &damaged)).exited(3);
    assert!(finished.stderr.contains("the record lacks what it was told"), "{finished:?}");
    let told = finished.json();
    assert!(
        told["diverged"] == false && told["answers"].as_u64() < fixture.summary["wakes"].as_u64(),
        "{told}"
    );

    let empty = file("empty.mcap", &bytes[..9_000]);
    let finished = replay("", &empty).exited(1);
    assert!(finished.stderr.contains("what its AUVs were told at birth"), "{finished:?}");
}

#[test]
fn a_replay_stops_and_goes_on_by_keys() {
    let mut child = std::process::Command::new(shoal())
        .args(["replay", "--from", "2", "--step", "1", "--estimator", "ekf", "--quiet"])
        .arg(fixture().record())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // Two steps, then no more stops.
    child.stdin.take().unwrap().write_all(b"\n\nc\n").unwrap();
    let output = child.wait_with_output().unwrap();
    let [stdout, stderr] =
        [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
    assert_eq!(output.status.code(), Some(1), "{stdout}{stderr}");
    assert!(
        stderr.lines().all(|line| line.contains("AUVs answer otherwise") && line.contains("[Enter to step")),
        "{stderr}"
    );
    assert!(stdout.contains("6 AUVs differ"), "{stdout}");
    // Nobody is there to press anything: it goes on.
    let alone = replay("--pause --rate 1000 --quiet", &fixture().record()).succeeded();
    assert!(alone.stderr.contains("[Enter to go on, q to end]"), "{alone:?}");
}

#[test]
fn misuse_is_refused_with_a_way_out() {
    let record = fixture().record();
    let refused = |arguments: &str, code: i32, words: &str| {
        let finished = replay(arguments, &record);
        assert!(finished.code() == Some(code) && finished.stderr.contains(words), "{finished:?}");
        assert_eq!(finished.stdout, "");
    };
    refused("--estimator kalman", 2, "give `tube`, `ekf`, `dead-reckoning`");
    refused("--from 5 --to 4", 2, "--to must be later");
    refused("--auv 77", 2, "give a number from 0 to 5");
    refused("--step 0", 2, "simulated seconds");
    let finished = replay("", Path::new("nowhere.mcap")).exited(1);
    assert!(finished.stderr.starts_with("error: nowhere.mcap: "), "{finished:?}");
}
