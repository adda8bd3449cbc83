//! The rules of the house that a compiler does not keep: who may know whom, and where unsafe code may be.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;
use shoal_tests::workspace;

/// Every crate that a crate links to in a build that is no test, by name.
struct Links(BTreeMap<String, BTreeSet<String>>);

impl Links {
    /// As cargo resolves them.
    fn read() -> Self {
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let output = std::process::Command::new(cargo)
            .args(["metadata", "--format-version", "1", "--offline", "--filter-platform"])
            // Of other systems' crates nothing has been downloaded.
            .arg(format!("{}-unknown-linux-gnu", std::env::consts::ARCH))
            .current_dir(workspace())
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let metadata: Value = serde_json::from_slice(&output.stdout).unwrap();
        let text = |value: &Value| value.as_str().unwrap().to_owned();
        let packages = metadata["packages"].as_array().unwrap();
        let names: BTreeMap<String, String> =
            packages.iter().map(|package| (text(&package["id"]), text(&package["name"]))).collect();
        let mut links: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        for node in metadata["resolve"]["nodes"].as_array().unwrap() {
            let of = links.entry(names[&text(&node["id"])].clone()).or_default();
            for dependency in node["deps"].as_array().unwrap() {
                let is_linked =
                    dependency["dep_kinds"].as_array().unwrap().iter().any(|kind| kind["kind"].is_null());
                if is_linked {
                    of.insert(names[&text(&dependency["pkg"])].clone());
                }
            }
        }
        Self(links)
    }

    /// All crates that `name` depends on, through others too.
    fn behind(&self, name: &str) -> BTreeSet<String> {
        let mut found = BTreeSet::new();
        let mut waiting = vec![name.to_owned()];
        while let Some(next) = waiting.pop() {
            for dependency in &self.0[&next] {
                if found.insert(dependency.clone()) {
                    waiting.push(dependency.clone());
                }
            }
        }
        found
    }

    /// Those of them that are ours.
    fn of_ours(&self, name: &str) -> Vec<String> {
        self.behind(name).into_iter().filter(|name| name.starts_with("shoal")).collect()
    }
}

#[test]
fn an_auv_never_knows_the_truth_and_the_water_never_a_mind() {
    let links = Links::read();
    assert_eq!(links.of_ours("shoal-auv"), ["shoal-bus", "shoal-interval", "shoal-tube"]);
    assert_eq!(links.of_ours("shoal-channel"), ["shoal-bus", "shoal-scenario"]);
    assert_eq!(links.of_ours("shoal-tube"), ["shoal-interval"]);
    for alone in ["shoal-interval", "shoal-bus", "shoal-scenario"] {
        assert!(links.of_ours(alone).is_empty(), "{alone}: {:?}", links.of_ours(alone));
    }
    assert_eq!(
        links.of_ours("shoal"),
        ["shoal-auv", "shoal-bus", "shoal-channel", "shoal-interval", "shoal-scenario", "shoal-tube"]
    );
}

#[test]
fn an_auv_draws_no_random_numbers() {
    // What it cannot draw it cannot guess: the seed determines the truth.
    let behind = Links::read().behind("shoal-auv");
    let ours = fs::read_to_string(workspace().join("agents/auv/Cargo.toml")).unwrap();
    assert!(!ours.contains("rand"), "{ours}");
    assert!(!behind.contains("shoal-scenario") && !behind.contains("shoal-channel"));
}

/// All Rust sources of the workspace.
fn sources() -> Vec<PathBuf> {
    fn gather(folder: &Path, into: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).unwrap().flatten() {
            let path = entry.path();
            let name = entry.file_name();
            if path.is_dir() && name != "target" && !name.to_string_lossy().starts_with('.') {
                gather(&path, into);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                into.push(path);
            }
        }
    }
    let mut found = Vec::new();
    gather(&workspace(), &mut found);
    found.sort();
    found
}

#[test]
fn unsafe_code_is_in_one_module() {
    let one = workspace().join("bus/src/os.rs");
    let lint = concat!("unsafe", "_code");
    let lifts = |line: &str| {
        line.contains(lint)
            && ["allow", "expect", "warn"].iter().any(|how| line.contains(&format!("{how}({lint}")))
    };
    let lifted_in: Vec<PathBuf> =
        sources().into_iter().filter(|path| fs::read_to_string(path).unwrap().lines().any(lifts)).collect();
    assert_eq!(lifted_in, [one], "only the operating system's module may lift the lint");
    let manifest = fs::read_to_string(workspace().join("Cargo.toml")).unwrap();
    assert!(manifest.contains(&format!("{lint} = \"deny\"")));
    // Every crate takes the workspace's lints.
    let members = [
        "agents/interval",
        "agents/tube",
        "agents/auv",
        "agents/channel",
        "bus",
        "scenario",
        "tools",
        "tests",
    ];
    for member in members {
        let manifest = fs::read_to_string(workspace().join(member).join("Cargo.toml")).unwrap();
        assert!(manifest.contains("[lints]\nworkspace = true"), "{member}");
    }
}

#[test]
fn minds_and_water_are_pure() {
    // No threads, processes, sockets, files or wall clocks where states are computed.
    let banned = ["std::thread", "std::process", "std::net", "std::fs", "std::time", "std::env", "println!"];
    // Pavings may share their work among threads where a person asks for it, which no mind or water does, and figures are written
    // to files.
    let offline = ["agents/interval/src/paving/engine.rs", "agents/interval/src/figure.rs"];
    let ways_there = ["with_threads", "shoal_interval::figure", "shoal_tube::figure"];
    for path in sources() {
        let room = path.strip_prefix(workspace()).unwrap().to_string_lossy().into_owned();
        let pure = ["agents/interval/src", "agents/tube/src", "agents/auv/src", "agents/channel/src"];
        let is_test = room.ends_with("tests.rs") || room.contains("/tests/");
        if !pure.iter().any(|pure| room.starts_with(pure)) || is_test || offline.contains(&room.as_str()) {
            continue;
        }
        let is_state_machine = room.starts_with("agents/auv") || room.starts_with("agents/channel");
        let also = if is_state_machine { ways_there.as_slice() } else { &[] };
        let text = fs::read_to_string(&path).unwrap();
        let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
        for (number, line) in code.enumerate() {
            let found = banned.iter().chain(also).find(|word| line.contains(**word));
            assert!(found.is_none(), "{room}: {} in code line {number}: {line}", found.unwrap_or(&""));
        }
    }
}
