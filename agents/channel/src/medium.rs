//! Sound at either level, behind one face.

use shoal_bus::message::AuvId;
use shoal_bus::time::SimTime;
use shoal_scenario::model::{Fault, Level as LevelModel, Scenario};

use crate::grid::Grid;
use crate::ideal::Ideal;
use crate::parallel::{share_out, shares_of};
use crate::sea::{Listener, Sea};
use crate::sound::{Flight, Told, Wavefront, Wavefronts};
use crate::vehicle::Vehicle;
use crate::water::Water;

/// What carries pings from emitters to receivers.
pub struct Medium {
    /// What sound meets.
    pub level: Level,
    /// Pings under way.
    pub wavefronts: Wavefronts,
    /// One for each AUV.
    pub receivers: Vec<Receiver>,
    /// What leaves in this window, of which so many are on their way.
    departures: Vec<Departure>,
    spread_until: usize,
    spread: Vec<Vec<Recipient>>,
}

/// Water as sound meets it; it never changes.
pub enum Level {
    /// A sphere with a sharp edge.
    Ideal(Ideal),
    /// As in water.
    Sea(Box<Sea>),
}

/// What is on its way to one AUV.
#[derive(Default)]
pub struct Receiver {
    /// Wavefronts that have not arrived (level `ideal`) or that its listener does not know yet (level `sea`).
    flights: Vec<Flight>,
    listener: Option<Box<Listener>>,
}

/// Somebody whom a wavefront may touch.
#[derive(Clone, Copy, Debug)]
pub struct Recipient {
    /// Who.
    pub to: AuvId,
    /// Its way there.
    pub flight: Flight,
}

/// A wavefront that leaves.
#[derive(Clone, Copy, Debug)]
struct Departure {
    number: u64,
    /// Nobody moved farther than this since the grid was sorted.
    moved_m: f64,
    /// How many others may ever notice it.
    within: u32,
}

impl Medium {
    /// The medium of a run; `vehicles` are all of its AUVs, newborn.
    pub fn new(scenario: &Scenario, water: &Water, vehicles: &[Vehicle]) -> Self {
        let greatest = |of: fn(&Vehicle) -> f64| vehicles.iter().map(of).fold(0.0, f64::max);
        let (level, receivers) = match (&scenario.environment.level, &water.column) {
            (LevelModel::Sea(sea), Some(column)) => {
                let listeners = Listener::all(scenario, sea, vehicles).map(Box::new).map(Some);
                let receivers = listeners.map(|listener| Receiver { flights: Vec::new(), listener });
                (Level::Sea(Box::new(Sea::new(scenario, sea, column))), receivers.collect())
            }
            _ => {
                let ideal = Ideal::new(
                    water.sound_speed_m_s,
                    greatest(|vehicle| vehicle.born.modem.range_m),
                    greatest(|vehicle| vehicle.ground_speed_m_s),
                    scenario.faults.iter().map(|&Fault::Kidnap { auv, .. }| AuvId(auv)).collect(),
                );
                (Level::Ideal(ideal), vehicles.iter().map(|_| Receiver::default()).collect())
            }
        };
        Self {
            level,
            wavefronts: Wavefronts::default(),
            receivers,
            departures: Vec::new(),
            spread_until: 0,
            spread: Vec::new(),
        }
    }

    /// Whether the modem of `auv` has heard nothing between `since` and `now`, up to which all motion is settled and all earlier
    /// emissions are known.
    pub fn is_quiet(&mut self, auv: AuvId, since: SimTime, now: SimTime, vehicles: &mut [Vehicle]) -> bool {
        let index = auv.0 as usize;
        let Receiver { flights, listener } = &mut self.receivers[index];
        match (&self.level, listener) {
            (Level::Sea(sea), Some(listener)) => {
                sea.listen(flights, listener, &mut vehicles[index], &self.wavefronts, now);
                listener.is_quiet(since, now)
            }
            _ => true,
        }
    }

    /// A wavefront leaves; since the grid was sorted, nobody moved farther than `moved_m`.
    pub fn emit(&mut self, wavefront: Wavefront, moved_m: f64) {
        if let Some(listener) = &mut self.receivers[wavefront.from.0 as usize].listener {
            listener.emit(&wavefront);
        }
        self.departures.push(Departure { number: self.wavefronts.next(), moved_m, within: 0 });
        self.wavefronts.leaves(wavefront);
    }

