//! Every vehicle follows every other, in each of the ways that are compared.

use nalgebra::Vector2;
use shoal_auv::relative::{Sighting, Track};
use shoal_interval::{Interval, IntervalBox};

use crate::sweep::{Dice, Step, Vehicle, measure, unknown_step_m};

/// Pings are heard from anywhere in the area and its diagonal beyond.
const REACH_M: f64 = 600.0;
/// Sightings of the horizon.
pub const REMEMBERED: usize = 16;

/// What the whole path leaves is paved as finely as this after each ping, with so many boxes at most, and the hull is kept.
pub const PRECISION_M: f64 = 2.0;
const BOXES: usize = 32;

/// What a ping tells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Measures {
    RangeAndBearing,
    Bearing,
    Range,
}

/// One way to follow the neighbours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Way {
    pub measures: Measures,
    /// Whether neighbours tell their commands.
    pub exchanged: bool,
    /// Whether the whole path counts, or only the last ping.
    pub whole_path: bool,
}

impl Way {
    /// All twelve, in the order of the seed.
    pub fn all() -> Vec<Self> {
        let mut ways = Vec::new();
        for measures in [Measures::RangeAndBearing, Measures::Bearing, Measures::Range] {
            for exchanged in [true, false] {
                for whole_path in [false, true] {
                    ways.push(Self { measures, exchanged, whole_path });
                }
            }
        }
        ways
    }

    pub fn words(&self) -> String {
        let measures = match self.measures {
            Measures::RangeAndBearing => "range and bearing",
            Measures::Bearing => "bearing only",
            Measures::Range => "range only",
        };
        let exchanged = if self.exchanged { "commands" } else { "no commands" };
        let path = if self.whole_path { "whole path" } else { "last ping" };
        format!("{measures}, {exchanged}, {path}")
    }

    fn sighting(&self, (range_m, bearing_rad): (Interval, Interval)) -> Sighting {
        match self.measures {
            Measures::RangeAndBearing => Sighting::new(range_m, bearing_rad),
            Measures::Bearing => Sighting::new(Interval::ENTIRE, bearing_rad),
            Measures::Range => Sighting::new(range_m, Interval::ENTIRE),
        }
    }
}

/// What every vehicle knows of every other, in one way.
#[derive(Clone)]
pub struct Followers {
    pub way: Way,
    /// By observer and neighbour; the own entry stays unused.
    pub tracks: Vec<Vec<Track>>,
}

impl Followers {
    pub fn new(way: Way, vehicles: usize) -> Self {
        let reach_m = IntervalBox::from([Interval::centred(0.0, REACH_M); 2]);
        let track = Track::new(reach_m, if way.whole_path { REMEMBERED } else { 1 });
        Self { way, tracks: vec![vec![track; vehicles]; vehicles] }
    }

    /// Everybody moved on.
    pub fn carry(&mut self, steps: &[Step]) {
        for (observer, tracks) in self.tracks.iter_mut().enumerate() {
            for (neighbour, track) in tracks.iter_mut().enumerate().filter(|&(index, _)| index != observer) {
                let moved_m =
                    if self.way.exchanged { steps[neighbour].commanded_m } else { unknown_step_m() };
                track.carry(&(moved_m - steps[observer].commanded_m));
            }
        }
    }

    /// The enclosures of all pairs, each of which holds the truth.
    ///
    /// # Panics
    /// When one does not.
    pub fn checked<'a>(&'a self, vehicles: &'a [Vehicle]) -> impl Iterator<Item = IntervalBox<2>> + 'a {
        self.tracks.iter().enumerate().flat_map(move |(observer, tracks)| {
            tracks.iter().enumerate().filter(move |&(index, _)| index != observer).map(
                move |(neighbour, track)| {
                    let truth_m: Vector2<f64> = vehicles[neighbour].at_m - vehicles[observer].at_m;
                    let box_m = track.position_m();
                    assert!(box_m.contains(&truth_m), "{truth_m:?} is not in {box_m}: {}", self.way.words());
                    box_m
                },
            )
        })
    }
}

/// `emitter` pings: everybody else takes it in, in all ways alike.
pub fn ping(emitter: usize, vehicles: &[Vehicle], all: &mut [Followers], dice: &mut Dice) {
    for observer in (0..vehicles.len()).filter(|&index| index != emitter) {
        let measured = measure(&vehicles[observer], &vehicles[emitter], dice);
        for followers in &mut *all {
            let sighting = followers.way.sighting(measured);
            let track = &mut followers.tracks[observer][emitter];
            let agrees = track.see(sighting);
            assert!(agrees, "sightings contradict each other: {}", followers.way.words());
            if followers.way.whole_path {
                track.refine(PRECISION_M, BOXES);
            }
        }
    }
}
