//! A system: how its state evolves, and what is observed of it.

use super::error::EstimationError;
use super::observation::Observation;
use super::sweep::{ANY_NEWS, Route, Schedule, Sweep};
use crate::contraction::together;
use crate::integration::{Evolution, Steps, Way};
use crate::tube::Tube;
use shoal_interval::contractor::Contracted;
use shoal_interval::{Interval, IntervalBox};

/// CONTRACT is repeated while the box at its gate shrinks to less than this share on some axis.
const WORTH_ANOTHER_ROUND: f64 = 0.8;

/// CONTRACT is repeated at most this often.
const MOST_ROUNDS: usize = 5;

/// A state equation and observations of it.
///
/// ```
/// use shoal_interval::expression::Expression;
/// use shoal_interval::{Interval, IntervalBox};
/// use shoal_tube::estimation::{Search, System, from_contraction};
/// use shoal_tube::{TimeDomain, Tube};
///
/// // An oscillator with a period of 2 pi s, seen at 0.5 to 0.6 m after 1 s and after 2 s. How did it start?
/// let oscillator = Expression::system(|[x, v]| [v, -x]);
/// let seen = IntervalBox::from([Interval::new(0.5, 0.6)?, Interval::ENTIRE]);
/// let see = |gate: usize| {
///     let time_s = Interval::point(gate as f64 * 0.1).unwrap();
///     from_contraction(time_s, move |states: &mut Tube<IntervalBox<2>>| states.contract_gate(gate, &seen))
/// };
/// let system = System::new(oscillator).observed(see(10)).observed(see(20));
///
/// let mut states = Tube::constant(TimeDomain::uniform(0.0, 0.1, 30)?, IntervalBox::ENTIRE);
/// let anywhere = IntervalBox::from([Interval::new(-10.0, 10.0)?; 2]);
/// let strangled = system.strangle(&mut states, 0, anywhere, &Search::new([0.05, 0.05]))?;
/// assert!(!strangled.kept.is_empty());
/// // x(0) = 0.55 (sin 2 - sin 1) / sin 1 if both are seen at 0.55 m.
/// assert!(states.gate(0).unwrap()[0].contains(0.0443) && states.gate(0).unwrap()[0].width() < 0.4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct System<'a, const N: usize, E> {
    pub(super) evolution: E,
    pub(super) observations: Vec<Box<dyn Observation<N> + 'a>>,
    pub(super) steps: Steps,
}

impl<'a, const N: usize, E: Evolution<N>> System<'a, N, E> {
    /// The system with this state equation and no observations, integrated with one step a slice.
    pub fn new(evolution: E) -> System<'a, N, E> {
        System { evolution, observations: Vec::new(), steps: Steps::ONE }
    }

    /// The same system with one more observation.
    #[must_use]
    pub fn observed(mut self, observation: impl Observation<N> + 'a) -> System<'a, N, E> {
        self.observations.push(Box::new(observation));
        self
    }

    /// The same system, integrated with these steps. More than one may prove bounds over slices where nothing is known,
    /// and costs a multiple.
    #[must_use]
    pub fn with_steps(mut self, steps: Steps) -> System<'a, N, E> {
        self.steps = steps;
        self
    }

    /// The algorithm CONTRACT: removes from the tube what cannot be if the state is in `states` at gate `gate`.
    ///
    /// Every trajectory of the tube that is in `states` at that time, obeys the state equation and contradicts no
    /// observation is still in the tube. From the gate on the states are carried forward, then backward, and observations
    /// are applied as soon as all of their times are passed. A sweep ends where it narrows nothing more; the two are
    /// repeated while the box at the gate shrinks by a fifth.
    ///
    /// # Errors
    /// When there is no such gate, or an observation is of a time outside the domain. The tube is then unchanged, or an
    /// observation failed on the way.
    ///
    /// Source: seed 001, tables 4.1 and 4.3.
    pub fn contract(
        &self,
        tube: &mut Tube<IntervalBox<N>>,
        gate: usize,
        states: &IntervalBox<N>,
    ) -> Result<Contracted, EstimationError> {
        tube.check_gate(gate)?;
        let schedule = Schedule::new(tube.domain(), &self.observations)?;
        let counted = vec![true; self.observations.len()];
        self.contract_scheduled(tube, gate, states, &self.sweep(&schedule, &counted), MOST_ROUNDS)
    }

    pub(super) fn sweep<'s>(&'s self, schedule: &'s Schedule, counted: &'s [bool]) -> Sweep<'s, N, E> {
        Sweep {
            evolution: &self.evolution,
            steps: self.steps,
            observations: &self.observations,
            schedule,
            first_gate: 0,
            counted,
            worth_going_on: ANY_NEWS,
        }
    }

    /// CONTRACT at a gate that the caller knows to exist, in at most so many rounds.
    pub(super) fn contract_scheduled(
        &self,
        tube: &mut Tube<IntervalBox<N>>,
        gate: usize,
        states: &IntervalBox<N>,
        sweep: &Sweep<'_, N, E>,
        rounds: usize,
    ) -> Result<Contracted, EstimationError> {
        if tube.is_empty() {
            return Ok(Contracted::Empty);
        }
        let mut set = tube.gates[gate];
        let mut contracted = tube.narrow_gate(gate, *states);
        if contracted == Contracted::Empty {
            return Ok(Contracted::Empty);
        }
        let (mut first, mut last) = (gate, gate);
        for round in 0..rounds {
            let forward = Route { from: first, at_least_to: last, way: Way::Forward };
            let Some(swept) = sweep.run(tube, forward)? else { return Ok(emptied(tube)) };
            contracted = together(contracted, swept.contracted);
            last = swept.last_news;
            let backward = Route { from: last, at_least_to: Way::Backward.beyond(first), way: Way::Backward };
            let Some(swept) = sweep.run(tube, backward)? else { return Ok(emptied(tube)) };
            contracted = together(contracted, swept.contracted);
            first = swept.last_news;

            let narrowed = tube.gates[gate];
            let shrunk =
                |(now, then): (&Interval, &Interval)| now.width() < WORTH_ANOTHER_ROUND * then.width();
            // What was learnt before the gate comes to it with the second sweep forward.
            let worth = narrowed.iter().zip(&set).any(shrunk) || (round == 0 && first < gate);
            set = narrowed;
            if !worth {
                break;
            }
        }
        Ok(contracted)
    }
}

/// After a sweep that left no trajectory.
fn emptied<const N: usize>(tube: &mut Tube<IntervalBox<N>>) -> Contracted {
    tube.refresh(0..tube.slice_count());
    Contracted::Empty
}
