//! Sweeps, and runs of scenarios that `--set` changes.

use rustix::process::Signal;
use shoal_tests::{Command, await_that};

#[test]
fn a_sweep_ends_as_its_runs_do() {
    let ended = |arguments: &str| {
        let finished = Command::new(arguments).finish();
        (finished.status.code(), finished.stdout, finished.stderr)
    };
    let folder = tempfile::tempdir().unwrap();
    let csv = folder.path().join("table.csv");
    let sweep = "sweep swarm-3 --duration 3 --seeds 1..2 --set group.modem.range_m=100,2000";
    let finished = Command::new(sweep).and("--csv").with(&csv).finish().succeeded();
    assert_eq!(finished.stdout.matches("mean").count(), 2, "{}", finished.stdout);
    assert_eq!(std::fs::read_to_string(&csv).unwrap().lines().count(), 3);
    // The same seed and values, the same table.
    assert_eq!(ended(sweep).1, finished.stdout);

    let (code, table, said) = ended("sweep swarm-3 --duration 3 --set group.modem.range_m=100,-1");
    assert_eq!((code, table.contains("not run: group.modem.range_m=-1: ")), (Some(3), true), "{table}");
    assert!(said.contains("changed by --set") && said.contains("range_m = -1"), "{said}");
    assert_eq!(ended("sweep swarm-3 --set group.modem.range_m=-1").0, Some(2));
    assert_eq!(ended("sweep swarm-3 --seeds 5..1").0, Some(2));
    assert_eq!(ended("sweep swarm-3 --seeds 1 --duration 3 --set group.0.sabotage=lying-ping").0, Some(4));
}

#[test]
fn a_run_takes_values_and_records_them() {
    let folder = tempfile::tempdir().unwrap();
    let changed = folder.path().join("changed.toml");
    let text = Command::new("scenarios swarm-3").finish().succeeded().stdout;
    std::fs::write(&changed, text.replace("ping_period_s = 1", "ping_period_s = 0.5")).unwrap();
    let set = Command::new("run swarm-3 --duration 3 --set group.modem.ping_period_s=0.5").json();
    let file = Command::new("run --duration 3").with(&changed).json();
    let plain = Command::new("run swarm-3 --duration 3").json();
    assert_eq!(set["digest"], file["digest"]);
    assert_ne!(set["digest"], plain["digest"]);
    let refused = Command::new("run swarm-3 --set group.modem.range_m=[").finish();
    assert_eq!(refused.status.code(), Some(2), "{refused:?}");
}

/// A sweep of six runs that takes some seconds on one core.
const SWEEP: &str =
    "sweep swarm-300 --auvs 60 --duration 4 --seeds 1..3 --set group.modem.range_m=150,300 --quiet";

#[test]
fn a_sweep_that_was_killed_goes_on_and_ends_as_if_it_had_not_been() {
    let folder = tempfile::tempdir().unwrap();
    let [whole, resumed] = ["whole", "resumed"].map(|name| folder.path().join(format!("{name}.csv")));
    let runs = folder.path().join("resumed.runs.jsonl");
    let lines = || std::fs::read_to_string(&runs).map_or(0, |text| text.lines().count());
    let expected = Command::new(SWEEP).and("--csv").with(&whole).finish().succeeded().stdout;

    let sweep = || Command::new(SWEEP).and("--jobs 1 --csv").with(&resumed);
    let killed = sweep().start();
    await_that("two runs have ended", || lines() >= 3);
    killed.signal(Signal::KILL);
    let finished = killed.finish();
    assert_eq!((finished.code(), resumed.exists()), (None, false));
    let kept = lines();
    assert!((3..7).contains(&kept), "{kept}");
    // It may have been in the middle of a line.
    let mut text = std::fs::read_to_string(&runs).unwrap();
    text += "{\"set\":[[\"group.modem.range_m\",\"300\"]],\"seed\":3,\"outco";
    std::fs::write(&runs, &text).unwrap();

    assert_eq!(sweep().finish().succeeded().stdout, expected);
    let read = |path: &std::path::Path| std::fs::read_to_string(path).unwrap();
    assert_eq!(read(&resumed), read(&whole));
    assert_eq!(lines(), 7);
    assert!(read(&runs).starts_with(&text[..text.rfind('\n').unwrap()]), "runs were made twice");
    // All is known now: nothing is added.
    let before = read(&runs);
    assert_eq!(sweep().finish().succeeded().stdout, expected);
    assert_eq!(read(&runs), before);
    // More seeds are added to those that are there; another scenario is not.
    let more = SWEEP.replace("1..3", "3..4");
    Command::new(&more).and("--csv").with(&resumed).finish().succeeded();
    assert_eq!(lines(), 9);
    let other = Command::new(&SWEEP.replace("--duration 4", "--duration 5")).and("--csv").with(&resumed);
    let refused = other.finish().exited(2);
    assert!(refused.stderr.contains("--duration") && refused.stderr.contains("--runs"), "{refused:?}");
    assert_eq!(lines(), 9);
}

#[test]
fn a_sweep_that_is_interrupted_says_how_to_go_on() {
    let folder = tempfile::tempdir().unwrap();
    let runs = folder.path().join("runs");
    let sweep = Command::new(SWEEP).and("--jobs 2 --runs").with(&runs);
    let live = sweep.start();
    await_that("a run has ended", || {
        std::fs::read_to_string(&runs).is_ok_and(|text| text.lines().count() > 1)
    });
    live.signal(Signal::INT);
    let finished = live.finish();
    if finished.code() == Some(0) {
        return; // It was faster than the signal.
    }
    let finished = finished.exited(3);
    assert!(finished.stderr.contains("the same command goes on from"), "{finished:?}");
    sweep.finish().succeeded();
    assert_eq!(std::fs::read_to_string(&runs).unwrap().lines().count(), 7);
}

#[test]
fn any_number_of_threads_gives_the_same_table() {
    let table = |jobs: &str| {
        let finished =
            Command::new("sweep swarm-3 --duration 4 --seeds 5..9 --set group.modem.range_m=100,2000")
                .and("--set group.controller.separation=1,2 --jobs")
                .with(jobs)
                .finish();
        finished.succeeded().stdout
    };
    let alone = table("1");
    assert_eq!(alone.matches("mean").count(), 4, "{alone}");
    assert_eq!(table("2"), alone);
    assert_eq!(table("7"), alone);
}

#[test]
fn a_run_in_which_something_goes_wrong_is_a_row_with_its_reason() {
    let folder = tempfile::tempdir().unwrap();
    let csv = folder.path().join("table.csv");
    let sweep = "sweep swarm-3 --seeds 1..2 --duration 3 --set group.0.sabotage=lying-ping --set group.modem.range_m=2000,-1";
    let finished = Command::new(sweep).and("--csv").with(&csv).finish().exited(4);
    for words in ["seed 2: violations: ", "at first the ping of ", "not run: ", "range_m=-1: "] {
        assert!(finished.stdout.contains(words), "{words}: {}", finished.stdout);
    }
    let text = std::fs::read_to_string(&csv).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 5, "{text}");
    assert!(
        lines[1].starts_with("lying-ping,2000,,2,0,") && lines[2].starts_with("lying-ping,2000,1,,"),
        "{text}"
    );
    assert!(lines[4].starts_with("lying-ping,-1,,0,0,") && lines[4].contains("range_m"), "{text}");
}
