//! Others can read a record: Python's `mcap`, and the Rust one with its index.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::synthetic::{run, write};
use crate::chronicle::What;

const SCRIPT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/read_record.py");

/// A folder of this process that vanishes with the test.
struct Scratch(PathBuf);

impl Scratch {
    fn new() -> Self {
        let path = std::env::temp_dir().join(format!("shoal-record-{}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// A Python that can `import mcap`, its packages fetched into `scratch` when they are missing; `None` when that fails too.
fn python(scratch: &Path) -> Option<impl Fn() -> Command> {
    let packages = scratch.join("packages");
    let search = std::env::var_os("PYTHONPATH").into_iter().collect::<Vec<_>>();
    let paths = std::iter::once(packages.clone()).chain(search.iter().flat_map(std::env::split_paths));
    let path = std::env::join_paths(paths).ok()?;
    let python = move || {
        let mut command = Command::new("python3");
        command.env("PYTHONPATH", &path);
        command
    };
    let succeeds = |command: &mut Command| command.output().is_ok_and(|output| output.status.success());
    let imports = || succeeds(python().args(["-c", "import mcap.reader, zstandard"]));
    if !imports() {
        let fetch = ["-m", "pip", "install", "--quiet", "--target"];
        succeeds(python().args(fetch).arg(&packages).args(["mcap", "zstandard"]));
    }
    imports().then_some(python)
}

#[test]
fn python_reads_every_channel() {
    let scratch = Scratch::new();
    let Some(python) = python(&scratch.0) else {
        println!("skipped: there is no python3 with the package mcap, and pip could not fetch it");
        return;
    };
    let entries = run(7, 3);
    let path = scratch.0.join("run.mcap");
    fs::write(&path, write(7, &entries, 130_000_000)).unwrap();
    let output = python().arg(SCRIPT).arg(&path).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();

    let count = |kind: fn(&What) -> bool| entries.iter().filter(|entry| kind(&entry.what)).count();
    assert_eq!(found["ticks"], count(|what| matches!(what, What::Truth(_))));
    assert_eq!(found["reports"], count(|what| matches!(what, What::Acted(_))));
    assert_eq!(found["told"], count(|what| matches!(what, What::Sensed(_))));
    assert_eq!(found["pings"], count(|what| matches!(what, What::Traffic(_))));
    assert_eq!(found["heard_bytes"], 7 * 30 * 3 * 32);
    assert_eq!(found["topics"]["/truth"], 31);
    assert_eq!((&found["topics"]["/flock"], &found["topics"]["/summary"]), (&3.into(), &1.into()));
    assert_eq!(found["metadata"]["shoal"]["seed"], "11");
    assert_eq!(found["metadata"]["shoal.outcome"]["digest"], "blake3:00ff");
    assert_eq!(found["attached"]["scenario.toml"], "name = \"made-up\"\n");
}

#[test]
fn the_index_finds_every_message() {
    let file = write(7, &run(7, 3), 130_000_000);
    let summary = mcap::Summary::read(&file).unwrap().unwrap();
    let mut found = 0;
    for chunk in &summary.chunk_indexes {
        for (channel, entries) in summary.read_message_indexes(&file, chunk).unwrap() {
            for entry in entries {
                let message = summary.seek_message(&file, chunk, &entry).unwrap();
                assert_eq!((message.channel.id, message.log_time), (channel.id, entry.log_time));
                found += 1;
            }
        }
    }
    assert_eq!(found, summary.stats.unwrap().message_count);
}
