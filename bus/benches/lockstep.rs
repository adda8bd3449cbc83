//! Windows per second with real processes, all of them due, and how long they take to start.
//!
//! `cargo bench -p shoal-bus --features iceoryx2,zenoh --bench lockstep [-- FILTER]`

#[path = "../tests/crew/mod.rs"]
mod crew;

use std::time::{Duration, Instant};

use crew::Crew;
use shoal_bus::lockstep::{Batch, Fleet};
use shoal_bus::message::Sensed;

const MEASURED: Duration = Duration::from_secs(4);

fn main() {
    if crew::be_an_auv_if_asked() {
        return;
    }
    // Without `--bench` this is `cargo test`, which only asks whether it runs.
    let is_bench = std::env::args().any(|argument| argument == "--bench");
    let (shared_memory, zenoh): (&[u32], &[u32]) =
        if is_bench { (&[100, 300, 1000], &[100, 300]) } else { (&[3], &[3]) };
    for &count in shared_memory {
        measure("iceoryx2", count, |crew| Box::new(crew.shared_memory(count, &[], &[])));
    }
    for &count in zenoh {
        measure("zenoh", count, |crew| Box::new(crew.zenoh(count, &[], &[])));
    }
}

fn measure(bus: &str, count: u32, start: impl Fn(&mut Crew) -> Box<dyn Fleet>) {
    let filter = std::env::args().skip(1).find(|argument| !argument.starts_with('-'));
    if filter.is_some_and(|filter| !format!("bus/{bus}/{count}/").contains(&filter)) {
        return;
    }
    let mut crew = Crew::new();
    let since = Instant::now();
    let mut fleet = start(&mut crew);
    let started_s = since.elapsed().as_secs_f64();
    assert_eq!(fleet.born(&crew::born(count)).expect("all are born"), []);
    let born_s = since.elapsed().as_secs_f64();
    let since = Instant::now();
    let mut windows = 0;
    while since.elapsed() < MEASURED {
        let one = |auv| Batch { auv, items: vec![crew::sensed(auv, windows)] };
        let batches: Vec<Batch<Sensed>> = crew::auvs(count).into_iter().map(one).collect();
        let answers = fleet.exchange(&batches, &mut || {}).expect("all answer");
        assert_eq!(answers.acted.len(), count as usize);
        windows += 1;
    }
    let rate = windows as f64 / since.elapsed().as_secs_f64();
    fleet.end();
    drop(fleet);
    crew.disband();
    print(&format!("bus/{bus}/{count}/spawned"), started_s, "s");
    print(&format!("bus/{bus}/{count}/born"), born_s, "s");
    print(&format!("bus/{bus}/{count}/windows"), rate, "1/s");
}

fn print(name: &str, value: f64, unit: &str) {
    let line = serde_json::json!({"format": "shoal.bench/1", "name": name, "value": value, "unit": unit});
    println!("{line}");
}
