//! Sound at level `ideal`: a sphere with a sharp edge. Whoever is in range hears at once and at any time.

use shoal_bus::message::AuvId;
use shoal_bus::time::SimTime;
use shoal_bus::traffic::{Fate, LossReason};

use crate::bearing::Incidence;
use crate::grid::Grid;
use crate::medium::Recipient;
use crate::sound::{Flight, Told, Wavefront, Wavefronts, reach_m};
use crate::vehicle::Vehicle;

/// Ideal water.
pub struct Ideal {
    sound_speed_m_s: f64,
    farthest_m: f64,
    fastest_m_s: f64,
    /// Who is carried elsewhere in this run, whom sound may meet sooner than their own motion would let it.
    kidnapped: Vec<AuvId>,
}

impl Ideal {
    /// Still water, in which nobody is heard farther than `farthest_m` metres and no body is faster than `fastest_m_s`, but for those
    /// that are `kidnapped`.
    pub fn new(sound_speed_m_s: f64, farthest_m: f64, fastest_m_s: f64, kidnapped: Vec<AuvId>) -> Self {
        let farthest_m = reach_m(farthest_m, fastest_m_s, sound_speed_m_s);
        Self { sound_speed_m_s, farthest_m, fastest_m_s, kidnapped }
    }

    /// How far away a receiver of any ping may be at its emission, in metres.
    pub fn farthest_m(&self) -> f64 {
        self.farthest_m
    }

    /// Adds all who may hear a wavefront to `recipients`: not all of them surely are in range.
    ///
    /// `grid` holds all vehicles where they were at some moment since which none moved farther than `moved_m`.
    pub fn spread(
        &self,
        number: u64,
        wavefront: &Wavefront,
        (grid, moved_m): (&Grid, f64),
        recipients: &mut Vec<Recipient>,
    ) {
        let (sound_speed_m_s, fastest_m_s) = (self.sound_speed_m_s, self.fastest_m_s);
        let reach_m = reach_m(wavefront.range_m, fastest_m_s, sound_speed_m_s);
        for (index, place_m) in grid.near(wavefront.origin_m, reach_m + moved_m) {
            let to = AuvId(index as u32);
            if to == wavefront.from {
                continue;
            }
            let distance_m = (place_m - wavefront.origin_m).norm();
            let earliest = if self.kidnapped.contains(&to) {
                wavefront.emitted
            } else {
                wavefront.earliest_at((distance_m - moved_m).max(0.0), fastest_m_s, sound_speed_m_s)
            };
            let is_sure = distance_m + moved_m < wavefront.range_m;
            recipients.push(Recipient { to, flight: Flight { wavefront: number, earliest, is_sure } });
        }
    }

    /// Takes out all flights that reach their receiver before `to`, and adds them to `told`, in no particular order. The numbers of
    /// those that left for it but will never come are added to `beyond`.
    pub fn hear(
        &self,
        flights: &mut Vec<Flight>,
        receiver: &Vehicle,
        wavefronts: &Wavefronts,
        to: SimTime,
        (told, beyond): (&mut Vec<Told>, &mut Vec<u64>),
    ) {
        flights.retain_mut(|Flight { wavefront: number, earliest, is_sure }| {
            let (number, earliest) = (*number, *earliest);
            if !*is_sure && self.is_beyond(wavefronts.get(number), receiver) {
                beyond.push(number);
                return false;
            }
            *is_sure = true;
            if earliest >= to {
                return true;
            }
            let wavefront = wavefronts.get(number);
            let arrival = wavefront.arrival(&receiver.body, earliest, self.sound_speed_m_s, to);
            let Some(arrival) = arrival else { return true };
            let (to, range_m) = (receiver.born.auv, arrival.range_m);
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
            told.push(Told { at: arrival.at, wavefront: number, fate, stamp: None, incidence });
            false
        });
    }

    /// Whether a receiver was too far away at the emission to come into range in time, whatever it does.
    fn is_beyond(&self, wavefront: &Wavefront, receiver: &Vehicle) -> bool {
        let place_m = receiver.body.position_at(wavefront.emitted);
        let distance_m = (place_m - wavefront.origin_m).norm();
        distance_m > reach_m(wavefront.range_m, receiver.ground_speed_m_s, self.sound_speed_m_s)
    }
}
