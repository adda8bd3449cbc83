//! The channel: the whole truth of a run, advanced window by window.

mod answers;
mod departures;
mod life;
mod order;
mod rebirth;

use shoal_bus::chronicle::{Entry, What};
use shoal_bus::codec::CodecError;
use shoal_bus::lockstep::{Answers, Batch, Loss};
use shoal_bus::message::{Acted, AuvId, Born, Estimator, Event, Sensed};
use shoal_bus::summary::Summary;
use shoal_bus::time::SimTime;
use shoal_scenario::model::{Fault, Scenario, WaterSabotage};
use thiserror::Error;

use crate::acoustics::profile::ProfileError;
use crate::birth;
use crate::body::{Body, Vec3};
use crate::digest::Digest;
use crate::flock::Flock;
use crate::grid::Grid;
use crate::medium::Medium;
use crate::parallel::{PIECE, share_out, shares_of};
use crate::sound::Told;
use crate::tally::{Counts, Excuse, Tally, ToldPings};
use crate::vehicle::{Planned, Vehicle};
use crate::water::Water;

use self::answers::Sighting;
use self::order::CanonicalOrder;

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
    fastest_m_s: f64,
    lookahead_ns: i64,
    /// One for each piece of the swarm.
    shares: Vec<Share>,
    now: SimTime,
    accepted: SimTime,
    happened: Vec<Entry>,
    chronicled: Vec<Entry>,
    order: CanonicalOrder,
    /// Where all vehicles were at moments that are not looked at yet.
    moments_m: Vec<Vec<Vec3>>,
    flock: Flock,
    tally: Tally,
    digest: Digest,
}

/// One piece of the swarm's part in a window: memory to work in, and the outcome. What is not taken from it keeps its memory.
#[derive(Default)]
struct Share {
    counts: Counts,
    leaving: Vec<(AuvId, Planned)>,
    /// How far kidnappers carried anyone in this window, in metres.
    leapt_m: f64,
    told: Vec<Told>,
    /// The earliest wavefront that anyone waits for.
    waits_for: Option<u64>,
    batches: Vec<Batch<Sensed>>,
    /// Memory of events that were chronicled, to be written anew: fresh one would cost more than what is written into it.
    spare: Vec<Vec<Event>>,
    answers: Vec<Batch<Acted>>,
    sightings: Vec<Sighting>,
    losses: Vec<Loss>,
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
            places_m: vec![Vec3::zeros(); vehicles.len()],
            lookahead_ns: vehicles.iter().map(Vehicle::lookahead_ns).min().unwrap_or(i64::MAX),
            shares: (0..shares_of(vehicles.len())).map(|_| Share::default()).collect(),
            fastest_m_s: vehicles.iter().map(|vehicle| vehicle.ground_speed_m_s).fold(0.0, f64::max),
            vehicles,
            now: SimTime::ZERO,
            accepted: SimTime::ZERO,
            happened: Vec::new(),
            chronicled: Vec::new(),
            order: CanonicalOrder::default(),
            moments_m: Vec::new(),
            flock: Flock::default(),
            digest: Digest::default(),
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
        self.lookahead_ns
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
        let (window_ns, lookahead_ns) = (to - self.now, self.lookahead_ns);
        if window_ns > lookahead_ns {
            return Err(ChannelError::Window { window_ns, lookahead_ns });
        }
        self.move_bodies(to);
        self.depart();
        let batches = self.live(to);
        self.remember_places(to);
        self.now = to;
        Ok(batches)
    }

    /// Takes the answers to the window just advanced and checks them. What happened in it waits for
    /// [`chronicle`](Channel::chronicle).
    pub fn accept(&mut self, answers: Answers) {
        self.take_answers(answers.acted);
        for loss in answers.losses {
            self.lose(loss);
        }
        self.accepted = self.now;
        // Buffers go round: fresh ones would cost more than what is written into them.
        self.happened.clear();
        std::mem::swap(&mut self.happened, &mut self.tally.counts.entries);
    }

    /// What happened in the window last accepted, in canonical order. It enters the digest here, and separations are looked at,
    /// apart from [`accept`](Channel::accept), so that this can be done while the AUVs are at work on the next window.
    pub fn chronicle(&mut self) -> Result<&[Entry], ChannelError> {
        for entry in self.chronicled.drain(..) {
            if let What::Sensed(sensed) = entry.what
                && let Some(share) = self.shares.get_mut(entry.auv.0 as usize / PIECE)
            {
                share.spare.push(sensed.events);
            }
        }
        std::mem::swap(&mut self.chronicled, &mut self.happened);
        self.order.sort(&mut self.chronicled);
        self.digest.update(&self.chronicled)?;
        self.watch_separation();
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
        let told = |vehicle: &Vehicle| ToldPings { heard: vehicle.pings_heard, windows: vehicle.windows() };
        let told: Vec<_> = self.vehicles.iter().map(told).collect();
        let in_flight = self.medium.in_flight();
        self.tally.summary(&self.scenario, self.now, self.digest.text(), flock, in_flight, &told)
    }

    /// Moves all bodies to `to`, and lets go what leaves before.
    fn move_bodies(&mut self, to: SimTime) {
        let now = self.now;
        share_out(&mut self.vehicles, &mut self.places_m, &mut self.shares, |vehicles, places_m, share| {
            share.leapt_m = 0.0;
            for (vehicle, place_m) in vehicles.iter_mut().zip(places_m) {
                vehicle.forget_before(now);
                vehicle.body.integrate(to);
                *place_m = vehicle.body.position_at(now);
                share.leapt_m = share.leapt_m.max(vehicle.body.leapt_since(now));
                while let Some(planned) = vehicle.next_emission(to) {
                    share.leaving.push((vehicle.born.auv, planned));
                }
            }
        });
    }

    /// Bodies forget where they were, so whoever looks at it later has to note it down.
    fn remember_places(&mut self, to: SimTime) {
        for at in Flock::samples(self.now, to) {
            self.moments_m.push(self.vehicles.iter().map(|vehicle| vehicle.body.position_at(at)).collect());
        }
    }

    fn watch_separation(&mut self) {
        if self.moments_m.is_empty() {
            return;
        }
        let length_m: Vec<f64> = self.vehicles.iter().map(|vehicle| vehicle.length_m).collect();
        for positions_m in self.moments_m.drain(..) {
            self.flock.sample(&positions_m, &length_m);
        }
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
