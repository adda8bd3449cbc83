//! Search among observations of which some may be wrong.

use super::error::EstimationError;
use super::search::{Search, Strangled, check_box, search_boxes};
use super::sweep::{Route, Schedule};
use super::system::System;
use crate::integration::{Evolution, Way};
use crate::tube::Tube;
use shoal_interval::IntervalBox;
use shoal_interval::contractor::{Contracted, relaxed_intersection_of_boxes};

impl<const N: usize, E: Evolution<N>> System<'_, N, E> {
    /// [`strangle`](System::strangle) when at most `outliers` of the observations may be wrong, whichever they are.
    ///
    /// Every trajectory of the tube that is in `initial` at gate `gate`, obeys the state equation and contradicts at most
    /// `outliers` observations is still in the tube. What each observation alone leaves of a box at the gate is met in a
    /// relaxed intersection; once as many observations as may be wrong are proved wrong for a box, all others are used
    /// together. Costs a contraction for each observation and each box.
    ///
    /// # Errors
    /// Those of [`strangle`](System::strangle).
    ///
    /// Source: seed 001, section 2.5 (relaxed intersection), on top of table 4.2; seed 002, section 3.6.
    pub fn strangle_relaxed(
        &self,
        tube: &mut Tube<IntervalBox<N>>,
        gate: usize,
        initial: IntervalBox<N>,
        search: &Search<N>,
        outliers: usize,
    ) -> Result<Strangled<N>, EstimationError> {
        if outliers == 0 {
            return self.strangle(tube, gate, initial, search);
        }
        check_box(&initial)?;
        search.check()?;
        tube.check_gate(gate)?;
        let schedule = Schedule::new(tube.domain(), &self.observations)?;
        let none = vec![false; self.observations.len()];
        search_boxes(tube, gate, initial, search, |part, set| {
            let motion = self.sweep(&schedule, &none);
            if self.contract_scheduled(part, gate, set, &motion)? == Contracted::Empty {
                return Ok(false);
            }
            let mut boxes = Vec::with_capacity(self.observations.len());
            for observation in 0..self.observations.len() {
                boxes.push(self.left_by(observation, part, gate, &schedule)?);
            }
            let wrong = boxes.iter().filter(|set| set.is_empty()).count();
            if wrong > outliers {
                return Ok(false);
            }
            let agreed = part.gates[gate] & relaxed_intersection_of_boxes(&boxes, outliers);
            if wrong < outliers {
                return Ok(self.contract_scheduled(part, gate, &agreed, &motion)? != Contracted::Empty);
            }
            let right: Vec<bool> = boxes.iter().map(|set| !set.is_empty()).collect();
            let all_others = self.sweep(&schedule, &right);
            Ok(self.contract_scheduled(part, gate, &agreed, &all_others)? != Contracted::Empty)
        })
    }

    /// The states at a gate that one observation leaves.
    fn left_by(
        &self,
        observation: usize,
        tube: &Tube<IntervalBox<N>>,
        gate: usize,
        schedule: &Schedule,
    ) -> Result<IntervalBox<N>, EstimationError> {
        let Some((first, last)) = schedule.gates_of(observation) else {
            return Ok(tube.gates[gate]);
        };
        let mut alone = tube.clone();
        match self.observations[observation].contract(&mut alone)? {
            Contracted::Empty => return Ok(IntervalBox::EMPTY),
            Contracted::Unchanged => return Ok(tube.gates[gate]),
            Contracted::Narrowed => {}
        }
        let none = vec![false; self.observations.len()];
        let motion = self.sweep(schedule, &none);
        // From beyond the observation to the gate, or both ways across the gate.
        let routes = [
            Route { from: last.max(gate), at_least_to: first.min(gate), way: Way::Backward },
            Route { from: first.min(gate), at_least_to: gate, way: Way::Forward },
        ];
        for route in routes {
            if motion.run(&mut alone, route)?.is_none() {
                return Ok(IntervalBox::EMPTY);
            }
        }
        Ok(alone.gates[gate])
    }
}
