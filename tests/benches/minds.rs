//! What a mind costs that hears what the AUVs of `swarm-1000` hear: every 25th of them lives its life once more, without water. Of a
//! life, a control step and a ping heard are told apart by a second life without pings.
//!
//! `cargo bench -p shoal-tests --bench minds`; for instructions instead of time, which do not mind a busy machine, count those of
//! `live` under callgrind (`--collect-atstart=no --toggle-collect='*live*'`).

use std::cell::RefCell;
use std::hint::black_box;
use std::rc::Rc;
use std::time::Instant;

use shoal_auv::Auv;
use shoal_bus::lockstep::Mind;
use shoal_bus::message::{Acted, Born, Sense, Sensed};
use shoal_bus::time::NS_PER_S;
use shoal_tests::{library_scenario, run_local_watched};

const EVERY: u32 = 25;

/// What one AUV was told from its birth on.
type Life = (Born, Vec<Sensed>);

fn main() {
    // Without `--bench` this is `cargo test`, which only asks whether it runs.
    let is_bench = std::env::args().any(|argument| argument == "--bench");
    let (rounds, seconds) = if is_bench { (20, 10) } else { (1, 1) };
    for (name, period_ns) in [("0.1s", NS_PER_S / 10), ("1s", NS_PER_S)] {
        let lives = lives(period_ns, seconds);
        let steps: usize = lives.iter().map(|(_, life)| life.len()).sum();
        let pings: usize = lives.iter().flat_map(|(_, life)| life).map(pings_heard).sum();
        let deaf: Vec<Life> = lives.iter().map(|(born, life)| (born.clone(), without_pings(life))).collect();
        let (all_us, deaf_us) = (cost_us(&lives, rounds), cost_us(&deaf, rounds));
        report(&format!("{name}/step"), deaf_us / steps as f64);
        report(&format!("{name}/ping"), (all_us - deaf_us) / pings as f64);
        report(&format!("{name}/auv_second"), all_us / (lives.len() * seconds as usize) as f64);
    }
}

/// What some AUVs sense when all have this control period.
fn lives(period_ns: i64, seconds: i64) -> Vec<Life> {
    let mut scenario = library_scenario("swarm-1000");
    scenario.duration_ns = seconds * NS_PER_S;
    for group in &mut scenario.groups {
        group.control_period_ns = period_ns;
        group.reaction_ns = group.reaction_ns.max(period_ns);
    }
    let lives: Rc<RefCell<Vec<Life>>> = Rc::default();
    let be_born = |born: &Born| {
        let index = born.auv.0.is_multiple_of(EVERY).then(|| {
            lives.borrow_mut().push((born.clone(), Vec::new()));
            lives.borrow().len() - 1
        });
        Diarist { mind: Auv::new(born), index, lives: Rc::clone(&lives) }
    };
    run_local_watched(&scenario, None, be_born, |_| {}).expect("the run goes on to its end");
    lives.take()
}

/// A mind that writes down what it is told.
struct Diarist {
    mind: Auv,
    index: Option<usize>,
    lives: Rc<RefCell<Vec<Life>>>,
}

impl Mind for Diarist {
    fn step(&mut self, sensed: &Sensed) -> Acted {
        if let Some(index) = self.index {
            self.lives.borrow_mut()[index].1.push(sensed.clone());
        }
        self.mind.step(sensed)
    }
}

fn is_ping(sense: &Sense) -> bool {
    matches!(sense, Sense::Heard { .. })
}

fn pings_heard(sensed: &Sensed) -> usize {
    sensed.events.iter().filter(|event| is_ping(&event.sense)).count()
}

fn without_pings(life: &[Sensed]) -> Vec<Sensed> {
    let mut life = life.to_vec();
    life.iter_mut().for_each(|sensed| sensed.events.retain(|event| !is_ping(&event.sense)));
    life
}

/// The best of some rounds: microseconds of all lives together.
fn cost_us(lives: &[Life], rounds: usize) -> f64 {
    let round_us = |_| {
        let mut minds: Vec<Auv> = lives.iter().map(|(born, _)| Auv::new(born)).collect();
        let since = Instant::now();
        for (mind, (_, life)) in minds.iter_mut().zip(lives) {
            live(mind, life);
        }
        since.elapsed().as_nanos() as f64 / 1e3
    };
    (0..rounds).map(round_us).fold(f64::INFINITY, f64::min)
}

#[inline(never)]
fn live(mind: &mut Auv, life: &[Sensed]) {
    for sensed in life {
        black_box(mind.step(black_box(sensed)));
    }
}

fn report(name: &str, value_us: f64) {
    println!(r#"{{"format":"shoal.bench/1","name":"minds/{name}","value":{value_us:.2},"unit":"us"}}"#);
}
