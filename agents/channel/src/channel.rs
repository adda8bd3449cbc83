//! The channel: the whole truth of a run, advanced window by window.

use std::sync::Arc;

use nalgebra::Vector3;
use shoal_bus::chronicle::{Enclosure, Entry, Truth, Violation, What};
use shoal_bus::codec::CodecError;
use shoal_bus::lockstep::{Answers, Batch, Loss};
use shoal_bus::message::{Acted, AuvId, Born, Sensed, box_width};
use shoal_bus::ping::{Frame, Ping};
use shoal_bus::summary::Summary;
use shoal_bus::time::SimTime;
use shoal_bus::traffic::{Fate, LossReason, Traffic};
use shoal_scenario::model::{Scenario, WaterSabotage};
use thiserror::Error;

use crate::birth;
use crate::body::{Body, Vec3};
use crate::check::{self, Check};
use crate::digest::Digest;
use crate::flock::Flock;
use crate::sound::{Flight, Wavefront, reach_m};
use crate::tally::Tally;
use crate::vehicle::Vehicle;
use crate::water::Water;

/// Why a run cannot go on.
#[derive(Debug, Error)]
pub enum ChannelError {
    /// The window is longer than the lookahead.
    #[error("a window of {window_ns} ns is longer than the reaction times allow: at most {lookahead_ns} ns")]
    Window {
        /// What was asked for.
        window_ns: i64,
        /// What the fastest AUV allows.
        lookahead_ns: i64,
    },
    /// A message could not be hashed.
    #[error(transparent)]
    Codec(#[from] CodecError),
}

/// The water with all its AUVs.
///
/// A run repeats [`advance`](Channel::advance), which gives what the AUVs sense in a window, [`accept`](Channel::accept),
/// which takes what they answer, and [`chronicle`](Channel::chronicle), which tells what happened, at the latest before the
/// next `accept`.
///
/// ```
/// use shoal_bus::lockstep::Answers;
/// use shoal_bus::time::SimTime;
/// use shoal_channel::channel::Channel;
///
/// let (source_name, text) = shoal_scenario::load("two-circles")?;
/// let mut channel = Channel::new(&shoal_scenario::parse(&source_name, &text)?);
/// let sensed = channel.advance(SimTime::from_ns(9_000_000))?;
/// // Both AUVs woke a thousand times a second of their own clocks.
/// assert_eq!(sensed.len(), 2);
/// assert!((8..=10).contains(&sensed[0].items.len()));
/// // Nobody answered: both bodies go on as they were.
/// channel.accept(Answers::default());
/// assert!(channel.chronicle()?.len() >= 2 * sensed[0].items.len());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Channel {
    scenario: Scenario,
    water: Water,
    vehicles: Vec<Vehicle>,
    flights: Vec<Flight>,
    now: SimTime,
    accepted: SimTime,
    happened: Vec<Entry>,
    chronicled: Vec<Entry>,
    flock: Flock,
    tally: Tally,
    digest: Digest,
}

impl Channel {
    /// The water of `scenario` at true time zero.
    pub fn new(scenario: &Scenario) -> Self {
        let water = Water::new(scenario);
        let mut vehicles = Vec::with_capacity(scenario.auv_count() as usize);
        for (group_index, group) in scenario.groups.iter().enumerate() {
            for index in 0..group.count {
                let auv = AuvId(vehicles.len() as u32);
                let newborn = birth::newborn(scenario, &water, auv, group_index as u16, index);
                let speed_m_s = Body::ground_speed_bound_m_s(&group.kind, &water.current);
                let (length_m, error_s) = (group.kind.length_m, group.modem.timestamp_error_s);
                vehicles.push(Vehicle::new(newborn, speed_m_s, length_m, error_s));
            }
        }
        if let Some(WaterSabotage::ShiftedTruth { auv, at_ns }) = scenario.sabotage
            && let Some(vehicle) = vehicles.get_mut(auv as usize)
        {
            vehicle.body.shift_truth(SimTime::from_ns(at_ns));
        }
        Self {
            scenario: scenario.clone(),
            water,
            tally: Tally::new(vehicles.len()),
            vehicles,
            flights: Vec::new(),
            now: SimTime::ZERO,
            accepted: SimTime::ZERO,
            happened: Vec::new(),
            chronicled: Vec::new(),
            flock: Flock::default(),
            digest: Digest::default(),
        }
    }

    /// What each AUV is told at birth, sorted by AUV.
    pub fn born(&self) -> Vec<Born> {
        self.vehicles.iter().map(|vehicle| vehicle.born.clone()).collect()
    }

