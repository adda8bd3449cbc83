//! Intervals, boxes and matrices in messages and files: bounds in pairs, checked when they are read.

use crate::error::IntervalError;
use crate::interval::Interval;
use crate::interval_box::IntervalBox;
use crate::interval_matrix::IntervalMatrix;
use serde::de::{Error, SeqAccess, Visitor};
use serde::ser::SerializeTuple;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;
use std::marker::PhantomData;

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

/// Writes the sides in the order of the axes, as a tuple.
impl<const N: usize> Serialize for IntervalBox<N> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Tuple(self.sides()).serialize(serializer)
    }
}

/// Reads as many sides as the box has axes.
impl<'de, const N: usize> Deserialize<'de> for IntervalBox<N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<IntervalBox<N>, D::Error> {
        Ok(IntervalBox::from(Tuple::deserialize(deserializer)?.0))
    }
}

/// Writes a tuple of rows, each a tuple of entries.
impl<const R: usize, const C: usize> Serialize for IntervalMatrix<R, C> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Tuple(self.rows().map(Tuple)).serialize(serializer)
    }
}

/// Reads as many rows and columns as the matrix has.
impl<'de, const R: usize, const C: usize> Deserialize<'de> for IntervalMatrix<R, C> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<IntervalMatrix<R, C>, D::Error> {
        let rows: [Tuple<Interval, C>; R] = Tuple::deserialize(deserializer)?.0;
        Ok(IntervalMatrix::from(rows.map(|row| row.0)))
    }
}

/// An array of any length, which serde by itself does not know how to write.
struct Tuple<T, const N: usize>([T; N]);

impl<T: Serialize, const N: usize> Serialize for Tuple<T, N> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut tuple = serializer.serialize_tuple(N)?;
        for item in &self.0 {
            tuple.serialize_element(item)?;
        }
        tuple.end()
    }
}

impl<'de, T: Deserialize<'de>, const N: usize> Deserialize<'de> for Tuple<T, N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Tuple<T, N>, D::Error> {
        deserializer.deserialize_tuple(N, TupleVisitor(PhantomData))
    }
}

struct TupleVisitor<T, const N: usize>(PhantomData<T>);

impl<'de, T: Deserialize<'de>, const N: usize> Visitor<'de> for TupleVisitor<T, N> {
    type Value = Tuple<T, N>;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "a sequence of {N}")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Tuple<T, N>, A::Error> {
        let mut read = Vec::with_capacity(N);
        while read.len() < N {
            let item = items.next_element()?.ok_or_else(|| A::Error::invalid_length(read.len(), &self))?;
            read.push(item);
        }
        let length = read.len();
        read.try_into().map(Tuple).map_err(|_| A::Error::invalid_length(length, &self))
    }
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

    fn numbers(values: [f64; 4]) -> Result<IntervalBox<2>, ReadError> {
        let sides = [[values[0], values[1]], [values[2], values[3]]];
        let sides = sides.map(|side| SeqDeserializer::new(side.into_iter()));
        IntervalBox::deserialize(SeqDeserializer::new(sides.into_iter()))
    }

    #[test]
    fn boxes_are_read_side_by_side() {
        let sides = numbers([1.0, 2.0, -3.0, f64::INFINITY]).unwrap();
        assert_eq!(sides[1], Interval::new(-3.0, f64::INFINITY).unwrap());
        assert!(numbers([1.0, 2.0, 4.0, 3.0]).is_err());
        let short = SeqDeserializer::new([SeqDeserializer::new([1.0, 2.0].into_iter())].into_iter());
        let mistake: ReadError = IntervalBox::<2>::deserialize(short).unwrap_err();
        assert_eq!(mistake.to_string(), "invalid length 1, expected a sequence of 2");
    }

    #[test]
    fn matrices_are_read_row_by_row() {
        let entry = |value: f64| SeqDeserializer::new([value, value].into_iter());
        let rows =
            [[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]].map(|row| SeqDeserializer::new(row.map(entry).into_iter()));
        let read: Result<IntervalMatrix<3, 2>, ReadError> =
            IntervalMatrix::deserialize(SeqDeserializer::new(rows.into_iter()));
        assert_eq!(read.unwrap()[(2, 0)], Interval::point(5.0).unwrap());
    }
}
