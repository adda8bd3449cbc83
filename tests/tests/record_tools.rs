//! `shoal record cat`, `export`, `verify`, `recover` and `diff` on the record of a real run.

use std::path::{Path, PathBuf};
use std::process::{Output, Stdio};
use std::sync::OnceLock;

use serde_json::Value;
use shoal_tests::{Command, Dice, Finished, shoal};

/// A record of a short run, made once, in a folder that the system clears.
struct Fixture {
    folder: tempfile::TempDir,
    summary: Value,
    bytes: Vec<u8>,
}

fn fixture() -> &'static Fixture {
    static FIXTURE: OnceLock<Fixture> = OnceLock::new();
    FIXTURE.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.mcap");
        let summary = Command::new("run swarm-3 --duration 8 --bus local --record").with(&path).json();
        let bytes = std::fs::read(&path).unwrap();
        Fixture { folder, summary, bytes }
    })
}

impl Fixture {
    fn record(&self) -> PathBuf {
        self.folder.path().join("run.mcap")
    }

    /// Another file with these bytes.
    fn file(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    }
}

fn of(arguments: &str, file: &Path) -> Finished {
    Command::new(arguments).with(file).finish()
}

/// A text without what changes with the packing of chunks: numbers of bytes, and where the file is.
fn without_bytes(text: &str, file: &Path) -> String {
    let text = text.replace(&*file.to_string_lossy(), "FILE");
    let mut words: Vec<String> = Vec::new();
    let mut is_place = false;
    for word in text.split(' ') {
        let bare = word.trim_end_matches([',', ';', ':', '\n']).replace(',', "");
        let is_number = !bare.is_empty() && bare.chars().all(|digit| digit.is_ascii_digit());
        let is_byte_count = is_number && (is_place || bare.len() >= 5);
        words.push(if is_byte_count {
            word.replace(|digit: char| digit.is_ascii_digit(), "#")
        } else {
            word.to_owned()
        });
        is_place = matches!(word, "byte" | "bytes" | "to" | "behind") || word.ends_with("byte");
    }
    words.join(" ")
}

#[test]
fn cat_prints_events_as_lines_of_json() {
    let fixture = fixture();
    let record = fixture.record();
    let pings = of("record cat --topic /pings", &record).succeeded().json_lines();
    let count = |fate: &str| pings.iter().filter(|ping| ping["fate"] == fate).count() as u64;
    assert_eq!(fixture.summary["pings"]["emitted"], count("emitted"));
    assert_eq!(fixture.summary["pings"]["heard"], count("heard"));
    assert!(pings.iter().all(|ping| ping["topic"] == "/pings"));

    let some =
        of("record cat --topic reports --auv blue-1 --from-s 2 --to-s 3.5", &record).succeeded().json_lines();
    assert!(some.len() >= 2 && some.iter().all(|report| report["auv"] == 1), "{some:?}");
    let time = |event: &Value| event["t_ns"].as_i64().unwrap();
    assert!(some.iter().all(|report| (2_000_000_000..=3_500_000_000).contains(&time(report))));
    assert_eq!(of("record cat --count 3", &record).succeeded().json_lines().len(), 3);
    let told = of("record cat --topic /sensed --topic /born --auv 2", &record).succeeded().json_lines();
    assert!(told[0]["orders"]["estimator"]["Tube"].is_object() && told[1]["events"].is_array());
    let far = Command::new("record cat --topic /pings --filter").with("range_m > 400").with(&record).finish();
    let far = far.succeeded().json_lines();
    assert!(!far.is_empty() && far.iter().all(|ping| ping["range_m"].as_f64().unwrap() > 400.0));
    // Every message of every topic.
    assert!(of("record cat", &record).succeeded().json_lines().len() > 500);
}

