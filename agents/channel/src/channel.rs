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
use crate::deadlines::{Deadlines, remembered_from};
use crate::digest::Digest;
use crate::flock::{Flock, Flying};
use crate::grid::Grid;
use crate::medium::Medium;
use crate::parallel::{PIECE, shares_of};
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
/// channel.accept(sensed, Answers::default());
/// assert!(channel.chronicle()?.len() >= 2 * (8 + 8));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Channel {
    scenario: Scenario,
    vehicles: Vec<Vehicle>,
    medium: Medium,
    grid: Grid,
    /// Where all vehicles were when the window began.
    places_m: Vec<Vec3>,
    /// Memory of what was told, to be written anew.
    batches: Vec<Batch<Sensed>>,
    fastest_m_s: f64,
    lookahead_ns: i64,
    /// One for each piece of the swarm.
    shares: Vec<Share>,
    now: SimTime,
    accepted: SimTime,
    happened: Vec<Entry>,
    chronicled: Vec<Entry>,
    order: CanonicalOrder,
    flock: Flock,
    is_flock_watched: bool,
    /// Moments of the window just advanced, and of those accepted, that are not looked at yet.
    moments: [Vec<Moment>; 2],
    tally: Tally,
    digest: Digest,
    /// Only where AUVs run freely.
    deadlines: Option<Deadlines>,
    /// The past before this is forgotten.
    remembered: SimTime,
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
    /// Numbers of wavefronts that left for someone and will never be noticed there.
    beyond: Vec<u64>,
    /// Where each was when the window ended.
    places_m: Vec<Vec3>,
    /// Where each was at the moments to be noted down.
    moments_m: Vec<Vec3>,
    batches: Vec<Batch<Sensed>>,
    /// True times of what is in the batches.
    sensed_at: Vec<SimTime>,
    spare: Spare,
    sensed: Vec<Batch<Sensed>>,
    answers: Vec<Batch<Acted>>,
    sightings: Vec<Sighting>,
    losses: Vec<Loss>,
}

/// Memory to be written anew: fresh one would cost more than what is written into it.
#[derive(Default)]
struct Spare {
    items: Vec<Vec<Sensed>>,
    events: Vec<Vec<Event>>,
    #[expect(clippy::vec_box, reason = "entries hold them in boxes, and it is the boxes that are spared")]
    acted: Vec<Box<Acted>>,
}

