//! What the channel costs per AUV and simulated second, whatever the swarm: from 10 to 10,000 AUVs at one density, waking once or ten
//! times a second and pinging once. Minds do not think, and are not counted.
//!
//! Beside each cost stands how many times that of 100 AUVs it is, in the same run, and its parts: `advance` (motion, sound,
//! senses) and `accept` (checks), during which AUVs wait, and `chronicle` (order and digest), which is done while they work. With the
//! feature `parallel` on as many threads as `RAYON_NUM_THREADS` says, else on one.
//!
//! `cargo bench -p shoal-channel --bench scale [--features parallel] [-- 0.1s|1s] [-- 10|100|1000|3000|10000]`

use std::time::Instant;

use shoal_bus::lockstep::Answers;
use shoal_bus::time::SimTime;
use shoal_channel::channel::Channel;
use shoal_scenario::model::Scenario;

use self::swarm::{Mind, scenario};

mod swarm;

/// Numbers of AUVs, and for how many seconds each swarm is measured.
const SWARMS: [(u32, i64); 5] = [(10, 200), (100, 40), (1_000, 6), (3_000, 3), (10_000, 2)];
const CONTROL_PERIODS: [(&str, f64); 2] = [("0.1s", 0.1), ("1s", 1.0)];
/// Until every AUV has woken and pinged, and first pings have arrived.
const WARM_UP_S: i64 = 3;
const RUNS: usize = 3;
/// What growth is measured from.
const SMALL: u32 = 100;

fn main() {
    // Without `--bench` this is `cargo test`, which only asks whether it runs.
    let is_bench = std::env::args().any(|argument| argument == "--bench");
    let filters: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    let swarms = if is_bench { &SWARMS[..] } else { &[(100, 1)] };
    let runs = if is_bench { RUNS } else { 1 };
    for (period, control_period_s) in CONTROL_PERIODS {
        let mut small_us = None;
        for &(auvs, measured_s) in swarms {
            let name = format!("channel/auv-second/{period}/{auvs}");
            if filters.iter().any(|filter| name.split('/').all(|part| part != filter)) {
                continue;
            }
            let cost = Cost::of(&scenario("ideal", auvs, control_period_s), measured_s, runs);
            let whole_us = cost.whole_us();
            if auvs == SMALL {
                small_us = Some(whole_us);
            }
            let growth = match small_us {
                Some(small_us) => format!(r#","growth":{:.2},"growth_goal":"< 2""#, whole_us / small_us),
                None => String::new(),
            };
            let Cost { advance_us, accept_us, chronicle_us } = cost;
            println!(
                r#"{{"format":"shoal.bench/1","name":"{name}","value":{whole_us:.1},"unit":"us/AUV-second","advance":{advance_us:.1},"accept":{accept_us:.1},"chronicle":{chronicle_us:.1}{growth}}}"#
            );
        }
    }
}

/// Microseconds per AUV and simulated second.
struct Cost {
    advance_us: f64,
    accept_us: f64,
    chronicle_us: f64,
}

impl Cost {
    /// Each window has the same work in every run, so its least time tells most.
    fn of(scenario: &Scenario, measured_s: i64, runs: usize) -> Self {
        let mut least_us: Vec<[f64; 3]> = Vec::new();
        for _ in 0..runs {
            for (index, spent_us) in windows(scenario, measured_s).into_iter().enumerate() {
                match least_us.get_mut(index) {
                    Some(least_us) => {
                        *least_us = std::array::from_fn(|part| least_us[part].min(spent_us[part]))
                    }
                    None => least_us.push(spent_us),
                }
            }
        }
        let measured_s = least_us.len() as f64 * scenario.window_ns as f64 * 1e-9;
        let auv_seconds = f64::from(scenario.auv_count()) * measured_s;
        let [advance_us, accept_us, chronicle_us] =
            [0, 1, 2].map(|part| least_us.iter().map(|spent_us| spent_us[part]).sum::<f64>() / auv_seconds);
        Self { advance_us, accept_us, chronicle_us }
    }

    fn whole_us(&self) -> f64 {
        self.advance_us + self.accept_us + self.chronicle_us
    }
}

/// What each window after the warm-up costs to advance, to accept and to chronicle, in microseconds.
fn windows(scenario: &Scenario, measured_s: i64) -> Vec<[f64; 3]> {
    let mut channel = Channel::new(scenario).expect("a profile");
    let mut minds: Vec<Mind> = channel.born().iter().map(|born| Mind::new(born, true)).collect();
    let (warm_up_ns, window_ns) = (WARM_UP_S * 1_000_000_000, scenario.window_ns);
    let mut spent_us = Vec::new();
    for window in 1..=(warm_up_ns + measured_s * 1_000_000_000) / window_ns {
        let (sensed, advance_us) =
            timed(|| channel.advance(SimTime::from_ns(window * window_ns)).expect("a short window"));
        let awake = sensed.len();
        let acted = sensed.iter().map(|batch| minds[batch.auv.0 as usize].answer(batch)).collect();
        let ((), accept_us) = timed(|| channel.accept(sensed, Answers { acted, losses: Vec::new() }));
        let (entries, chronicle_us) = timed(|| channel.chronicle().expect("encodable").len());
        assert!(entries >= 2 * awake, "every tick is chronicled");
        if window * window_ns >= warm_up_ns {
            spent_us.push([advance_us, accept_us, chronicle_us]);
        }
    }
    assert_eq!(channel.summary().containment.violations, 0, "the boxes hold the truth");
    spent_us
}

fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let since = Instant::now();
    let result = work();
    (result, since.elapsed().as_secs_f64() * 1e6)
}
