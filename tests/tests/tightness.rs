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
        if born.auv.0 % step == 0 {
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

#[test]
#[ignore = "a measurement"]
fn survey() {
    for (name, step, thin) in [("swarm-300", 12, 1), ("six-circles", 1, 1), ("six-auvs-3d", 1, 1), ("two-circles", 1, 1)] {
        let _ = thin;
        let lives = lives(&library_scenario(name), step);
        let heard = |life: &Life| {
            life.sensed.iter().flat_map(|s| &s.events).filter(|e| matches!(e.sense, Sense::Heard { .. })).count()
        };
        println!("{name}: {} lives, heard {:?}", lives.len(), median(lives.iter().map(|l| heard(l) as f64).collect()));
        let now = std::time::Instant::now();
        let hulls: Vec<Hull> = lives.iter().map(Life::hull).collect();
        println!(
            "  hull outer {:.4} inner {:.4} m; offset {:.3e} {:.3e}   ({:?})",
            median(hulls.iter().map(|h| width_m(&h.outer)).collect()),
            median(hulls.iter().map(|h| width_m(&h.inner)).collect()),
            median(hulls.iter().map(|h| h.outer.offset_s.width()).collect()),
            median(hulls.iter().map(|h| h.inner.offset_s.width()).collect()),
            now.elapsed()
        );
        let show = |what: &str, states: Vec<State>| {
            let ratio = |state: &State, hull: &State| width_m(state) / width_m(hull);
            let outer = median(states.iter().zip(&hulls).map(|(s, h)| ratio(s, &h.outer)).collect());
            let inner = median(states.iter().zip(&hulls).map(|(s, h)| ratio(s, &h.inner)).collect());
            let clock = median(states.iter().zip(&hulls).map(|(s, h)| s.offset_s.width() / h.outer.offset_s.width()).collect());
            println!(
                "  {what}: {:.4} m, {:.3e} s; / outer {outer:.3}, / inner {inner:.3}, clock {clock:.3}",
                median(states.iter().map(width_m).collect()),
                median(states.iter().map(|s| s.offset_s.width()).collect())
            );
        };
        show("deaf", lives.iter().map(|l| l.deaf().tube(TubeSettings { rings: 0, ..l.settings() })).collect());
        for rings in [0, 4, 6, 8, 10, 12, 16, 32] {
            for stopping_ratio in [0.05] {
                let now = std::time::Instant::now();
                let states = lives.iter().map(|l| l.tube(TubeSettings { rings, stopping_ratio, ..l.settings() })).collect();
                let ms = now.elapsed().as_millis();
                show(&format!("rings {rings} {stopping_ratio} {ms} ms"), states);
            }
        }
    }
}
