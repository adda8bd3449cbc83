//! Readers that are not ours: they find in a record, and in the schema of scenarios, what we put there.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Output;

use serde_json::Value;
use shoal_tests::{Command, random_scenario, random_sea_scenario, scenario_file, workspace};

/// Python with these modules, or a printed reason why a test is skipped.
fn python(modules: &str) -> Option<impl Fn(&[&Path]) -> Output> {
    let run = |arguments: &[&Path]| std::process::Command::new("python3").args(arguments).output();
    let import = format!("import {modules}");
    if !run(&[Path::new("-c"), Path::new(&import)]).is_ok_and(|output| output.status.success()) {
        println!("skipped: python3 cannot import {modules} (pip install {})", modules.replace(',', ""));
        return None;
    }
    Some(move |arguments: &[&Path]| run(arguments).unwrap())
}

fn json(output: &Output) -> Value {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Records that have messages on every topic between them.
fn records(folder: &Path) -> Vec<PathBuf> {
    let record = |name: &str| folder.join(name);
    Command::new("run swarm-3 --duration 4 --record").with(record("whole.mcap")).json();
    Command::new("run")
        .with(scenario_file("lying-ping"))
        .and("--bus local --record")
        .with(record("false.mcap"))
        .finish();
    Command::new("localize").with(record("whole.mcap")).and("--offline --json").finish().succeeded();
    ["whole.mcap", "false.mcap", "whole.offline.mcap"].map(record).to_vec()
}

#[test]
fn python_reads_every_channel() {
    let Some(python) = python("mcap, zstandard, jsonschema") else { return };
    let folder = tempfile::tempdir().unwrap();
    let script = workspace().join("bus/tests/read_record.py");
    let mut read: BTreeSet<String> = BTreeSet::new();
    let mut known = BTreeSet::new();
    for record in records(folder.path()) {
        let found = json(&python(&[&script, &record]));
        read.extend(found["topics"].as_object().unwrap().keys().cloned());
        let info = Command::new("record info --json").with(&record).finish().succeeded().json();
        for topic in info["topics"].as_array().unwrap() {
            known.insert(topic["topic"].as_str().unwrap().to_owned());
            let count = found["topics"]
                .get(topic["topic"].as_str().unwrap())
                .map_or(0, |count| count.as_u64().unwrap());
            assert_eq!(topic["messages"], count, "{topic}");
        }
    }
    assert_eq!(read, known);
    assert!(known.len() >= 11, "{known:?}");
}

#[test]
fn the_example_plots_a_tube_with_the_truth_inside() {
    let Some(python) = python("mcap, zstandard, matplotlib") else { return };
    let folder = tempfile::tempdir().unwrap();
    let [record, picture] = ["run.mcap", "tube.png"].map(|name| folder.path().join(name));
    Command::new("run swarm-3 --duration 10 --record").with(&record).json();
    let script = workspace().join("tools/examples/plot_tube.py");
    let flags = ["--auv", "2", "--out"].map(Path::new);
    let found = json(&python(&[&script, &record, flags[0], flags[1], flags[2], &picture]));
    assert_eq!((&found["truth_inside"], &found["ticks"]), (&found["reports"], &found["reports"]), "{found}");
    assert!(found["reports"].as_u64().unwrap() > 50, "{found}");
    assert!(std::fs::read(&picture).unwrap().starts_with(b"\x89PNG\r\n\x1a\n"));
}

#[test]
fn rerun_accepts_a_record() {
    let folder = tempfile::tempdir().unwrap();
    // It keeps settings at home, and would say how it was used.
    let rerun = |arguments: &[&Path]| {
        std::process::Command::new("rerun").args(arguments).env("HOME", folder.path()).output()
    };
    if !rerun(&[Path::new("--version")]).is_ok_and(|output| output.status.success()) {
        println!("skipped: there is no rerun (pip install rerun-sdk)");
        return;
    }
    let run = |arguments: &[&Path]| {
        let output = rerun(arguments).unwrap();
        assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    run(&["analytics", "disable"].map(Path::new));
    let [mcap, check, convert, out, rrd, verify] =
        ["mcap", "check", "convert", "--output", "rrd", "verify"].map(Path::new);
    for (index, record) in records(folder.path()).iter().enumerate() {
        let checked = run(&[mcap, check, record]);
        assert!(checked.contains("/truth") && !checked.contains("error"), "{checked}");
        let converted = folder.path().join(format!("{index}.rrd"));
        run(&[mcap, convert, record, out, &converted]);
        let verified = run(&[rrd, verify, &converted]);
        assert!(std::fs::metadata(&converted).unwrap().len() > 10_000, "{verified}");
    }
}

#[test]
fn the_example_shows_a_run_in_rerun() {
    let Some(python) = python("mcap, zstandard, rerun") else { return };
    let folder = tempfile::tempdir().unwrap();
    let [record, shown] = ["run.mcap", "run.rrd"].map(|name| folder.path().join(name));
    Command::new("run swarm-3 --duration 5 --bus local --record").with(&record).json();
    let script = workspace().join("tools/examples/rerun_run.py");
    let output = python(&[&script, &record, Path::new("--save"), &shown]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let verified = std::process::Command::new("rerun")
        .args([Path::new("rrd"), Path::new("verify"), &shown])
        .env("HOME", folder.path())
        .output()
        .unwrap();
    assert!(verified.status.success(), "{}", String::from_utf8_lossy(&verified.stderr));
    assert!(std::fs::metadata(&shown).unwrap().len() > 10_000);
}

#[test]
fn python_holds_scenarios_against_the_schema() {
    let Some(python) = python("jsonschema, tomllib") else { return };
    let folder = tempfile::tempdir().unwrap();
    let schema = folder.path().join("scenario.schema.json");
    std::fs::write(&schema, Command::new("schema").finish().succeeded().stdout).unwrap();
    let mut scenarios = 0;
    let mut put = |text: &str| {
        std::fs::write(folder.path().join(format!("{scenarios}.toml")), text).unwrap();
        scenarios += 1;
    };
    for entry in shoal_scenario::library() {
        put(entry.text);
    }
    for number in 0..40 {
        put(&random_scenario(number, 5.0));
        put(&random_sea_scenario(number, 5.0));
    }
    let script = workspace().join("scenario/tests/check_schema.py");
    let found = json(&python(&[&script, &schema, folder.path()]));
    assert_eq!((&found["valid"], &found["invalid"]), (&scenarios.into(), &Value::from(0)), "{found}");
    // An unknown key in each table, and a table for each number.
    assert!(found["refused"].as_u64().unwrap() > 1_000, "{found}");
    assert_eq!(found["let_through"], serde_json::json!([]), "{found}");
}
