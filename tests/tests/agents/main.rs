//! Programs of the user's as AUVs: the example in Python flies, and whatever such a program does wrong costs only itself.

use std::net::TcpListener;
use std::path::{Path, PathBuf};

use rustix::process::Signal;
use serde_json::Value;
use shoal_tests::{Command, await_that, workspace};

/// The scenario of the example.
fn polyglot() -> PathBuf {
    workspace().join("agents/python/polyglot.toml")
}

/// Fails with what to do where Python cannot speak zenoh.
fn needs_python() {
    let imported = std::process::Command::new("python3").args(["-c", "import zenoh"]).output();
    assert!(
        imported.is_ok_and(|output| output.status.success()),
        "python3 cannot import zenoh: python3 -m pip install -r agents/python/requirements.txt"
    );
}

/// The example's scenario with one more group for each command, each of one AUV like that of the example.
fn with_more(folder: &Path, groups: &[(&str, Vec<String>)]) -> PathBuf {
    let text = std::fs::read_to_string(polyglot()).unwrap();
    let (shared, python) = text.split_once("[[group]]\nname = \"python\"").unwrap();
    let more = groups.iter().map(|(name, command)| {
        let group =
            python.replace("command = [\"python3\", \"agent.py\"]", &format!("command = {command:?}"));
        format!("[[group]]\nname = {name:?}{group}\n")
    });
    let path = folder.join("more.toml");
    std::fs::write(&path, format!("{shared}{}", more.collect::<String>())).unwrap();
    path
}

fn misbehaving(fault: &str) -> Vec<String> {
    let script = workspace().join("tests/tests/agents/misbehave.py");
    ["python3", &script.to_string_lossy(), fault].map(str::to_owned).into()
}

fn lost(summary: &Value) -> Vec<(String, String)> {
    let text = |value: &Value| value.as_str().unwrap().to_owned();
    let lost = summary["agents"]["lost"].as_array().unwrap();
    lost.iter().map(|lost| (text(&lost["name"]), text(&lost["reason"]))).collect()
}

#[test]
fn python_flies_and_the_digest_is_one() {
    needs_python();
    let folder = tempfile::tempdir().unwrap();
    let mut digests = Vec::new();
    for (bus, window_ms) in [("iceoryx2", "90"), ("zenoh", "90"), ("iceoryx2", "33")] {
        let record = folder.path().join("run.mcap");
        let command = Command::new("run --bus").with(bus).and("--window").with(window_ms).with(polyglot());
        let summary = command.with("--record").with(&record).json();
        assert_eq!(lost(&summary), []);
        assert_eq!((&summary["sim_s"], &summary["processes"]), (&60.0.into(), &5.into()));
        assert_eq!(
            (&summary["reproducible"], &summary["containment"]["violations"]),
            (&true.into(), &0.into())
        );
        // A report and a slice at each of 600 ticks of four AUVs, and some thirty pings of each.
        assert!(summary["containment"]["checks"].as_u64().unwrap() > 4 * 2 * 590 + 4 * 25, "{summary}");
        digests.push((summary["digest"].clone(), std::fs::read(record).unwrap()));
    }
    assert!(
        digests.iter().all(|of| *of == digests[0]),
        "{:?}",
        digests.iter().map(|of| &of.0).collect::<Vec<_>>()
    );
}

#[test]
fn python_flies_beside_a_host_and_in_a_free_run() {
    needs_python();
    let run = |options: &str| Command::new("run --duration 10").with(polyglot()).and(options);
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let endpoint = format!("tcp/{}", listener.local_addr().unwrap());
    drop(listener);
    let host = Command::new("host --slots 9 --connect").with(&endpoint).start();
    let on_a_host = run("--hosts 1 --listen").with(&endpoint).json();
    host.finish().succeeded();
    assert_eq!(on_a_host["digest"], run("").json()["digest"]);
    let free = run("--free-run --pace 4").json();
    for summary in [on_a_host, free] {
        assert_eq!((lost(&summary), &summary["containment"]["violations"]), (vec![], &0.into()), "{summary}");
        assert_eq!(summary["processes"], 5);
    }
}

