//! `shoal run` really runs a process for the water and one for each AUV.

use shoal_tests::{Command, await_that};

#[test]
fn a_run_is_one_process_per_auv_and_one_for_the_water() {
    let mut live = Command::new("run six-circles --pace 20 --json").start();
    live.await_pings(6);
    let auvs = live.auvs();
    assert_eq!(auvs.keys().copied().collect::<Vec<_>>(), [0, 1, 2, 3, 4, 5]);
    let channel = live.channel().unwrap();
    assert_eq!(live.children().len(), 7);
    // Each is this very executable, and knows nothing but its id and where the run is.
    let executable = |pid: u32| std::fs::read_link(format!("/proc/{pid}/exe")).unwrap();
    for (auv, process) in &auvs {
        assert_eq!(executable(process.pid), executable(live.launcher().pid));
        let arguments = process.arguments().join(" ");
        assert!(arguments.contains(&format!("--auvs {auv}..{} ", auv + 1)), "{arguments}");
        assert!(!arguments.contains("six-circles") && !arguments.contains("seed"), "{arguments}");
    }
    assert!(!auvs.values().any(|auv| *auv == channel));

    let summary = live.finish().succeeded().json();
    assert_eq!(summary["format"], "shoal.summary/1");
    assert_eq!((&summary["auvs"], &summary["processes"]), (&6.into(), &7.into()));
    assert_eq!(summary["bus"], "iceoryx2");
    assert_eq!(summary["containment"]["violations"], 0);
    assert!(summary["containment"]["checks"].as_u64().unwrap() > 30_000);
    assert_eq!(summary["reproducible"], true);
    assert_eq!(summary["sim_s"], 60.0);
    assert!(summary["memory"]["auv_pss_kib_median"].as_u64().unwrap() > 0);
}

#[test]
fn zenoh_has_as_many_and_local_has_none() {
    let mut live = Command::new("run six-circles --pace 30 --bus zenoh --json").start();
    await_that("all processes are there", || live.children().len() == 7);
    assert_eq!(live.finish().succeeded().json()["processes"], 7);

    let mut live = Command::new("run six-circles --pace 100 --bus local --json").start();
    await_that("the run is there", || live.run_id().is_some());
    assert!(live.children().is_empty());
    assert_eq!(live.finish().succeeded().json()["processes"], 1);
}

#[test]
fn several_auvs_may_share_a_process() {
    for bus in ["iceoryx2", "zenoh"] {
        let mut live =
            Command::new("run six-circles --pace 30 --auvs-per-process 4 --json --bus").with(bus).start();
        live.await_pings(6);
        let auvs = live.auvs();
        assert_eq!(live.children().len(), 3);
        assert!((1..4).all(|auv| auvs[&auv] == auvs[&0]) && auvs[&4] == auvs[&5] && auvs[&4] != auvs[&0]);
        let summary = live.finish().succeeded().json();
        assert_eq!((&summary["auvs"], &summary["processes"]), (&6.into(), &3.into()));
        assert!(summary["memory"]["auv_pss_kib_median"].as_u64().unwrap() > 0);
    }
}

#[test]
fn the_summary_is_for_people_too() {
    let finished = Command::new("run six-circles --quiet").finish().succeeded();
    for expected in
        ["six-circles, seed 7: 6 AUVs, 7 processes on iceoryx2", "0 violations", "digest", "reproducible"]
    {
        assert!(finished.stdout.contains(expected), "{expected}:\n{}", finished.stdout);
    }
}

#[test]
fn scenarios_are_listed_and_checked() {
    let listed = Command::new("scenarios").finish().succeeded().stdout;
    let names: Vec<&str> = shoal_scenario::library().iter().map(|entry| entry.name).collect();
    for name in &names {
        assert!(listed.lines().any(|line| line.trim_start().starts_with(*name)), "{name}:\n{listed}");
    }
    assert_eq!(Command::new("scenarios --json").finish().succeeded().json_lines().len(), names.len());
    Command::new("check").with("two-circles").with("swarm-1000").finish().succeeded();
    // What is printed is a scenario file that runs.
    let folder = tempfile::tempdir().unwrap();
    let mine = folder.path().join("mine.toml");
    std::fs::write(&mine, Command::new("scenarios swarm-3").finish().succeeded().stdout).unwrap();
    Command::new("check").with(&mine).finish().succeeded();
    let from_file = Command::new("run --duration 2").with(&mine).json();
    assert_eq!(from_file["digest"], Command::new("run --duration 2 swarm-3").json()["digest"]);
}

#[test]
fn what_is_doubtful_runs_with_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    let mine = folder.path().join("mine.toml");
    let text = "name = \"many\"\nduration_s = 1\nenvironment.area_m = [[0, 90], [0, 90], [-90, 0]]\n\
                [[group]]\nname = \"a\"\ncount = 16\nmodem = \"seatrac\"\n";
    std::fs::write(&mine, text).unwrap();
    let said = "16 AUVs have the modem `seatrac`, whose addresses end at 15: this swarm is an extrapolation";
    for command in ["run --bus local --json --auvs 16", "check"] {
        let finished = Command::new(command).with(&mine).finish().succeeded();
        let warnings: Vec<_> = finished.stderr.lines().filter(|line| line.starts_with("warning:")).collect();
        assert!(
            matches!(warnings[..], [warning] if warning.ends_with(said)),
            "{command}:\n{}",
            finished.stderr
        );
        assert!(!finished.stdout.contains("warning"), "{}", finished.stdout);
    }
    let fewer = Command::new("run --bus local --json --auvs 15").with(&mine).finish().succeeded();
    assert!(!fewer.stderr.contains("warning:"), "{}", fewer.stderr);
}

#[test]
fn what_cannot_be_run_is_refused_with_a_sentence() {
    let refused = |arguments: &str, said: &str| {
        let finished = Command::new(arguments).finish().exited(2);
        assert!(finished.stderr.contains(said), "{arguments}:\n{}", finished.stderr);
        assert_eq!(finished.stdout, "");
    };
    refused("run six-circels", "did you mean `six-circles`?");
    refused("run six-circles --noise loud", "uniform");
    refused("run six-circles --duration 0", "duration");
    refused("run six-circles --auvs 0", "auvs");
    refused("run six-circles --pace 0", "pace");
    refused("run six-circles --auvs-per-process 0", "give a whole number from 1 on");
    refused(
        "run six-circles --bus local --auvs-per-process 2",
        "--auvs-per-process is for AUVs in processes",
    );
    refused("check six-circels", "did you mean `six-circles`?");
    refused("run", "<SCENARIO>");
}
