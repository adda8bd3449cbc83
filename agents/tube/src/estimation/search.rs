//! The algorithm STRANGLE: the box at one gate is cut in two again and again.

use super::error::EstimationError;
use super::sweep::{Route, Schedule, Sweep};
use super::system::System;
use crate::Constraint;
use crate::enclosure::Enclosure;
use crate::integration::{Evolution, Way};
use crate::tube::Tube;
use shoal_interval::IntervalBox;
use shoal_interval::contractor::Contracted;
use std::rc::Rc;

/// The whole tube is contracted at most this often before it is cut.
const MOST_ROUNDS_BEFORE: usize = 20;

/// The states of a box that is to be cut are followed while they make a gate narrower than this share on some axis.
const GREAT_NEWS: f64 = 0.5;

/// The same for boxes that are narrow enough to be kept.
const GOOD_NEWS: f64 = 0.9;

/// How finely to cut, and for how long.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Search<const N: usize> {
    /// Boxes that are as narrow as this on every axis, each in its own unit, are not cut further.
    pub precision: [f64; N],
    /// How many tubes may be contracted. What is not decided by then is kept.
    pub budget: usize,
}

impl<const N: usize> Search<N> {
    /// Cuts down to `precision` on each axis, in at most 100,000 contractions.
    pub const fn new(precision: [f64; N]) -> Search<N> {
        Search { precision, budget: 100_000 }
    }

    /// The same precision, in at most so many contractions.
    #[must_use]
    pub const fn with_budget(self, budget: usize) -> Search<N> {
        Search { budget, ..self }
    }

    pub(super) fn check(&self) -> Result<(), EstimationError> {
        let positive = |axis: usize| self.precision[axis] > 0.0;
        match (0..N).find(|&axis| !positive(axis)) {
            Some(axis) => Err(EstimationError::NotAPrecision { axis, precision: self.precision[axis] }),
            None => Ok(()),
        }
    }

    /// The two halves of a box, cut where it is widest next to the precision; `None` if it is narrow enough, or cannot be
    /// cut.
    pub(super) fn halves(&self, set: &IntervalBox<N>) -> Option<(IntervalBox<N>, IntervalBox<N>)> {
        let (axis, share) = self.widest(set);
        if share > 1.0 { set.bisect_axis(axis) } else { None }
    }

    /// The axis on which a box is widest next to the precision, and how many times as wide.
    pub(super) fn widest(&self, set: &IntervalBox<N>) -> (usize, f64) {
        let shares = set.iter().zip(&self.precision).map(|(side, precision)| side.width() / precision);
        let mut widest = (0, 0.0);
        for (axis, share) in shares.enumerate() {
            if share > widest.1 {
                widest = (axis, share);
            }
        }
        widest
    }
}

/// What became of the boxes of a search; with the parts that contraction cut off, they fill the initial box.
#[derive(Debug, Clone, PartialEq)]
pub struct Strangled<const N: usize> {
    /// Boxes as narrow as the precision from which some trajectory may start: blue in the seed's figures.
    pub kept: Vec<IntervalBox<N>>,
    /// Boxes from which no trajectory starts, a proof: white in the seed's figures.
    pub rejected: Vec<IntervalBox<N>>,
    /// Boxes that were not looked at when the budget was used up. They count as kept.
    pub undecided: Vec<IntervalBox<N>>,
    /// How many tubes were contracted.
    pub contractions: usize,
}

impl<const N: usize> Strangled<N> {
    pub(super) const fn new() -> Strangled<N> {
        Strangled { kept: Vec::new(), rejected: Vec::new(), undecided: Vec::new(), contractions: 0 }
    }

    /// The smallest box around all boxes that are kept or undecided: where the state is at that gate.
    pub fn hull(&self) -> IntervalBox<N> {
        self.kept.iter().chain(&self.undecided).fold(IntervalBox::EMPTY, |hull, set| hull | *set)
    }

    /// Records what contraction cut off from a box.
    pub(super) fn reject_rest(&mut self, set: &IntervalBox<N>, contracted: &IntervalBox<N>) {
        self.rejected.extend(set.difference(contracted));
    }
}

