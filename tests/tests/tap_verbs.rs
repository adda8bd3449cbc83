//! Every verb of `shoal tap`, on live runs of real processes and on records.

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Output, Stdio};

use serde_json::Value;
use shoal_tests::{Command, Live, await_that, shoal};

/// The record of a short run: the same bytes each time.
struct Record {
    _folder: tempfile::TempDir,
    path: PathBuf,
}

impl Record {
    /// Of a scenario of the tests.
    fn of(arguments: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.mcap");
        Command::new("run --bus local").and(arguments).and("--record").with(&path).json();
        Self { _folder: folder, path }
    }

    fn of_swarm_3() -> Self {
        Self::of("swarm-3 --duration 5")
    }

    fn tap(&self, arguments: &str) -> Command {
        Command::new("tap --read").with(&self.path).and(arguments)
    }

    fn said(&self, arguments: &str) -> String {
        self.tap(arguments).finish().succeeded().stdout
    }
}

/// The executable with a line of a shell's environment: `NAME=VALUE`.
fn with_environment(environment: &[(&str, &str)], record: &Path, arguments: &[&str]) -> Output {
    std::process::Command::new(shoal())
        .arg("tap")
        .args(arguments)
        .arg("-r")
        .arg(record)
        .envs(environment.iter().copied())
        .stdin(Stdio::null())
        .output()
        .unwrap()
}