#[test]
fn misuse_is_refused_with_a_way_out() {
    let record = fixture().record();
    let refused = |arguments: &str, code: i32, words: &str| {
        let finished = of(arguments, &record);
        assert!(finished.code() == Some(code) && finished.stderr.contains(words), "{finished:?}");
        assert_eq!(finished.stdout, "");
    };
    refused("record cat --topic /ping", 2, "did you mean `/pings`?");
    refused("record cat --auv green-9", 2, "a name such as `blue-0`");
    refused("record cat --topic pings --filter range>3", 2, "range_m");
    refused("record export", 2, "give a folder with -o DIR, or choose one with --topic");
    let nowhere = Path::new("/nowhere/run.mcap");
    for verb in ["cat", "verify", "recover --out nothing.mcap", "export --topic pings"] {
        let finished = of(&format!("record {verb}"), nowhere).exited(1);
        assert!(finished.stderr.starts_with("error: /nowhere/run.mcap: "), "{finished:?}");
    }
    let text = fixture().file("text.txt", b"some text");
    for verb in ["cat", "verify", "export --topic pings"] {
        let finished = of(&format!("record {verb}"), &text).exited(1);
        assert!(finished.stderr.contains("this is not an MCAP file"), "{finished:?}");
    }
}

#[test]
fn a_closed_pipe_ends_quietly() {
    let mut child = std::process::Command::new(shoal())
        .args(["record", "cat"])
        .arg(fixture().record())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let Output { status, stderr, .. } = child.wait_with_output().unwrap();
    assert_eq!((status.code(), String::from_utf8_lossy(&stderr).as_ref()), (Some(0), ""));
}

#[test]
fn tables_have_documented_columns_with_units() {
    let fixture = fixture();
    let folder = tempfile::tempdir().unwrap();
    Command::new("record export")
        .with(fixture.record())
        .and("--out")
        .with(folder.path())
        .finish()
        .succeeded();
    let described = Command::new("record export --columns").finish().succeeded().stdout;
    insta::assert_snapshot!("export_columns", described);
    let mut tables = 0;
    for entry in std::fs::read_dir(folder.path()).unwrap() {
        let path = entry.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let head = text.lines().next().unwrap();
        let part = described
            .split(&format!("\n{name}\n"))
            .nth(1)
            .unwrap_or_else(|| panic!("{name} is not described"));
        let part = part.split("\n\n").next().unwrap();
        let columns: Vec<&str> = part.lines().map(|line| line.split_whitespace().next().unwrap()).collect();
        assert_eq!(head, columns.join(","), "{name}");
        tables += 1;
        let rows = text.lines().count() as u64 - 1;
        match name.as_str() {
            "reports.csv" | "ticks.csv" => assert_eq!(fixture.summary["wakes"], rows, "{name}"),
            "auvs.csv" => assert_eq!(rows, 3),
            _ => assert!(rows > 0, "{name}"),
        }
    }
    assert_eq!(tables, 9);
    // The same numbers, digit by digit, in both forms.
    let lines = of("record export --topic ticks --format jsonl --auv 1 --count 1", &fixture.record())
        .succeeded()
        .stdout;
    let csv = of("record export --topic ticks --auv 1 --count 1", &fixture.record()).succeeded().stdout;
    let cells: Vec<&str> = csv.lines().nth(1).unwrap().split(',').collect();
    let values: Vec<&str> = lines
        .trim()
        .trim_end_matches('}')
        .split(',')
        .map(|member| member.split(':').nth(1).unwrap())
        .collect();
    assert_eq!(cells, values);
}

#[test]
fn verify_knows_every_byte_and_the_digest() {
    let fixture = fixture();
    let whole = of("record verify --json", &fixture.record()).succeeded().json();
    assert_eq!((&whole["whole"], &whole["digest"]), (&true.into(), &"fits".into()));
    assert_eq!(whole["file_bytes"], fixture.bytes.len());
    let text = of("record verify", &fixture.record()).succeeded().stdout;
    insta::assert_snapshot!("verify_whole", without_bytes(&text, &fixture.record()));

    let mut bytes = fixture.bytes.clone();
    let at = bytes.len() / 2;
    bytes[at] ^= 0x10;
    let damaged = fixture.file("damaged.mcap", &bytes);
    let found = of("record verify --json", &damaged).exited(5).json();
    let fault = &found["faults"][0];
    assert!(
        fault["from"].as_u64().unwrap() <= at as u64 && at as u64 <= fault["to"].as_u64().unwrap(),
        "{found}"
    );
    assert_eq!((&fault["changed"]["byte"], &fault["changed"]["bits"]), (&at.into(), &0x10.into()));
    assert_eq!(fault["part"], "chunk");
    assert!(
        fault["time_s"][1].as_f64().unwrap() <= 8.0 && fault["topics"].as_array().unwrap().len() > 3,
        "{found}"
    );
    let text = of("record verify", &damaged).exited(5).stdout;
    assert!(text.contains("the bits 0x10") || text.contains("its bits 0x10"), "{text}");

    let cut = fixture.file("cut.mcap", &fixture.bytes[..at]);
    let text = of("record verify", &cut).exited(3).stdout;
    insta::assert_snapshot!("verify_cut", without_bytes(&text, &cut));
}

