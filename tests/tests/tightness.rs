//! How tight the tube is online, beside everything that the same data allow.

use std::cell::RefCell;
use std::collections::BTreeMap;

use shoal_auv::Auv;
use shoal_auv::estimator::Estimator as _;
use shoal_auv::state::State;
use shoal_auv::tube_estimator::TubeEstimator;
use shoal_bus::chronicle::What;
use shoal_bus::message::{Born, Estimator, Sense, Sensed, TubeSettings};
use shoal_scenario::Scenario;
use shoal_tests::present::{Hull, Present};
use shoal_tests::{library_scenario, run_local_watched};

/// What one AUV was told in its life.
struct Life {
    born: Born,
    sensed: Vec<Sensed>,
}

/// The lives of every `step`-th AUV.
fn lives(scenario: &Scenario, step: u32) -> Vec<Life> {
    let lives = RefCell::new(BTreeMap::new());
    let be_born = |born: &Born| {
        if born.auv.0.is_multiple_of(step) {
            lives.borrow_mut().insert(born.auv.0, Life { born: born.clone(), sensed: Vec::new() });
        }
        Auv::new(born)
    };
    run_local_watched(scenario, None, be_born, |entry| {
        if let What::Sensed(sensed) = &entry.what
            && let Some(life) = lives.borrow_mut().get_mut(&entry.auv.0)
        {
            life.sensed.push(sensed.clone());
        }
    })
    .unwrap();
    lives.into_inner().into_values().collect()
}

impl Life {
    /// The state at the end of what was told, by a tube that is set so.
    fn tube(&self, settings: TubeSettings) -> State {
        let mut born = self.born.clone();
        born.orders.estimator = Estimator::Tube(settings);
        let mut tube = TubeEstimator::new(&born);
        let last = self.sensed.iter().map(|sensed| tube.update(sensed)).last();
        last.unwrap().state
    }

    fn deaf(&self) -> Self {
        let mut sensed = self.sensed.clone();
        for sensed in &mut sensed {
            sensed.events.retain(|event| !matches!(event.sense, Sense::Heard { .. }));
        }
        Self { born: self.born.clone(), sensed }
    }

    fn hull(&self) -> Hull {
        let mut present = Present::new(&self.born);
        self.sensed.iter().for_each(|sensed| present.update(sensed));
        present.hull()
    }

