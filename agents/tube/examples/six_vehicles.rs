//! Six vehicles that find themselves by pings and a few surface fixes: seed 001, section 4.3.3.
//!
//! Vehicles 1 to 3 circle just below the surface and come up once a turn for a fix; vehicles 4 to 6 circle 20 m deeper and
//! never come up. Each knows its speed, yaw and pitch with bounded errors, and that it is in the operating area. Each pings
//! every second with the box in which it knows itself to be; whoever is within range hears it a real travel time later, and
//! contracts its own tube online, forward in time. Afterwards, when the logs are read together, a pass backward in time
//! contracts both ends of each ping.
//!
//! What the seed leaves open is chosen here: the trajectories (4.45) and (4.46), the same for three vehicles, are
//! followed a third of a turn apart, at 0.1 rad/s above and 0.06 rad/s below, so that vehicles meet and part. In (4.47)
//! pitch and yaw are taken by their meaning: the printed `u2` and `u3` are called the other way round.
//!
//! Run with `cargo run --release -p shoal-tube --example six_vehicles`; the figures are those of 4.11.

use nalgebra::{Vector2, Vector3};
use pxfm::{f_cos, f_sin};
use shoal_interval::figure::{Class, Figure, figures_folder};
use shoal_interval::{Interval, IntervalBox};
use shoal_tube::contractor::{Moving, Ping, contract_ping};
use shoal_tube::figure::{DrawTube, over_time};
use shoal_tube::{Direction, TimeDomain, Tube, TubeError};
use std::error::Error;
use std::f64::consts::TAU;
use std::time::Instant;

const STEP_S: f64 = 0.1;
const STEPS: usize = 1_000;
/// A ping each second.
const STEPS_PER_PING: usize = 10;

const RADIUS_M: f64 = 100.0;
const VERTICAL_M: f64 = 10.0;
const REACH_M: f64 = 40.0;
const SOUND_SPEED_M_S: f64 = 1500.0;

const SPEED_ERROR_M_S: f64 = 0.05;
const ANGLE_ERROR_RAD: f64 = 0.01;
const SOUND_SPEED_ERROR_M_S: f64 = 2.0;
const RECEPTION_ERROR_S: f64 = 5e-4;
const FIX_ERROR_M: f64 = 2.0;
/// Above this height the antenna is out of the water.
const SURFACE_M: f64 = -0.5;

/// How a vehicle moves in truth.
#[derive(Clone, Copy)]
struct Motion {
    depth_m: f64,
    turn_rad_s: f64,
    phase_rad: f64,
}

impl Motion {
    /// Of vehicles 0 to 5, which the seed calls 1 to 6.
    fn of(vehicle: usize) -> Motion {
        let third_rad = TAU / 3.0 * (vehicle % 3) as f64;
        if vehicle < 3 {
            Motion { depth_m: 10.0, turn_rad_s: 0.1, phase_rad: third_rad }
        } else {
            Motion { depth_m: 30.0, turn_rad_s: 0.06, phase_rad: third_rad + 0.8 }
        }
    }

    fn position_m(self, time_s: f64) -> Vector3<f64> {
        let angle = self.turn_rad_s * time_s + self.phase_rad;
        let (sin, cos) = (f_sin(angle), f_cos(angle));
        Vector3::new(RADIUS_M * sin, RADIUS_M * cos, VERTICAL_M * cos - self.depth_m)
    }

    /// The positions over some times, (4.45) and (4.46).
    #[cfg(test)]
    fn positions_m(self, times_s: Interval) -> IntervalBox<3> {
        let (sin, cos) = (times_s * self.turn_rad_s + self.phase_rad).sin_cos();
        IntervalBox::from([sin * RADIUS_M, cos * RADIUS_M, cos * VERTICAL_M - self.depth_m])
    }

    /// Speed, yaw and pitch over some times: what (4.47) makes the positions of.
    fn commands(self, times_s: Interval) -> [Interval; 3] {
        let angle = times_s * self.turn_rad_s + self.phase_rad;
        let slope = angle.sin() * (VERTICAL_M / RADIUS_M);
        let speed_m_s = (slope.sqr() + 1.0).sqrt() * (RADIUS_M * self.turn_rad_s);
        [speed_m_s, -angle, slope.atan()]
    }
}

/// What a vehicle knows.
struct Vehicle {
    position_m: Tube<IntervalBox<3>>,
    velocity_m_s: Tube<IntervalBox<3>>,
    /// Borders at which it saw the sky, and what it read there.
    fixes: Vec<(usize, IntervalBox<3>)>,
}

