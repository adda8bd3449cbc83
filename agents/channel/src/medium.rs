//! Sound at either level, behind one face.

use std::sync::Arc;

use shoal_bus::message::AuvId;
use shoal_bus::time::SimTime;
use shoal_scenario::model::{Fault, Level, Scenario};

use crate::grid::Grid;
use crate::ideal::Ideal;
use crate::sea::Sea;
use crate::sound::{Told, Wavefront};
use crate::vehicle::Vehicle;
use crate::water::Water;

/// What carries pings from emitters to receivers.
pub enum Medium {
    /// A sphere with a sharp edge.
    Ideal(Ideal),
    /// As in water.
    Sea(Box<Sea>),
}

impl Medium {
    /// The medium of a run; `vehicles` are all of its AUVs, newborn.
    pub fn new(scenario: &Scenario, water: &Water, vehicles: &[Vehicle]) -> Self {
        let greatest = |of: fn(&Vehicle) -> f64| vehicles.iter().map(of).fold(0.0, f64::max);
        match (&scenario.environment.level, &water.column) {
            (Level::Sea(sea), Some(column)) => Self::Sea(Box::new(Sea::new(scenario, sea, column, vehicles))),
            _ => Self::Ideal(Ideal::new(
                water.sound_speed_m_s,
                greatest(|vehicle| vehicle.born.modem.range_m),
                greatest(|vehicle| vehicle.ground_speed_m_s),
                scenario.faults.iter().map(|&Fault::Kidnap { auv, .. }| AuvId(auv)).collect(),
            )),
        }
    }

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

    /// Whether the modem of `auv` has heard nothing between `since` and `now`, up to which all motion is settled and all earlier
    /// emissions are known.
    pub fn is_quiet(&mut self, auv: AuvId, since: SimTime, now: SimTime, vehicles: &mut [Vehicle]) -> bool {
        match self {
            Self::Ideal(_) => true,
            Self::Sea(sea) => sea.is_quiet(auv, since, now, vehicles),
        }
    }

    /// Sends a wavefront to all who may hear it; returns how many surely do not.
    ///
    /// `grid` holds all vehicles where they were at a moment since which none moved farther than `moved_m`.
    pub fn emit(
        &mut self,
        wavefront: &Arc<Wavefront>,
        vehicles: &mut [Vehicle],
        grid: &Grid,
        moved_m: f64,
    ) -> u32 {
        match self {
            Self::Ideal(ideal) => ideal.emit(wavefront, vehicles, grid, moved_m),
            Self::Sea(sea) => sea.emit(wavefront, vehicles, grid, moved_m),
        }
    }

    /// Adds all that is settled before `to` to `told`, in no particular order.
    pub fn arrive(&mut self, to: SimTime, vehicles: &mut [Vehicle], told: &mut Vec<Told>) {
        match self {
            Self::Ideal(ideal) => ideal.arrive(to, vehicles, told),
            Self::Sea(sea) => sea.arrive(to, vehicles, told),
        }
    }

    /// Wavefronts on their way, counted once for each receiver.
    pub fn in_flight(&self) -> u64 {
        match self {
            Self::Ideal(ideal) => ideal.in_flight(),
            Self::Sea(sea) => sea.in_flight(),
        }
    }
}
