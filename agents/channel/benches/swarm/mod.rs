//! Swarms of any size and one density, and minds that do not think: what the channel costs alone.

use shoal_bus::lockstep::Batch;
use shoal_bus::message::{
    Acted, AuvId, Born, Bounds, MediumAccess, PlannedPing, Report, Sensed, Setpoint, Slice,
};
use shoal_bus::ping::{Frame, Ping};
use shoal_bus::time::LocalTime;
use shoal_channel::budget::Link;
use shoal_scenario::model::{Level, Scenario};

const NEIGHBOURS: f64 = 20.0;
const REACH_M: f64 = 250.0;
/// Ten AUVs have no more than nine neighbours, however little water there is.
const SIDE_MIN_M: f64 = 200.0;
/// As in `swarm-300`.
const DEPTH_M: f64 = 1_000.0;
/// What shrinks the reach of the modem below to `REACH_M`.
const SOURCE_LEVEL_DB: f64 = 122.2;

/// Answers every tick with the same setpoint, a box wide enough to be true, and the pings that are due.
pub struct Mind {
    reaction_ns: i64,
    period_ns: i64,
    /// How long its modem listens before each ping; one that is held back is not tried again.
    listen_ns: i64,
    frame: Frame,
    report: Report,
    /// The next ping that is not booked yet, and the time to the one after; `None` for one that never pings.
    next_ping: Option<(LocalTime, i64)>,
}

impl Mind {
    /// The mind of an AUV that pings by its clock, or not at all.
    pub fn new(born: &Born, pings: bool) -> Self {
        let (first, period_ns, listen_ns) = match born.orders.access {
            MediumAccess::Periodic { first, period_ns } => (first, period_ns, 0),
            MediumAccess::Csma { first, period_ns, listen_ns, .. } => (first, period_ns, listen_ns),
            _ => panic!("it pings by its clock"),
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
            listen_ns,
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

    /// Answers a batch.
    pub fn answer(&mut self, sensed: &Batch<Sensed>) -> Batch<Acted> {
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
                    pings.push(PlannedPing { at: *at, listen_ns: self.listen_ns, frame: self.frame });
                }
                *at = *at + *period_ns;
            }
        }
        let setpoint = Setpoint { velocity_m_s: [1.0, 0.0, 0.0] };
        Acted { tick: sensed.tick, setpoint, pings, report: self.report.clone() }
    }
}

/// So many AUVs in so much water that whoever pings, once a second, has 20 others within 250 m on average, edges included.
pub fn scenario(level: &str, auvs: u32, control_period_s: f64) -> Scenario {
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
            control_period_s = {control_period_s}
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
    dense_m.max(SIDE_MIN_M)
}
