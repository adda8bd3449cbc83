//! Intervals in messages and files: a pair of bounds, checked when it is read.

use crate::error::IntervalError;
use crate::interval::Interval;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Writes the pair `(lower, upper)`; the empty set is `(+inf, -inf)`, so a format must be able to hold infinities.
impl Serialize for Interval {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        (self.lower(), self.upper()).serialize(serializer)
    }
}

/// Reads the pair `(lower, upper)` and refuses what [`Interval::new`] refuses, except the bounds of the empty set.
impl<'de> Deserialize<'de> for Interval {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Interval, D::Error> {
        let (lower, upper) = <(f64, f64)>::deserialize(deserializer)?;
        interval_or_empty(lower, upper).map_err(D::Error::custom)
    }
}

fn interval_or_empty(lower: f64, upper: f64) -> Result<Interval, IntervalError> {
    if (lower, upper) == (Interval::EMPTY.lower(), Interval::EMPTY.upper()) {
        return Ok(Interval::EMPTY);
    }
    Interval::new(lower, upper)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::de::value::{Error as ReadError, SeqDeserializer};

    fn read(lower: f64, upper: f64) -> Result<Interval, ReadError> {
        Interval::deserialize(SeqDeserializer::new([lower, upper].into_iter()))
    }

    #[test]
    fn bounds_are_checked_when_read() {
        assert_eq!(read(1.0, 2.0), Interval::new(1.0, 2.0).map_err(ReadError::custom));
        assert_eq!(read(f64::INFINITY, f64::NEG_INFINITY), Ok(Interval::EMPTY));
        assert!(read(2.0, 1.0).is_err());
        assert!(read(f64::NAN, 1.0).is_err());
    }
}
