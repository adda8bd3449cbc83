//! The channel: the whole truth of a run, advanced window by window.

mod rebirth;

use std::sync::Arc;

use nalgebra::Vector3;
use shoal_bus::chronicle::{Enclosure, Entry, Truth, Violation, What};
use shoal_bus::codec::CodecError;
use shoal_bus::lockstep::{Answers, Batch, Loss};
use shoal_bus::message::{Acted, Around, AuvId, Born, Estimator, Event, Sensed, box_width};
use shoal_bus::ping::{Frame, Payload};
use shoal_bus::summary::Summary;
use shoal_bus::time::SimTime;
use shoal_bus::traffic::{Fate, LossReason, Traffic};
use shoal_scenario::model::{Fault, Scenario, WaterSabotage};
use thiserror::Error;

use crate::acoustics::profile::ProfileError;
use crate::birth;
use crate::body::{Body, Vec3};
use crate::check::{self, Check};
use crate::deadlines::{Deadlines, remembered_from};
use crate::digest::Digest;
use crate::flock::Flock;
use crate::grid::Grid;
use crate::medium::Medium;
use crate::sound::{Told, Wavefront};
use crate::tally::{Excuse, Tally};
use crate::vehicle::{Planned, Tick, Vehicle};
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
    /// The scenario's speed of sound over depth is none.
    #[error(transparent)]
    Profile(#[from] ProfileError),
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
/// let mut channel = Channel::new(&shoal_scenario::parse(&source_name, &text)?)?;
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
    vehicles: Vec<Vehicle>,
    medium: Medium,
    grid: Grid,
    /// Where all vehicles were when the window began.
    places_m: Vec<Vec3>,
    told: Vec<Told>,
    fastest_m_s: f64,
    now: SimTime,
    accepted: SimTime,
    happened: Vec<Entry>,
    chronicled: Vec<Entry>,
    /// Memory of events that were chronicled, to be written anew.
    spare: Vec<Vec<Event>>,
    flock: Flock,
    tally: Tally,
    digest: Digest,
    /// Only where AUVs run freely.
    deadlines: Option<Deadlines>,
    /// The past before this is forgotten.
    remembered: SimTime,
}

