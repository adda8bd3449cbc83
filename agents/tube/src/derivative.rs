//! A trajectory and its derivative: contraction both ways in time, and the integral.

use crate::contraction::together;
use crate::enclosure::Enclosure;
use crate::error::{Constraint, TubeError};
use crate::time_domain::duration_s;
use crate::tube::Tube;
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
            let reached = gate + slope * derivative.domain.duration_at(index);
            slices.push_back(on_the_way(gate, reached));
            gate = reached;
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
        let mut contracted = Contracted::Unchanged;
        if direction != Direction::Backward {
            contracted = together(contracted, self.sweep_forward(derivative));
        }
        if direction != Direction::Forward {
            contracted = together(contracted, self.sweep_backward(derivative));
        }
        if contracted != Contracted::Unchanged {
            self.refresh(0..self.slice_count());
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

    /// [`carry_forward`](Tube::carry_forward) through all slices.
    fn sweep_forward(&mut self, derivative: &Tube<T>) -> Contracted {
        let mut contracted = Contracted::Unchanged;
        let mut start = 0;
        while let Some(stuck) = self.sweep_forward_from(start, derivative, &mut contracted) {
            contracted = together(contracted, self.carry_forward(stuck, derivative.slices[stuck]));
            start = stuck + 1;
        }
        contracted
    }

    /// Goes on until a slice through which nothing can be carried, which it returns.
    fn sweep_forward_from(
        &mut self,
        start: usize,
        derivative: &Tube<T>,
        contracted: &mut Contracted,
    ) -> Option<usize> {
        let (slices, gates) = (self.slices.make_contiguous(), self.gates.make_contiguous());
        let mut from_s = self.domain.border_at(start);
        let mut gate = gates[start];
        let mut is_narrowed = false;
        let mut stuck = None;
        let parts =
            slices[start..].iter_mut().zip(&mut gates[start + 1..]).zip(derivative.slices.range(start..));
        for (index, ((slice, next_gate), &slope)) in (start..).zip(parts) {
            let to_s = self.domain.border_at(index + 1);
            let reached = gate + slope * duration_s(from_s, to_s);
            let Some(narrowed) = narrow_both(slice, next_gate, gate, reached) else {
                stuck = Some(index);
                break;
            };
            is_narrowed |= narrowed;
            (gate, from_s) = (*next_gate, to_s);
        }
        if is_narrowed {
            *contracted = together(*contracted, Contracted::Narrowed);
        }
        stuck
    }

    /// [`carry_backward`](Tube::carry_backward) through all slices.
    fn sweep_backward(&mut self, derivative: &Tube<T>) -> Contracted {
        let mut contracted = Contracted::Unchanged;
        let mut end = self.slice_count();
        while let Some(stuck) = self.sweep_backward_from(end, derivative, &mut contracted) {
            contracted = together(contracted, self.carry_backward(stuck, derivative.slices[stuck]));
            end = stuck;
        }
        contracted
    }

    /// [`sweep_forward_from`](Tube::sweep_forward_from), from the end of slice `end - 1` to the start of the tube.
    fn sweep_backward_from(
        &mut self,
        end: usize,
        derivative: &Tube<T>,
        contracted: &mut Contracted,
    ) -> Option<usize> {
        let (slices, gates) = (self.slices.make_contiguous(), self.gates.make_contiguous());
        let mut to_s = self.domain.border_at(end);
        let mut gate = gates[end];
        let mut is_narrowed = false;
        let mut stuck = None;
        let parts = slices[..end].iter_mut().zip(&mut gates[..end]).zip(derivative.slices.range(..end));
        for (index, ((slice, next_gate), &slope)) in (0..end).zip(parts).rev() {
            let from_s = self.domain.border_at(index);
            let left = gate - slope * duration_s(from_s, to_s);
            let Some(narrowed) = narrow_both(slice, next_gate, gate, left) else {
                stuck = Some(index);
                break;
            };
            is_narrowed |= narrowed;
            (gate, to_s) = (*next_gate, from_s);
        }
        if is_narrowed {
            *contracted = together(*contracted, Contracted::Narrowed);
        }
        stuck
    }

    /// Carries the input gate of slice `index`, which the caller knows to exist, through the slice to its output gate. The
    /// summaries wait for [`refresh`](Tube::refresh).
    #[inline]
    pub(crate) fn carry_forward(&mut self, index: usize, derivative: T) -> Contracted {
        let input_gate = self.gates[index];
        let reached = input_gate + derivative * self.domain.duration_at(index);
        let of_slice = self.narrow_slice_alone(index, on_the_way(input_gate, reached));
        if of_slice == Contracted::Empty {
            return self.narrow_slice(index, T::EMPTY);
        }
        // The input gate is inside the slice still, because no travel is zero.
        let of_output = self.narrow_gate(index + 1, reached & self.slices[index]);
        debug_assert!(self.gates_are_inside(index));
        together(of_slice, of_output)
    }

    /// [`carry_forward`](Tube::carry_forward), from the output gate to the input gate.
    #[inline]
    pub(crate) fn carry_backward(&mut self, index: usize, derivative: T) -> Contracted {
        let output_gate = self.gates[index + 1];
        let left = output_gate - derivative * self.domain.duration_at(index);
        let of_slice = self.narrow_slice_alone(index, on_the_way(output_gate, left));
        if of_slice == Contracted::Empty {
            return self.narrow_slice(index, T::EMPTY);
        }
        let of_input = self.narrow_gate(index, left & self.slices[index]);
        debug_assert!(self.gates_are_inside(index));
        together(of_slice, of_input)
    }
}

/// Narrows a slice and the gate behind it, at which `reached` is reached from `gate`. The answer is whether one of them
/// changed; `None`, with both left as they are, if one of them would be empty.
#[inline]
fn narrow_both<T: Enclosure>(slice: &mut T, next_gate: &mut T, gate: T, reached: T) -> Option<bool> {
    let narrower = *slice & on_the_way(gate, reached);
    let narrower_gate = reached & narrower & *next_gate;
    if narrower.is_empty() || narrower_gate.is_empty() {
        return None;
    }
    let narrowed = narrower != *slice || narrower_gate != *next_gate;
    (*slice, *next_gate) = (narrower, narrower_gate);
    Some(narrowed)
}

/// Where a trajectory is while a constant set of derivatives leads it from one gate to what is reached at the other.
///
/// Rounding is monotonic, so the hull of both ends is `gate + [0, duration] * derivative` to the bit.
#[inline]
fn on_the_way<T: Enclosure>(gate: T, reached: T) -> T {
    if reached.is_empty() { reached } else { gate | reached }
}

#[cfg(test)]
mod tests;
