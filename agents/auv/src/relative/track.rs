//! One neighbour, followed.

use std::collections::VecDeque;

use shoal_interval::contractor::{Contractor, from_fn};
use shoal_interval::paving::{InclusionTest, Options, Paving, PavingError, csivia};
use shoal_interval::{IntervalBox, Membership};

use super::Sighting;

/// A pass over all sightings that takes less than this part of every side is the last one.
const STOPPING_RATIO: f64 = 0.02;

/// Encloses where one neighbour is, seen from the body: a box east and north, in metres.
///
/// ```
/// use shoal_auv::relative::{Sighting, Track};
/// use shoal_interval::{Interval, IntervalBox};
///
/// // Heard up to 500 m; eight sightings are remembered.
/// let mut track = Track::new(IntervalBox::from([Interval::spanning(-500.0, 500.0); 2]), 8);
/// // A range alone is a ring, seen twice from 80 m apart two moons, far from each other in one box.
/// assert!(track.see(Sighting::new(Interval::centred(100.0, 1.0), Interval::ENTIRE)));
/// track.carry(&IntervalBox::from([Interval::spanning(-80.0, -80.0), Interval::ZERO]));
/// assert!(track.see(Sighting::new(Interval::centred(100.0, 1.0), Interval::ENTIRE)));
/// let moons = track.paving(2.0)?;
/// assert_eq!(moons.parts(), 2);
/// let both_m = moons.hull();
/// assert!(both_m[0].width() < 12.0 && both_m[1].width() > 180.0);
/// # Ok::<(), shoal_interval::paving::PavingError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Track {
    reach_m: IntervalBox<2>,
    remembered: usize,
    sightings: VecDeque<Sighting>,
    position_m: IntervalBox<2>,
}

impl Track {
    /// A neighbour that is somewhere in `reach_m` whenever it is seen, of whom so many sightings are remembered, one at least.
    ///
    /// With one, only the last measurement counts, and nothing of the path is carried on.
    pub fn new(reach_m: IntervalBox<2>, remembered: usize) -> Self {
        let remembered = remembered.max(1);
        Self { reach_m, remembered, sightings: VecDeque::with_capacity(remembered), position_m: reach_m }
    }

    /// The neighbour moved by `moved_m` more than the body, in metres east and north.
    pub fn carry(&mut self, moved_m: &IntervalBox<2>) {
        self.position_m += *moved_m;
        for sighting in &mut self.sightings {
            sighting.carry(moved_m);
        }
    }

    /// Takes in a sighting. False when nothing satisfies it together with the remembered ones: then they are forgotten, and it
    /// counts alone.
    pub fn see(&mut self, sighting: Sighting) -> bool {
        let alone_m = sighting.contract(self.reach_m);
        if self.remembered == 1 {
            self.sightings.clear();
        }
        while self.sightings.len() >= self.remembered {
            self.sightings.pop_front();
        }
        self.sightings.push_back(sighting);
        let before_m = if self.remembered == 1 { self.reach_m } else { self.position_m };
        let position_m = self.contracted(before_m & alone_m);
        let agrees = !position_m.is_empty();
        if !agrees {
            self.sightings.clear();
            self.sightings.push_back(sighting);
        }
        self.position_m = if agrees { position_m } else { alone_m };
        agrees
    }

    /// Where the neighbour is, seen from the body, in metres east and north.
    pub fn position_m(&self) -> IntervalBox<2> {
        self.position_m
    }

    /// How many sightings bear on it.
    pub fn sightings(&self) -> usize {
        self.sightings.len()
    }

    /// The same as a sub-paving, which tells apart what a box cannot: several places, a ring, a sector (seed 002, figures 5.7 to 5.9).
    ///
    /// # Errors
    /// [`PavingError`] when the precision is not positive, or nothing bounds the position.
    pub fn paving(&self, precision_m: f64) -> Result<Paving<2>, PavingError> {
        let contractor = from_fn(|domain| self.once(domain));
        csivia(&contractor, &Unknown, self.position_m, &Options::new(precision_m))
    }

    /// As [`paving`](Self::paving), but of no more than `boxes` boxes, and only their hull, which replaces the box.
    pub fn refine(&mut self, precision_m: f64, boxes: usize) {
        let contractor = from_fn(|domain| self.once(domain));
        let options = Options::new(precision_m).with_budget(boxes);
        let Ok(paving) = csivia(&contractor, &Unknown, self.position_m, &options) else { return };
        let hull_m = paving.hull();
        // Nothing left means sightings that do not agree; the box stays, and the next sighting tells.
        if !hull_m.is_empty() {
            self.position_m = hull_m;
        }
    }

    /// All sightings once, the last one first.
    fn once(&self, domain: IntervalBox<2>) -> IntervalBox<2> {
        self.sightings.iter().rev().fold(domain, |domain, sighting| sighting.contract(domain))
    }

    fn contracted(&self, domain: IntervalBox<2>) -> IntervalBox<2> {
        from_fn(|domain| self.once(domain)).fixpoint(STOPPING_RATIO).contract(domain)
    }
}

/// Of no box it is known that all of it is true.
struct Unknown;

impl InclusionTest<2> for Unknown {
    fn test(&self, domain: &IntervalBox<2>) -> Membership {
        if domain.is_empty() { Membership::Outside } else { Membership::Undecided }
    }
}