impl<const N: usize, E: Evolution<N>> System<'_, N, E> {
    /// The algorithm STRANGLE: contracts the tube, knowing that the state is in `initial` at gate `gate`, by cutting that
    /// box into parts.
    ///
    /// Every trajectory of the tube that is in `initial` at that time, obeys the state equation and contradicts no
    /// observation is still in the tube. If there is none the tube becomes [empty](Tube::is_empty) at the gate and no box
    /// is kept. Boxes are cut in order, the lower half first, so the result is always the same.
    ///
    /// # Errors
    /// When there is no such gate, the box is empty or unbounded, the precision is not positive, or an observation is of
    /// times outside the domain. The tube is then unchanged.
    ///
    /// Source: seed 001, tables 4.2 and 4.4.
    pub fn strangle(
        &self,
        tube: &mut Tube<IntervalBox<N>>,
        gate: usize,
        initial: IntervalBox<N>,
        search: &Search<N>,
    ) -> Result<Strangled<N>, EstimationError> {
        check_box(&initial)?;
        search.check()?;
        tube.check_gate(gate)?;
        let schedule = Schedule::new(tube.domain(), &self.observations)?;
        let counted = vec![true; self.observations.len()];
        let sweep = self.sweep(&schedule, &counted);
        // What can be learnt without a box is learnt once, and no part goes through all of the tube for it.
        let all = Route { from: 0, at_least_to: tube.slice_count(), way: Way::Forward };
        let back = Route { from: tube.slice_count(), at_least_to: 0, way: Way::Backward };
        for _ in 0..MOST_ROUNDS_BEFORE {
            let (Some(forward), Some(backward)) = (sweep.run(tube, all)?, sweep.run(tube, back)?) else {
                return Ok(all_rejected(tube, gate, initial));
            };
            if forward.last_news == all.from && backward.last_news == back.from {
                break;
            }
        }
        let coarse = Sweep { worth_going_on: GREAT_NEWS, ..sweep };
        let fine = Sweep { worth_going_on: GOOD_NEWS, ..sweep };
        search_boxes(tube, gate, initial, search, |part, set| {
            // What is to be cut anyway is only asked whether it can be rejected soon.
            if search.halves(set).is_some() {
                if self.contract_scheduled(part, gate, set, &coarse, 1)? == Contracted::Empty {
                    return Ok(false);
                }
                if search.halves(&part.gates[gate]).is_some() {
                    return Ok(true);
                }
            }
            Ok(self.contract_scheduled(part, gate, set, &fine, 1)? != Contracted::Empty)
        })
    }
}

/// Cuts `initial` at gate `gate`; `contract` contracts a part of the tube, knowing that the state is in a box at that gate,
/// and tells whether anything is left.
pub(super) fn search_boxes<const N: usize>(
    tube: &mut Tube<IntervalBox<N>>,
    gate: usize,
    initial: IntervalBox<N>,
    search: &Search<N>,
    mut contract: impl FnMut(&mut Tube<IntervalBox<N>>, &IntervalBox<N>) -> Result<bool, EstimationError>,
) -> Result<Strangled<N>, EstimationError> {
    let mut strangled = Strangled::new();
    let mut union = Union::new(tube);
    let mut waiting = vec![(initial, Rc::new(tube.clone()))];
    while let Some((set, parent)) = waiting.pop() {
        if strangled.contractions >= search.budget {
            union.add(&parent, gate, &set);
            strangled.undecided.push(set);
            continue;
        }
        strangled.contractions += 1;
        let mut part = (*parent).clone();
        if !contract(&mut part, &set)? {
            strangled.rejected.push(set);
            continue;
        }
        let contracted = part.gates[gate];
        strangled.reject_rest(&set, &contracted);
        match search.halves(&contracted) {
            Some((low, high)) => {
                let part = Rc::new(part);
                waiting.push((high, Rc::clone(&part)));
                waiting.push((low, part));
            }
            None => {
                union.add(&part, gate, &contracted);
                strangled.kept.push(contracted);
            }
        }
    }
    union.narrow(tube);
    Ok(strangled)
}

/// The answer for a tube that is empty without any box.
fn all_rejected<const N: usize>(
    tube: &mut Tube<IntervalBox<N>>,
    gate: usize,
    initial: IntervalBox<N>,
) -> Strangled<N> {
    let emptied = tube.narrow_gate(gate, IntervalBox::EMPTY);
    tube.blamed(emptied, Constraint::StateEquation);
    tube.refresh(0..tube.slice_count());
    Strangled { rejected: vec![initial], contractions: 1, ..Strangled::new() }
}

pub(super) fn check_box<const N: usize>(set: &IntervalBox<N>) -> Result<(), EstimationError> {
    if set.is_empty() {
        return Err(EstimationError::EmptyBox);
    }
    match set.iter().position(|side| !side.is_bounded()) {
        Some(axis) => Err(EstimationError::UnboundedBox { axis }),
        None => Ok(()),
    }
}

/// The hull of tubes on one domain.
pub(super) struct Union<T> {
    slices: Vec<T>,
    gates: Vec<T>,
}

impl<T: Enclosure> Union<T> {
    pub(super) fn new(tube: &Tube<T>) -> Union<T> {
        Union { slices: vec![T::EMPTY; tube.slice_count()], gates: vec![T::EMPTY; tube.slice_count() + 1] }
    }

    /// Adds the trajectories of a tube that are in `set` at a gate.
    pub(super) fn add(&mut self, tube: &Tube<T>, gate: usize, set: &T) {
        let here = self.gates[gate] | (tube.gates[gate] & *set);
        for (union, slice) in self.slices.iter_mut().zip(tube.slices()) {
            *union = *union | slice;
        }
        for (union, gate) in self.gates.iter_mut().zip(tube.gates()) {
            *union = *union | gate;
        }
        self.gates[gate] = here;
    }

    /// Removes from the tube what is in none of those that were added.
    pub(super) fn narrow(&self, tube: &mut Tube<T>) {
        for (index, &gate) in self.gates.iter().enumerate() {
            let contracted = tube.narrow_gate(index, gate);
            tube.blamed(contracted, Constraint::StateEquation);
        }
        for (index, &slice) in self.slices.iter().enumerate() {
            tube.narrow_slice(index, slice);
        }
        tube.refresh(0..tube.slice_count());
    }
}
