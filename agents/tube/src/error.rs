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
    #[error("a step of {step_s} s is not positive or too small to be told apart at {time_s} s")]
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
    #[error("the two tubes are cut at different times")]
    DifferentDomains,
}

/// The place where a tube is empty, and its times: what to look at when a model contradicts what was measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Emptied {
    /// The slice or the gate that is empty.
    pub place: Place,
    /// When that is, in seconds.
    pub times_s: Interval,
}

impl fmt::Display for Emptied {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (from_s, to_s) = (self.times_s.lower(), self.times_s.upper());
        match self.place {
            Place::Gate(index) => write!(formatter, "gate {index}, at {from_s} s, is empty"),
            Place::Slice(index) => write!(formatter, "slice {index}, from {from_s} s to {to_s} s, is empty"),
        }
    }
}
