//! The states of a vehicle, carried from gate to gate through a tube.

use super::evolution::Evolution;
use super::step::{Span, States, step};
use crate::contraction::together;
use crate::tube::Tube;
use shoal_interval::IntervalBox;
use shoal_interval::contractor::Contracted;
use std::ops::Range;
use thiserror::Error;

/// Into how many steps a slice is cut for the integration. The tube keeps its slices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Steps {
    /// At least this many; more make the gates tighter. At least one is taken.
    pub least: u32,
    /// At most this many: the number is doubled up to here while no solution can be proved to stay bounded over a step.
    pub most: u32,
}

impl Steps {
    /// One step a slice, and no more: the cheapest.
    pub const ONE: Steps = Steps { least: 1, most: 1 };
}

/// One step a slice, at most 64.
impl Default for Steps {
    fn default() -> Steps {
        Steps { least: 1, most: 64 }
    }
}

/// No bounded enclosure of the solutions was found: they may leave every bound within the slice, or the slice is too long.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error(
    "the solutions may be unbounded in slice {slice}, from {from_s} s to {to_s} s; shorter slices or more steps may help"
)]
pub struct Diverged {
    /// The index of the slice.
    pub slice: usize,
    /// Where the slice starts, in seconds.
    pub from_s: f64,
    /// Where the slice ends, in seconds.
    pub to_s: f64,
}

/// Which way a carrier goes through a slice.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Way {
    Forward,
    Backward,
}

impl Way {
    /// The gate that is passed later.
    pub(crate) fn later(self, one: usize, other: usize) -> usize {
        if self == Way::Forward { one.max(other) } else { one.min(other) }
    }

    /// The gate after this one, were there any number of gates.
    pub(crate) fn beyond(self, gate: usize) -> usize {
        if self == Way::Forward { gate + 1 } else { gate.saturating_sub(1) }
    }

    /// The slice after a gate and the gate after that, if that slice is one of `slices`.
    pub(crate) fn next(self, gate: usize, slices: Range<usize>) -> Option<(usize, usize)> {
        match self {
            Way::Forward => (gate < slices.end).then_some((gate, gate + 1)),
            Way::Backward => (gate > slices.start).then(|| (gate - 1, gate - 1)),
        }
    }
}

/// What passing a slice did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Passage {
    pub(crate) contracted: Contracted,
    pub(crate) diverged: Option<Diverged>,
}

/// Goes through a tube slice by slice and remembers more of the states than the gates can hold.
pub(crate) struct Carrier<'a, const N: usize, E: ?Sized> {
    evolution: &'a E,
    steps: Steps,
    way: Way,
    /// At the gate that was left last; `None` at the start and after a slice without a bounded enclosure.
    states: Option<States<N>>,
}

impl<'a, const N: usize, E: Evolution<N> + ?Sized> Carrier<'a, N, E> {
    pub(crate) fn new(evolution: &'a E, steps: Steps, way: Way) -> Carrier<'a, N, E> {
        Carrier { evolution, steps, way, states: None }
    }

    /// Carries what is known through slice `index`, which the caller knows to exist, and contracts it and the gate behind
    /// it. Slices are to be passed one after the other. The summaries wait for [`refresh`](Tube::refresh).
    pub(crate) fn pass(&mut self, tube: &mut Tube<IntervalBox<N>>, index: usize) -> Passage {
        let (from, to) = match self.way {
            Way::Forward => (index, index + 1),
            Way::Backward => (index + 1, index),
        };
        let gate = tube.gates[from];
        let start = self.states.map_or(States::new(gate), |states| states.met_with(&gate));
        let (from_s, to_s) = (tube.domain.border_at(from), tube.domain.border_at(to));

        let least = self.steps.least.max(1);
        let mut count = least;
        let passed = loop {
            let last = count.saturating_mul(2) > self.steps.most;
            let passed = self.in_steps(count, from_s, to_s, &start, &tube.slices[index], last);
            if passed.is_some() || last {
                break passed;
            }
            count *= 2;
        };
        let Some((over, end)) = passed else {
            self.states = None;
            let span = tube.domain.span_at(index);
            let diverged = Diverged { slice: index, from_s: span.lower(), to_s: span.upper() };
            return Passage { contracted: Contracted::Unchanged, diverged: Some(diverged) };
        };
        let of_slice = tube.narrow_slice(index, over);
        let of_gate = tube.narrow_gate(to, *end.hull());
        self.states = Some(end.met_with(&tube.gates[to]));
        Passage { contracted: together(of_slice, of_gate), diverged: None }
    }

    fn in_steps(
        &self,
        count: u32,
        from_s: f64,
        to_s: f64,
        start: &States<N>,
        known: &IntervalBox<N>,
        known_will_do: bool,
    ) -> Option<(IntervalBox<N>, States<N>)> {
        let mut over = IntervalBox::EMPTY;
        let mut states = *start;
        let mut step_from_s = from_s;
        for done in 1..=count {
            // Each border is rounded, but the last, and each step starts exactly where the one before ended.
            let share = f64::from(done) / f64::from(count);
            let step_to_s = if done == count { to_s } else { from_s + (to_s - from_s) * share };
            let span = Span::new(step_from_s, step_to_s);
            let (over_step, end) = step(self.evolution, span, &states, known, known_will_do)?;
            over = over | over_step;
            states = end;
            step_from_s = step_to_s;
        }
        Some((over, states))
    }
}
