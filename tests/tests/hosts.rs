//! Runs on several hosts: real processes on the loopback, and across network namespaces with a bad link in between.

use std::net::TcpListener;
use std::time::{Duration, Instant};

use rustix::process::Signal;
use serde_json::Value;
use shoal_tests::{Command, Live, Networks, Side, await_that};

/// A short run of every kind of message.
const CIRCLES: &str = "six-circles --duration 4";

/// One with many pings.
const SWARM: &str = "swarm-300 --auvs 6 --duration 4";

/// An endpoint on the loopback where nobody listens.
fn free_endpoint() -> String {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    format!("tcp/{}", listener.local_addr().unwrap())
}

fn run(scenario: &str, endpoint: &str, hosts: usize) -> Command {
    Command::new("run")
        .and(scenario)
        .and("--json --listen")
        .with(endpoint)
        .and("--hosts")
        .with(hosts.to_string())
}

fn host(endpoint: &str, name: &str, slots: u32) -> Command {
    Command::new("host --connect")
        .with(endpoint)
        .and("--name")
        .with(name)
        .and("--slots")
        .with(slots.to_string())
}

fn digest_of_one_machine(scenario: &str) -> Value {
    Command::new("run --bus local").and(scenario).json()["digest"].clone()
}

/// Waits until the run is under way.
fn await_pings(run: &Live) {
    await_that("the run has an id", || run.run_id().is_some());
    let heard = Command::new("tap --json --count 1 --wait 60 --run").with(run.run_id().unwrap()).finish();
    assert_eq!(heard.succeeded().stdout.lines().count(), 1);
}

/// All went well, as the launcher and its hosts say.
fn succeeded(run: Live, hosts: Vec<Live>) -> Value {
    let finished = run.finish().succeeded();
    for host in hosts {
        let finished = host.finish().succeeded();
        assert!(finished.stderr.contains("the run is over"), "{}", finished.stderr);
    }
    let summary = finished.json();
    assert_eq!((&summary["reproducible"], &summary["bus"]), (&true.into(), &"hosts".into()));
    summary
}

#[test]
fn two_and_three_hosts_have_the_digest_of_one_machine() {
    for (scenario, auvs) in [(CIRCLES, 6), ("swarm-300 --auvs 20 --duration 3", 20)] {
        let expected = digest_of_one_machine(scenario);
        for (slots, options, processes) in [
            (vec![auvs / 2, auvs - auvs / 2], "", auvs + 1),
            (vec![auvs, auvs, auvs], "--auvs-per-process 50", 4),
        ] {
            let endpoint = free_endpoint();
            // Hosts may be there first.
            let hosts: Vec<Live> =
                slots.iter().map(|&slots| host(&endpoint, "alpha", slots).start()).collect();
            let run = run(scenario, &endpoint, slots.len()).and(options).start();
            let summary = succeeded(run, hosts);
            assert_eq!(summary["digest"], expected, "{scenario} on {slots:?}");
            assert_eq!(summary["processes"], processes);
        }
    }
}

#[test]
fn a_link_that_delays_loses_and_goes_down_changes_nothing() {
    let networks = match Networks::new(20.0, 0.02) {
        Ok(networks) => networks,
        Err(why) => {
            eprintln!("skipped: no network namespaces with a link here: {why}");
            return;
        }
    };
    let expected = digest_of_one_machine(SWARM);
    let folder = tempfile::tempdir().unwrap();
    let config = folder.path().join("zenoh.json5");
    // With the first, connections outlive the gap; with the second they are closed and opened again, and what was said is lost.
    for (port, lease_ms) in [(7447, 5000), (7448, 400)] {
        std::fs::write(&config, format!("{{ transport: {{ link: {{ tx: {{ lease: {lease_ms} }} }} }} }}"))
            .unwrap();
        let endpoint = format!("tcp/{}:{port}", networks.address(Side::Near));
        let at = |side: Side, command: Command| {
            command.and("--zenoh-config").with(&config).within(networks.entry(side)).start()
        };
        let run = at(Side::Near, run(SWARM, &endpoint, 2));
        let hosts = ["alpha", "beta"].map(|name| at(Side::Far, host(&endpoint, name, 3))).into();
        await_pings(&run);
        let since = Instant::now();
        networks.set_link(false);
        std::thread::sleep(Duration::from_secs(2));
        networks.set_link(true);
        let summary = succeeded(run, hosts);
        assert!(since.elapsed() > Duration::from_secs(2), "the link went down after the run");
        assert_eq!(summary["digest"], expected, "lease {lease_ms} ms");
    }
}