    /// Sends all that was emitted since the last time to all whom it may touch.
    pub fn spread(&mut self, grid: &Grid) {
        let Self { level, wavefronts, receivers, departures, spread_until, spread } = self;
        let departures = &mut departures[*spread_until..];
        *spread_until += departures.len();
        let pieces = shares_of(departures.len());
        spread.resize_with(spread.len().max(pieces), Vec::new);
        let spread = &mut spread[..pieces];
        // Whom a ping may touch does not depend on other pings.
        let mut alone = vec![(); departures.len()];
        share_out(departures, &mut alone, spread, |departures, _, recipients| {
            recipients.clear();
            for Departure { number, moved_m, within } in departures {
                let before = recipients.len();
                level.spread(*number, wavefronts.get(*number), (grid, *moved_m), recipients);
                *within = (recipients.len() - before) as u32;
            }
        });
        for Recipient { to, flight } in spread.iter().flatten() {
            receivers[to.0 as usize].flights.push(*flight);
        }
    }

    /// Tells `departed` of each wavefront that left in the window, and of how many AUVs will surely never notice it, when all have
    /// looked: `beyond` has the numbers of those that did not come to one who might have been touched.
    pub fn departed(&mut self, beyond: impl Iterator<Item = u64>, mut departed: impl FnMut(&Wavefront, u32)) {
        if let Some(&Departure { number: first, .. }) = self.departures.first() {
            // Everybody looks in the window in which a wavefront leaves.
            beyond.for_each(|number| self.departures[(number - first) as usize].within -= 1);
        }
        let others = self.receivers.len() as u32 - 1;
        for Departure { number, within, .. } in self.departures.drain(..) {
            departed(self.wavefronts.get(number), others - within);
        }
        self.spread_until = 0;
    }

    /// Wavefronts on their way, counted once for each receiver.
    pub fn in_flight(&self) -> u64 {
        self.receivers.iter().map(Receiver::in_flight).sum()
    }
}

impl Level {
    /// How far away from an emission anyone may be who is touched by it, in metres.
    pub fn farthest_m(&self) -> f64 {
        match self {
            Self::Ideal(ideal) => ideal.farthest_m(),
            Self::Sea(sea) => sea.farthest_m(),
        }
    }

    /// Length of a packet of so many bytes that an AUV of this group emits, in nanoseconds of true time.
    pub fn packet_ns(&self, group: u16, bytes: u16) -> i64 {
        match self {
            Self::Ideal(_) => 0,
            Self::Sea(sea) => sea.packet_ns(group, bytes),
        }
    }

    /// Adds all others whom a wavefront may touch to `recipients`.
    fn spread(
        &self,
        number: u64,
        wavefront: &Wavefront,
        near: (&Grid, f64),
        recipients: &mut Vec<Recipient>,
    ) {
        match self {
            Self::Ideal(ideal) => ideal.spread(number, wavefront, near, recipients),
            Self::Sea(sea) => sea.spread(number, wavefront, near, recipients),
        }
    }

    /// Adds all that is settled at one receiver before `to` to `told`, in no particular order, and to `beyond` the numbers of
    /// wavefronts that might have touched it but never will.
    pub fn hear(
        &self,
        receiver: &mut Receiver,
        vehicle: &mut Vehicle,
        wavefronts: &Wavefronts,
        to: SimTime,
        (told, beyond): (&mut Vec<Told>, &mut Vec<u64>),
    ) {
        let Receiver { flights, listener } = receiver;
        match (self, listener) {
            (Self::Ideal(ideal), _) => ideal.hear(flights, vehicle, wavefronts, to, (told, beyond)),
            (Self::Sea(sea), Some(listener)) => {
                sea.listen(flights, listener, vehicle, wavefronts, to);
                told.append(&mut listener.told);
                beyond.append(&mut listener.beyond);
            }
            (Self::Sea(_), None) => {}
        }
    }
}

impl Receiver {
    /// The number of the earliest wavefront that it waits for.
    pub fn waits_for(&self) -> Option<u64> {
        let flights = self.flights.iter().map(|flight| flight.wavefront);
        flights.chain(self.listener.iter().flat_map(|listener| listener.waits_for())).min()
    }

    fn in_flight(&self) -> u64 {
        match &self.listener {
            Some(listener) => listener.unsettled() as u64,
            None => self.flights.len() as u64,
        }
    }
}