impl Channel {
    /// The water of `scenario` at true time zero.
    ///
    /// # Errors
    /// [`ChannelError::Profile`] for a scenario that no file can say.
    pub fn new(scenario: &Scenario) -> Result<Self, ChannelError> {
        let water = Water::new(scenario)?;
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
        for &Fault::Kidnap { auv, at_ns, to_m } in &scenario.faults {
            if let Some(vehicle) = vehicles.get_mut(auv as usize) {
                vehicle.kidnap(SimTime::from_ns(at_ns), to_m.into());
            }
        }
        Ok(Self {
            scenario: scenario.clone(),
            tally: Tally::new(vehicles.len()),
            medium: Medium::new(scenario, &water, &vehicles),
            grid: Grid::default(),
            places_m: Vec::new(),
            told: Vec::new(),
            fastest_m_s: vehicles.iter().map(|vehicle| vehicle.ground_speed_m_s).fold(0.0, f64::max),
            vehicles,
            now: SimTime::ZERO,
            accepted: SimTime::ZERO,
            happened: Vec::new(),
            chronicled: Vec::new(),
            spare: Vec::new(),
            flock: Flock::default(),
            digest: Digest::default(),
            deadlines: None,
            remembered: SimTime::ZERO,
        })
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
        self.vehicles.iter().map(Vehicle::lookahead_ns).min().unwrap_or(i64::MAX)
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
        self.places_m.clear();
        self.remembered = match &self.deadlines {
            Some(_) => remembered_from(&self.vehicles, self.now),
            None => self.now,
        };
        for vehicle in &mut self.vehicles {
            vehicle.forget_before(self.remembered);
            vehicle.body.integrate(to);
            self.places_m.push(vehicle.body.position_at(self.now));
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
        // Buffers go round: fresh ones would cost more than what is written into them.
        self.happened.clear();
        std::mem::swap(&mut self.happened, &mut self.tally.window);
    }

    /// As [`accept`](Channel::accept), for AUVs that run freely: answers may be to earlier windows, or come later. `by` is the true
    /// time that the wall clock stands for; a tick whose answer is not in by its reaction time counts as a miss. What was
    /// decided too late takes effect now, pings whose time has passed are lost as `late`, and reports are checked against the
    /// truth of their ticks.
    pub fn accept_late(&mut self, answers: Answers, by: SimTime) {
        self.deadlines.get_or_insert_default().judge(&mut self.vehicles, by.max(self.now));
        self.accept(answers);
    }

    /// What happened in the window last accepted, in canonical order. It enters the digest here, apart from
    /// [`accept`](Channel::accept), so that this can be done while the AUVs are at work on the next window.
    pub fn chronicle(&mut self) -> Result<&[Entry], ChannelError> {
        self.spare.extend(self.chronicled.drain(..).filter_map(|entry| match entry.what {
            What::Sensed(sensed) => Some(sensed.events),
            _ => None,
        }));
        std::mem::swap(&mut self.chronicled, &mut self.happened);
        self.chronicled.sort_by_cached_key(canonical_order);
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
        let windows: Vec<_> = self.vehicles.iter().map(Vehicle::windows).collect();
        let in_flight = self.medium.in_flight();
        let summary =
            self.tally.summary(&self.scenario, self.now, self.digest.text(), flock, in_flight, &windows);
        let free_run = self.deadlines.as_ref().map(|deadlines| deadlines.summary(&self.vehicles));
        Summary { reproducible: summary.reproducible && free_run.is_none(), free_run, ..summary }
    }

    /// All pings that leave before `to`.
    fn emit(&mut self, to: SimTime) {
        let mut leaving: Vec<(SimTime, AuvId, Planned)> = Vec::new();
        for vehicle in &mut self.vehicles {
            while let Some(planned) = vehicle.next_emission(to) {
                leaving.push((planned.at, vehicle.born.auv, planned));
            }
        }
        if leaving.is_empty() {
            return;
        }
        self.grid.sort(&self.places_m, self.medium.farthest_m());
        if leaving.iter().any(|(_, _, planned)| planned.listen_ns > 0) {
            // What a modem hears decides whether it emits, so what came before has to be known.
            leaving.sort_by_key(|&(at, auv, _)| (at, auv));
        } else {
            // Otherwise only an emitter's own order counts, and neighbours in space share neighbours in memory.
            leaving.sort_by_key(|&(at, auv, _)| (self.grid.cell_of(auv.0 as usize), auv, at));
        }
        let start = self.now;
        let leapt_m = self.vehicles.iter().map(|vehicle| vehicle.body.leapt_since(start)).fold(0.0, f64::max);
        for (at, from, planned) in leaving {
            self.emit_one(at, from, planned, leapt_m);
        }
    }

    /// One ping that leaves; kidnappers carried nobody farther than `leapt_m` since `now`.
    fn emit_one(&mut self, at: SimTime, from: AuvId, planned: Planned, leapt_m: f64) {
        let group = self.vehicles[from.0 as usize].born.group;
        let packet_ns = self.medium.packet_ns(group, planned.frame.bytes().len() as u16);
        if let Some(reason) = self.held_back(at, from, &planned) {
            let sequence = self.vehicles[from.0 as usize].emitted;
            let fate = Fate::lost(None, reason, 0.0);
            self.tally.traffic(from, Traffic { at, from, sequence, fate });
            return;
        }
        let emitter = &mut self.vehicles[from.0 as usize];
        let sequence = emitter.emitted;
        emitter.emitted += 1;
        emitter.emits_until = at + packet_ns;
        let pose = emitter.body.at(at);
        let excuse = excuse(emitter, at, planned.booked);
        let Checked { is_promise, violation, box_width_m } =
            check_ping(&emitter.born, at, &planned.frame, &pose.position_m, &pose.ground_velocity_m_s);
        let wavefront = Arc::new(Wavefront {
            from,
            sequence,
            emitted: at,
            packet_ns,
            origin_m: pose.position_m,
            velocity_m_s: pose.ground_velocity_m_s,
            frame: planned.frame,
            box_width_m,
            range_m: emitter.born.modem.range_m,
            is_false: violation.is_some(),
        });
        let moved_m = self.fastest_m_s * ((at - self.now) as f64 * 1e-9) + 1e-6 + leapt_m;
        let beyond_range = self.medium.emit(&wavefront, &mut self.vehicles, &self.grid, moved_m);
        let fate = Fate::Emitted {
            position_m: pose.position_m.into(),
            bytes: wavefront.frame.bytes().len() as u16,
            box_width_m,
            beyond_range,
            packet_s: packet_ns as f64 * 1e-9,
        };
        self.tally.traffic(from, Traffic { at, from, sequence, fate });
        if is_promise {
            self.tally.check(from, at, violation, excuse);
        }
    }

    /// Why a modem does not emit what is booked for now, if it does not.
    fn held_back(&mut self, at: SimTime, from: AuvId, planned: &Planned) -> Option<LossReason> {
        if at < self.vehicles[from.0 as usize].emits_until {
            return Some(LossReason::HalfDuplex);
        }
        if planned.listen_ns == 0 {
            return None;
        }
        if self.medium.is_quiet(from, at + -planned.listen_ns, at, &mut self.vehicles) {
            return None;
        }
        self.vehicles[from.0 as usize].hold(planned.stamp, at);
        Some(LossReason::Busy)
    }

    /// All pings that are settled before `to`.
    fn arrive(&mut self, to: SimTime) {
        let mut told = std::mem::take(&mut self.told);
        self.medium.arrive(to, &mut self.vehicles, &mut told);
        // Receivers share nothing, so that each takes all that is its own at once.
        told.sort_by_cached_key(|told| (told.to, told.at, told.wavefront.from, told.wavefront.sequence));
        for Told { at, to, wavefront, mut fate, stamp, incidence } in told.drain(..) {
            let receiver = &mut self.vehicles[to.0 as usize];
            let (from, sequence) = (wavefront.from, wavefront.sequence);
            match fate {
                Fate::Heard { range_m, .. } if !receiver.alive => {
                    fate = Fate::lost(Some(to), LossReason::Dead, range_m);
                }
                Fate::Heard { range_m, .. } if receiver.was_kidnapped_between(wavefront.emitted, at) => {
                    fate = Fate::lost(Some(to), LossReason::Asleep, range_m);
                }
                Fate::Heard { ref mut outlier, .. } => {
                    let late_ns = receiver.draw_false_arrival();
                    *outlier |= late_ns.is_some();
                    let is_false = *outlier || wavefront.is_false;
                    receiver.hear(at, stamp, late_ns.unwrap_or(0), &wavefront, incidence.as_ref(), is_false);
                }
                _ => {}
            }
            self.tally.traffic(to, Traffic { at, from, sequence, fate });
        }
        self.told = told;
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
                let mut events = self.spare.pop().unwrap_or_default();
                events.clone_from(&sensed.events);
                self.tally.happened(tick.at, auv, What::Sensed(Sensed { events, ..sensed }));
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
                self.vehicles.iter().map(|vehicle| vehicle.body.position_at(at)).collect();
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
        // In lockstep no answer is late.
        let told_at = tick.at.max(self.accepted);
        vehicle.body.steer(vehicle.clock.reaches(takes_effect).max(self.now), velocity_m_s);
        let offset_s = (tick.at.ns() - tick.stamp.ns()) as f64 * 1e-9;
        let report = &acted.report;
        let (promises, excuse) = (promises(&vehicle.born), excuse(vehicle, tick.at, tick.at));
        if promises {
            let at_tick = Check::of(Enclosure::Report)
                .position(&report.position_m, &tick.pose.position_m)
                .time(&report.clock_offset_s, offset_s)
                .violation();
            let between_ticks = Check::of(Enclosure::Slice)
                .position(&report.slice.position_m, &tick.between_position_m)
                .time(&report.slice.clock_offset_s, tick.between_offset_s)
                .violation();
            self.tally.check(auv, told_at, at_tick, excuse);
            self.tally.check(auv, told_at, between_ticks, excuse);
            if report.emptied.is_some() {
                self.tally.check(auv, told_at, Some(check::nothing(Enclosure::Emptied)), excuse);
                if let Some(after_ns) = vehicle.notices(tick.at) {
                    self.tally.noticed(after_ns);
                }
            }
        }
        self.tally.reported(auv, report, &tick.pose.position_m, offset_s);
        for (index, ping) in acted.pings.iter().enumerate() {
            if ping.at < takes_effect || vehicle.clock.reaches(ping.at) < self.now {
                // It never left, so it has no number but its place in the answer.
                let sequence = index as u32;
                let fate = Fate::lost(None, LossReason::Late, 0.0);
                self.tally.traffic(auv, Traffic { at: told_at, from: auv, sequence, fate });
            } else {
                vehicle.plan(ping.clone(), tick.at);
            }
        }
        let is_remembered = tick.at >= self.remembered;
        for around in report.around.iter().filter(|_| promises && is_remembered) {
            let violation = check_around(around, &tick, &self.vehicles);
            let excuse = excuse_around(auv, around, tick.at, &self.vehicles).or(excuse);
            self.tally.check(auv, told_at, violation, excuse);
        }
        self.tally.happened(told_at, auv, What::Acted(acted));
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

/// Why no promise covers what an AUV states at `at` by what it knew at its tick at `known`, if none does.
fn excuse(vehicle: &Vehicle, at: SimTime, known: SimTime) -> Option<Excuse> {
    if vehicle.is_kidnapped_at(at, known) {
        return Some(Excuse::Kidnapped);
    }
    vehicle.is_exposed_at(known).then_some(Excuse::Misled)
}

/// Whether the AUV promises that what it states holds the truth: all but Kalman filters do.
fn promises(born: &Born) -> bool {
    !matches!(born.orders.estimator, Estimator::Ekf(_))
}

/// What a payload is worth.
struct Checked {
    is_promise: bool,
    violation: Option<Violation>,
    box_width_m: f64,
}

/// Checks a payload at its emission. The Gaussian of an AUV that promises nothing is not false, whatever it says: only estimators
/// that promise nothing either take it in.
fn check_ping(emitter: &Born, at: SimTime, frame: &Frame, position_m: &Vec3, velocity_m_s: &Vec3) -> Checked {
    let (is_promise, violation, box_width_m) = match Payload::decode(frame) {
        Ok(Payload::Intervals(ping)) if ping.sender == emitter.auv => {
            let violation = Check::of(Enclosure::Ping)
                .position(&ping.position_m, position_m)
                .velocity(&ping.velocity_m_s, velocity_m_s)
                .time(&ping.emission_s, at.as_s())
                .violation();
            (true, violation, box_width(&ping.position_m))
        }
        Ok(Payload::Gaussian(ping)) if ping.sender == emitter.auv && !promises(emitter) => {
            (false, None, box_width(&ping.position_box_m()))
        }
        _ => (true, Some(check::nothing(Enclosure::Ping)), 0.0),
    };
    Checked { is_promise, violation, box_width_m }
}

/// Why no promise covers where an AUV sees a neighbour at `at`, besides what excuses all that it states: its past sightings do not know
/// that one of both was carried elsewhere.
fn excuse_around(auv: AuvId, around: &Around, at: SimTime, vehicles: &[Vehicle]) -> Option<Excuse> {
    // No number of wrong pings is assumed of neighbours.
    if vehicles.get(auv.0 as usize).is_some_and(|vehicle| vehicle.is_deceived_at(at)) {
        return Some(Excuse::Misled);
    }
    let both = [auv, around.auv].into_iter().filter_map(|auv| vehicles.get(auv.0 as usize));
    let mut kidnapped = both.filter(|vehicle| vehicle.was_kidnapped_between(SimTime::ZERO, at));
    kidnapped.next().map(|_| Excuse::Kidnapped)
}

/// Checks where an AUV sees a neighbour at its tick, which lies in the window just advanced.
fn check_around(around: &Around, tick: &Tick, vehicles: &[Vehicle]) -> Option<Violation> {
    let Some(neighbour) = vehicles.get(around.auv.0 as usize) else {
        return Some(check::nothing(Enclosure::Around));
    };
    let apart_m = neighbour.body.position_at(tick.at) - tick.pose.position_m;
    Check::of(Enclosure::Around).horizontal(&around.position_m, &apart_m).violation()
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
