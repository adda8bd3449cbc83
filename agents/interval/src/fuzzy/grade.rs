//! Grades of membership.

use super::FuzzyError;
use crate::interval::Interval;
use std::cmp::Ordering;
use std::fmt;

/// A grade of membership: a fraction from 0 to 1, compared exactly.
///
/// ```
/// use shoal_interval::fuzzy::Grade;
///
/// assert_eq!(Grade::new(2, 4)?, Grade::new(1, 2)?);
/// assert!(Grade::new(1, 5)? < Grade::ONE);
/// assert!(Grade::new(6, 5).is_err());
/// # Ok::<(), shoal_interval::fuzzy::FuzzyError>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Grade {
    numerator: u32,
    denominator: u32,
}

impl Grade {
    /// No membership at all.
    pub const ZERO: Grade = Grade { numerator: 0, denominator: 1 };

    /// Full membership: the alpha-cut at it is the core.
    pub const ONE: Grade = Grade { numerator: 1, denominator: 1 };

    /// The grade `numerator / denominator`.
    ///
    /// # Errors
    /// [`FuzzyError::Grade`] when the fraction is above one or the denominator is zero.
    pub fn new(numerator: u32, denominator: u32) -> Result<Grade, FuzzyError> {
        if denominator == 0 || numerator > denominator {
            return Err(FuzzyError::Grade { numerator, denominator });
        }
        Ok(Grade { numerator, denominator })
    }

    /// A fraction that is known to be one.
    pub(super) fn from_parts(numerator: u32, denominator: u32) -> Grade {
        debug_assert!(denominator > 0 && numerator <= denominator);
        Grade { numerator, denominator }
    }

    pub(super) fn parts(self) -> (u32, u32) {
        (self.numerator, self.denominator)
    }

    /// The smallest interval of `f64` bounds that holds the grade.
    pub fn to_interval(self) -> Interval {
        Interval::spanning(f64::from(self.numerator), f64::from(self.numerator)) / f64::from(self.denominator)
    }
}

impl PartialEq for Grade {
    fn eq(&self, other: &Grade) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Grade {}

impl PartialOrd for Grade {
    fn partial_cmp(&self, other: &Grade) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Grade {
    fn cmp(&self, other: &Grade) -> Ordering {
        let left = u64::from(self.numerator) * u64::from(other.denominator);
        left.cmp(&(u64::from(other.numerator) * u64::from(self.denominator)))
    }
}

/// Writes the fraction.
impl fmt::Display for Grade {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}/{}", self.numerator, self.denominator)
    }
}
