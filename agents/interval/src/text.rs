//! Intervals as text: read and written outwards, so that neither loses a number.
//!
//! What is written can be read back: in decimals it comes back as the same set or a wider one, in hexadecimals
//! (`{:x}`) as the same.
//!
//! Source: IEEE 1788-2015, clauses 9.7 (literals, constructors) and 12.11 (number and interval literals), 13.3 and 13.4 (output
//! that encloses, exact text).

mod decimal;
mod display;
mod error;
mod exact;
mod literal;
mod natural;

pub use error::ParseIntervalError;

use crate::interval::Interval;
use std::str::FromStr;

/// Reads an interval literal of IEEE 1788, or a plain number, as the smallest interval that holds what is written.
///
/// | text | means |
/// |---|---|
/// | `[1.1, 2.3]`, `[0x1.8p-4, 0x1p3]`, `[1/3, 2/3]` | from the one to the other, decimal, hexadecimal or rational |
/// | `[1.1]`, `1.1` | the number, which may lie between two `f64` |
/// | `[-inf, 3]`, `[, 3]`, `[1.5, infinity]`, `[1.5,]` | no bound on one side |
/// | `[entire]`, `[,]`, `entire` | every number |
/// | `[empty]`, `[]`, `empty` | no number |
/// | `3.56?1`, `3.56?`, `3.56?1e2` | 3.56 within 1 (or a half) in the last place, times a power of ten |
/// | `2.50?3u`, `2.50?3d` | the same, upwards or downwards only |
/// | `2.5??`, `2.5??u`, `2.5??d` | within an unknown radius |
///
/// Letters may be upper or lower case, blanks may surround bounds. The lower bound is rounded down, the upper one up, exactly,
/// however many digits there are and however large the exponent is. Bounds are put in order after rounding: two that are inverted
/// by less than that pass, as in the standard. Decorations are refused.
///
/// ```
/// use shoal_interval::Interval;
///
/// let tenth: Interval = "0.1".parse()?;
/// assert_eq!(tenth, Interval::new(0.1_f64.next_down(), 0.1)?);
/// let depth_m: Interval = "12.5?2".parse()?;
/// assert!(depth_m.contains(12.3) && depth_m.contains(12.7));
/// let mistake = "[1.0, 2.O]".parse::<Interval>().unwrap_err();
/// assert_eq!(mistake.to_string(), "expected `]`, found `O` at character 9");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
impl FromStr for Interval {
    type Err = ParseIntervalError;

    fn from_str(text: &str) -> Result<Interval, ParseIntervalError> {
        literal::read(text)
    }
}

#[cfg(test)]
mod tests;