impl Vehicle {
    fn new(time: &TimeDomain, motion: Motion, random: &mut Random) -> Vehicle {
        let velocity_m_s = Tube::from_function(time.clone(), |times_s| {
            // A sensor that is off by less than its error, and the bounds that it stands for.
            let mut read = |truth: Interval, error: f64| (truth + error * random.symmetric()).inflate(error);
            let [speed, yaw, pitch] = motion.commands(times_s);
            let commands =
                [read(speed, SPEED_ERROR_M_S), read(yaw, ANGLE_ERROR_RAD), read(pitch, ANGLE_ERROR_RAD)];
            velocity(commands)
        });
        let fixes = time
            .borders_s()
            .map(|time_s| motion.position_m(time_s))
            .enumerate()
            .filter(|(border, position_m)| border % STEPS_PER_PING == 0 && position_m.z > SURFACE_M)
            .map(|(border, position_m)| {
                let read = IntervalBox::from(std::array::from_fn(|axis| {
                    Interval::centred(position_m[axis] + FIX_ERROR_M * random.symmetric(), FIX_ERROR_M)
                }));
                (border, read)
            })
            .collect();
        Vehicle { position_m: Tube::constant(time.clone(), operating_area()), velocity_m_s, fixes }
    }

    fn contract_step(&mut self, step: usize, direction: Direction) -> Result<(), TubeError> {
        let border = if direction == Direction::Backward { step + 1 } else { step };
        if let Some((_, fix_m)) = self.fixes.iter().find(|(at, _)| *at == border) {
            self.position_m.contract_gate(border, fix_m)?;
        }
        if let Some(velocity_m_s) = self.velocity_m_s.slice(step) {
            self.position_m.contract_slice_derivative(step, velocity_m_s, direction)?;
        }
        Ok(())
    }

    /// Contracts where the vehicle was when it heard a ping, and where the emitter was, by (4.48).
    fn hear(&mut self, ping: Ping, emitter: Moving<'_, 3>) -> Result<(), TubeError> {
        let receiver = Moving { position_m: &mut self.position_m, velocity_m_s: Some(&self.velocity_m_s) };
        contract_ping(receiver, emitter, &mut ping.clone())?;
        Ok(())
    }
}

/// The state equation (4.47), pitch and yaw by their meaning: nose up is a negative pitch.
fn velocity([speed, yaw, pitch]: [Interval; 3]) -> IntervalBox<3> {
    let ((sin_yaw, cos_yaw), (sin_pitch, cos_pitch)) = (yaw.sin_cos(), pitch.sin_cos());
    let level = speed * cos_pitch;
    IntervalBox::from([level * cos_yaw, level * sin_yaw, -(speed * sin_pitch)])
}

fn operating_area() -> IntervalBox<3> {
    IntervalBox::from([
        Interval::centred(0.0, 150.0),
        Interval::centred(0.0, 150.0),
        Interval::spanning(-60.0, 0.0),
    ])
}

/// A ping that was heard.
struct Heard {
    sender: usize,
    receiver: usize,
    ping: Ping,
}

impl Heard {
    /// The slice in which it was heard, more or less.
    fn step(&self) -> usize {
        (self.ping.reception_s.mid() / STEP_S) as usize
    }

    /// What the ping said: where its sender knew itself to be.
    fn message(&self, vehicles: &[Vehicle]) -> Result<Tube<IntervalBox<3>>, TubeError> {
        let emission_s = self.ping.emission_s.mid();
        Tube::starting_at(emission_s, vehicles[self.sender].position_m.at(emission_s)?)
    }
}