#[test]
fn a_host_whose_link_stays_down_is_lost() {
    let Ok(networks) = Networks::new(0.0, 0.0) else {
        eprintln!("skipped: no network namespaces with a link here");
        return;
    };
    let endpoint = format!("tcp/{}:7447", networks.address(Side::Near));
    let run =
        run(SWARM, &endpoint, 2).and("--host-limit 2 --pace 2").within(networks.entry(Side::Near)).start();
    let far = host(&endpoint, "far", 3).within(networks.entry(Side::Far)).start();
    let near = host(&endpoint, "near", 3).within(networks.entry(Side::Near)).start();
    await_pings(&run);
    networks.set_link(false);
    let finished = run.finish().exited(3);
    let summary = finished.json();
    assert_eq!(summary["sim_s"], 4.0);
    let lost = summary["agents"]["lost"].as_array().unwrap();
    assert_eq!(lost.len(), 3);
    assert!(lost.iter().all(|lost| lost["reason"] == "host far was silent for 2 s"), "{lost:?}");
    let told = far.finish().exited(3).stderr;
    assert!(told.contains("the launcher was silent for 2 s and is gone"), "{told}");
    near.finish().succeeded();
}

#[test]
fn a_killed_host_is_replaced_by_one_that_joins() {
    let endpoint = free_endpoint();
    let run = run("swarm-300 --auvs 6 --duration 12 --pace 2", &endpoint, 2).start();
    let stays = host(&endpoint, "alpha", 3).start();
    let dies = host(&endpoint, "beta", 3).start();
    await_pings(&run);
    dies.signal(Signal::KILL);
    // Nothing of it stays, though it could not clean up.
    assert_eq!(dies.finish().code(), None);
    let spare = host(&endpoint, "gamma", 4).start();
    let finished = run.finish().exited(3);
    let summary = finished.json();
    assert_eq!((&summary["sim_s"], &summary["reproducible"]), (&12.0.into(), &false.into()));
    let agents = |which: &str| -> Vec<u64> {
        summary["agents"][which].as_array().unwrap().iter().map(|auv| auv["auv"].as_u64().unwrap()).collect()
    };
    assert_eq!(agents("lost").len(), 3);
    assert_eq!(agents("restarted"), agents("lost"));
    assert_eq!(summary["agents"]["lost"][0]["reason"], "host beta ended without a word");
    assert_eq!(summary["containment"]["violations"], 0);
    for said in [
        "host beta ended without a word: AUVs",
        "host gamma joined with 4 slots, as a spare",
        "host gamma carries AUVs",
    ] {
        assert!(finished.stderr.contains(said), "{said}:\n{}", finished.stderr);
    }
    stays.finish().succeeded();
    let spare = spare.finish().succeeded();
    assert!(spare.stderr.contains("as a spare") && spare.stderr.contains("carries AUVs"), "{}", spare.stderr);
}

#[test]
fn an_auv_that_dies_on_a_host_is_lost_alone() {
    let endpoint = free_endpoint();
    let run = run(SWARM, &endpoint, 1).and("--pace 2").start();
    let mut alpha = host(&endpoint, "alpha", 6).start();
    await_pings(&run);
    alpha.auvs()[&4].signal(Signal::KILL);
    let summary = run.finish().exited(3).json();
    let lost = summary["agents"]["lost"].as_array().unwrap();
    assert_eq!(lost.len(), 1);
    assert_eq!((&lost[0]["auv"], &lost[0]["reason"]), (&4.into(), &"killed by signal 9".into()));
    alpha.finish().succeeded();
}

