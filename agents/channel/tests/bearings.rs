//! Directions from which pings arrive, told to an AUV, against where everybody truly is, at both levels.

use shoal_bus::chronicle::What;
use shoal_bus::lockstep::{Answers, Batch};
use shoal_bus::message::{
    Acted, Around, AuvId, Born, Bounds, Measured, PlannedPing, Report, Sense, Sensed, Setpoint, Slice,
};
use shoal_bus::ping::Ping;
use shoal_bus::time::SimTime;
use shoal_bus::traffic::Fate;
use shoal_channel::channel::Channel;

const ERROR_RAD: f64 = 0.01;
/// A body at 1 m/s moves and turns so little between two ticks, as seen from 100 m.
const BETWEEN_TICKS_RAD: f64 = 5e-4;
/// A ray bends by less over 100 m, and comes in from much farther below.
const BENT_RAD: f64 = 0.02;

/// One AUV that listens on its way and one that pings, each where nothing pushes it.
fn water(level: &str, modem: &str, noise: &str) -> String {
    format!(
        r#"
name = "two"
duration_s = 20
noise = "{noise}"
[environment]
area_m = [[-500, 500], [-500, 500], [-100, 0]]
level = "{level}"
[kind.calm]
like = "lauv"
disturbance_m_s = [0, 0, 0]
[clock.good]
drift_bound = 0
offset_bound_s = 0
[[group]]
name = "ears"
count = 1
kind = "calm"
clock = "good"
control_period_s = 0.01
modem = {{ like = "{modem}", ping_period_s = false, bearing_error_rad = {ERROR_RAD} }}
sensors.heading_error_rad = 0.003
start = {{ points_m = [[0, 0, -20]], heading_rad = 2, speed_m_s = 1, box_width_m = [0, 0] }}
[[group]]
name = "voice"
count = 1
kind = "calm"
clock = "good"
control_period_s = 0.01
modem = {{ like = "{modem}", ping_period_s = 3 }}
start = {{ points_m = [[60, -80, -30]], heading_rad = 0, speed_m_s = 1, box_width_m = [0, 0] }}
"#
    )
}

/// An answer that steers straight on and, at every 300th tick of the second AUV, pings.
fn answer(born: &Born, sensed: &Sensed, around: &[Around]) -> Acted {
    let none = Bounds::new(-1e9, 1e9);
    let ping = Ping {
        sender: born.auv,
        sequence: 0,
        emission_s: Bounds::new(0.0, 100.0),
        position_m: [Bounds::new(-500.0, 500.0); 3],
        velocity_m_s: [Bounds::new(-9.0, 9.0); 3],
    };
    let pings = (born.auv == AuvId(1) && sensed.tick % 300 == 50).then(|| PlannedPing {
        at: sensed.stamp + 2 * born.wake.reaction_ns,
        listen_ns: 0,
        frame: ping.encode().unwrap(),
    });
    let heading_rad: f64 = if born.auv == AuvId(0) { 2.0 } else { 0.0 };
    let (sin, cos) = pxfm::f_sincos(heading_rad);
    Acted {
        tick: sensed.tick,
        setpoint: Setpoint { velocity_m_s: [cos, sin, 0.0] },
        pings: pings.into_iter().collect(),
        report: Report {
            position_m: [none; 3],
            clock_offset_s: none,
            slice: Slice { position_m: [none; 3], clock_offset_s: none },
            emptied: None,
            neighbours: 0,
            contractions: 0,
            rejected: 0,
            around: around.to_vec(),
            components: 1,
            gaussian: None,
        },
    }
}

