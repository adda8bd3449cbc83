//! Sound at level `ideal`: a sphere with a sharp edge. Whoever is in range hears at once and at any time.

use std::sync::Arc;

use shoal_bus::message::AuvId;
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
    fastest_m_s: f64,
    /// Who is carried elsewhere in this run, whom sound may meet sooner than their own motion would let it.
    kidnapped: Vec<AuvId>,
    flights: Vec<Flight>,
    due: Vec<Flight>,
}

impl Ideal {
    /// Still water, in which nobody is heard farther than `farthest_m` metres and no body is faster than `fastest_m_s`, but for those
    /// that are `kidnapped`.
    pub fn new(sound_speed_m_s: f64, farthest_m: f64, fastest_m_s: f64, kidnapped: Vec<AuvId>) -> Self {
        Self {
            sound_speed_m_s,
            farthest_m: reach_m(farthest_m, fastest_m_s, sound_speed_m_s),
            fastest_m_s,
            kidnapped,
            flights: Vec::new(),
            due: Vec::new(),
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
        let before = self.flights.len();
        for (index, place_m) in grid.near(wavefront.origin_m, self.farthest_m + moved_m) {
            let to = AuvId(index as u32);
            if to == wavefront.from {
                continue;
            }
            // Where it was is enough for most, and spares a look at the receiver.
            let farthest_m = (place_m - wavefront.origin_m).norm() + moved_m;
            if farthest_m < wavefront.range_m {
                let nearest_m = (farthest_m - 2.0 * moved_m).max(0.0);
                self.flights.push(wavefront.flight(to, nearest_m, self.fastest_m_s, sound_speed_m_s));
                continue;
            }
            let receiver = &vehicles[index];
            let distance_m = (receiver.body.position_at(wavefront.emitted) - wavefront.origin_m).norm();
            let speed_m_s = receiver.ground_speed_m_s;
            self.flights.extend(wavefront.towards(to, distance_m, speed_m_s, sound_speed_m_s));
        }
        if !self.kidnapped.is_empty() {
            for flight in &mut self.flights[before..] {
                if self.kidnapped.contains(&flight.to) {
                    flight.earliest = wavefront.emitted;
                }
            }
        }
        let within = (self.flights.len() - before) as u32;
        vehicles.len() as u32 - 1 - within
    }

    /// All wavefronts that reach their receivers before `to`, in no particular order.
    pub fn arrive(&mut self, to: SimTime, vehicles: &mut [Vehicle], told: &mut Vec<Told>) {
        let sound_speed_m_s = self.sound_speed_m_s;
        self.due.extend(self.flights.extract_if(.., |flight| flight.earliest < to));
        // One receiver after the other, as they lie in memory.
        self.due.sort_by_key(|flight| flight.to);
        let flying = self.due.extract_if(.., |flight| {
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
            let incidence = receiver.has_bearings().then(|| {
                let pose = receiver.body.at(arrival.at);
                let towards = wavefront.origin_m - pose.position_m;
                Incidence { towards, heading_rad: pose.attitude.heading_rad }
            });
            told.push(Told { at: arrival.at, to, wavefront, fate, stamp: None, incidence });
            false
        });
        self.flights.extend(flying);
        self.due.clear();
    }

    /// Wavefronts on their way.
    pub fn in_flight(&self) -> u64 {
        self.flights.len() as u64
    }
}
