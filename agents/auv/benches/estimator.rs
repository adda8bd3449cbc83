//! What a control step and a ping cost an AUV that remembers 60 s: ten steps a second, twenty neighbours that ping once a second
//! each. A goal stands beside the number that it is for.
//!
//! `cargo bench -p shoal-auv --bench estimator [-- FILTER]`

use std::hint::black_box;
use std::time::Instant;

use shoal_auv::estimator::Estimator as _;
use shoal_auv::tube_estimator::TubeEstimator;
use shoal_bus::message::{
    AuvId, BodyBounds, Born, Bounds, ClockBounds, Controller, Estimator, Event, Measured, MediumAccess,
    ModemBounds, Orders, Sense, Sensed, TubeSettings, Wake,
};
use shoal_bus::ping::Ping;
use shoal_bus::time::LocalTime;

const PERIOD_NS: i64 = 100_000_000;
const HORIZON_NS: i64 = 60_000_000_000;
/// As many as the horizon holds.
const STEPS: i64 = HORIZON_NS / PERIOD_NS;
const NEIGHBOURS: i64 = 20;
const SPEED_M_S: f64 = 1.5;
const SOUND_M_S: f64 = 1_500.0;
/// How the estimator may be set, and what it is called then.
const SETTINGS: [(&str, u16); 5] =
    [("forward", 0), ("rings/4", 4), ("rings/6", 6), ("rings/8", 8), ("rings/16", 16)];

fn main() {
    // Without `--bench` this is `cargo test`, which only asks whether it runs.
    let is_bench = std::env::args().any(|argument| argument == "--bench");
    let filters: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    let is_asked = |name: &str| filters.iter().all(|filter| name.contains(filter.as_str()));
    let rounds = if is_bench { 20 } else { 1 };
    for (name, rings) in SETTINGS {
        let settings = TubeSettings { rings, ..TubeSettings::forward(HORIZON_NS) };
        let ask = |what: &str, unit: &str, goal: &str, measure: &dyn Fn() -> f64| {
            let name = format!("{what}/{name}");
            if is_asked(&name) {
                report(&name, measure(), unit, goal);
            }
        };
        let step_us = || cost_us(settings, rounds, Pings::None);
        let ping_us = |late_ns: i64| cost_us(settings, rounds, Pings::OneAStep { late_ns }) - step_us();
        ask("step", "us", "< 1 us", &step_us);
        ask("ping", "us", "< 3 us", &|| ping_us(0));
        ask("late_ping", "us", "", &|| ping_us(2_000_000_000));
        ask("memory", "bytes", "", &|| aged(settings, Pings::OneAStep { late_ns: 0 }).memory_bytes() as f64);
    }
}

/// What is heard.
#[derive(Clone, Copy)]
enum Pings {
    None,
    /// Each so long after it arrived.
    OneAStep {
        late_ns: i64,
    },
}

/// The best of some rounds: microseconds of a step, once the memory is full.
fn cost_us(settings: TubeSettings, rounds: usize, pings: Pings) -> f64 {
    let mut best_us = f64::INFINITY;
    // Half a horizon: rings are carried along at every step, and none may be forgotten.
    let steps: Vec<Sensed> = (STEPS + 2..STEPS + 2 + STEPS / 2).map(|step| sensed(step, pings)).collect();
    for _ in 0..rounds {
        let mut estimator = aged(settings, Pings::OneAStep { late_ns: 0 });
        let since = Instant::now();
        for sensed in &steps {
            black_box(estimator.update(black_box(sensed)));
        }
        best_us = best_us.min(since.elapsed().as_nanos() as f64 / 1e3 / steps.len() as f64);
    }
    best_us
}

/// An estimator that remembers all that it can.
fn aged(settings: TubeSettings, pings: Pings) -> TubeEstimator {
    let mut estimator = TubeEstimator::new(&born(settings));
    for step in 0..STEPS + 2 {
        let estimate = estimator.update(&sensed(step, pings));
        assert!(estimate.emptied.is_none(), "{:?} at step {step}", estimate.emptied);
    }
    estimator
}

