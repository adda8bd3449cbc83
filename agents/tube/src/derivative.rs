//! A trajectory and its derivative: contraction both ways in time, and the integral.

use crate::enclosure::Enclosure;
use crate::error::TubeError;
use crate::online::{narrow, together};
use crate::tube::Tube;
use shoal_interval::Interval;
use shoal_interval::contractor::Contracted;

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
        let mut tube = Tube::constant(derivative.domain().clone(), T::ENTIRE);
        tube.gates[0] = at_start;
        for index in 0..tube.slice_count() {
            tube.contract_forward(index, derivative.slices[index]);
        }
        tube
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
        if self.domain != derivative.domain {
            return Err(TubeError::DifferentDomains);
        }
        let mut contracted = Contracted::Unchanged;
        if direction != Direction::Backward {
            for index in 0..self.slice_count() {
                contracted = together(contracted, self.contract_forward(index, derivative.slices[index]));
            }
        }
        if direction != Direction::Forward {
            for index in (0..self.slice_count()).rev() {
                contracted = together(contracted, self.contract_backward(index, derivative.slices[index]));
            }
        }
        Ok(contracted)
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
        if index >= self.slice_count() {
            return Err(TubeError::NoSuchSlice { index, count: self.slice_count() });
        }
        Ok(match direction {
            Direction::Forward => self.contract_forward(index, derivative),
            Direction::Backward => self.contract_backward(index, derivative),
            Direction::Both => {
                together(self.contract_forward(index, derivative), self.contract_backward(index, derivative))
            }
        })
    }

    fn contract_forward(&mut self, index: usize, derivative: T) -> Contracted {
        let input_gate = self.gates[index];
        let duration_s = self.duration_s(index);
        let reached = input_gate + derivative * duration_s;
        let passed = input_gate + derivative * (duration_s | Interval::ZERO);
        let of_gate = narrow(&mut self.gates[index + 1], reached);
        together(of_gate, self.narrow_slice(index, passed))
    }

    fn contract_backward(&mut self, index: usize, derivative: T) -> Contracted {
        let output_gate = self.gates[index + 1];
        let duration_s = self.duration_s(index);
        let left = output_gate - derivative * duration_s;
        let passed = output_gate - derivative * (duration_s | Interval::ZERO);
        let of_gate = narrow(&mut self.gates[index], left);
        together(of_gate, self.narrow_slice(index, passed))
    }

    fn narrow_slice(&mut self, index: usize, value: T) -> Contracted {
        let of_slice = narrow(&mut self.slices[index], value);
        let slice = self.slices[index];
        let of_input = narrow(&mut self.gates[index], slice);
        let of_output = narrow(&mut self.gates[index + 1], slice);
        together(together(of_slice, of_input), of_output)
    }

    /// The exact length of a slice, enclosed: the difference of its borders may not be a `f64`.
    fn duration_s(&self, index: usize) -> Interval {
        let span = self.domain.slice_span(index).unwrap_or(Interval::ENTIRE);
        Interval::spanning(span.upper(), span.upper()) - span.lower()
    }
}

#[cfg(test)]
mod tests;