    /// All AUVs in the order of their first ticks, so that neighbours in the order tend to be due together.
    pub fn wake_order(&self) -> Vec<AuvId> {
        let mut order: Vec<&Vehicle> = self.vehicles.iter().collect();
        order.sort_by_key(|vehicle| (vehicle.next_tick_at(), vehicle.born.auv));
        order.iter().map(|vehicle| vehicle.born.auv).collect()
    }

    /// The longest window in nanoseconds: no decision made within one may act within it.
    pub fn lookahead_ns(&self) -> i64 {
        let of = |vehicle: &Vehicle| {
            let usable_ns = (vehicle.born.wake.reaction_ns - crate::clock::STAMP_NS) as f64;
            (usable_ns / (1.0 + vehicle.born.clock.drift)).floor() as i64
        };
        self.vehicles.iter().map(of).min().unwrap_or(i64::MAX)
    }

    /// True time up to which the run has advanced.
    pub fn now(&self) -> SimTime {
        self.now
    }

    /// True time up to which answers were accepted.
    pub fn accepted(&self) -> SimTime {
        self.accepted
    }

    /// True time at which the run ends.
    pub fn end(&self) -> SimTime {
        SimTime::from_ns(self.scenario.duration_ns)
    }

    /// Advances to `to` and returns what every AUV with a tick before it senses, sorted by AUV.
    pub fn advance(&mut self, to: SimTime) -> Result<Vec<Batch<Sensed>>, ChannelError> {
        let (window_ns, lookahead_ns) = (to - self.now, self.lookahead_ns());
        if window_ns > lookahead_ns {
            return Err(ChannelError::Window { window_ns, lookahead_ns });
        }
        for vehicle in &mut self.vehicles {
            vehicle.forget_before(self.now);
            vehicle.body.integrate(to);
        }
        self.emit(to);
        self.arrive(to);
        let batches = self.tick(to);
        self.watch_separation(to);
        self.now = to;
        Ok(batches)
    }

    /// Takes the answers to the window just advanced and checks them. What happened in it waits for
    /// [`chronicle`](Channel::chronicle).
    pub fn accept(&mut self, answers: Answers) {
        for batch in answers.acted {
            for acted in batch.items {
                if let Err(reason) = self.answer(batch.auv, acted) {
                    self.lose(Loss { auv: batch.auv, reason });
                    break;
                }
            }
        }
        for loss in answers.losses {
            self.lose(loss);
        }
        self.accepted = self.now;
        self.happened = std::mem::take(&mut self.tally.window);
    }

    /// What happened in the window last accepted, in canonical order. It enters the digest here, apart from
    /// [`accept`](Channel::accept), so that this can be done while the AUVs are at work on the next window.
    pub fn chronicle(&mut self) -> Result<&[Entry], ChannelError> {
        self.chronicled.clear();
        self.chronicled.append(&mut self.happened);
        self.chronicled.sort_by_key(canonical_order);
        self.digest.update(&self.chronicled)?;
        Ok(&self.chronicled)
    }

    /// Takes AUVs that ended before the run began.
    pub fn stillborn(&mut self, losses: Vec<Loss>) {
        for loss in losses {
            self.lose(loss);
        }
    }

    /// Whether the AUV's process still lives, as far as the channel knows.
    pub fn is_alive(&self, auv: AuvId) -> bool {
        self.vehicles.get(auv.0 as usize).is_some_and(|vehicle| vehicle.alive)
    }

    /// What the run amounts to, as far as it is chronicled.
    pub fn summary(&self) -> Summary {
        let poses: Vec<_> = self.vehicles.iter().map(|vehicle| vehicle.body.at(self.now)).collect();
        let positions_m: Vec<Vec3> = poses.iter().map(|pose| pose.position_m).collect();
        let velocities_m_s: Vec<Vec3> = poses.iter().map(|pose| pose.ground_velocity_m_s).collect();
        let range_m: Vec<f64> = self.vehicles.iter().map(|vehicle| vehicle.born.modem.range_m).collect();
        let flock = self.flock.figures(&positions_m, &velocities_m_s, &range_m);
        self.tally.summary(&self.scenario, self.now, self.digest.text(), flock, self.flights.len() as u64)
    }

    /// All pings that leave before `to`.
    fn emit(&mut self, to: SimTime) {
        let mut leaving: Vec<(SimTime, AuvId, Frame)> = Vec::new();
        for vehicle in &mut self.vehicles {
            while let Some((at, frame)) = vehicle.next_emission(to) {
                leaving.push((at, vehicle.born.auv, frame));
            }
        }
        leaving.sort_by_key(|&(at, auv, _)| (at, auv));
        // Positions at the window's start tell cheaply who is surely out of range.
        let start = self.now;
        let near: Vec<Vec3> = match leaving.is_empty() {
            true => Vec::new(),
            false => self.vehicles.iter().map(|vehicle| vehicle.body.at(start).position_m).collect(),
        };
        for (at, from, frame) in leaving {
            self.emit_one(at, from, frame, &near);
        }
    }