#[test]
fn what_python_says_is_heard_and_what_it_hears_helps() {
    needs_python();
    let folder = tempfile::tempdir().unwrap();
    let width = |settings: &str| {
        let record = folder.path().join("run.mcap");
        let summary = Command::new("run --noise adversarial --record")
            .with(&record)
            .with(polyglot())
            .and(settings)
            .json();
        assert_eq!(summary["containment"]["violations"], 0);
        summary["position_width_m"]["end_max"].as_f64().unwrap()
    };
    // Whoever is deep has nothing but pings to go by; here, all but those of Python fall silent.
    let deaf = width("--set group.modem.range_m=1");
    let heard = width("--set group.0.modem.range_m=1 --set group.1.modem.range_m=1");
    let all = width("");
    assert!(heard < 0.7 * deaf && all < 0.7 * heard, "{deaf} {heard} {all}");
}

#[test]
fn whatever_a_program_does_wrong_costs_only_itself() {
    needs_python();
    let folder = tempfile::tempdir().unwrap();
    let faults = [
        ("exception", "exited with code 1: ValueError: the sonar fell off"),
        ("version", "it speaks protocol 99, this build speaks protocol 1"),
        ("no hello", "expected {\"protocol\":1,\"dialect\":\"json\"}"),
        ("misspelt", "unknown field `setpont`, expected one of `tick`, `setpoint`, `pings`, `report`"),
        ("text", "invalid type: string \"fast\", expected f64, at ...20, \"setpoint\": {\"velocity_m_s\""),
        ("huge", "setpoint.velocity_m_s[2] is 1e300"),
        ("nan", "\"setpoint\": {\"velocity_m_s\": [N"),
        ("nothing", "answered 0 of 1 ticks"),
        ("another tick", "it answered tick 7 when asked tick 20"),
        ("long ping", "at most 64 bytes, in text two hexadecimal digits each"),
        ("garbage", "sent a frame without kind (0, 1 or 2) and sequence number (8 bytes)"),
        ("number", "answered frame"),
        ("hello again", "said hello again after its birth"),
    ];
    let groups: Vec<(String, Vec<String>)> =
        faults.iter().map(|(fault, _)| (fault.replace(' ', "-"), misbehaving(fault))).collect();
    let groups: Vec<(&str, Vec<String>)> =
        groups.iter().map(|(name, command)| (name.as_str(), command.clone())).collect();
    let scenario = with_more(folder.path(), &groups);
    for bus in ["iceoryx2", "zenoh"] {
        let command = Command::new("run --json --duration 10 --bus").with(bus).with(&scenario);
        let finished = command.finish().exited(3);
        let summary = finished.json();
        let lost = lost(&summary);
        for (fault, said) in faults {
            let name = format!("{}-0", fault.replace(' ', "-"));
            let reason =
                &lost.iter().find(|(lost, _)| *lost == name).unwrap_or_else(|| panic!("{name}: {lost:?}")).1;
            assert!(reason.contains(said), "{fault}: {reason}");
        }
        assert_eq!(lost.len(), faults.len(), "{lost:?}");
        assert_eq!((&summary["sim_s"], &summary["containment"]["violations"]), (&10.0.into(), &0.into()));
        // The traceback is shown in full.
        assert!(
            finished.stderr.contains("Traceback") && finished.stderr.contains("in step"),
            "{}",
            finished.stderr
        );
    }
}

#[test]
fn what_cannot_be_started_is_refused_before_anything_runs() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("agent.py"), "").unwrap();
    let refused = |program: &str, said: &str| {
        let scenario =
            with_more(folder.path(), &[("strange", vec![program.to_owned(), "--fast".to_owned()])]);
        let finished = Command::new("run").with(scenario).finish().exited(2);
        for said in ["the command of group `strange` cannot be started", said] {
            assert!(finished.stderr.contains(said), "{program}:\n{}", finished.stderr);
        }
        assert_eq!(finished.stdout, "");
    };
    refused("no-such-program", "there is no program `no-such-program` in PATH");
    refused("./no-such-file", "paths are relative to the scenario file");
    refused("./agent.py", "is not executable; make it so with `chmod +x`");
    refused("agent.py", "write `./agent.py` for the file beside the scenario");
    let local = Command::new("run --bus local").with(polyglot()).finish().exited(2);
    assert!(local.stderr.contains("the local bus has no processes"), "{}", local.stderr);
}

#[test]
fn it_dies_with_the_launcher() {
    needs_python();
    let mut live = Command::new("run --pace 1 --json").with(polyglot()).start();
    live.await_pings(4);
    let python = live.auvs()[&3];
    assert!(python.arguments()[0].contains("python"), "{:?}", python.arguments());
    live.signal(Signal::KILL);
    await_that("Python has ended", || !python.is_alive());
    live.finish();
}
