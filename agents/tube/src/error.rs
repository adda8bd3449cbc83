//! What can be wrong with a question to a tube, and where a tube became empty.

use crate::time_domain::Place;
use shoal_interval::Interval;
use std::fmt;
use thiserror::Error;

/// Why a time domain or a tube refused what it was given. A tube that turned out empty is not an error.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum TubeError {
    /// A time is NaN or infinite.
    #[error("a time must be a finite number of seconds, not {time_s}")]
    NotATime {
        /// The time that was given, in seconds.
        time_s: f64,
    },
    /// A border of the time domain does not come after the one before.
    #[error("the borders of a time domain must increase: {next_s} s does not come after {previous_s} s")]
    Unsorted {
        /// The border before, in seconds.
        previous_s: f64,
        /// The border that should come after it, in seconds.
        next_s: f64,
    },
    /// Steps must be positive, and large enough that no two borders are rounded to one.
    #[error(
        "a step of {step_s:?} s must be positive, and large enough that borders up to {time_s:?} s differ"
    )]
    StepTooSmall {
        /// The step, in seconds.
        step_s: f64,
        /// The largest time of the domain, in seconds.
        time_s: f64,
    },
    /// A time domain needs at least one border.
    #[error("a time domain needs at least one border")]
    NoBorder,
    /// Nothing is known outside the time domain.
    #[error("{time_s} s is outside the time domain, {start_s} s to {end_s} s")]
    OutsideDomain {
        /// The time that was asked for, in seconds.
        time_s: f64,
        /// The start of the time domain, in seconds.
        start_s: f64,
        /// The end of the time domain, in seconds.
        end_s: f64,
    },
    /// There is no slice with this index.
    #[error("there is no slice {index}, the tube has {count}")]
    NoSuchSlice {
        /// The index that was asked for.
        index: usize,
        /// The number of slices.
        count: usize,
    },
    /// There is no gate with this index.
    #[error("there is no gate {index}, the tube has {count}")]
    NoSuchGate {
        /// The index that was asked for.
        index: usize,
        /// The number of gates, one more than slices.
        count: usize,
    },
    /// A tube has as many slices as its domain, and one gate more.
    #[error(
        "a domain of {expected} slices needs {expected} values and one gate more, not {slices} and {gates}"
    )]
    WrongCount {
        /// The number of slices of the domain.
        expected: usize,
        /// The number of slices that were given.
        slices: usize,
        /// The number of gates that were given.
        gates: usize,
    },
    /// Two tubes that are taken together must be cut at the same times.
    #[error(
        "the two tubes are cut at different times: give both a clone of one domain, or bring one to the other's with `resampled`"
    )]
    DifferentDomains,
}

/// The place where a tube is empty, and its times: what to look at when a model contradicts what was measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Emptied {
    /// The slice or the gate that is empty.
    pub place: Place,
    /// When that is, in seconds.
    pub times_s: Interval,
    /// What the trajectory should have obeyed when nothing was left, if that is known.
    pub constraint: Option<Constraint>,
}

impl Emptied {
    /// The same after `count` slices were dropped at the front; `None` if it is gone with them.
    pub(crate) fn without_front(self, count: usize) -> Option<Emptied> {
        let place = match self.place {
            Place::Gate(index) => Place::Gate(index.checked_sub(count)?),
            Place::Slice(index) => Place::Slice(index.checked_sub(count)?),
        };
        Some(Emptied { place, ..self })
    }
}

impl fmt::Display for Emptied {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (from_s, to_s) = (self.times_s.lower(), self.times_s.upper());
        match self.place {
            Place::Gate(index) => write!(formatter, "gate {index}, at {from_s} s, is empty"),
            Place::Slice(index) => write!(formatter, "slice {index}, from {from_s} s to {to_s} s, is empty"),
        }?;
        self.constraint.map_or(Ok(()), |constraint| write!(formatter, ": emptied by {constraint}"))
    }
}

/// What a trajectory must obey: the name of what contracts tubes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Constraint {
    /// A value at one time or over one slice.
    Value,
    /// A derivative.
    Derivative,
    /// One trajectory never above another.
    Order,
    /// Two trajectories that are one.
    Equality,
    /// A trajectory that follows another after a delay.
    Delay,
    /// A trajectory that repeats itself.
    Periodicity,
    /// A trajectory that is its own mirror image, in time or in a point.
    Symmetry,
    /// A value at an uncertain time.
    Evaluation,
    /// A trajectory after another, `x(h(t)) = y(t)`.
    Composition,
    /// A state equation.
    StateEquation,
    /// An equation between values of the same time.
    Algebraic,
    /// The time that sound took between two trajectories.
    Ping,
}

impl fmt::Display for Constraint {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Constraint::Value => "a value",
            Constraint::Derivative => "the derivative",
            Constraint::Order => "an order",
            Constraint::Equality => "an equality",
            Constraint::Delay => "a delay",
            Constraint::Periodicity => "a period",
            Constraint::Symmetry => "a symmetry",
            Constraint::Evaluation => "a value at an uncertain time",
            Constraint::Composition => "a composition",
            Constraint::StateEquation => "the state equation",
            Constraint::Algebraic => "an algebraic constraint",
            Constraint::Ping => "a ping",
        })
    }
}
