//! Windows per second with real processes, all of them due, beside the least that such processes cost on this machine, and how
//! long they take to start.
//!
//! `cargo bench -p shoal-bus --features iceoryx2,zenoh --bench lockstep [-- FILTER]`

#[path = "../../tests/crew/mod.rs"]
mod crew;
mod opponents;

use std::time::{Duration, Instant};

use crew::{Crew, Echo};
use opponents::{Packets, Raw, Sizes};
use shoal_bus::codec;
use shoal_bus::lockstep::{Batch, Fleet, FromAuv, Mind, ToAuv};
use shoal_bus::message::Sensed;

/// Opponents take turns, so that other work on the machine meets all of them alike.
const TURNS: usize = 8;
const TURN: Duration = Duration::from_millis(500);

fn main() {
    if crew::be_an_auv_if_asked() {
        return;
    }
    opponents::be_one_if_asked();
    // Without `--bench` this is `cargo test`, which only asks whether it runs.
    let is_bench = std::env::args().any(|argument| argument == "--bench");
    let (shared_memory, zenoh): (&[u32], &[u32]) =
        if is_bench { (&[100, 300, 1000, 4000], &[100, 300]) } else { (&[3], &[3]) };
    for &count in shared_memory {
        beside_opponents(count);
    }
    for &count in zenoh.iter().filter(|count| is_wanted(&format!("bus/zenoh/{count}/"))) {
        let mut crew = Crew::new();
        let mut fleet = start("zenoh", count, &mut crew, |crew| Box::new(crew.zenoh(count, &[], &[])));
        let mut rounds = fleet_rounds(fleet.as_mut(), count);
        let rate = take_turns(&mut [&mut rounds]);
        drop(rounds);
        fleet.end();
        drop(fleet);
        crew.disband();
        print(&format!("bus/zenoh/{count}/windows"), rate[0], "1/s");
    }
}

fn is_wanted(name: &str) -> bool {
    let filter = std::env::args().skip(1).find(|argument| !argument.starts_with('-'));
    filter.is_none_or(|filter| name.contains(&filter))
}

fn beside_opponents(count: u32) {
    if !is_wanted(&format!("bus/iceoryx2/{count}/")) {
        return;
    }
    let sizes = sizes(count);
    let mut crew = Crew::new();
    let mut fleet = start("iceoryx2", count, &mut crew, |crew| Box::new(crew.shared_memory(count, &[], &[])));
    let mut raw = Raw::new(crew.run.path().join("raw"), count as usize, sizes);
    let mut packets = Packets::new(count as usize, sizes);
    let mut ours = fleet_rounds(fleet.as_mut(), count);
    let rates = take_turns(&mut [&mut ours, &mut || raw.round(), &mut || packets.round()]);
    drop(ours);
    drop((raw, packets));
    fleet.end();
    drop(fleet);
    crew.disband();
    let [ours, raw, packets] = rates[..] else { unreachable!("three took turns") };
    print(&format!("bus/iceoryx2/{count}/windows"), ours, "1/s");
    print(&format!("bus/raw/{count}/windows"), raw, "1/s");
    print(&format!("bus/packets/{count}/windows"), packets, "1/s");
    print(&format!("bus/iceoryx2/{count}/of_raw"), ours / raw, "");
    print(&format!("bus/iceoryx2/{count}/of_packets"), ours / packets, "");
}

/// Starts the processes of a fleet, and tells how long that took.
fn start(
    bus: &str,
    count: u32,
    crew: &mut Crew,
    start: impl Fn(&mut Crew) -> Box<dyn Fleet>,
) -> Box<dyn Fleet> {
    let since = Instant::now();
    let mut fleet = start(crew);
    let started_s = since.elapsed().as_secs_f64();
    assert_eq!(fleet.born(&crew::born(count)).expect("all are born"), []);
    print(&format!("bus/{bus}/{count}/spawned"), started_s, "s");
    print(&format!("bus/{bus}/{count}/born"), since.elapsed().as_secs_f64(), "s");
    fleet
}

/// One window of a fleet in which all AUVs are due.
fn fleet_rounds(fleet: &mut dyn Fleet, count: u32) -> impl FnMut() {
    let batches: Vec<Vec<Batch<Sensed>>> = (0..4).map(|tick| batches(count, tick)).collect();
    let mut window = 0;
    move || {
        let answers = fleet.exchange(&batches[window % batches.len()], &mut || {}).expect("all answer");
        assert_eq!(answers.acted.len(), count as usize);
        window += 1;
    }
}

fn batches(count: u32, tick: u64) -> Vec<Batch<Sensed>> {
    let one = |auv| Batch { auv, items: vec![crew::sensed(auv, tick)] };
    crew::auvs(count).into_iter().map(one).collect()
}

/// Mean length of the messages each way.
fn sizes(count: u32) -> Sizes {
    let born = crew::born(count);
    let mut sizes = Sizes { down: 0, up: 0 };
    for (batch, born) in batches(count, 1).into_iter().zip(&born) {
        let acted = batch.items.iter().map(|sensed| Echo::new(born).step(sensed)).collect();
        sizes.up += codec::encode(&FromAuv::Acted(acted)).expect("it can be encoded").len();
        sizes.down += codec::encode(&ToAuv::Sensed(batch.items)).expect("it can be encoded").len();
    }
    Sizes { down: sizes.down / count as usize, up: sizes.up / count as usize }
}

/// Rounds per second of each.
fn take_turns(of: &mut [&mut dyn FnMut()]) -> Vec<f64> {
    let mut rounds = vec![(0, Duration::ZERO); of.len()];
    for _ in 0..TURNS {
        for (round, (count, time)) in of.iter_mut().zip(&mut rounds) {
            // What the others left cold is not counted.
            round();
            let since = Instant::now();
            while since.elapsed() < TURN {
                round();
                *count += 1;
            }
            *time += since.elapsed();
        }
    }
    rounds.into_iter().map(|(count, time)| f64::from(count) / time.as_secs_f64()).collect()
}

fn print(name: &str, value: f64, unit: &str) {
    let line = serde_json::json!({"format": "shoal.bench/1", "name": name, "value": value, "unit": unit});
    println!("{line}");
}