#[test]
fn interrupted_hosts_and_launchers_leave_nothing() {
    let endpoint = free_endpoint();
    let live = run("swarm-300 --auvs 6 --pace 1", &endpoint, 2).start();
    let (alpha, beta) = (host(&endpoint, "alpha", 3).start(), host(&endpoint, "beta", 3).start());
    await_pings(&live);
    let since = Instant::now();
    alpha.signal(Signal::INT);
    let told = alpha.finish().exited(3).stderr;
    assert!(told.contains("interrupted; its AUVs are lost"), "{told}");
    live.signal(Signal::INT);
    live.finish().exited(3);
    beta.finish().succeeded();
    assert!(since.elapsed() < Duration::from_secs(30));

    // Nobody tells a host that the water's process was killed.
    let endpoint = free_endpoint();
    let mut live = run("swarm-300 --auvs 6 --pace 1 --host-limit 1", &endpoint, 1).start();
    let alpha = host(&endpoint, "alpha", 6).start();
    await_pings(&live);
    live.channel().unwrap().signal(Signal::KILL);
    let told = alpha.finish().exited(3).stderr;
    assert!(told.contains("the launcher was silent for 1 s and is gone; its AUVs are lost"), "{told}");
    live.finish().exited(1);
}

#[test]
fn who_cannot_join_is_told_why_on_both_sides() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    };
    let (token, other) = (file("token", "sesame\n"), file("other", "barley\n"));
    let endpoint = free_endpoint();
    let live = run(CIRCLES, &endpoint, 1).and("--token").with(&token).start();
    for (command, said) in [
        (host(&endpoint, "naked", 6), "shows no token"),
        (host(&endpoint, "forger", 6).and("--token").with(&other), "another one than the launcher's"),
        (host(&endpoint, "choosy", 6).and("--scenario two-circles"), "insists on a scenario"),
    ] {
        let told = command.finish().exited(1).stderr;
        assert!(told.contains("error: the launcher refuses this host: ") && told.contains(said), "{told}");
    }
    let small = host(&endpoint, "small", 4).and("--scenario six-circles --token").with(&token).start();
    let told = live.finish().exited(1).stderr;
    for said in [
        "host naked was refused: it shows no token",
        "host forger was refused: its token",
        "host choosy was refused: it insists on a scenario",
        "error: 2 of 6 AUVs have no place on the hosts that joined (small: 4 slots)",
    ] {
        assert!(told.contains(said), "{said}:\n{told}");
    }
    let told = small.finish().exited(1).stderr;
    assert!(told.contains("the run has failed: 2 of 6 AUVs have no place"), "{told}");
}

#[test]
fn wrong_addresses_and_files_are_told() {
    let fails = |command: Command, code: i32, said: &str| {
        let told = command.finish().exited(code).stderr;
        assert!(told.contains(said), "{said}:\n{told}");
    };
    let nobody = free_endpoint();
    fails(host(&nobody, "lonely", 1).and("--wait 1"), 1, "nobody could be reached at tcp/127.0.0.1:");
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let endpoint = format!("tcp/{}", taken.local_addr().unwrap());
    fails(run(CIRCLES, &endpoint, 1), 1, "Address already in use (os error 98); is the port in use");
    fails(Command::new("host --connect 127.0.0.1 --slots 1"), 2, "tcp/ADDRESS:PORT");
    fails(Command::new("host --connect tcp/127.0.0.1:7447 --slots 0"), 2, "--slots");
    fails(Command::new("run six-circles --listen tcp/127.0.0.1:7447"), 2, "--hosts");
    fails(Command::new("run six-circles --listen tcp/127.0.0.1:7447 --hosts 1 --bus zenoh"), 2, "--bus");
    fails(Command::new("run six-circles --zenoh-config x"), 2, "--zenoh-config");
    fails(host(&nobody, "a", 1).and("--token /no/such/file"), 2, "--token /no/such/file: No such file");
    fails(
        host(&nobody, "a", 1).and("--zenoh-config /no/such/file"),
        2,
        "/no/such/file: this is no configuration of zenoh",
    );
    let printed = Command::new("host --print-zenoh-config").finish().succeeded().stdout;
    assert!(printed.contains("scouting") && printed.contains("lease"), "{printed}");
}