    fn settings(&self) -> TubeSettings {
        match self.born.orders.estimator {
            Estimator::Tube(settings) => settings,
            _ => unreachable!("all are tubes"),
        }
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn width_m(state: &State) -> f64 {
    state.position_m.width()
}

/// Widths of tubes beside their hulls, the medians of many lives.
struct Beside {
    position: f64,
    clock: f64,
}

impl Beside {
    /// The hull from the inside: what is found there is allowed for sure, so no hull is narrower.
    fn hulls(states: &[State], hulls: &[Hull]) -> Self {
        Self::all(states, &hulls.iter().map(|hull| hull.inner).collect::<Vec<_>>())
    }

    fn all(states: &[State], others: &[State]) -> Self {
        let pairs = || states.iter().zip(others);
        Self {
            position: median(pairs().map(|(one, other)| width_m(one) / width_m(other)).collect()),
            clock: median(
                pairs().map(|(one, other)| one.offset_s.width() / other.offset_s.width()).collect(),
            ),
        }
    }
}

fn tubes(lives: &[Life], rings: u16) -> Vec<State> {
    lives.iter().map(|life| life.tube(TubeSettings { rings, ..life.settings() })).collect()
}

fn show(what: &str, states: &[State], hulls: &[Hull]) {
    let Beside { position, clock } = Beside::hulls(states, hulls);
    let width_s = median(states.iter().map(|state| state.offset_s.width()).collect());
    println!(
        "  {what}: {:.2} m, {:.2} ms; beside the hull {position:.3}, {clock:.3}",
        median(states.iter().map(width_m).collect()),
        width_s * 1e3
    );
}

/// How wide the hulls themselves are known, and the tubes that are deaf, listen slice by slice, and keep rings.
fn survey(name: &str, lives: &[Life], hulls: &[Hull], counts: &[u16]) {
    println!("{name}, {} AUVs", lives.len());
    let outer: Vec<State> = hulls.iter().map(|hull| hull.outer).collect();
    let none: Vec<State> = lives.iter().map(|life| life.deaf().tube(life.settings())).collect();
    show("hull from outside", &outer, hulls);
    show("deaf", &none, hulls);
    let slice_wise = tubes(lives, 0);
    show("slice-wise", &slice_wise, hulls);
    for &rings in counts {
        let states = tubes(lives, rings);
        show(&format!("{rings} rings"), &states, hulls);
        let mut factors: Vec<f64> =
            states.iter().zip(&slice_wise).map(|(rings, slices)| width_m(rings) / width_m(slices)).collect();
        factors.sort_by(f64::total_cmp);
        let at = |part: usize| factors[(factors.len() - 1) * part / 10];
        println!("    beside slice-wise: median {:.3}, best tenth {:.3}, worst {:.3}", at(5), at(1), at(10));
    }
}

/// The figures of BENCHMARKS.md: `cargo test --release -p shoal-tests --test tightness -- --ignored --nocapture`.
#[test]
#[ignore = "prints figures and takes long"]
fn the_library() {
    for (name, step) in [("swarm-300", 6), ("six-circles", 1), ("six-auvs-3d", 1), ("two-circles", 1)] {
        let lives = lives(&library_scenario(name), step);
        let hulls: Vec<Hull> = lives.iter().map(Life::hull).collect();
        survey(name, &lives, &hulls, &[4, 6, 8, 16, 32]);
    }
}

#[test]
fn a_swarm_knows_nearly_all_that_it_could() {
    let mut scenario = library_scenario("swarm-300");
    // Long enough for some hundred pings each.
    scenario.duration_ns = 15_000_000_000;
    let lives = lives(&scenario, 25);
    let hulls: Vec<Hull> = lives.iter().map(Life::hull).collect();
    survey("swarm-300, 15 s", &lives, &hulls, &[6]);
    let online: Vec<State> = lives.iter().map(|life| life.tube(life.settings())).collect();
    let beside = Beside::hulls(&online, &hulls);
    assert!(beside.position < 1.5 && beside.clock < 1.5, "{} {}", beside.position, beside.clock);
    // Neither is it because nothing could be learnt.
    let deaf: Vec<State> = lives.iter().map(|life| life.deaf().tube(life.settings())).collect();
    assert!(Beside::hulls(&deaf, &hulls).position > 1.2);
    let rings = Beside::all(&online, &tubes(&lives, 0));
    assert!(rings.position < 0.97 && rings.clock <= 1.0, "{}", rings.position);
}

#[test]
fn one_ping_contracts_all_that_it_could() {
    let mut scenario = library_scenario("two-circles");
    let heard =
        |sensed: &Sensed| sensed.events.iter().any(|event| matches!(event.sense, Sense::Heard { .. }));
    for seed in [scenario.seed, 1, 2, 3] {
        scenario.seed = seed;
        let mut lives = lives(&scenario, 1);
        let mut listener = lives.pop().unwrap();
        let ping = listener.sensed.iter().position(heard).unwrap();
        listener.sensed.truncate(ping + 1);
        let (hull, online) = (listener.hull(), listener.tube(listener.settings()));
        let reception = online.offset_s.width() / hull.inner.offset_s.width();
        let position = width_m(&online) / width_m(&hull.inner);
        println!(
            "seed {seed}: reception time {reception:.3}, position {position:.3} of a fine set inversion"
        );
        assert!(reception < 1.2 && position < 1.2, "seed {seed}: {reception} {position}");
        assert!(online.offset_s.width() < 0.5 * listener.deaf().tube(listener.settings()).offset_s.width());
    }
}
