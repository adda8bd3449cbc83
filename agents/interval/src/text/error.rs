//! Why a text is not an interval.

use crate::error::IntervalError;
use thiserror::Error;

/// Why a text could not be read as an [`Interval`](crate::Interval). Characters are counted from 1.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ParseIntervalError {
    /// A character is not what may stand there.
    #[error("expected {expected}, found `{found}` at character {character}")]
    Unexpected {
        /// What could have stood there.
        expected: &'static str,
        /// What stands there.
        found: char,
        /// Where it stands.
        character: usize,
    },
    /// The text ends too early.
    #[error("expected {expected} at the end of the text")]
    Incomplete {
        /// What could have followed.
        expected: &'static str,
    },
    /// The denominator of a fraction is zero.
    #[error("the denominator that ends before character {character} is zero")]
    ZeroDenominator {
        /// The place after the denominator.
        character: usize,
    },
    /// The text reads well, but its bounds are not those of an interval.
    #[error(transparent)]
    Bounds(#[from] IntervalError),
    /// The text is longer than [`ParseIntervalError::LONGEST`].
    #[error("an interval takes at most {longest} bytes of text, not {length}", longest = Self::LONGEST)]
    TooLong {
        /// The length of the text in bytes.
        length: usize,
    },
}

impl ParseIntervalError {
    /// The longest text that is read, in bytes. Exact arithmetic on longer ones would take noticeable time.
    pub const LONGEST: usize = 1 << 16;
}
