//! Sound at level `ideal`: a sphere with a sharp edge. Whoever is in range hears at once and at any time.

use std::sync::Arc;

use shoal_bus::time::SimTime;
use shoal_bus::traffic::{Fate, LossReason};

use crate::bearing::Incidence;
use crate::grid::Grid;
use crate::sound::{Flight, Told, Wavefront, reach_m};
use crate::vehicle::Vehicle;

/// All wavefronts on their way through ideal water.
pub struct Ideal {
    sound_speed_m_s: f64,
    farthest_m: f64,
    flights: Vec<Flight>,
}

impl Ideal {
    /// Still water, in which nobody is heard farther than `farthest_m` metres and no body is faster than `fastest_m_s`.
    pub fn new(sound_speed_m_s: f64, farthest_m: f64, fastest_m_s: f64) -> Self {
        Self {
            sound_speed_m_s,
            farthest_m: reach_m(farthest_m, fastest_m_s, sound_speed_m_s),
            flights: Vec::new(),
        }
    }

    /// How far away a receiver of any ping may be at its emission, in metres.
    pub fn farthest_m(&self) -> f64 {
        self.farthest_m
    }

    /// Sends a wavefront to all who may hear it; returns how many surely do not.
    ///
    /// `grid` holds all vehicles where they were at some moment since which none moved farther than `moved_m`.
    pub fn emit(
        &mut self,
        wavefront: &Arc<Wavefront>,
        vehicles: &[Vehicle],
        grid: &Grid,
        moved_m: f64,
    ) -> u32 {
        let sound_speed_m_s = self.sound_speed_m_s;
        let mut within = 0;
        for index in grid.near(wavefront.origin_m, self.farthest_m + moved_m) {
            let receiver = &vehicles[index];
            if receiver.born.auv == wavefront.from {
                continue;
            }
            let distance_m = (receiver.body.position_at(wavefront.emitted) - wavefront.origin_m).norm();
            let speed_m_s = receiver.ground_speed_m_s;
            let flight = wavefront.towards(receiver.born.auv, distance_m, speed_m_s, sound_speed_m_s);
            within += u32::from(flight.is_some());
            self.flights.extend(flight);
        }
        vehicles.len() as u32 - 1 - within
    }

    /// All wavefronts that reach their receivers before `to`, in no particular order.
    pub fn arrive(&mut self, to: SimTime, vehicles: &mut [Vehicle], told: &mut Vec<Told>) {
        let sound_speed_m_s = self.sound_speed_m_s;
        self.flights.retain(|flight| {
            if flight.earliest >= to {
                return true;
            }
            let receiver = &vehicles[flight.to.0 as usize];
            let Some(arrival) = flight.arrival(&receiver.body, sound_speed_m_s, to) else { return true };
            let (to, range_m, wavefront) = (flight.to, arrival.range_m, Arc::clone(&flight.wavefront));
            let fate = if range_m > wavefront.range_m {
                Fate::lost(Some(to), LossReason::Range, range_m)
            } else {
                Fate::Heard {
                    to,
                    range_m,
                    travel_s: arrival.travel_s,
                    box_width_m: wavefront.box_width_m,
                    reception: None,
                    outlier: false,
                }
            };
            let pose = receiver.body.at(arrival.at);
            let incidence = Incidence {
                towards: wavefront.origin_m - pose.position_m,
                heading_rad: pose.attitude.heading_rad,
            };
            let incidence = Some(incidence);
            told.push(Told { at: arrival.at, to, wavefront, fate, stamp: None, incidence });
            false
        });
    }

    /// Wavefronts on their way.
    pub fn in_flight(&self) -> u64 {
        self.flights.len() as u64
    }
}