/// Where all vehicles were at one moment, and how those that live moved, where that is told.
struct Moment {
    at: SimTime,
    positions_m: Vec<Vec3>,
    flying: Option<Flying>,
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
            tally: Tally::new(scenario),
            medium: Medium::new(scenario, &water, &vehicles),
            grid: Grid::default(),
            places_m: vehicles.iter().map(|vehicle| vehicle.body.position_at(SimTime::ZERO)).collect(),
            batches: Vec::new(),
            lookahead_ns: vehicles.iter().map(Vehicle::lookahead_ns).min().unwrap_or(i64::MAX),
            shares: (0..shares_of(vehicles.len())).map(|_| Share::default()).collect(),
            fastest_m_s: vehicles.iter().map(|vehicle| vehicle.ground_speed_m_s).fold(0.0, f64::max),
            vehicles,
            now: SimTime::ZERO,
            accepted: SimTime::ZERO,
            happened: Vec::new(),
            chronicled: Vec::new(),
            order: CanonicalOrder::default(),
            flock: Flock::default(),
            is_flock_watched: false,
            moments: Default::default(),
            digest: Digest::default(),
            deadlines: None,
            remembered: SimTime::ZERO,
        })
    }

    /// What each AUV is told at birth, sorted by AUV.
    pub fn born(&self) -> Vec<Born> {
        self.vehicles.iter().map(|vehicle| vehicle.born.clone()).collect()
    }

    /// From now on the chronicle tells once a simulated second how the swarm moves and holds together. Nothing else changes, not the
    /// digest either.
    pub fn watch_flock(&mut self) {
        self.is_flock_watched = true;
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
        self.remembered = match &self.deadlines {
            Some(_) => remembered_from(&self.vehicles, self.now),
            None => self.now,
        };
        self.depart(to);
        let batches = self.live(to);
        self.now = to;
        Ok(batches)
    }

    /// Takes back what [`advance`](Channel::advance) gave, for the chronicle, and takes the answers and checks them. What happened in
    /// the window waits for [`chronicle`](Channel::chronicle).
    pub fn accept(&mut self, sensed: Vec<Batch<Sensed>>, answers: Answers) {
        self.take_back(sensed);
        self.take_answers(answers.acted);
        for loss in answers.losses {
            self.lose(loss);
        }
        self.accepted = self.now;
        // Buffers go round: fresh ones would cost more than what is written into them.
        self.happened.clear();
        std::mem::swap(&mut self.happened, &mut self.tally.counts.entries);
        let [advanced, accepted] = &mut self.moments;
        accepted.append(advanced);
    }

    /// As [`accept`](Channel::accept), for AUVs that run freely: answers may be to earlier windows, or come later. `by` is the true
    /// time that the wall clock stands for; a tick whose answer is not in by its reaction time counts as a miss. What was
    /// decided too late takes effect now, pings whose time has passed are lost as `late`, and reports are checked against the
    /// truth of their ticks.
    pub fn accept_late(&mut self, sensed: Vec<Batch<Sensed>>, answers: Answers, by: SimTime) {
        self.deadlines.get_or_insert_default().judge(&mut self.vehicles, by.max(self.now));
        self.accept(sensed, answers);
    }

    /// What happened in the window last accepted, in canonical order. It enters the digest here, and separations are looked at,
    /// apart from [`accept`](Channel::accept), so that this can be done while the AUVs are at work on the next window.
    pub fn chronicle(&mut self) -> Result<&[Entry], ChannelError> {
        for Entry { auv, what, .. } in self.chronicled.drain(..) {
            let Some(share) = self.shares.get_mut(auv.0 as usize / PIECE) else { continue };
            match what {
                What::Sensed(Sensed { mut events, .. }) => {
                    events.clear();
                    share.spare.events.push(events);
                }
                What::Acted(acted) => share.spare.acted.push(acted),
                _ => {}
            }
        }
        std::mem::swap(&mut self.chronicled, &mut self.happened);
        self.look_at_moments();
        self.order.sort(&mut self.chronicled);
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
        let flock = self.flock.figures(&flying(&self.vehicles, self.now));
        let told = |vehicle: &Vehicle| ToldPings { heard: vehicle.pings_heard, windows: vehicle.windows() };
        let told: Vec<_> = self.vehicles.iter().map(told).collect();
        let in_flight = self.medium.in_flight();
        let summary =
            self.tally.summary(&self.scenario, self.now, self.digest.text(), flock, in_flight, &told);
        let free_run = self.deadlines.as_ref().map(|deadlines| deadlines.summary(&self.vehicles));
        Summary { reproducible: summary.reproducible && free_run.is_none(), free_run, ..summary }
    }

    fn look_at_moments(&mut self) {
        let moments = &mut self.moments[1];
        if moments.is_empty() {
            return;
        }
        let length_m: Vec<f64> = self.vehicles.iter().map(|vehicle| vehicle.length_m).collect();
        for Moment { at, positions_m, flying } in moments.drain(..) {
            self.flock.sample(&positions_m, &length_m);
            if let Some(flying) = flying {
                let what = What::Flock(self.flock.figures_lately(&flying));
                self.chronicled.push(Entry { at, auv: AuvId(0), what });
            }
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

/// The AUVs that live.
fn flying(vehicles: &[Vehicle], at: SimTime) -> Flying {
    let alive = vehicles.iter().filter(|vehicle| vehicle.alive);
    alive
        .map(|vehicle| {
            let pose = vehicle.body.at(at);
            (pose.position_m, pose.ground_velocity_m_s, vehicle.born.modem.range_m)
        })
        .collect()
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
