//! A made-up run: smooth motion, noisy measurements, pings.

use crate::chronicle::{Coordinate, Enclosure, Entry, Truth, Violation, What};
use crate::message::{
    Acted, Around, AuvId, Bounds, Culprit, Emptied, Event, Gaussian, Measured, PlannedPing, Report, Sense,
    Sensed, Setpoint, Slice,
};
use crate::ping::Frame;
use crate::record::{RecordHeader, RecordWriter, RecordedAuv};
use crate::summary::{
    Agents, Containment, EstimatorLine, Flock, Memory, Pings, SUMMARY_FORMAT, Summary, Widths,
};
use crate::time::{LocalTime, NS_PER_S, SimTime};
use crate::traffic::{Boundary, Fate, LossReason, Reception, SoundPath, Traffic};

const TICK_NS: i64 = NS_PER_S / 10;
const NEIGHBOURS: u32 = 30;

pub fn header(auvs: u32) -> RecordHeader {
    let auv =
        |index| RecordedAuv { name: format!("a-{index}"), group: 0, group_name: "a".into(), length_m: 1.6 };
    RecordHeader {
        scenario_name: "made-up".into(),
        seed: 11,
        scenario_text: "name = \"made-up\"\n".into(),
        auvs: (0..auvs).map(auv).collect(),
    }
}

pub fn summary(auvs: u32) -> Summary {
    summary_with(auvs, 0.02)
}

pub fn summary_with(auvs: u32, end_max: f64) -> Summary {
    Summary {
        format: SUMMARY_FORMAT.into(),
        scenario: "made-up".into(),
        seed: 11,
        bus: Some("local".into()),
        reproducible: true,
        auvs,
        processes: Some(auvs + 1),
        sim_s: 3.0,
        wall_s: Some(0.1),
        startup_s: Some(0.01),
        real_time_factor: Some(30.0),
        wakes: 210,
        digest: "blake3:00ff".into(),
        estimators: vec![EstimatorLine { estimator: "tube".into(), ..EstimatorLine::default() }],
        containment: Containment { checks: 42, violations: 2, ..Containment::default() },
        position_width_m: Widths::default(),
        clock_width_s: Widths { end_max, ..Widths::default() },
        off_station_m: Some(Widths::default()),
        pings: Pings::default(),
        flock: Flock::default(),
        agents: Agents::default(),
        memory: Some(Memory::default()),
        timings: None,
        free_run: None,
    }
}

/// The record of `entries`, given in windows of `window_ns`.
pub fn write(auvs: u32, entries: &[Entry], window_ns: i64) -> Vec<u8> {
    let mut writer = RecordWriter::create(Vec::new(), &header(auvs)).unwrap();
    let (mut rest, mut border) = (entries, SimTime::ZERO);
    while !rest.is_empty() {
        border = border + window_ns;
        let (window, later) = rest.split_at(rest.partition_point(|entry| entry.at < border));
        writer.append(window).unwrap();
        writer.advance(border).unwrap();
        rest = later;
    }
    writer.finish(&summary(auvs)).unwrap()
}

/// All entries of `seconds` of a run, sorted.
pub fn run(auvs: u32, seconds: i64) -> Vec<Entry> {
    let mut entries: Vec<Entry> = (0..seconds).flat_map(|second| one_second(auvs, second)).collect();
    let end = SimTime::from_ns(seconds * NS_PER_S);
    let mut last = |auv, what| entries.push(Entry { at: end, auv: AuvId(auv), what });
    if auvs > 4 {
        let violation =
            |enclosure, margin| What::Violation(Violation { enclosure, coordinate: Coordinate::X, margin });
        last(2, violation(Enclosure::Report, 0.25));
        last(3, violation(Enclosure::Slice, f64::INFINITY));
        last(4, What::Ended("its process was killed by signal 9".into()));
    }
    entries
}

/// The entries of one second, sorted.
pub fn one_second(auvs: u32, second: i64) -> Vec<Entry> {
    let mut noise = Noise(0x9e37_79b9_7f4a_7c15 ^ (second as u64) << 32);
    let begin = second * NS_PER_S;
    let mut entries = Vec::new();
    for auv in 0..auvs {
        let phase = i64::from(auv) * TICK_NS / i64::from(auvs);
        for tick in 0..10 {
            let at = SimTime::from_ns(begin + phase + tick * TICK_NS);
            tick_of(AuvId(auv), at, (second * 10 + tick) as u64, &mut noise, &mut entries);
        }
        pings_of(AuvId(auv), auvs, begin, second as u32, &mut noise, &mut entries);
    }
    let flock = Flock { polarization: 0.25, components: 3, largest_component: 5, ..Flock::default() };
    entries.push(Entry { at: SimTime::from_ns(begin), auv: AuvId(0), what: What::Flock(flock) });
    // Stable, so simultaneous events of one AUV and kind keep their order.
    entries.sort_by_key(|entry| (entry.at, entry.auv, entry.what.rank()));
    entries
}