/// What is sensed at the end of a step by an AUV that goes straight on, its log and compass right in the middle of their bounds.
fn sensed(step: i64, pings: Pings) -> Sensed {
    let stamp = LocalTime::from_ns((step + 1) * PERIOD_NS);
    let measured = |value: f64, error: f64| Measured { value, error };
    let sense = Sense::Inertial {
        heading_rad: measured(0.0, 0.01),
        pitch_rad: measured(0.0, 0.01),
        speed_m_s: measured(SPEED_M_S, 0.02),
    };
    let mut events =
        vec![Event { stamp, sense }, Event { stamp, sense: Sense::Depth { depth_m: measured(50.0, 0.1) } }];
    if let Pings::OneAStep { late_ns } = pings
        && step * PERIOD_NS >= late_ns
    {
        events.push(heard(step % NEIGHBOURS, stamp + -late_ns + -PERIOD_NS / 3));
    }
    events.sort_by_key(|event| event.stamp);
    Sensed { tick: step as u64, stamp, events }
}

/// The ping of a neighbour that goes along, known to 10 m and a millisecond, heard at `stamp`.
fn heard(neighbour: i64, stamp: LocalTime) -> Event {
    // All around, 100 to 200 m away.
    let angle_rad = neighbour as f64 * 2.4;
    let range_m = 100.0 + 5.0 * neighbour as f64;
    let (sin, cos) = pxfm::f_sincos(angle_rad);
    let apart_m = [range_m * cos, range_m * sin, 0.0];
    let own_m = [SPEED_M_S * stamp.as_s(), 0.0, -50.0];
    let ping = Ping {
        sender: AuvId(neighbour as u32 + 1),
        sequence: 0,
        emission_s: around(stamp.as_s() - range_m / SOUND_M_S, 5e-4),
        position_m: std::array::from_fn(|axis| {
            around(own_m[axis] + apart_m[axis], if axis == 2 { 0.1 } else { 5.0 })
        }),
        velocity_m_s: [Bounds::default(); 3],
    };
    let frame = ping.encode().expect("it fits");
    Event { stamp, sense: Sense::Heard { frame } }
}

fn born(settings: TubeSettings) -> Born {
    let anywhere = [around(0.0, 5e3); 3];
    Born {
        auv: AuvId(0),
        group: 0,
        name: "bench-0".to_owned(),
        wake: Wake {
            first_tick: LocalTime::from_ns(PERIOD_NS),
            period_ns: PERIOD_NS,
            reaction_ns: PERIOD_NS,
        },
        clock: ClockBounds { drift: 5e-5, offset_s: around(0.0, 5e-4), stamp_ns: 2 },
        birth: LocalTime::ZERO,
        prior_position_m: [around(0.0, 10.0), around(0.0, 10.0), around(-50.0, 1.0)],
        body: BodyBounds {
            speed_m_s: 2.0,
            acceleration_m_s2: 0.3,
            current_m_s: [Bounds::default(); 3],
            current_change_m_s2: [0.0; 3],
            current_step_m_s: [0.0; 3],
            disturbance_m_s: [around(0.0, 0.02); 3],
        },
        modem: ModemBounds {
            range_m: 250.0,
            hearing_range_m: 250.0,
            sound_speed_m_s: around(SOUND_M_S, 1.0),
            sound_speed_is_constant: true,
            timestamp_s: 1e-5,
            frame_bytes: 64,
        },
        orders: Orders {
            estimator: Estimator::Tube(settings),
            controller: Controller::Hold,
            access: MediumAccess::Silent,
            area_m: anywhere,
            relative: None,
            sabotage: None,
        },
    }
}

fn around(middle: f64, error: f64) -> Bounds {
    Bounds::new(middle - error, middle + error)
}

fn report(name: &str, value: f64, unit: &str, goal: &str) {
    let goal = if goal.is_empty() { String::new() } else { format!(r#","goal":"{goal}""#) };
    println!(r#"{{"format":"shoal.bench/1","name":"auv/{name}","value":{value:.2},"unit":"{unit}"{goal}}}"#);
}
