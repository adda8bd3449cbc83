//! Sweeps, and runs of scenarios that `--set` changes.

use shoal_tests::Command;

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
