//! One sweep along a tube: states are carried from gate to gate and meet the observations on the way.

use super::observation::Observation;
use crate::contraction::together;
use crate::enclosure::Enclosure;
use crate::error::TubeError;
use crate::integration::{Carrier, Evolution, Steps, Way};
use crate::time_domain::{Place, TimeDomain};
use crate::tube::Tube;
use shoal_interval::IntervalBox;
use shoal_interval::contractor::Contracted;
use std::iter::Peekable;
use std::ops::Range;

/// A sweep goes on while it makes some side of the gates narrower than this share, as long as nothing else is said.
pub(super) const ANY_NEWS: f64 = 0.98;

/// The gates of an observation of no time: the first is after the last.
const NEVER: (usize, usize) = (usize::MAX, 0);

/// When observations can say something, by the gates of one domain.
#[derive(Debug, Clone)]
pub(super) struct Schedule {
    /// The first and the last gate around the times of each observation.
    gates: Vec<(usize, usize)>,
    /// The observations in the order in which a sweep forward has passed all of their times.
    by_last: Vec<usize>,
    /// The same for a sweep backward.
    by_first: Vec<usize>,
    /// For each gate the last gate of all observations that begin at it or before.
    told_until: Vec<usize>,
    /// For each gate the first gate of all observations that end at it or after.
    told_since: Vec<usize>,
}

impl Schedule {
    /// Fails if an observation is of times outside the domain. Observations of no time say nothing.
    pub(super) fn new<const N: usize>(
        domain: &TimeDomain,
        observations: &[Box<dyn Observation<N> + '_>],
    ) -> Result<Schedule, TubeError> {
        let mut gates = Vec::with_capacity(observations.len());
        for observation in observations {
            let times_s = observation.times_s();
            if times_s.is_empty() {
                gates.push(NEVER);
                continue;
            }
            let first = match domain.place_of(times_s.lower())? {
                Place::Gate(index) | Place::Slice(index) => index,
            };
            let last = match domain.place_of(times_s.upper())? {
                Place::Gate(index) => index,
                Place::Slice(index) => index + 1,
            };
            gates.push((first, last));
        }
        let timely = |&index: &usize| gates[index].0 <= gates[index].1;
        let mut by_last: Vec<usize> = (0..gates.len()).filter(timely).collect();
        let mut by_first = by_last.clone();
        by_last.sort_by_key(|&index| gates[index].1);
        by_first.sort_by_key(|&index| gates[index].0);

        let mut told_until: Vec<usize> = (0..domain.slice_count() + 1).collect();
        let mut told_since = told_until.clone();
        for &(first, last) in gates.iter().filter(|(first, last)| first <= last) {
            told_until[first] = told_until[first].max(last);
            told_since[last] = told_since[last].min(first);
        }
        for gate in 1..told_until.len() {
            told_until[gate] = told_until[gate].max(told_until[gate - 1]);
        }
        for gate in (1..told_since.len()).rev() {
            told_since[gate - 1] = told_since[gate - 1].min(told_since[gate]);
        }
        Ok(Schedule { gates, by_last, by_first, told_until, told_since })
    }

    /// The gate at which a sweep has passed all times of an observation.
    fn done_at(&self, observation: usize, way: Way) -> usize {
        let (first, last) = self.gates[observation];
        if way == Way::Forward { last } else { first }
    }

    /// The observations that a sweep from a gate comes to, in their order.
    fn coming(&self, from: usize, way: Way) -> Peekable<impl Iterator<Item = usize> + '_> {
        let order = if way == Way::Forward { &self.by_last } else { &self.by_first };
        let skipped = match way {
            Way::Forward => order.partition_point(|&observation| self.gates[observation].1 < from),
            Way::Backward => order.partition_point(|&observation| self.gates[observation].0 <= from),
        };
        let (before, after) = order.split_at(skipped);
        let (backward, forward) = if way == Way::Forward { (&[][..], after) } else { (before, &[][..]) };
        forward.iter().chain(backward.iter().rev()).copied().peekable()
    }

    /// How far a sweep has to go after something was narrowed at `gate`, for observations that begin there or before.
    fn told_from(&self, gate: usize, way: Way) -> usize {
        if way == Way::Forward { self.told_until[gate] } else { self.told_since[gate] }
    }

    /// The first and the last gate that an observation may change; `None` if it is of no time.
    pub(super) fn gates_of(&self, observation: usize) -> Option<(usize, usize)> {
        Some(self.gates[observation]).filter(|(first, last)| first <= last)
    }
}

