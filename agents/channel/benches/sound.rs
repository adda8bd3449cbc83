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
use shoal_bus::lockstep::{Answers, Batch};
use shoal_bus::message::{
    Acted, AuvId, Born, Bounds, MediumAccess, PlannedPing, Report, Sensed, Setpoint, Slice,
};
use shoal_bus::ping::{Frame, Ping};
use shoal_bus::time::{LocalTime, SimTime};
use shoal_bus::traffic::Fate;
use shoal_channel::budget::Link;
use shoal_channel::channel::Channel;
use shoal_scenario::model::{Level, Scenario};

/// Numbers of AUVs, and for how many seconds each swarm is measured.
const SWARMS: [(u32, i64); 3] = [(100, 20), (1_000, 6), (10_000, 2)];
/// Until every AUV has woken and pinged, and first pings have arrived.
const WARM_UP_S: i64 = 3;
const NEIGHBOURS: f64 = 20.0;
const REACH_M: f64 = 250.0;
/// As in `swarm-300`.
const DEPTH_M: f64 = 1_000.0;
/// What shrinks the reach of the modem below to `REACH_M`.
const SOURCE_LEVEL_DB: f64 = 122.2;
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
            let Cost { ping_ns, whole_ns, neighbours } = cost(&scenario(level, auvs), measured_s, runs);
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
            channel.accept(Answers { acted, losses: Vec::new() });
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

/// Answers without thinking.
struct Mind {
    reaction_ns: i64,
    period_ns: i64,
    frame: Frame,
    report: Report,
    /// The next ping that is not booked yet, and the time to the one after; `None` for one that never pings.
    next_ping: Option<(LocalTime, i64)>,
}

impl Mind {
    fn new(born: &Born, pings: bool) -> Self {
        let MediumAccess::Periodic { first, period_ns } = born.orders.access else {
            panic!("it pings by its clock")
        };
        let everywhere_m = [Bounds::new(-1e5, 1e5); 3];
        let whenever_s = Bounds::new(-1e3, 1e3);
        let ping = Ping {
            sender: AuvId(born.auv.0),
            sequence: 0,
            emission_s: whenever_s,
            position_m: everywhere_m,
            velocity_m_s: [Bounds::new(-10.0, 10.0); 3],
        };
        Self {
            reaction_ns: born.wake.reaction_ns,
            period_ns: born.wake.period_ns,
            frame: ping.encode().expect("it fits"),
            report: Report {
                position_m: everywhere_m,
                clock_offset_s: whenever_s,
                slice: Slice { position_m: everywhere_m, clock_offset_s: whenever_s },
                emptied: None,
                neighbours: 0,
                contractions: 0,
                rejected: 0,
                around: Vec::new(),
                components: 1,
                gaussian: None,
            },
            next_ping: pings.then_some((first, period_ns)),
        }
    }

    fn answer(&mut self, sensed: &Batch<Sensed>) -> Batch<Acted> {
        let items = sensed.items.iter().map(|sensed| self.act(sensed)).collect();
        Batch { auv: sensed.auv, items }
    }

    fn act(&mut self, sensed: &Sensed) -> Acted {
        let from = sensed.stamp + self.reaction_ns;
        let to = from + self.period_ns;
        let mut pings = Vec::new();
        if let Some((at, period_ns)) = &mut self.next_ping {
            while *at < to {
                if *at >= from {
                    pings.push(PlannedPing { at: *at, listen_ns: 0, frame: self.frame });
                }
                *at = *at + *period_ns;
            }
        }
        let setpoint = Setpoint { velocity_m_s: [1.0, 0.0, 0.0] };
        Acted { tick: sensed.tick, setpoint, pings, report: self.report.clone() }
    }
}

fn scenario(level: &str, auvs: u32) -> Scenario {
    let side_m = side_m(auvs);
    let (environment, modem) = match level {
        "sea" => (SEA.to_owned(), format!(r#"{MODEM}, source_level_db = {SOURCE_LEVEL_DB}"#)),
        _ => ("sound_speed_m_s = 1500".to_owned(), format!("range_m = {REACH_M}")),
    };
    let text = format!(
        r#"
            name = "cost"
            duration_s = 1000
            window_ms = 199
            [environment]
            level = "{level}"
            area_m = [[0, {side_m}], [0, {side_m}], [-{DEPTH_M}, 0]]
            {environment}
            [[group]]
            name = "swarm"
            count = {auvs}
            kind = "lauv"
            clock = "tcxo"
            control_period_s = 1
            reaction_s = 0.2
            modem = {{ ping_period_s = 1, {modem} }}
            controller = {{ name = "hold" }}
            start = {{ region_m = [[0, {side_m}], [0, {side_m}], [-{DEPTH_M}, 0]], box_width_m = [5, 20] }}
        "#
    );
    let scenario = shoal_scenario::parse("cost", &text).unwrap_or_else(|error| panic!("{error:?}"));
    if let (Level::Sea(sea), Some(modem)) = (&scenario.environment.level, scenario.groups[0].modem.physical) {
        let reach_m = Link::new(sea, &modem, &modem).reach_m;
        assert!((reach_m - REACH_M).abs() < 5.0, "{reach_m} m");
    }
    scenario
}

const SEA: &str = r#"
    [environment.sea]
    sound_speed = { depths_m = [0, 15, 25, 50, 100, 200, 500, 1000], speeds_m_s = [1527, 1527, 1514, 1498, 1494, 1492, 1488, 1495] }
    wind_m_s = 5
    bottom = "sand"
    bounces_max = 2
    fading = "rician"
"#;

/// So high that absorption ends its reach.
const MODEM: &str = r#"
    centre_hz = 200e3, bandwidth_hz = 40e3, bit_rate_bit_s = 20e3, preamble_s = 0.005, modulation = "bpsk",
    coding_gain_db = 3, detection_threshold_db = 6
"#;

/// Horizontal sides of the water in which an AUV has `NEIGHBOURS` others within `REACH_M` on average.
fn side_m(auvs: u32) -> f64 {
    // A difference of two places drawn evenly from `extent_m` has the density 2 (1 - x / extent) / extent.
    const STEPS: u32 = 50;
    let differences = |extent_m: f64| {
        let step_m = extent_m.min(REACH_M) / f64::from(STEPS);
        (0..STEPS).map(move |step| {
            let apart_m = (f64::from(step) + 0.5) * step_m;
            (apart_m * apart_m, 2.0 * (1.0 - apart_m / extent_m) / extent_m * step_m)
        })
    };
    let neighbours = |side_m: f64| {
        let mut share = 0.0;
        for (x_m2, of_x) in differences(side_m) {
            for (y_m2, of_y) in differences(side_m) {
                let in_reach =
                    differences(DEPTH_M).filter(|&(z_m2, _)| x_m2 + y_m2 + z_m2 <= REACH_M * REACH_M);
                share += of_x * of_y * in_reach.map(|(_, of_z)| of_z).sum::<f64>();
            }
        }
        share * f64::from(auvs - 1)
    };
    let (mut dense_m, mut sparse_m) = (0.0, 1e6);
    while sparse_m - dense_m > 1.0 {
        let middle_m = 0.5 * (dense_m + sparse_m);
        if neighbours(middle_m) > NEIGHBOURS { dense_m = middle_m } else { sparse_m = middle_m }
    }
    dense_m
}