/// A record whose checksums are all right, and whose digest is not that of its events: `recover` copies what is whole, so one that lost
/// a chunk and forgets to say so must be found out.
#[test]
fn verify_finds_a_record_that_tells_another_story() {
    let fixture = fixture();
    let mut bytes = fixture.bytes.clone();
    let at = bytes.len() / 2;
    bytes[at..at + 100].fill(7);
    let damaged = fixture.file("hole.mcap", &bytes);
    let whole = fixture.folder.path().join("hole.recovered.mcap");
    let finished = Command::new("record recover").with(&damaged).and("--out").with(&whole).finish().exited(3);
    assert!(finished.stdout.contains("lost: bytes "), "{finished:?}");
    let found = of("record verify --json", &whole).exited(3).json();
    assert_eq!((&found["faults"], &found["digest"]), (&Value::Array(Vec::new()), &"unknown".into()));
    assert!(found["recovered"].as_str().unwrap().contains("chunk"), "{found}");
}

#[test]
fn recover_brings_back_what_was_flushed() {
    let fixture = fixture();
    let cut = fixture.file("half.mcap", &fixture.bytes[..fixture.bytes.len() / 2]);
    let finished = of("record recover", &cut).exited(3);
    let out = cut.with_extension("recovered.mcap");
    insta::assert_snapshot!("recover_cut", without_bytes(&finished.stdout, &out));
    let info = of("record info --json", &out).succeeded().json();
    assert!(info["truncated"].is_null() && info["last_s"].as_f64().unwrap() >= 3.0, "{info}");
    // Nothing is ever overwritten: neither what is there, nor the source.
    let again = of("record recover", &cut).exited(2);
    assert!(again.stderr.contains("overwrites nothing"), "{again:?}");
    let itself = Command::new("record recover").with(&cut).and("--out").with(&cut).finish().exited(2);
    assert!(itself.stderr.contains("overwrites nothing"), "{itself:?}");
    assert_eq!(std::fs::read(&cut).unwrap(), fixture.bytes[..fixture.bytes.len() / 2]);
    // Nothing of a copy is left that could not be made.
    let nothing = fixture.file("nothing.mcap", &fixture.bytes[..60]);
    let finished = of("record recover", &nothing).exited(1);
    assert!(finished.stderr.contains("nothing can be recovered"), "{finished:?}");
    assert!(!nothing.with_extension("recovered.mcap").exists());
}

#[test]
fn cut_and_flipped_files_are_judged_right() {
    let fixture = fixture();
    let mut dice = Dice::new(8);
    for round in 0..24 {
        let at = dice.between(400.0, fixture.bytes.len() as f64) as usize;
        let (file, is_cut) = if round % 2 == 0 {
            (fixture.file(&format!("{round}.mcap"), &fixture.bytes[..at]), true)
        } else {
            let mut bytes = fixture.bytes.clone();
            bytes[at] ^= 1 << dice.between(0.0, 8.0) as u32;
            (fixture.file(&format!("{round}.mcap"), &bytes), false)
        };
        let verified = of("record verify", &file);
        assert_eq!(verified.code(), Some(if is_cut { 3 } else { 5 }), "{at}: {verified:?}");
        let out = file.with_extension("good.mcap");
        let recovered = Command::new("record recover --json").with(&file).and("--out").with(&out).finish();
        // One changed bit is put right, and of a file that was cut behind its data only the index is missing.
        let is_complete = recovered.json()["complete"] == true;
        assert!(is_complete || is_cut, "{at}: {recovered:?}");
        assert_eq!(recovered.code(), Some(if is_complete { 0 } else { 3 }), "{at}: {recovered:?}");
        assert_eq!(std::fs::read(&out).unwrap() == fixture.bytes, is_complete, "{at}");
        let good = of("record verify", &out);
        assert_eq!(good.code(), recovered.code(), "{at}: {good:?}");
        assert!(!good.stdout.contains("damaged"), "{good:?}");
    }
}

