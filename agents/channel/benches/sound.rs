//! What sound costs the channel per emitted ping: the time of a run less that of the same run without pings, over the
//! pings emitted. Minds are none: every tick is answered with the same setpoint and the pings of a period, whose boxes
//! are wide enough to be true.
//!
//! Swarms of 100, 1,000 and 10,000 AUVs fill 1,000 m of water, so densely that whoever pings has 20 others within 250 m on
//! average, edges included: a ping costs the same work whatever the swarm. Beside each cost stands how many
//! times that of 100 AUVs it is, and that of level `ideal`, in the same run: these machines are shared, and ratios travel
//! better than times. At level `sea` there are a thermocline, two bounces, Rician fading, and a modem
//! that is noticed as far, 250 m with luck; farther out its packets only disturb.
//!
//! `cargo bench -p shoal-channel --bench sound [-- ideal|sea] [-- 100|1000|10000]`

use std::time::Instant;

use shoal_bus::chronicle::{Entry, What};
use shoal_bus::lockstep::Answers;
use shoal_bus::time::SimTime;
use shoal_bus::traffic::Fate;
use shoal_channel::channel::Channel;
use shoal_scenario::model::Scenario;

use self::swarm::{Mind, scenario};

mod swarm;

/// Numbers of AUVs, and for how many seconds each swarm is measured.
const SWARMS: [(u32, i64); 3] = [(100, 20), (1_000, 6), (10_000, 2)];
/// Until every AUV has woken and pinged, and first pings have arrived.
const WARM_UP_S: i64 = 3;
const RUNS: usize = 5;

fn main() {
    // Without `--bench` this is `cargo test`, which only asks whether it runs.
    let is_bench = std::env::args().any(|argument| argument == "--bench");
    let filters: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    let swarms = if is_bench { &SWARMS[..] } else { &[(100, 1)] };
    let runs = if is_bench { RUNS } else { 1 };
    let mut smallest_ns = [None; 2];
    for &(auvs, measured_s) in swarms {
        let mut ideal_ns = None;
        for (level, smallest_ns) in ["ideal", "sea"].into_iter().zip(&mut smallest_ns) {
            let name = format!("channel/ping/{level}/{auvs}");
            if filters.iter().any(|filter| name.split('/').all(|part| part != filter)) {
                continue;
            }
            let Cost { ping_ns, whole_ns, neighbours } = cost(&scenario(level, auvs, 1.0), measured_s, runs);
            let growth = ping_ns / *smallest_ns.get_or_insert(ping_ns);
            let goal = if auvs == 10_000 { r#","growth_goal":"< 1.5""# } else { "" };
            let beside = match ideal_ns {
                Some(ideal_ns) => {
                    format!(r#","times_ideal":{:.2},"times_ideal_goal":"< 4""#, ping_ns / ideal_ns)
                }
                None => String::new(),
            };
            println!(
                r#"{{"format":"shoal.bench/1","name":"{name}","value":{ping_ns:.0},"unit":"ns/ping","whole":{whole_ns:.0},"neighbours":{neighbours:.1},"growth":{growth:.2}{goal}{beside}}}"#
            );
            if level == "ideal" {
                ideal_ns = Some(ping_ns);
            }
        }
    }
}

struct Cost {
    ping_ns: f64,
    /// All that the channel does, over the pings emitted.
    whole_ns: f64,
    /// To how many AUVs a ping's fate was told.
    neighbours: f64,
}

fn cost(scenario: &Scenario, measured_s: i64, runs: usize) -> Cost {
    let (mut loud, mut silent) = (Run::default(), Run::default());
    for _ in 0..runs {
        loud.again(scenario, true, measured_s);
        silent.again(scenario, false, measured_s);
    }
    let emitted = loud.emitted as f64;
    assert!(silent.emitted == 0 && emitted > 0.0, "one run is silent and the other is not");
    let total_ns = |run: &Run| run.windows_ns.iter().sum::<f64>();
    let whole_ns = total_ns(&loud) / emitted;
    let ping_ns = whole_ns - total_ns(&silent) / emitted;
    Cost { ping_ns, whole_ns, neighbours: loud.told as f64 / emitted }
}

/// Runs of one scenario, window by window: each has the same work in every run, so its least time tells most.
#[derive(Default)]
struct Run {
    windows_ns: Vec<f64>,
    emitted: u64,
    told: u64,
}

impl Run {
    fn again(&mut self, scenario: &Scenario, pings: bool, measured_s: i64) {
        let mut channel = Channel::new(scenario).expect("a profile");
        let mut minds: Vec<Mind> = channel.born().iter().map(|born| Mind::new(born, pings)).collect();
        let (warm_up_ns, window_ns) = (WARM_UP_S * 1_000_000_000, scenario.window_ns);
        (self.emitted, self.told) = (0, 0);
        for window in 1..=(warm_up_ns + measured_s * 1_000_000_000) / window_ns {
            let since = Instant::now();
            let sensed = channel.advance(SimTime::from_ns(window * window_ns)).expect("a short window");
            let mut spent_ns = elapsed_ns(since);
            let acted = sensed.iter().map(|batch| minds[batch.auv.0 as usize].answer(batch)).collect();
            let since = Instant::now();
            channel.accept(sensed, Answers { acted, losses: Vec::new() });
            let entries = channel.chronicle().expect("encodable");
            spent_ns += elapsed_ns(since);
            if window * window_ns >= warm_up_ns {
                self.count(entries);
                let index = (window - 1 - warm_up_ns / window_ns) as usize;
                match self.windows_ns.get_mut(index) {
                    Some(least_ns) => *least_ns = least_ns.min(spent_ns),
                    None => self.windows_ns.push(spent_ns),
                }
            }
        }
        assert_eq!(channel.summary().containment.violations, 0, "the boxes hold the truth");
    }

    fn count(&mut self, entries: &[Entry]) {
        for entry in entries {
            if let What::Traffic(traffic) = &entry.what {
                match traffic.fate {
                    Fate::Emitted { .. } => self.emitted += 1,
                    Fate::Heard { .. } | Fate::Lost { .. } => self.told += 1,
                }
            }
        }
    }
}

fn elapsed_ns(since: Instant) -> f64 {
    since.elapsed().as_nanos() as f64
}