/// All pings that are heard, in the order in which they are received.
fn pings(time: &TimeDomain, random: &mut Random) -> Vec<Heard> {
    let mut pings = Vec::new();
    for emission_s in time.borders_s().step_by(STEPS_PER_PING) {
        for sender in 0..6 {
            let emitter_m = Motion::of(sender).position_m(emission_s);
            for receiver in (0..6).filter(|&receiver| receiver != sender) {
                // Vehicles are slow beside sound, so this settles within a few rounds.
                let flight_s = (0..20).fold(0.0, |flight_s, _| {
                    (Motion::of(receiver).position_m(emission_s + flight_s) - emitter_m).norm()
                        / SOUND_SPEED_M_S
                });
                let read_s = emission_s + flight_s + RECEPTION_ERROR_S * random.symmetric();
                let ping = Ping {
                    emission_s: Interval::spanning(emission_s, emission_s),
                    reception_s: Interval::centred(read_s, RECEPTION_ERROR_S),
                    sound_speed_m_s: Interval::centred(SOUND_SPEED_M_S, SOUND_SPEED_ERROR_M_S),
                };
                if flight_s * SOUND_SPEED_M_S < REACH_M && ping.reception_s.is_subset_of(time.span()) {
                    pings.push(Heard { sender, receiver, ping });
                }
            }
        }
    }
    pings.sort_by(|one, other| one.ping.reception_s.mid().total_cmp(&other.ping.reception_s.mid()));
    pings
}

/// What the vehicles know at four moments, each vehicle's tube.
struct Outcome {
    /// Nothing but the operating area.
    unknown: Tube<IntervalBox<3>>,
    /// Vehicle 4, which hears pings but does not know how it moves.
    heard_only: Tube<IntervalBox<3>>,
    online: Vec<Tube<IntervalBox<3>>>,
    afterwards: Vec<Tube<IntervalBox<3>>>,
    pings: usize,
    milliseconds: f64,
}

fn solve() -> Result<Outcome, TubeError> {
    let time = TimeDomain::uniform(0.0, STEP_S, STEPS)?;
    let mut random = Random(7);
    let mut vehicles: Vec<_> =
        (0..6).map(|vehicle| Vehicle::new(&time, Motion::of(vehicle), &mut random)).collect();
    let pings = pings(&time, &mut random);
    let unknown = Tube::constant(time.clone(), operating_area());
    let mut heard_only = Vehicle {
        position_m: unknown.clone(),
        velocity_m_s: vehicles[3].velocity_m_s.clone(),
        fixes: vec![],
    };

    let since = Instant::now();
    let mut log = pings.iter().peekable();
    for step in 0..STEPS {
        for vehicle in &mut vehicles {
            vehicle.contract_step(step, Direction::Forward)?;
        }
        while let Some(heard) = log.next_if(|heard| heard.step() == step) {
            let mut message_m = heard.message(&vehicles)?;
            if heard.receiver == 3 {
                heard_only
                    .hear(heard.ping, Moving { position_m: &mut message_m.clone(), velocity_m_s: None })?;
            }
            let emitter = Moving { position_m: &mut message_m, velocity_m_s: None };
            vehicles[heard.receiver].hear(heard.ping, emitter)?;
        }
    }
    let online = vehicles.iter().map(|vehicle| vehicle.position_m.clone()).collect();

    let mut log = pings.iter().rev().peekable();
    for step in (0..STEPS).rev() {
        while let Some(heard) = log.next_if(|heard| heard.step() == step) {
            if let Ok([receiver, sender]) = vehicles.get_disjoint_mut([heard.receiver, heard.sender]) {
                receiver
                    .hear(heard.ping, Moving { position_m: &mut sender.position_m, velocity_m_s: None })?;
            }
        }
        for vehicle in &mut vehicles {
            vehicle.contract_step(step, Direction::Backward)?;
        }
    }
    let milliseconds = since.elapsed().as_secs_f64() * 1e3;
    let afterwards = vehicles.into_iter().map(|vehicle| vehicle.position_m).collect();
    Ok(Outcome {
        unknown,
        heard_only: heard_only.position_m,
        online,
        afterwards,
        pings: pings.len(),
        milliseconds,
    })
}

fn main() -> Result<(), Box<dyn Error>> {
    let outcome = solve()?;
    println!("{} pings heard; contracted in {:.1} ms (the seed: 15 ms)", outcome.pings, outcome.milliseconds);
    let kilobytes: usize = outcome.afterwards.iter().map(|tube| tube.memory_bytes() / 1000).sum();
    println!("six tubes of boxes take {kilobytes} kB (the seed: 900 kB)");
    println!("mean width of the abscissa in metres:");
    for vehicle in 0..6 {
        let [online, afterwards] =
            [&outcome.online, &outcome.afterwards].map(|tubes| mean_width(&tubes[vehicle]));
        println!("  vehicle {}: online {online:6.2}, afterwards {afterwards:6.2}", vehicle + 1);
    }
    for (file, title, tube) in [
        ("a", "Vehicle 4, nothing heard", &outcome.unknown),
        ("b", "Vehicle 4, pings alone", &outcome.heard_only),
        ("c", "Vehicle 4, online: pings and commands forward in time", &outcome.online[3]),
        ("d", "Vehicle 4, afterwards: backward in time as well", &outcome.afterwards[3]),
    ] {
        draw(title, tube)?.save(figures_folder().join(format!("001_4_11{file}_six_vehicles.svg")))?;
    }
    from_above(&outcome)?.save(figures_folder().join("001_4_10_six_vehicles.svg"))?;
    Ok(())
}

