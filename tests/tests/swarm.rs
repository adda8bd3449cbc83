//! Hundreds and a thousand AUVs, a process each.

use shoal_tests::{Command, alone};

#[test]
fn swarm_300_finds_itself() {
    let _cores = alone();
    let summary = Command::new("run swarm-300").json();
    assert_eq!((&summary["auvs"], &summary["processes"]), (&300.into(), &301.into()));
    assert_eq!(summary["containment"]["violations"], 0);
    assert!(summary["containment"]["checks"].as_u64().unwrap() > 180_000);
    let width_m = &summary["position_width_m"];
    let [start, end] = ["start_median", "end_median"].map(|key| width_m[key].as_f64().unwrap());
    // Measured: 23.8 m to 12.4 m.
    assert!(end < 0.75 * start, "{width_m}");
    let flock = &summary["flock"];
    assert!((0.0..=1.0).contains(&flock["polarization"].as_f64().unwrap()), "{flock}");
    assert!(flock["min_separation_m"].as_f64().unwrap() > 0.0, "{flock}");
    assert!(flock["connectivity"].as_f64().unwrap() > 0.0, "{flock}");
    // Every ping has one fate at each of the 299 others.
    let pings = &summary["pings"];
    let count = |key: &str| pings[key].as_u64().unwrap();
    let lost: u64 = pings["lost"].as_object().unwrap().values().map(|count| count.as_u64().unwrap()).sum();
    assert_eq!(pings["lost"]["late"], 0);
    assert_eq!(count("emitted") * 299, count("heard") + lost + count("in_flight"));
    assert!(count("heard") > 100_000, "{pings}");
}

#[test]
fn swarm_1000_is_a_thousand_processes() {
    let _cores = alone();
    let mut live = Command::new("run swarm-1000 --duration 3 --json").start();
    shoal_tests::await_that("all processes are there", || {
        live.auvs().len() == 1000 || !live.launcher().is_alive()
    });
    assert!(live.channel().is_some());
    let summary = live.finish().succeeded().json();
    assert_eq!((&summary["auvs"], &summary["processes"]), (&1000.into(), &1001.into()));
    assert_eq!(summary["containment"]["violations"], 0);
    assert_eq!(summary["agents"]["lost"], serde_json::json!([]));
    assert_eq!(summary["sim_s"], 3.0);
    // Ten ticks a second each.
    assert!((29_000..=31_000).contains(&summary["wakes"].as_u64().unwrap()), "{}", summary["wakes"]);
}
