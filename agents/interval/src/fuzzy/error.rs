//! What is not a grade, a score function or a fuzzy set.

use super::Grade;
use thiserror::Error;

/// Why a grade, a score function or what is made of them was refused.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum FuzzyError {
    /// A grade is above one, or its denominator is zero.
    #[error("{numerator}/{denominator} is not a grade: grades go from 0 to 1")]
    Grade {
        /// The numerator that was asked for.
        numerator: u32,
        /// The denominator that was asked for.
        denominator: u32,
    },
    /// A mean has no weight that is not zero, or a least or greatest score has no parts: its value is not defined.
    #[error("a mean needs a weight that is not zero, a least or greatest score needs a part")]
    NoWeight,
    /// The common denominator of all values of a score function is too large to compute with exactly.
    #[error(
        "the weights of a score function have a common denominator above {}: use smaller whole numbers",
        u32::MAX
    )]
    TooFine,
    /// A score function asks for a granule that is not there.
    #[error("a score function uses granule {granule}, but there are only {granules}, counted from zero")]
    NoSuchGranule {
        /// Which granule it uses.
        granule: usize,
        /// How many granules there are.
        granules: usize,
    },
    /// A closure cannot be checked for so many granules, since it has to be asked about every combination.
    #[error(
        "a score function given as a closure can have {limit} granules at most, not {granules}: build it from `Score`"
    )]
    TooManyGranules {
        /// How many granules were asked for.
        granules: usize,
        /// How many are possible.
        limit: usize,
    },
    /// A score function does not give 0 for no granule, or not 1 for all.
    #[error("a score function must be 0 in no granule and 1 in all, not {none} and {all}")]
    Ends {
        /// Its value in no granule.
        none: Grade,
        /// Its value in all granules.
        all: Grade,
    },
    /// A score function falls when a vector is in one granule more.
    #[error(
        "a score function must not fall, but being in granule {granule} as well lowers it from {without} to {with}"
    )]
    NotMonotone {
        /// The granule that lowers it.
        granule: usize,
        /// Its value without.
        without: Grade,
        /// Its value with it.
        with: Grade,
    },
    /// The number of granules is not that of the score function.
    #[error("a score function of {expected} granules was given {given}")]
    GranuleCount {
        /// How many granules the score function has.
        expected: usize,
        /// How many were given.
        given: usize,
    },
    /// The core of a fuzzy set is empty or not inside its support.
    #[error("the core of a fuzzy set must be an interval inside of its support")]
    Core,
}
