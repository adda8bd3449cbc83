//! A trajectory and its derivative: contraction both ways in time, and the integral.

use crate::contraction::together;
use crate::enclosure::Enclosure;
use crate::error::{Constraint, TubeError};
use crate::tube::Tube;
use shoal_interval::Interval;
use shoal_interval::contractor::Contracted;
use std::collections::VecDeque;

/// Which way in time a contractor carries what is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// From the past to the future, as an observer online can.
    Forward,
    /// From the future to the past.
    Backward,
    /// Forward, then backward.
    Both,
}

impl<T: Enclosure> Tube<T> {
    /// The integral of a derivative, from what is known of the value at the start of the domain.
    ///
    /// Source: seed 001, equations (4.4) to (4.6).
    pub fn primitive(derivative: &Tube<T>, at_start: T) -> Tube<T> {
        let mut gates = VecDeque::with_capacity(derivative.slice_count() + 1);
        let mut slices = VecDeque::with_capacity(derivative.slice_count());
        let mut gate = at_start;
        gates.push_back(gate);
        for (index, &slope) in derivative.slices.iter().enumerate() {
            let travel = Travel::new(slope, derivative.domain.duration_at(index));
            slices.push_back(gate + travel.within);
            gate = gate + travel.across;
            gates.push_back(gate);
        }
        Tube::assembled(derivative.domain.clone(), slices, gates)
    }

    /// Removes every trajectory whose derivative is not, almost always, in the slices of `derivative`.
    ///
    /// With `D` the length of a slice and `[v]` the derivative over it, forward in time
    /// `output gate ⊂ input gate + D [v]` and `slice ⊂ input gate + [0, D] [v]`, and backward the same from the output gate.
    /// A trajectory that was inside and has such a derivative stays inside.
    ///
    /// # Errors
    /// When the two tubes are cut at different times.
    ///
    /// Source: seed 001, equations (5.5) and (5.6), and table 4.1 with slices in place of Euler's steps.
    pub fn contract_derivative(
        &mut self,
        derivative: &Tube<T>,
        direction: Direction,
    ) -> Result<Contracted, TubeError> {
        self.check_same_domain(derivative)?;
        let all = 0..self.slice_count();
        let mut contracted = Contracted::Unchanged;
        if direction != Direction::Backward {
            for index in all.clone() {
                contracted = together(contracted, self.carry_forward(index, derivative.slices[index]));
            }
        }
        if direction != Direction::Forward {
            for index in all.clone().rev() {
                contracted = together(contracted, self.carry_backward(index, derivative.slices[index]));
            }
        }
        if contracted != Contracted::Unchanged {
            self.refresh(all);
        }
        Ok(self.blamed(contracted, Constraint::Derivative))
    }

    /// The same over one slice: `derivative` holds the derivative almost always between its two gates. Derivatives that
    /// jump from slice to slice, as commands do, are given in this way.
    ///
    /// ```
    /// use shoal_interval::Interval;
    /// use shoal_tube::{Direction, Tube};
    ///
    /// let mut x_m = Tube::starting_at(0.0, Interval::ZERO)?;
    /// x_m.append(0.5, Interval::ENTIRE, Interval::ENTIRE)?;
    /// x_m.contract_slice_derivative(0, Interval::new(1.0, 2.0)?, Direction::Forward)?;
    /// assert_eq!(x_m.slice(0), Some(Interval::new(0.0, 1.0)?));
    /// assert_eq!(x_m.output_gate(0), Some(Interval::new(0.5, 1.0)?));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When there is no such slice.
    pub fn contract_slice_derivative(
        &mut self,
        index: usize,
        derivative: T,
        direction: Direction,
    ) -> Result<Contracted, TubeError> {
        self.check_slice(index)?;
        let contracted = match direction {
            Direction::Forward => self.carry_forward(index, derivative),
            Direction::Backward => self.carry_backward(index, derivative),
            Direction::Both => {
                together(self.carry_forward(index, derivative), self.carry_backward(index, derivative))
            }
        };
        if contracted != Contracted::Unchanged {
            self.refresh(index..index + 1);
        }
        Ok(self.blamed(contracted, Constraint::Derivative))
    }

    /// Carries the input gate of slice `index`, which the caller knows to exist, through the slice to its output gate. The
    /// summaries wait for [`refresh`](Tube::refresh).
    #[inline]
    pub(crate) fn carry_forward(&mut self, index: usize, derivative: T) -> Contracted {
        let travel = Travel::new(derivative, self.domain.duration_at(index));
        let input_gate = self.gates[index];
        let of_slice = self.narrow_slice_alone(index, input_gate + travel.within);
        if of_slice == Contracted::Empty {
            return self.narrow_slice(index, T::EMPTY);
        }
        // The input gate is inside the slice still, because no travel is zero.
        let reached = (input_gate + travel.across) & self.slices[index];
        let of_output = self.narrow_gate(index + 1, reached);
        debug_assert!(self.gates_are_inside(index));
        together(of_slice, of_output)
    }

    /// [`carry_forward`](Tube::carry_forward), from the output gate to the input gate.
    #[inline]
    pub(crate) fn carry_backward(&mut self, index: usize, derivative: T) -> Contracted {
        let travel = Travel::new(derivative, self.domain.duration_at(index));
        let output_gate = self.gates[index + 1];
        let of_slice = self.narrow_slice_alone(index, output_gate - travel.within);
        if of_slice == Contracted::Empty {
            return self.narrow_slice(index, T::EMPTY);
        }
        let left = (output_gate - travel.across) & self.slices[index];
        let of_input = self.narrow_gate(index, left);
        debug_assert!(self.gates_are_inside(index));
        together(of_slice, of_input)
    }
}

/// How far a derivative leads in a slice.
struct Travel<T> {
    /// From its start to its end.
    across: T,
    /// From its start to any time of it.
    within: T,
}

impl<T: Enclosure> Travel<T> {
    #[inline]
    fn new(derivative: T, duration_s: Interval) -> Travel<T> {
        let across = derivative * duration_s;
        // Rounding up is monotonic, so this is `derivative * [0, duration]` to the bit.
        let within = if across.is_empty() { across } else { across | T::zero() };
        Travel { across, within }
    }
}

#[cfg(test)]
mod tests;
