//! What can be wrong with a question to a tube.

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
    /// Two tubes that are taken together must be cut at the same times.
    #[error("the two tubes are cut at different times")]
    DifferentDomains,
}
