//! The algorithms TubeCSIVIA and RTubeCSIVIA: whole tubes are cut in two where they are widest.

use super::error::EstimationError;
use super::search::{Search, check_box};
use super::sweep::{Route, Schedule, Sweep};
use super::system::System;
use crate::integration::{Evolution, Way};
use crate::tube::Tube;
use shoal_interval::IntervalBox;

/// The tubes that TubeCSIVIA found.
#[derive(Debug, Clone, PartialEq)]
pub struct Solutions<const N: usize> {
    /// Tubes whose gates, behind those forgotten, are all as narrow as the precision. Every trajectory that contradicts nothing is in one of them or
    /// in one of those that are undecided.
    pub tubes: Vec<Tube<IntervalBox<N>>>,
    /// Tubes that were not looked at when the budget was used up.
    pub undecided: Vec<Tube<IntervalBox<N>>>,
    /// How many tubes were contracted.
    pub contractions: usize,
    /// How many of the oldest slices were forgotten to find a solution; always zero but for RTubeCSIVIA. The tubes say no
    /// more of them than the initial tube.
    pub forgotten: usize,
}

impl<const N: usize> Solutions<N> {
    /// Whether it is proved that no trajectory agrees with everything.
    pub fn is_empty(&self) -> bool {
        self.tubes.is_empty() && self.undecided.is_empty()
    }

    /// Holds the state at a gate; empty when there is no solution, or no such gate.
    pub fn states_at(&self, gate: usize) -> IntervalBox<N> {
        let gates = self.tubes.iter().chain(&self.undecided).filter_map(|tube| tube.gate(gate));
        gates.fold(IntervalBox::EMPTY, |hull, gate| hull | gate)
    }
}

impl<const N: usize, E: Evolution<N>> System<'_, N, E> {
    /// The algorithm TubeCSIVIA: the trajectories of a tube that obey the state equation and the observations, as a list of
    /// narrow tubes.
    ///
    /// Each tube is contracted by the motion forward, by the observations on the way, and by the motion backward. It is then
    /// cut in two at its widest gate, until all gates are as narrow as the precision. A tube that turned empty
    /// holds no solution. Tubes are cut in order, the lower half first.
    ///
    /// # Errors
    /// When the first gate of the tube is empty or unbounded, the precision is not positive, or an observation is of times
    /// outside the domain. Gates behind it that stay unbounded are never narrow enough and are not cut: their tubes
    /// are [`undecided`](Solutions::undecided).
    ///
    /// Source: seed 002, algorithm 4.1.
    pub fn tube_csivia(
        &self,
        tube: &Tube<IntervalBox<N>>,
        search: &Search<N>,
    ) -> Result<Solutions<N>, EstimationError> {
        let schedule = Schedule::new(tube.domain(), &self.observations)?;
        let counted = vec![true; self.observations.len()];
        self.cut_tubes(tube, search, &self.sweep(&schedule, &counted))
    }

    /// The algorithm RTubeCSIVIA: [`tube_csivia`](System::tube_csivia), and if there is no solution, again without the oldest
    /// `forget` slices and what was observed in them, and so on, until there is one or nothing is left.
    ///
    /// It is for a vehicle that was carried away, or whose past observations were wrong: what happened before the forgotten
    /// slices end no longer counts. This is robust, not guaranteed: a wrong observation that is not yet contradicted still
    /// counts. For outliers whose number is bounded see [`strangle_relaxed`](System::strangle_relaxed).
    ///
    /// # Errors
    /// Those of [`tube_csivia`](System::tube_csivia), for each of the shorter tubes too: what starts them is their first gate.
    ///
    /// Source: seed 002, algorithm 4.2.
    pub fn r_tube_csivia(
        &self,
        tube: &Tube<IntervalBox<N>>,
        search: &Search<N>,
        forget: usize,
    ) -> Result<Solutions<N>, EstimationError> {
        let schedule = Schedule::new(tube.domain(), &self.observations)?;
        let (mut forgotten, mut contractions) = (0, 0);
        loop {
            let counts = |index: usize| schedule.gates_of(index).is_some_and(|(first, _)| first >= forgotten);
            let counted: Vec<bool> = (0..self.observations.len()).map(counts).collect();
            let sweep = Sweep { first_gate: forgotten, ..self.sweep(&schedule, &counted) };
            let mut solutions = self.cut_tubes(tube, search, &sweep)?;
            contractions += solutions.contractions;
            if !solutions.is_empty() || forgotten == tube.slice_count() {
                solutions.forgotten = forgotten;
                solutions.contractions = contractions;
                return Ok(solutions);
            }
            forgotten = forgotten.saturating_add(forget.max(1)).min(tube.slice_count());
        }
    }

    /// The tubes behind the first gate of the sweep; what is before stays as it is.
    fn cut_tubes(
        &self,
        tube: &Tube<IntervalBox<N>>,
        search: &Search<N>,
        sweep: &Sweep<'_, N, E>,
    ) -> Result<Solutions<N>, EstimationError> {
        search.check()?;
        let (start, end) = (sweep.first_gate, tube.slice_count());
        check_box(&tube.gates[start])?;
        let forward = Route { from: start, at_least_to: end, way: Way::Forward };
        let backward = Route { from: end, at_least_to: start, way: Way::Backward };
        let mut solutions =
            Solutions { tubes: Vec::new(), undecided: Vec::new(), contractions: 0, forgotten: 0 };
        let mut waiting = vec![tube.clone()];
        while let Some(mut part) = waiting.pop() {
            if solutions.contractions >= search.budget {
                solutions.undecided.push(part);
                continue;
            }
            solutions.contractions += 1;
            if part.is_empty()
                || sweep.run(&mut part, forward)?.is_none()
                || sweep.run(&mut part, backward)?.is_none()
            {
                continue;
            }
            match halves(&part, start, search) {
                Cut::Narrow => solutions.tubes.push(part),
                Cut::Impossible => solutions.undecided.push(part),
                Cut::At(gate, low, high) => {
                    let mut other = part.clone();
                    other.narrow_gate(gate, high);
                    part.narrow_gate(gate, low);
                    waiting.push(other);
                    waiting.push(part);
                }
            }
        }
        Ok(solutions)
    }
}

enum Cut<T> {
    /// All gates are narrow.
    Narrow,
    /// Some are not, and none of these can be cut.
    Impossible,
    At(usize, T, T),
}

/// Cuts the gate from `start` on that is widest next to the precision, the first of several.
fn halves<const N: usize>(
    tube: &Tube<IntervalBox<N>>,
    start: usize,
    search: &Search<N>,
) -> Cut<IntervalBox<N>> {
    let mut widest = (start, 1.0);
    let mut narrow = true;
    for (index, gate) in tube.gates().enumerate().skip(start) {
        let share = search.widest(&gate).1;
        narrow &= share <= 1.0;
        if share > widest.1 && gate.is_bounded() {
            widest = (index, share);
        }
    }
    if narrow {
        return Cut::Narrow;
    }
    match search.halves(&tube.gates[widest.0]) {
        Some((low, high)) => Cut::At(widest.0, low, high),
        None => Cut::Impossible,
    }
}