fn mean_width(tube: &Tube<IntervalBox<3>>) -> f64 {
    tube.slices().map(|slice| slice[0].width()).sum::<f64>() / tube.slice_count() as f64
}

fn draw(title: &str, tube: &Tube<IntervalBox<3>>) -> Result<Figure, Box<dyn Error>> {
    let abscissa = tube.component(0);
    let span_s = tube.domain().span();
    let mut figure =
        over_time(span_s, Interval::centred(0.0, 155.0))?.title(title).tube(&abscissa, Class::Level(0));
    // What a ping taught, where nothing carries it on to the slices beside.
    let pings = tube.domain().borders_s().zip(abscissa.gates().zip(abscissa.slices()));
    for (time_s, (gate, _)) in pings.filter(|(_, (gate, slice))| gate.width() < 0.8 * slice.width()) {
        figure = figure.segment(Vector2::new(time_s, gate.lower()), Vector2::new(time_s, gate.upper()));
    }
    Ok(figure
        .trajectory(span_s, |time_s| Motion::of(3).position_m(time_s).x)
        .legend(Class::Level(0), "tube")
        .legend(Class::Line, "gate with a ping")
        .legend(Class::Curve, "truth")
        .axes("t (s)", "x (m)"))
}

fn from_above(outcome: &Outcome) -> Result<Figure, Box<dyn Error>> {
    let area = operating_area();
    let mut figure = Figure::new(IntervalBox::from([area[0], area[1]]))?
        .title("All six from above, afterwards")
        .axes("x (m)", "y (m)");
    for (vehicle, tube) in outcome.afterwards.iter().enumerate().rev() {
        figure = figure.trace(tube, [0, 1], if vehicle < 3 { Class::Level(0) } else { Class::Level(3) });
    }
    for vehicle in 0..6 {
        let motion = Motion::of(vehicle);
        let [x, y] = [0, 1].map(|axis| motion.position_m(0.0)[axis]);
        figure = figure.point(Vector2::new(x, y), &format!("{}", vehicle + 1));
    }
    Ok(figure
        .path(Interval::spanning(0.0, 100.0), |time_s| Motion::of(0).position_m(time_s).xy())
        .legend(Class::Level(0), "vehicles 1 to 3")
        .legend(Class::Level(3), "vehicles 4 to 6")
        .legend(Class::Curve, "truth"))
}

/// The errors of sensors, the same in each run.
struct Random(u64);

impl Random {
    /// A number from -1 to 1.
    fn symmetric(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use shoal_interval::Membership;

    #[test]
    fn the_commands_make_the_trajectories() {
        for vehicle in 0..6 {
            let motion = Motion::of(vehicle);
            for time_s in [0.0, 17.0, 50.5] {
                let velocity_m_s = velocity(motion.commands(Interval::spanning(time_s, time_s)));
                let small_s = 1e-4;
                let moved_m = motion.position_m(time_s + small_s) - motion.position_m(time_s - small_s);
                assert!(velocity_m_s.inflate(1e-6).contains(&(moved_m / (2.0 * small_s))));
            }
        }
    }

    #[test]
    fn the_truth_is_never_lost_and_tubes_become_thin() {
        let outcome = solve().unwrap();
        for vehicle in 0..6 {
            let truth = |times_s: Interval| Motion::of(vehicle).positions_m(times_s);
            let (online, afterwards) = (&outcome.online[vehicle], &outcome.afterwards[vehicle]);
            assert_eq!(online.contains(truth), Membership::Inside);
            assert_eq!(afterwards.contains(truth), Membership::Inside);
            assert!(afterwards.is_subset_of(online).unwrap());
            assert_eq!(afterwards.domain(), outcome.unknown.domain());
            assert!(mean_width(online) < 150.0 && mean_width(&outcome.unknown) == 300.0);
            assert!(mean_width(afterwards) < if vehicle < 3 { 10.0 } else { 35.0 });
        }
    }
}
