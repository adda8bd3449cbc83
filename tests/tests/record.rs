//! The record of a real run: what `shoal record info` says of it, and what an outside reader finds in it.

use serde_json::Value;
use shoal_tests::{Command, workspace};

/// Python reads every message of a record and prints what it found; it lives with the bus, which tests made-up records.
const SCRIPT: &str = "bus/tests/read_record.py";

#[test]
fn info_tells_what_a_record_holds() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    let summary = Command::new("run six-circles --record").with(&path).json();
    let info = Command::new("record info --json").with(&path).finish().succeeded().json();
    assert_eq!(info["format"], "shoal.record_info/1");
    assert_eq!(
        (&info["scenario"], &info["seed"], &info["auvs"]),
        (&"six-circles".into(), &7.into(), &6.into())
    );
    assert_eq!((&info["digest"], &info["reproducible"]), (&summary["digest"], &true.into()));
    assert_eq!(info["containment"]["violations"], 0);
    assert_eq!(info["containment"]["checks"], summary["containment"]["checks"]);
    assert!(info["truncated"].is_null());
    assert_eq!(info["file_bytes"], std::fs::metadata(&path).unwrap().len());
    assert_eq!(info["attachments"][0]["name"], "scenario.toml");
    let topics: Vec<&str> =
        info["topics"].as_array().unwrap().iter().map(|topic| topic["topic"].as_str().unwrap()).collect();
    for topic in ["/truth", "/ticks", "/reports", "/sensed", "/pings", "/summary"] {
        assert!(topics.contains(&topic), "{topic}: {topics:?}");
    }

    let text = Command::new("record info").with(&path).finish().succeeded().stdout;
    for told in ["six-circles", "/reports", summary["digest"].as_str().unwrap()] {
        assert!(text.contains(told), "{told}:\n{text}");
    }
}

#[test]
fn a_record_holds_no_fact_of_the_machine() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    Command::new("run swarm-3 --duration 3 --bus zenoh --pace 20 --record").with(&path).json();
    let bytes = std::fs::read(&path).unwrap();
    for word in ["zenoh", "wall_s", "processes", "memory"] {
        assert!(!bytes.windows(word.len()).any(|part| part == word.as_bytes()), "{word}");
    }
}

#[test]
fn an_outside_reader_finds_every_message() {
    let python = |arguments: &[&str]| std::process::Command::new("python3").args(arguments).output();
    if !python(&["-c", "import mcap.reader, zstandard, jsonschema"])
        .is_ok_and(|output| output.status.success())
    {
        println!(
            "skipped: python3 cannot import mcap, zstandard and jsonschema (pip install mcap zstandard jsonschema)"
        );
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    for scenario in [
        "six-circles",
        "swarm-300 --auvs 40 --duration 6",
        "surface-bounce --duration 20",
        "data-incest --duration 6",
        "sweep-16 --duration 20",
    ] {
        let summary = Command::new(&format!("run {scenario} --record")).with(&path).json();
        let script = workspace().join(SCRIPT);
        let output = python(&[&script.to_string_lossy(), &path.to_string_lossy()]).unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let found: Value = serde_json::from_slice(&output.stdout).unwrap();
        for rows in ["ticks", "reports", "told"] {
            assert_eq!(found[rows], summary["wakes"], "{rows}");
        }
        assert_eq!(found["topics"]["/flock"].as_f64(), summary["sim_s"].as_f64());
        let pings = &summary["pings"];
        let count = |value: &Value| value.as_u64().unwrap();
        // Those beyond reach when a ping leaves are counted in its emission, and have no row of their own.
        assert!(count(&found["pings"]) >= count(&pings["emitted"]) + count(&pings["heard"]), "{found}");
        assert!(count(&found["heard_bytes"]) <= 32 * count(&pings["heard"]), "{found}");
        assert!(count(&found["heard_bytes"]) > 0);
        assert_eq!(found["topics"]["/summary"], 1);
        assert_eq!(found["metadata"]["shoal.outcome"]["digest"], summary["digest"]);
        let attached = found["attached"]["scenario.toml"].as_str().unwrap();
        let name = scenario.split(' ').next().unwrap();
        assert_eq!(attached, Command::new("scenarios").with(name).finish().stdout);
    }
}