fn tick_of(auv: AuvId, at: SimTime, tick: u64, noise: &mut Noise, entries: &mut Vec<Entry>) {
    let stamp = LocalTime::from_ns(at.ns() + at.ns() / 30_000 + 17_000_000);
    let angle = at.as_s() * 0.02 + f64::from(auv.0);
    let (sin, cos) = pxfm::f_sincos(angle);
    let radius_m = 100.0 + f64::from(auv.0);
    let position_m = [radius_m * cos, radius_m * sin, -20.0 + sin];
    let velocity_m_s = [-1.5 * sin, 1.5 * cos, 0.02 * cos];
    let truth =
        Truth { tick, local: stamp, position_m, velocity_m_s, heading_rad: angle, pitch_rad: 0.013 * cos };

    let mut measured = |value, error| Measured { value: value + error * noise.draw(), error };
    let inertial = Sense::Inertial {
        heading_rad: measured(angle, 0.01),
        pitch_rad: measured(0.013 * cos, 0.01),
        speed_m_s: measured(1.5, 0.02),
    };
    let depth = Sense::Depth { depth_m: measured(20.0 - sin, 0.1) };
    let mut events = vec![Event { stamp, sense: inertial }, Event { stamp, sense: depth }];
    for _ in 0..NEIGHBOURS / 10 {
        let heard = LocalTime::from_ns(stamp.ns() - (noise.draw().abs() * 9e7) as i64);
        events.push(Event { stamp: heard, sense: Sense::Heard { frame: noise.frame() } });
    }
    let mut sides = |half: f64| {
        position_m.map(|middle| {
            Bounds::new(middle - half * (1.0 + noise.draw()), middle + half * (1.0 + noise.draw()))
        })
    };
    let (position_m, slice_m) = (sides(2.0), sides(2.2));
    let clock_offset_s = Bounds::new(-0.017 + 1e-3 * noise.draw(), -0.015 + 1e-3 * noise.draw());
    let pings = match tick % 10 {
        0 => vec![PlannedPing { at: stamp + TICK_NS, listen_ns: 0, frame: noise.frame() }],
        _ => Vec::new(),
    };
    let acted = Acted {
        tick,
        setpoint: Setpoint { velocity_m_s: [noise.draw(), noise.draw(), 0.1 * noise.draw()] },
        pings,
        report: Report {
            position_m,
            clock_offset_s,
            slice: Slice { position_m: slice_m, clock_offset_s },
            emptied: (tick == 5 && auv.0 == 1).then_some(Emptied { stamp, by: Culprit::Ping(AuvId(0)) }),
            neighbours: 12,
            contractions: 3,
            rejected: 1,
            components: 2,
            around: vec![Around {
                auv: AuvId(1),
                position_m: [Bounds::new(-3.0, 4.0), Bounds::new(5.0, 6.5)],
            }],
            gaussian: tick.is_multiple_of(2).then_some(Gaussian { mean: [0.5; 4], covariance: [0.25; 10] }),
        },
    };
    let mut push = |what| entries.push(Entry { at, auv, what });
    push(What::Truth(truth));
    push(What::Sensed(Sensed { tick, stamp, events }));
    push(What::Acted(Box::new(acted)));
}

fn pings_of(from: AuvId, auvs: u32, begin: i64, sequence: u32, noise: &mut Noise, entries: &mut Vec<Entry>) {
    let mut push = |auv, offset_ns: i64, fate| {
        let at = SimTime::from_ns(begin + offset_ns);
        entries.push(Entry { at, auv, what: What::Traffic(Traffic { at, from, sequence, fate }) });
    };
    let position_m = [noise.draw() * 500.0, noise.draw() * 500.0, -20.0];
    let emitted = Fate::Emitted {
        position_m,
        bytes: 31,
        box_width_m: 4.0 + noise.draw(),
        beyond_range: 3,
        packet_s: 0.2,
    };
    push(from, i64::from(from.0) % 100 * 1_000, emitted);
    let box_width_m = 4.0 + noise.draw();
    for step in 1..=NEIGHBOURS.min(auvs - 1) {
        let to = AuvId((from.0 + step) % auvs);
        let range_m = 300.0 * noise.draw().abs() + 5.0;
        let travel_s = range_m / 1_500.0;
        let reception = (step % 2 == 0).then_some(Reception {
            path: SoundPath::Bounced { first: Boundary::Bottom, bounces: 2 },
            level_db: 100.0 + noise.draw(),
            sinr_db: 12.0,
            doppler: 1.0 + 1e-3 * noise.draw(),
        });
        let outlier = step % 4 == 0;
        let heard = Fate::Heard { to, range_m, travel_s, box_width_m, reception, outlier };
        push(to, (travel_s * 1e9) as i64 + 100_000, heard);
        if step % 5 == 0 {
            push(
                to,
                (travel_s * 2e9) as i64 + 100_000,
                Fate::Lost {
                    to: Some(to),
                    reason: LossReason::Collision,
                    range_m,
                    reception,
                    colliding: vec![AuvId(1), AuvId(2)],
                },
            );
        }
    }
}

struct Noise(u64);

impl Noise {
    /// Uniform in [-1, 1).
    fn draw(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn frame(&mut self) -> Frame {
        Frame::new(&std::array::from_fn::<u8, 32, _>(|_| (self.draw() * 128.0) as i8 as u8)).unwrap()
    }
}