fn lines(text: &str) -> Vec<Value> {
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
fn a_record_is_read_by_every_verb() {
    let record = Record::of_swarm_3();
    let shown = |arguments: &str| format!("$ shoal tap -r FILE {arguments}\n{}", record.said(arguments));
    insta::assert_snapshot!(
        [
            "--count 8",
            "--lost --count 3",
            "--kind heard --from 2 --to 2.5",
            "--kind emitted --once",
            "--once --json",
            "--count 2 --csv",
            "--count 2 --field t_s,from,to,range_m --kind heard",
            "--once --field fate,position_m.2 --json",
            "--count 2 --field from,range_m --filter to==1 --csv",
            "list",
            "list --json",
            "info /flock",
            "info /pings --json",
            "echo /reports --count 2",
            "echo ticks --count 2",
            "echo /flock --duration 1",
            "echo /auvs",
            "echo /log",
            "hz /pings",
            "hz /pings --json --lost",
            "bw /reports --from 2",
            "top",
            "top --sort box --json",
        ]
        .map(shown)
        .join("\n")
    );
}

#[test]
fn pings_of_a_sea_have_their_reception() {
    let record = Record::of("echoes --duration 20");
    let text = record.said("--filter reception --count 6");
    assert!(text.lines().all(|line| line.contains("  SINR ") && line.contains(" dB")), "{text}");
    let lost: Vec<Value> = lines(&record.said("--lost=collision,half_duplex --json"));
    assert!(lost.iter().all(|ping| ["collision", "half_duplex"].contains(&ping["reason"].as_str().unwrap())));
    // A filter chooses what --lost does, and what counting by hand does.
    let all = lines(&record.said("--json"));
    let by_hand =
        all.iter().filter(|ping| ping["range_m"].as_f64().is_some_and(|range_m| range_m > 100.0)).count();
    let (loud, written) =
        (record.said("--filter range_m>100"), record.said("--filter (range_m>100)and(t_s>=0)"));
    assert_eq!((loud.lines().count(), &loud), (by_hand, &written));
    assert!(by_hand > 0 && by_hand < all.len());
}

#[test]
fn what_is_wrong_is_said_with_a_fix() {
    let record = Record::of_swarm_3();
    let said = |arguments: &str, code: i32| {
        let finished = record.tap(arguments).finish().exited(code);
        assert_eq!(finished.stdout, "", "{arguments}");
        format!("$ shoal tap {arguments}\n{}", finished.stderr)
    };
    insta::assert_snapshot!(
        [
            "echo /ping",
            "info /report",
            "hz pongs",
            "echo zzz",
            "--filter rang_m>3",
            "--filter range_m>",
            "--lost=noize",
            "--lost --kind heard",
            "echo /reports --lost",
            "echo /sensed --csv",
            "--field rnge_m",
            "list --csv",
            "top --filter from==1",
            "hz /auvs",
            "delay /pings",
        ]
        .map(|arguments| said(arguments, 2))
        .join("\n")
    );
    let missing = Command::new("tap -r nowhere.mcap list").finish().exited(1);
    assert!(missing.stderr.starts_with("error: nowhere.mcap: "), "{}", missing.stderr);
    let other = Command::new("tap -r Cargo.toml").finish().exited(1);
    assert!(other.stderr.contains("Cargo.toml: this is not an MCAP file"), "{}", other.stderr);
    Command::new("tap echo /offline --run 00000000").finish().exited(1);
}

#[test]
fn a_record_that_is_cut_is_read_as_far_as_it_goes() {
    let record = Record::of_swarm_3();
    let bytes = std::fs::read(&record.path).unwrap();
    std::fs::write(&record.path, &bytes[..bytes.len() / 2]).unwrap();
    let finished = record.tap("").finish().exited(3);
    assert!(!finished.stdout.is_empty());
    assert!(finished.stderr.contains("the record ends before the run does, at "), "{}", finished.stderr);
    // Who has all that was asked for misses nothing.
    assert_eq!(record.tap("--count 2").finish().succeeded().stdout.lines().count(), 2);
}

#[test]
fn a_reader_that_leaves_a_narrow_terminal_and_no_colour() {
    let record = Record::of("six-circles --duration 20");
    for arguments in [&[][..], &["echo", "/ticks", "--json"], &["echo", "/ticks", "--csv"]] {
        let mut tap = std::process::Command::new(shoal())
            .arg("tap")
            .args(arguments)
            .arg("-r")
            .arg(&record.path)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut first = String::new();
        BufReader::new(tap.stdout.take().unwrap()).read_line(&mut first).unwrap();
        let output = tap.wait_with_output().unwrap();
        assert_eq!((output.status.code(), output.stderr.as_slice()), (Some(0), &[][..]), "{arguments:?}");
        assert!(!first.is_empty());
    }
    for (columns, arguments) in [("40", &["top"][..]), ("31", &["list"]), ("1", &["list"])] {
        let output = with_environment(&[("COLUMNS", columns)], &record.path, arguments);
        let text = String::from_utf8(output.stdout).unwrap();
        let columns: usize = columns.parse().unwrap();
        // The heading and the first column are there however narrow it is.
        let table: Vec<&str> =
            text.lines().skip_while(|line| !line.starts_with("auv") && !line.starts_with("topic")).collect();
        let fits = |line: &&&str| line.chars().count() > columns.max("/reports".len());
        assert!(table.len() > 6 && table.iter().find(fits).is_none(), "{text}");
    }
    let coloured = with_environment(&[("TERM", "xterm-256color")], &record.path, &["top"]);
    let plain = with_environment(&[("NO_COLOR", "1"), ("TERM", "dumb")], &record.path, &["top"]);
    assert_eq!(coloured.stdout, plain.stdout);
    assert!(!plain.stdout.contains(&0x1b), "no terminal, so no escapes");
}

/// `script` gives the executable a terminal, and its standard input as the keys.
fn on_a_terminal(record: &Path, keys: &'static str, environment: &[(&str, &str)]) -> Option<Output> {
    use std::io::Write;
    let line = format!("stty rows 12 cols 60; {} tap top -r {}", shoal().display(), record.display());
    let mut script = std::process::Command::new("script")
        .args(["-qec", &line, "/dev/null"])
        .env("TERM", "xterm-256color")
        .env_remove("COLUMNS")
        .envs(environment.iter().copied())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .ok()?;
    let mut input = script.stdin.take().unwrap();
    let typing = std::thread::spawn(move || {
        for key in keys.chars() {
            std::thread::sleep(std::time::Duration::from_millis(300));
            // One that has ended takes no more keys.
            let _ended = input.write_all(key.to_string().as_bytes()).and_then(|()| input.flush());
        }
    });
    let output = script.wait_with_output().unwrap();
    typing.join().unwrap();
    Some(output)
}

#[test]
fn top_takes_a_terminal_and_gives_it_back() {
    let record = Record::of_swarm_3();
    let Some(output) = on_a_terminal(&record.path, "bblrq", &[]) else {
        println!("skipped: there is no `script` to make a terminal");
        return;
    };
    let text = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{text}");
    for shown in ["blue-0", "swarm-3", "quit", "\u{1b}[?1049h", "\u{1b}[?1049l"] {
        assert!(text.contains(shown), "{shown:?}: {text}");
    }
    let left = on_a_terminal(&record.path, "\u{3}", &[("NO_COLOR", "1")]).unwrap();
    assert_eq!(left.status.code(), Some(0));
}

/// A run of three that lasts long enough.
fn three(bus: &str) -> Live {
    let mut live = Command::new("run swarm-3 --pace 4 --duration 600 --json --bus").with(bus).start();
    await_that("the run is there", || live.run_id().is_some());
    live.await_pings(if bus == "local" { 0 } else { 3 });
    live
}

#[test]
fn every_verb_looks_at_a_live_run_on_every_bus() {
    for bus in ["local", "iceoryx2", "zenoh"] {
        let live = three(bus);
        let id = live.run_id().unwrap();
        let tap = |arguments: &str| Command::new("tap --run").with(&id).and(arguments);
        let listed = tap("list --json").finish().succeeded().json_lines();
        let of = |topic: &str| listed.iter().find(|line| line["topic"] == topic).unwrap();
        assert_eq!((&of("/auvs")["messages"], &of("/born")["messages"]), (&1.into(), &3.into()), "{bus}");
        for topic in ["/ticks", "/reports", "/sensed"] {
            let hz = of(topic)["sim_hz"].as_f64().unwrap();
            // Three AUVs that wake ten times a second; the borders of windows are not theirs.
            assert!(
                of(topic)["messages"].as_u64().unwrap() > 10 && (25.0..35.0).contains(&hz),
                "{bus} {listed:?}"
            );
        }
        for topic in ["pings", "/ticks", "/reports", "/sensed", "/truth", "/flock", "/born"] {
            let messages = tap("--json --count 2 echo").with(topic).finish().succeeded().json_lines();
            assert_eq!(messages.len(), 2, "{bus} {topic}");
            assert!(
                messages
                    .iter()
                    .all(|message| message["topic"] == format!("/{}", topic.trim_start_matches('/')))
            );
        }
        let cast = tap("echo /auvs --json").finish().succeeded().json();
        assert_eq!(cast["auvs"].as_array().unwrap().len(), 3);
        let info = tap("info /reports --json").finish().succeeded().json();
        assert!(info["messages"].as_u64().unwrap() > 10 && info["schema"] == "shoal.Reports/1");
        let hz = tap("hz /reports --once --json").finish().succeeded().json();
        assert!((25.0..35.0).contains(&hz["sim_hz"].as_f64().unwrap()), "{hz}");
        let bw = tap("bw /reports --once --json").finish().succeeded().json();
        assert!(bw["bytes_per_s"].as_f64().unwrap() > bw["bytes_per_sim_s"].as_f64().unwrap(), "{bw}");
        let delay = tap("delay /reports --once --json").finish().succeeded().json();
        let told = &delay["telling_s"];
        assert!(delay["arrival_s"]["mean"].as_f64().unwrap() > 0.0);
        assert!(
            (0.0..0.2).contains(&told["min"].as_f64().unwrap()) && told["max"].as_f64().unwrap() < 0.2,
            "{delay}"
        );
        let top = tap("top --once --json").finish().succeeded().json_lines();
        assert_eq!(top.len(), 3);
        assert!(top.iter().all(|auv| auv["box_width_m"].as_f64().unwrap() > 0.0 && auv["state"] == "alive"));
        let quiet = tap("--filter from==99 --timeout 0.3").finish();
        assert_eq!(quiet.stdout, "");
        live.signal(rustix::process::Signal::INT);
        live.finish().exited(3);
    }
}

#[test]
fn a_silent_topic_times_out_and_a_stopped_capture_is_whole() {
    let live = three("iceoryx2");
    let id = live.run_id().unwrap();
    let finished = Command::new("tap echo /log --timeout 0.5 --run").with(&id).finish().exited(1);
    assert!(finished.stderr.contains("no message came within --timeout 0.5 s"), "{}", finished.stderr);

    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("part.mcap");
    let capture = Command::new("tap --run").with(&id).and("-w").with(&path).start();
    await_that("something is written", || std::fs::metadata(&path).is_ok_and(|file| file.len() > 20_000));
    capture.signal(rustix::process::Signal::INT);
    let finished = capture.finish().succeeded();
    assert!(finished.stderr.contains(" messages written to "), "{}", finished.stderr);
    let info = Command::new("record info --json").with(&path).finish().succeeded().json();
    assert_eq!((&info["scenario"], info["truncated"].is_null()), (&"swarm-3".into(), true));
    // A part does not claim to be the run.
    assert!(info["digest"].is_null());
    let first = Command::new("tap --once --json -r").with(&path).finish().succeeded().json();
    assert!(first["t_ns"].as_i64().unwrap() > 0);
    live.signal(rustix::process::Signal::INT);
    live.finish().exited(3);
}

#[test]
fn what_a_tap_writes_from_the_beginning_is_the_record() {
    let folder = tempfile::tempdir().unwrap();
    let [record, tapped, copied, part] =
        ["record.mcap", "tapped.mcap", "copied.mcap", "part.mcap"].map(|name| folder.path().join(name));
    let mut live = Command::new("run swarm-3 --duration 9 --pace 3 --json --record").with(&record).start();
    await_that("the run is there", || live.run_id().is_some());
    let tap =
        Command::new("tap --wait 60 --run").with(live.run_id().unwrap()).and("-w").with(&tapped).start();
    live.children();
    let summary = live.finish().succeeded().json();
    tap.finish().succeeded();
    let bytes = |path: &Path| std::fs::read(path).unwrap();
    assert!(bytes(&tapped) == bytes(&record), "byte for byte");
    let info = Command::new("record info --json").with(&tapped).finish().succeeded().json();
    assert_eq!(info["digest"], summary["digest"]);

    Command::new("tap -r").with(&record).and("-w").with(&copied).finish().succeeded();
    assert!(bytes(&copied) == bytes(&record), "byte for byte");
    Command::new("tap --from 2 --to 3 --kind heard -r")
        .with(&record)
        .and("-w")
        .with(&part)
        .finish()
        .succeeded();
    let chosen =
        Command::new("tap --from 2 --to 3 --kind heard --json -r").with(&record).finish().succeeded();
    let kept = Command::new("tap --json -r").with(&part).finish().succeeded();
    assert!(chosen.stdout == kept.stdout && kept.stdout.lines().count() > 3);
    Command::new("tap -r").with(&record).and("-w").with(&record).finish().exited(2);
}