    fn emit_one(&mut self, at: SimTime, from: AuvId, frame: Frame, near: &[Vec3]) {
        let since_start_s = (at - self.now) as f64 * 1e-9;
        let sound_speed_m_s = self.water.sound_speed_m_s;
        let emitter = &mut self.vehicles[from.0 as usize];
        let sequence = emitter.emitted;
        emitter.emitted += 1;
        let pose = emitter.body.at(at);
        let range_m = emitter.born.modem.range_m;
        let (violation, box_width_m) =
            check_ping(from, at, &frame, &pose.position_m, &pose.ground_velocity_m_s);
        let wavefront = Arc::new(Wavefront {
            from,
            sequence,
            emitted: at,
            origin_m: pose.position_m,
            frame,
            box_width_m,
            range_m,
        });
        let mut beyond_range = 0;
        for (receiver, near_m) in self.vehicles.iter().zip(near) {
            let to = receiver.born.auv;
            if to == from {
                continue;
            }
            let speed_m_s = receiver.ground_speed_m_s;
            let surely_within_m =
                reach_m(range_m, speed_m_s, sound_speed_m_s) + speed_m_s * since_start_s + 1e-6;
            let roughly_m2 = (near_m - wavefront.origin_m).norm_squared();
            let flight = if roughly_m2 > surely_within_m * surely_within_m {
                None
            } else {
                let distance_m = (receiver.body.at(at).position_m - wavefront.origin_m).norm();
                wavefront.towards(to, distance_m, speed_m_s, sound_speed_m_s)
            };
            match flight {
                Some(flight) => self.flights.push(flight),
                None => beyond_range += 1,
            }
        }
        let position_m = pose.position_m.into();
        let bytes = wavefront.frame.bytes().len() as u16;
        let fate = Fate::Emitted { position_m, bytes, box_width_m, beyond_range, packet_s: 0.0 };
        self.tally.traffic(from, Traffic { at, from, sequence, fate });
        self.tally.check(from, at, violation);
    }

    /// All wavefronts that reach their receivers before `to`.
    fn arrive(&mut self, to: SimTime) {
        let sound_speed_m_s = self.water.sound_speed_m_s;
        let mut arrived = Vec::new();
        let vehicles = &self.vehicles;
        self.flights.retain(|flight| {
            if flight.earliest >= to {
                return true;
            }
            let receiver = &vehicles[flight.to.0 as usize];
            match flight.arrival(&receiver.body, sound_speed_m_s, to) {
                Some(arrival) => {
                    arrived.push((arrival, flight.clone()));
                    false
                }
                None => true,
            }
        });
        arrived.sort_by_key(|(arrival, flight)| {
            (arrival.at, flight.to, flight.wavefront.from, flight.wavefront.sequence)
        });
        for (arrival, Flight { wavefront, to: receiver_id, .. }) in arrived {
            let receiver = &mut self.vehicles[receiver_id.0 as usize];
            let (to, range_m) = (receiver_id, arrival.range_m);
            let lost = |reason| Fate::lost(Some(to), reason, range_m);
            let fate = if range_m > wavefront.range_m {
                lost(LossReason::Range)
            } else if !receiver.alive {
                lost(LossReason::Dead)
            } else {
                receiver.hear(arrival.at, wavefront.from.0, &wavefront.frame);
                Fate::Heard {
                    to,
                    range_m,
                    travel_s: arrival.travel_s,
                    box_width_m: wavefront.box_width_m,
                    reception: None,
                    outlier: false,
                }
            };
            let (from, sequence) = (wavefront.from, wavefront.sequence);
            self.tally.traffic(to, Traffic { at: arrival.at, from, sequence, fate });
        }
    }

    /// All ticks before `to`.
    fn tick(&mut self, to: SimTime) -> Vec<Batch<Sensed>> {
        let mut batches = Vec::new();
        for vehicle in self.vehicles.iter_mut().filter(|vehicle| vehicle.alive) {
            let auv = vehicle.born.auv;
            let mut items = Vec::new();
            while vehicle.next_tick_at() < to {
                let (tick, sensed) = vehicle.sense();
                let truth = Truth {
                    tick: tick.index,
                    local: tick.stamp,
                    position_m: tick.pose.position_m.into(),
                    velocity_m_s: tick.pose.water_velocity_m_s.into(),
                    heading_rad: tick.pose.attitude.heading_rad,
                    pitch_rad: tick.pose.attitude.pitch_rad,
                };
                self.tally.happened(tick.at, auv, What::Truth(truth));
                self.tally.happened(tick.at, auv, What::Sensed(sensed.clone()));
                items.push(sensed);
            }
            if !items.is_empty() {
                batches.push(Batch { auv, items });
            }
        }
        batches
    }

