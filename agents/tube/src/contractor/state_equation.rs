//! A trajectory that obeys a state equation.

use super::asynchronous::both_or_none;
use crate::contraction::together;
use crate::derivative::Direction;
use crate::enclosure::Enclosure;
use crate::error::{Constraint, TubeError};
use crate::tube::Tube;
use shoal_interval::Interval;
use shoal_interval::contractor::Contracted;

impl<T: Enclosure> Tube<T> {
    /// Removes every trajectory that does not obey `dx/dt = f(t, x)`. `rate` is an inclusion function of `f`: given an
    /// interval of time, in seconds, and a set of states, it returns a set that holds the derivative for all of them.
    ///
    /// Inputs, which may jump, are read by `rate`: it is only asked about the times of one slice at once. Each pass goes
    /// through the slices in `direction` and carries every gate through the slice at the rates that the slice allows; passes
    /// are repeated, `passes` times at most, until one removes nothing.
    ///
    /// The tube must be bounded already where `f` is not: this finds no first enclosure of a flow.
    ///
    /// ```
    /// use shoal_interval::{Interval, IntervalBox};
    /// use shoal_tube::{Direction, TimeDomain, Tube};
    ///
    /// // A pendulum: position and speed, seen at the start and after half a second.
    /// let time = TimeDomain::uniform(0.0, 0.01, 50)?;
    /// let mut state = Tube::constant(time, IntervalBox::from([Interval::new(-1.0, 1.0)?; 2]));
    /// state.contract_gate(0, &IntervalBox::from([Interval::new(0.5, 0.5)?, Interval::ZERO]))?;
    /// state.contract_state_equation(
    ///     |_, state| IntervalBox::from([state[1], -state[0].sin()]),
    ///     Direction::Both,
    ///     10,
    /// );
    /// assert!(state.last_gate()[0].contains(0.4418) && state.last_gate().width() < 0.05);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// Source: seed 001, equation (4.22), tables 4.1 and 4.2 with enclosures in place of Euler's steps; equation (5.5).
    pub fn contract_state_equation(
        &mut self,
        mut rate: impl FnMut(Interval, T) -> T,
        direction: Direction,
        passes: usize,
    ) -> Contracted {
        let mut contracted = Contracted::Unchanged;
        let all = 0..self.slice_count();
        for _ in 0..passes {
            let mut pass = Contracted::Unchanged;
            if direction != Direction::Backward {
                for index in all.clone() {
                    let slope = rate(self.domain.span_at(index), self.slices[index]);
                    pass = together(pass, self.carry_forward(index, slope));
                }
            }
            if direction != Direction::Forward {
                for index in all.clone().rev() {
                    let slope = rate(self.domain.span_at(index), self.slices[index]);
                    pass = together(pass, self.carry_backward(index, slope));
                }
            }
            contracted = together(contracted, pass);
            if pass != Contracted::Narrowed {
                break;
            }
        }
        if contracted != Contracted::Unchanged {
            self.refresh(all);
        }
        self.blamed(contracted, Constraint::StateEquation)
    }
}

/// Contracts a state and its derivative by `dx/dt = f(x, u)` with an input `u`. `rate` is an inclusion function of `f`: it
/// returns a set that holds the derivative for all states and inputs of the sets it is given.
///
/// Each pass narrows the derivative to what state and input allow, and the state by the derivative, forward and backward in
/// time; passes are repeated, `passes` times at most, until one removes nothing. The derivative is continuous, as all
/// trajectories of tubes are; for inputs that jump use
/// [`contract_state_equation`](Tube::contract_state_equation), which keeps no derivative.
///
/// ```
/// use shoal_interval::{Interval, IntervalBox};
/// use shoal_tube::contractor::contract_chain;
/// use shoal_tube::{TimeDomain, Tube};
///
/// // A vehicle at 2 m/s that turns slowly.
/// let time = TimeDomain::uniform(0.0, 0.1, 50)?;
/// let heading_rad = Tube::from_function(time.clone(), |t| t * 0.1);
/// let mut position_m = Tube::constant(time.clone(), IntervalBox::ENTIRE);
/// let mut velocity_m_s = Tube::constant(time, IntervalBox::<2>::ENTIRE);
/// position_m.contract_gate(0, &IntervalBox::from([Interval::ZERO; 2]))?;
/// contract_chain(&mut position_m, &mut velocity_m_s, &heading_rad, 5, |_, heading| {
///     IntervalBox::from([heading.cos() * 2.0, heading.sin() * 2.0])
/// })?;
/// // It ends at x = 20 sin(0.5).
/// assert!(position_m.last_gate()[0].contains(9.58851) && position_m.last_gate().width() < 0.1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When the tubes are not all cut at the same times.
///
/// Source: seed 001, equations (4.22) and (5.5).
pub fn contract_chain<T: Enclosure, U: Enclosure>(
    state: &mut Tube<T>,
    derivative: &mut Tube<T>,
    input: &Tube<U>,
    passes: usize,
    mut rate: impl FnMut(T, U) -> T,
) -> Result<Contracted, TubeError> {
    state.check_same_domain(derivative)?;
    state.check_same_domain(input)?;
    let mut contracted = Contracted::Unchanged;
    for _ in 0..passes {
        let mut pass = Contracted::Unchanged;
        for place in state.domain.places() {
            let value = rate(state.set_at(place), input.set_at(place));
            pass = together(pass, derivative.narrow_at(place, value));
        }
        if pass != Contracted::Unchanged {
            derivative.refresh(0..derivative.slice_count());
        }
        derivative.blamed(pass, Constraint::StateEquation);
        pass = together(pass, state.contract_derivative(derivative, Direction::Both)?);
        contracted = together(contracted, pass);
        if pass != Contracted::Narrowed {
            break;
        }
    }
    Ok(both_or_none(state, derivative, contracted, Constraint::StateEquation))
}