/// The same of a record of many megabytes, in an address space with no room for it.
#[test]
fn memory_is_bounded() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("big.mcap");
    Command::new("run swarm-300 --duration 30 --bus local --record").with(&path).json();
    let mut bytes = std::fs::read(&path).unwrap();
    let length = bytes.len();
    assert!(length > 20 << 20, "{length} bytes");
    // A length of exabytes, and one of megabytes that are not there.
    let attachment = 30 + 9 + u64::from_le_bytes(bytes[31..39].try_into().unwrap()) as usize;
    assert_eq!((bytes[30], bytes[attachment]), (0x0c, 0x09), "metadata and attachment");
    bytes[attachment + 7] ^= 0x40;
    bytes[length / 3] ^= 1;
    std::fs::write(&path, &bytes).unwrap();
    let limited = |arguments: &str| {
        // Kibibytes of address space, less than the file has unpacked; the program itself takes a part of it.
        let script = format!("ulimit -v 98304; exec \"$0\" record {arguments} \"$1\"");
        let shell = std::process::Command::new("sh").args(["-c", &script]).arg(shoal()).arg(&path).output();
        let Output { status, stdout, stderr } = shell.unwrap();
        let [stdout, stderr] = [stdout, stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
        (status.code(), stdout, stderr)
    };
    let (code, stdout, stderr) = limited("verify");
    assert_eq!(code, Some(5), "{stdout}{stderr}");
    let good = folder.path().join("good.mcap");
    let (code, stdout, stderr) = limited(&format!("recover --out {}", good.display()));
    assert_eq!(code, Some(3), "{stdout}{stderr}");
    let (code, _, stderr) = limited("cat --topic flock");
    assert_eq!(code, Some(3), "{stderr}");
    assert!(std::fs::metadata(&good).unwrap().len() > 20 << 20);
}

#[test]
fn diff_names_the_first_event_that_differs() {
    let fixture = fixture();
    let record = fixture.record();
    let diff = |other: &Path| Command::new("record diff").with(&record).with(other).finish();
    let copy = fixture.file("copy.mcap", &fixture.bytes);
    let equal = diff(&copy).succeeded().stdout;
    assert!(equal.starts_with("the runs are equal: "), "{equal}");

    let run = |more: &str, name: &str| {
        let path = fixture.folder.path().join(name);
        Command::new(&format!("run swarm-3 --bus local {more} --record")).with(&path).json();
        path
    };
    let seed = run("--duration 8 --seed 2", "seed.mcap");
    let text = diff(&seed).exited(1).stdout;
    let text = text.replace(&*fixture.folder.path().to_string_lossy(), "FOLDER");
    insta::assert_snapshot!("diff_seed", text);

    // Another speed of sound is told at birth, and seen in a ping before it is felt.
    let other = run("--duration 8 --set environment.sound_speed_m_s=1499", "sound.mcap");
    let found = Command::new("record diff --json").with(&record).with(&other).finish().exited(1).json();
    assert_eq!(found["equal"], false);
    assert!(found["runs"][0]["field"].as_str().unwrap().starts_with("scenario.toml line "), "{found}");
    assert_eq!((&found["first"]["topic"], &found["first"]["auv"]), (&"/born".into(), &0.into()));
    let fields = found["first"]["fields"].as_array().unwrap();
    assert!(
        fields.iter().any(|field| field["field"].as_str().unwrap().contains("sound_speed_m_s")),
        "{found}"
    );

    let shorter = run("--duration 6", "shorter.mcap");
    let found = Command::new("record diff --json").with(&record).with(&shorter).finish().exited(1).json();
    assert!(found["first"]["t_s"].as_f64().unwrap() >= 6.0 && found["first"]["only_in"] == "a", "{found}");
}