    fn watch_separation(&mut self, to: SimTime) {
        for at in Flock::samples(self.now, to) {
            let positions_m: Vec<Vec3> =
                self.vehicles.iter().map(|vehicle| vehicle.body.at(at).position_m).collect();
            let length_m: Vec<f64> = self.vehicles.iter().map(|vehicle| vehicle.length_m).collect();
            self.flock.sample(&positions_m, &length_m);
        }
    }

    /// Takes one answer: checks its report, books its setpoint and pings. The reason is why the AUV has lost its place.
    fn answer(&mut self, auv: AuvId, acted: Acted) -> Result<(), String> {
        let Some(vehicle) = self.vehicles.get_mut(auv.0 as usize).filter(|vehicle| vehicle.alive) else {
            return Ok(());
        };
        let Some(tick) = vehicle.answer_tick() else {
            return Err("it answered a tick that it was not asked".to_owned());
        };
        vehicle.validate(&acted, &tick)?;

        let wake = vehicle.born.wake;
        let takes_effect = tick.stamp + wake.reaction_ns;
        let velocity_m_s = Vector3::from(acted.setpoint.velocity_m_s);
        vehicle.body.steer(vehicle.clock.reaches(takes_effect), velocity_m_s);
        let offset_s = (tick.at.ns() - tick.stamp.ns()) as f64 * 1e-9;
        let between_offset_s = vehicle.clock.offset_s(tick.between);
        let report = &acted.report;
        let at_tick = Check::of(Enclosure::Report)
            .position(&report.position_m, &tick.pose.position_m)
            .time(&report.clock_offset_s, offset_s)
            .violation();
        let between_ticks = Check::of(Enclosure::Slice)
            .position(&report.slice.position_m, &tick.between_position_m)
            .time(&report.slice.clock_offset_s, between_offset_s)
            .violation();
        self.tally.check(auv, tick.at, at_tick);
        self.tally.check(auv, tick.at, between_ticks);
        if report.emptied.is_some() {
            self.tally.check(auv, tick.at, Some(check::nothing(Enclosure::Emptied)));
        }
        self.tally.reported(auv, box_width(&report.position_m), report.clock_offset_s.width());
        for (index, ping) in acted.pings.iter().enumerate() {
            if ping.at < takes_effect {
                // It never left, so it has no number but its place in the answer.
                let sequence = index as u32;
                let fate = Fate::lost(None, LossReason::Late, 0.0);
                self.tally.traffic(auv, Traffic { at: tick.at, from: auv, sequence, fate });
            } else {
                vehicle.plan(ping.clone());
            }
        }
        self.tally.happened(tick.at, auv, What::Acted(acted));
        Ok(())
    }

    fn lose(&mut self, loss: Loss) {
        let Some(vehicle) = self.vehicles.get_mut(loss.auv.0 as usize).filter(|vehicle| vehicle.alive) else {
            return;
        };
        vehicle.end(self.now);
        self.tally.lost(self.now, loss.auv, &vehicle.born.name, &loss.reason);
    }
}

/// Checks a payload at its emission; also gives the width of its position box in metres.
fn check_ping(
    from: AuvId,
    at: SimTime,
    frame: &Frame,
    position_m: &Vec3,
    velocity_m_s: &Vec3,
) -> (Option<Violation>, f64) {
    match Ping::decode(frame) {
        Ok(ping) if ping.sender == from => {
            let violation = Check::of(Enclosure::Ping)
                .position(&ping.position_m, position_m)
                .velocity(&ping.velocity_m_s, velocity_m_s)
                .time(&ping.emission_s, at.as_s())
                .violation();
            (violation, box_width(&ping.position_m))
        }
        _ => (Some(check::nothing(Enclosure::Ping)), 0.0),
    }
}

/// (true time, vehicle, kind, index): entries of one vehicle, kind and moment keep the order in which they were told, but
/// for pings, which are told by emitter and number.
fn canonical_order(entry: &Entry) -> (SimTime, AuvId, u8, u32, u32) {
    let (from, sequence) = match &entry.what {
        What::Traffic(traffic) => (traffic.from.0, traffic.sequence),
        _ => (0, 0),
    };
    (entry.at, entry.auv, entry.what.rank(), from, sequence)
}
