//! A value at an uncertain time: `y = x(t)` with `[t]`, `[y]` and the tube `[x]` all contracted.
//!
//! With a derivative, the trajectory passes through `[y]` at *some* time of `[t]`; which slice that is in is not known. Each
//! slice that `[t]` touches is a case: the passage is in this slice. A case says where the trajectory is before and after,
//! as far as the derivative carries it; the tube keeps the hull of all cases. Gate by gate this takes two sweeps, because
//! the hull of the cases of all earlier slices is carried on as one:
//! `before[i + 1] = (before[i] + D [v]) ∪ passage in slice i, carried to its end`, and `after[i]` the same from the other
//! side; the gate keeps `before[i] ∪ after[i]`.
//!
//! Source: seed 001, section 5.3, after equation (5.7); the constraint is known as the evaluation constraint since S. Rohou's
//! thesis (2017).

use crate::contraction::together;
use crate::enclosure::Enclosure;
use crate::error::{Constraint, TubeError};
use crate::time_domain::{Place, exactly};
use crate::tube::Tube;
use shoal_interval::Interval;
use shoal_interval::contractor::Contracted;

/// How often time and value are contracted by each other, at most.
const PASSES: usize = 8;

impl<T: Enclosure> Tube<T> {
    /// Contracts a time and a value by `value = x(time)`, for an unknown time of `time_s`, in logarithmic time.
    ///
    /// Without a derivative the tube learns nothing, unless the time is exactly a gate, which then keeps what is in the
    /// value. [`contract_evaluation_with_derivative`](Tube::contract_evaluation_with_derivative) is sharper. When nothing
    /// is left, time, value and tube are empty; so they are for an empty time: an observation at no time contradicts itself.
    ///
    /// ```
    /// use shoal_interval::Interval;
    /// use shoal_tube::{TimeDomain, Tube};
    ///
    /// let mut x_m = Tube::from_function(TimeDomain::uniform(0.0, 0.5, 20)?, |t| t * 2.0);
    /// let (mut time_s, mut value_m) = (Interval::new(2.2, 9.0)?, Interval::new(0.0, 7.5)?);
    /// x_m.contract_evaluation(&mut time_s, &mut value_m)?;
    /// assert_eq!((time_s, value_m), (Interval::new(2.2, 4.0)?, Interval::new(4.0, 7.5)?));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When some of the times are outside the domain, where nothing is known. Intersect with the domain's
    /// [span](crate::TimeDomain::span) first if it is sure that the time is inside.
    pub fn contract_evaluation(
        &mut self,
        time_s: &mut Interval,
        value: &mut T,
    ) -> Result<Contracted, TubeError> {
        self.evaluate(None, time_s, value, Constraint::Evaluation)
    }

    /// Contracts a time, a value and the tube by `value = x(time)`, for an unknown time of `time_s`, when the derivative of
    /// `x` is enclosed by `derivative`.
    ///
    /// Only slices that touch the times are narrowed; [`contract_derivative_around`](Tube::contract_derivative_around)
    /// carries it on. The time that it takes grows with their number. When nothing is left, time, value and tube are empty.
    ///
    /// ```
    /// use shoal_interval::Interval;
    /// use shoal_tube::{TimeDomain, Tube};
    ///
    /// // A vehicle at about 1 m/s sees a buoy that is at 5.0 m to 5.2 m, somewhen between 4 s and 6 s.
    /// let speed_m_s = Tube::constant(TimeDomain::uniform(0.0, 0.5, 20)?, Interval::new(0.9, 1.1)?);
    /// let mut x_m = Tube::primitive(&speed_m_s, Interval::new(-1.0, 1.0)?);
    /// let (mut time_s, mut value_m) = (Interval::new(4.0, 6.0)?, Interval::new(5.0, 5.2)?);
    /// x_m.contract_evaluation_with_derivative(&speed_m_s, &mut time_s, &mut value_m)?;
    /// x_m.contract_derivative_around(&speed_m_s, time_s)?;
    /// assert!(x_m.gate(8).unwrap().is_subset_of(Interval::new(2.79, 5.21)?));
    /// assert!(x_m.gate(8).unwrap().contains(4.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When the two tubes are cut at different times, or some of the times are outside the domain, where nothing is known.
    pub fn contract_evaluation_with_derivative(
        &mut self,
        derivative: &Tube<T>,
        time_s: &mut Interval,
        value: &mut T,
    ) -> Result<Contracted, TubeError> {
        self.check_same_domain(derivative)?;
        self.evaluate(Some(derivative), time_s, value, Constraint::Evaluation)
    }

    /// Both of the above, with the constraint to blame for a contradiction. The derivative is cut at the same times.
    pub(super) fn evaluate(
        &mut self,
        derivative: Option<&Tube<T>>,
        time_s: &mut Interval,
        value: &mut T,
        constraint: Constraint,
    ) -> Result<Contracted, TubeError> {
        let (times_s, values, of_tube) = match derivative.filter(|_| self.slice_count() > 0) {
            Some(derivative) => {
                // Fails outside the domain.
                self.over(*time_s)?;
                let passages = self.passages(derivative, *time_s, *value);
                let (times_s, values) = hull(&passages);
                (times_s, values, self.narrow_by_passages(derivative, &passages))
            }
            None => {
                let (times_s, values) = self.passing(None, *time_s, *value)?;
                let narrowed = match self.domain.place_of(times_s.lower()) {
                    Ok(Place::Gate(index)) if times_s.is_point() => self.narrow_gate(index, values),
                    _ => Contracted::Unchanged,
                };
                (times_s, values, narrowed)
            }
        };
        if times_s.is_empty() || values.is_empty() || self.is_empty() {
            if !self.is_empty() {
                self.empty_near(time_s.mid(), constraint);
            }
            (*time_s, *value) = (Interval::EMPTY, T::EMPTY);
            return Ok(self.blamed(Contracted::Empty, constraint));
        }
        let changed = *time_s != times_s || *value != values;
        (*time_s, *value) = (times_s, values);
        Ok(together(of_tube, if changed { Contracted::Narrowed } else { Contracted::Unchanged }))
    }