/// Where a sweep goes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Route {
    /// The gate where it starts.
    pub(super) from: usize,
    /// The gate that it goes to even if it has nothing new to say.
    pub(super) at_least_to: usize,
    pub(super) way: Way,
}

/// How a sweep ended.
#[derive(Debug, Clone, Copy)]
pub(super) struct Swept {
    /// The gate that was reached.
    pub(super) gate: usize,
    /// The last gate that became narrower: there is nothing to carry back from beyond.
    pub(super) last_news: usize,
    pub(super) contracted: Contracted,
}

/// The parts of a system that a sweep needs, and which of its observations count.
pub(super) struct Sweep<'a, const N: usize, E: ?Sized> {
    pub(super) evolution: &'a E,
    pub(super) steps: Steps,
    pub(super) observations: &'a [Box<dyn Observation<N> + 'a>],
    pub(super) schedule: &'a Schedule,
    /// No sweep goes back beyond this gate.
    pub(super) first_gate: usize,
    /// Whether each observation counts.
    pub(super) counted: &'a [bool],
    /// A sweep goes on while it makes some side of the gates narrower than this share.
    pub(super) worth_going_on: f64,
}

impl<const N: usize, E: Evolution<N> + ?Sized> Sweep<'_, N, E> {
    /// Goes along the route and beyond, for as long as something is narrowed or an observation of what was narrowed is yet
    /// to come. `None` as soon as no trajectory is left; the summaries of the tube are then out of date.
    pub(super) fn run(
        &self,
        tube: &mut Tube<IntervalBox<N>>,
        route: Route,
    ) -> Result<Option<Swept>, TubeError> {
        let Route { from, at_least_to, way } = route;
        let mut carrier = Carrier::new(self.evolution, self.steps, way);
        let mut stale = Stale::default();
        let mut swept = Swept { gate: from, last_news: from, contracted: Contracted::Unchanged };
        // Whatever was narrowed before the sweep is at its start.
        let mut until =
            way.later(self.schedule.told_from(from, way), way.later(at_least_to, way.beyond(from)));
        let mut coming = self.schedule.coming(from, way);
        loop {
            let mut contracted = Contracted::Unchanged;
            let mut before = tube.gates[swept.gate];
            while let Some(observation) =
                coming.next_if(|&observation| self.schedule.done_at(observation, way) == swept.gate)
            {
                if self.counted[observation] {
                    stale.refresh(tube);
                    contracted = together(contracted, self.observations[observation].contract(tube)?);
                }
            }
            let mut news = is_narrower(&tube.gates[swept.gate], &before, self.worth_going_on);
            if !news && swept.gate == way.later(until, swept.gate) {
                swept.contracted = together(swept.contracted, contracted);
                break;
            }
            let Some((slice, gate)) = way.next(swept.gate, self.first_gate..tube.slice_count()) else {
                swept.contracted = together(swept.contracted, contracted);
                break;
            };
            if contracted != Contracted::Empty {
                before = tube.gates[gate];
                let of_slice = carrier.pass(tube, slice).contracted;
                if of_slice == Contracted::Narrowed {
                    stale.add(slice);
                }
                news |= is_narrower(&tube.gates[gate], &before, self.worth_going_on);
                contracted = together(contracted, of_slice);
            }
            if contracted == Contracted::Empty {
                return Ok(None);
            }
            if news {
                swept.last_news = gate;
                until = way.later(until, way.later(self.schedule.told_from(gate, way), way.beyond(gate)));
            }
            swept.gate = gate;
            swept.contracted = together(swept.contracted, contracted);
        }
        stale.refresh(tube);
        Ok(if tube.is_empty() { None } else { Some(swept) })
    }
}

/// Whether some side of a gate has become narrower than a share of what it was.
fn is_narrower<const N: usize>(now: &IntervalBox<N>, before: &IntervalBox<N>, share: f64) -> bool {
    now.iter().zip(before).any(|(now, before)| now.width() < share * before.width())
}

/// Slices that were narrowed since the summaries were brought up to date.
#[derive(Debug, Default)]
struct Stale(Option<Range<usize>>);

impl Stale {
    fn add(&mut self, slice: usize) {
        self.0 = Some(match self.0.take() {
            Some(range) => range.start.min(slice)..range.end.max(slice + 1),
            None => slice..slice + 1,
        });
    }

    fn refresh<T: Enclosure>(&mut self, tube: &mut Tube<T>) {
        if let Some(range) = self.0.take() {
            tube.refresh(range);
        }
    }
}