/// Runs it; how many bearings were told, and the largest error of an azimuth.
fn run(level: &str, modem: &str, noise: &str) -> (usize, f64) {
    let scenario = shoal_scenario::parse("two", &water(level, modem, noise)).unwrap();
    let mut channel = Channel::new(&scenario).unwrap();
    let born = channel.born();
    let mut emissions_m = Vec::new();
    let mut bearings = Vec::new();
    let mut places = Vec::new();
    while channel.now() < channel.end() {
        let to = SimTime::from_ns((channel.now().ns() + 50_000_000).min(channel.end().ns()));
        let sensed = channel.advance(to).unwrap();
        let acted = sensed
            .iter()
            .map(|batch| {
                let born = &born[batch.auv.0 as usize];
                let items = batch.items.iter().map(|sensed| answer(born, sensed, &[])).collect();
                Batch { auv: batch.auv, items }
            })
            .collect();
        channel.accept(sensed, Answers { acted, losses: Vec::new() });
        for entry in channel.chronicle().unwrap() {
            match &entry.what {
                What::Traffic(traffic) => {
                    if let Fate::Emitted { position_m, .. } = traffic.fate {
                        emissions_m.push(position_m);
                    }
                }
                What::Truth(truth) if entry.auv == AuvId(0) => {
                    places.push((truth.local, truth.position_m, truth.heading_rad));
                }
                What::Sensed(sensed) => {
                    let heard = |event: &shoal_bus::message::Event| match event.sense {
                        Sense::Bearing { sender, azimuth_rad, elevation_rad, heading_rad } => {
                            Some((event.stamp, sender, azimuth_rad, elevation_rad.unwrap(), heading_rad))
                        }
                        _ => None,
                    };
                    bearings.extend(sensed.events.iter().filter_map(heard));
                    let pings =
                        sensed.events.iter().filter(|event| matches!(event.sense, Sense::Heard { .. }));
                    let said = sensed.events.iter().filter_map(heard).count();
                    assert_eq!(pings.count(), said, "a direction with every ping");
                }
                _ => {}
            }
        }
    }
    let mut farthest_rad = 0.0_f64;
    for (index, &(stamp, sender, azimuth_rad, elevation_rad, heading_rad)) in bearings.iter().enumerate() {
        assert_eq!(sender, AuvId(1));
        let next = places.partition_point(|&(local, ..)| local < stamp).min(places.len() - 1);
        let (_, place_m, true_heading_rad) = places[next];
        let to_emitter_m: [f64; 3] = std::array::from_fn(|axis| emissions_m[index][axis] - place_m[axis]);
        let true_azimuth_rad = pxfm::f_atan2(to_emitter_m[1], to_emitter_m[0]) - true_heading_rad;
        let apart = |measured: Measured, truth_rad: f64| {
            let off_rad = measured.value - truth_rad;
            let turns = (off_rad / (2.0 * std::f64::consts::PI)).round();
            (off_rad - turns * 2.0 * std::f64::consts::PI).abs()
        };
        let off_rad = apart(azimuth_rad, true_azimuth_rad);
        assert!(off_rad <= azimuth_rad.error + BETWEEN_TICKS_RAD, "{off_rad} off, {azimuth_rad:?} stated");
        assert!(apart(heading_rad, true_heading_rad) <= heading_rad.error + BETWEEN_TICKS_RAD);
        let horizontal_m = (to_emitter_m[0] * to_emitter_m[0] + to_emitter_m[1] * to_emitter_m[1]).sqrt();
        let true_elevation_rad = pxfm::f_atan2(to_emitter_m[2], horizontal_m);
        let bent_rad = if level == "ideal" { BETWEEN_TICKS_RAD } else { BENT_RAD };
        assert!(apart(elevation_rad, true_elevation_rad) <= elevation_rad.error + bent_rad);
        farthest_rad = farthest_rad.max(off_rad);
    }
    (bearings.len(), farthest_rad)
}

#[test]
fn every_ping_heard_comes_from_where_its_emitter_was() {
    for (level, modem) in [("ideal", "ideal"), ("sea", "evologics-18-34")] {
        let (told, farthest_rad) = run(level, modem, "adversarial");
        assert!(told >= 5, "{told} bearings at level {level}");
        // At its bound, and so no other direction by chance.
        assert!((farthest_rad - ERROR_RAD).abs() < BETWEEN_TICKS_RAD, "{farthest_rad} at level {level}");
        let (told_again, smaller_rad) = run(level, modem, "uniform");
        assert!(told_again >= 5 && smaller_rad < ERROR_RAD + BETWEEN_TICKS_RAD);
    }
}

#[test]
fn a_neighbour_that_is_elsewhere_is_a_violation() {
    let scenario = shoal_scenario::parse("two", &water("ideal", "ideal", "uniform")).unwrap();
    let violations = |auv: u32, east_m: [f64; 2]| {
        let mut channel = Channel::new(&scenario).unwrap();
        let born = channel.born();
        let position_m = [Bounds::new(east_m[0], east_m[1]), Bounds::new(-90.0, -70.0)];
        let around = [Around { auv: AuvId(auv), position_m }];
        let sensed = channel.advance(SimTime::from_ns(50_000_000)).unwrap();
        let acted = sensed
            .iter()
            .filter(|batch| batch.auv == AuvId(0))
            .map(|batch| {
                let items = batch.items.iter().map(|sensed| answer(&born[0], sensed, &around)).collect();
                Batch { auv: batch.auv, items }
            })
            .collect();
        channel.accept(sensed, Answers { acted, losses: Vec::new() });
        channel.summary().containment.violations
    };
    // It starts 60 m east and 80 m south of the other.
    assert_eq!(violations(1, [50.0, 70.0]), 0);
    assert!(violations(1, [61.0, 70.0]) >= 4);
    assert!(violations(9, [50.0, 70.0]) >= 4, "nobody is AUV 9");
}