    /// What is left of the time and the value, without a change of the tube.
    pub(super) fn passing(
        &self,
        derivative: Option<&Tube<T>>,
        time_s: Interval,
        value: T,
    ) -> Result<(Interval, T), TubeError> {
        let (mut times_s, mut values) = (time_s, value & self.over(time_s)?);
        if let Some(derivative) = derivative.filter(|_| self.slice_count() > 0) {
            return Ok(hull(&self.passages(derivative, time_s, value)));
        }
        for _ in 0..PASSES {
            let narrowed_s = self.invert_within(values, times_s);
            values = values & self.over(narrowed_s)?;
            if narrowed_s == times_s {
                break;
            }
            times_s = narrowed_s;
        }
        Ok((times_s, values))
    }

    /// The cases: one a slice that the times touch, empty where the trajectory cannot pass.
    fn passages(&self, derivative: &Tube<T>, time_s: Interval, value: T) -> Vec<Passage<T>> {
        let passage = |index: usize| {
            let slope = derivative.slices[index];
            let times_s = time_s & self.times_in_cones(index, value, slope);
            let values = value & self.hull_in_cones(index, times_s, slope);
            let times_s = if values.is_empty() { Interval::EMPTY } else { times_s };
            Passage { index, times_s, values }
        };
        self.slices_beside(time_s).map(passage).collect()
    }

    /// Narrows the slices of the passages, and the gates beside, to the hull of the cases.
    fn narrow_by_passages(&mut self, derivative: &Tube<T>, passages: &[Passage<T>]) -> Contracted {
        let (Some(first), Some(last)) = (passages.first(), passages.last()) else {
            return Contracted::Unchanged;
        };
        let range = first.index..last.index + 1;

        // At the input gate of each slice: where the trajectory is if it passes in this slice or later.
        let mut after = vec![T::EMPTY; passages.len() + 1];
        for (position, passage) in passages.iter().enumerate().rev() {
            let duration_s = self.domain.duration_at(passage.index);
            let slope = derivative.slices[passage.index];
            let passing = passage.at_input(exactly(self.domain.border_at(passage.index)), slope);
            after[position] =
                self.gates[passage.index] & ((after[position + 1] - slope * duration_s) | passing);
        }

        let mut contracted = Contracted::Unchanged;
        // At the input gate of the slice: where the trajectory is if it passed in an earlier one.
        let mut before = T::EMPTY;
        for (position, passage) in passages.iter().enumerate() {
            let index = passage.index;
            let (start_s, end_s) = (self.domain.border_at(index), self.domain.border_at(index + 1));
            let (slope, duration_s) = (derivative.slices[index], self.domain.duration_at(index));
            let within_s = duration_s | Interval::ZERO;
            let next_before = self.gates[index + 1] & (before + slope * duration_s);
            let slice = ((before + slope * within_s) & (next_before - slope * within_s))
                | (after[position + 1] - slope * within_s)
                | passage.around(exactly(start_s), exactly(end_s), slope);
            contracted = together(contracted, self.narrow_gate(index, before | after[position]));
            contracted = together(contracted, self.narrow_slice(index, slice));
            before = next_before | (self.gates[index + 1] & passage.at_output(exactly(end_s), slope));
        }
        contracted = together(contracted, self.narrow_gate(range.end, before));
        if contracted != Contracted::Unchanged {
            self.refresh(range);
        }
        contracted
    }
}

/// The case that the trajectory passes through the value in this slice.
#[derive(Debug, Clone, Copy)]
struct Passage<T> {
    index: usize,
    /// When it may pass.
    times_s: Interval,
    /// Where it may pass.
    values: T,
}

impl<T: Enclosure> Passage<T> {
    /// Where the trajectory then is at the start of the slice.
    fn at_input(&self, start_s: Interval, slope: T) -> T {
        self.values - slope * since(start_s, self.times_s)
    }

    /// Where the trajectory then is at the end of the slice.
    fn at_output(&self, end_s: Interval, slope: T) -> T {
        self.values + slope * since(self.times_s, end_s)
    }

    /// Where the trajectory then is over all of the slice.
    fn around(&self, start_s: Interval, end_s: Interval, slope: T) -> T {
        if self.times_s.is_empty() {
            return T::EMPTY;
        }
        let earlier_s = since(start_s, self.times_s) | Interval::ZERO;
        let later_s = since(self.times_s, end_s) | Interval::ZERO;
        (self.values - slope * earlier_s) | (self.values + slope * later_s)
    }
}

/// The times and the values of all cases.
fn hull<T: Enclosure>(passages: &[Passage<T>]) -> (Interval, T) {
    passages.iter().fold((Interval::EMPTY, T::EMPTY), |(times_s, values), passage| {
        (times_s | passage.times_s, values | passage.values)
    })
}

/// How long it is from the times of `from_s` to those of `to_s`, which are not earlier.
fn since(from_s: Interval, to_s: Interval) -> Interval {
    (to_s - from_s) & Interval::NON_NEGATIVE
}

#[cfg(test)]
mod tests;
