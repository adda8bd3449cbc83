//! Sums, products and determinants of interval matrices, rounded outwards at each of the operations.

use super::IntervalMatrix;
use crate::interval::Interval;
use crate::interval_box::IntervalBox;
use std::ops::{Add, Mul, Neg, Sub};

impl IntervalMatrix<2, 2> {
    /// The determinants of the matrices. Minimal up to rounding: each entry is used once.
    #[inline]
    pub fn determinant(&self) -> Interval {
        if self.is_empty() {
            return Interval::EMPTY;
        }
        let [[a, b], [c, d]] = self.rows;
        a * d - b * c
    }
}

impl IntervalMatrix<3, 3> {
    /// An enclosure of the determinants of the matrices: what is common to the expansions along each row. Entries are
    /// used more than once, so it is not minimal for wide ones.
    pub fn determinant(&self) -> Interval {
        if self.is_empty() {
            return Interval::EMPTY;
        }
        let minor = |row: usize, column: usize| {
            let others = |index: usize| ((index + 1) % 3, (index + 2) % 3);
            let ((above, below), (left, right)) = (others(row), others(column));
            let rows = &self.rows;
            rows[above][left] * rows[below][right] - rows[above][right] * rows[below][left]
        };
        (0..3)
            .map(|row| {
                let [a, b, c] = self.rows[row];
                a * minor(row, 0) + b * minor(row, 1) + c * minor(row, 2)
            })
            .fold(Interval::ENTIRE, Interval::intersection)
    }
}

/// The sum of the products of each of `row` with one of `column`: exact when there is one, zero when there is none.
#[inline]
fn dot<const K: usize>(row: &[Interval; K], column: impl Fn(usize) -> Interval) -> Interval {
    // A loop, because chained iterators are not inlined where it matters.
    let mut sum = Interval::ZERO;
    for (index, &entry) in row.iter().enumerate() {
        let product = entry * column(index);
        sum = if index == 0 { product } else { sum + product };
    }
    sum
}

/// The products of a matrix of each. An entry is minimal up to rounding; the set of all products is not a product of
/// intervals, so the result holds other matrices, too.
impl<const R: usize, const K: usize, const C: usize> Mul<IntervalMatrix<K, C>> for IntervalMatrix<R, K> {
    type Output = IntervalMatrix<R, C>;

    #[inline]
    fn mul(self, other: IntervalMatrix<K, C>) -> IntervalMatrix<R, C> {
        if self.is_empty() || other.is_empty() {
            return IntervalMatrix::EMPTY;
        }
        IntervalMatrix::from_fn(|row, column| dot(&self.rows[row], |index| other.rows[index][column]))
    }
}

/// The smallest box, up to rounding, that holds the products of a matrix and a vector.
impl<const R: usize, const C: usize> Mul<IntervalBox<C>> for IntervalMatrix<R, C> {
    type Output = IntervalBox<R>;

    #[inline]
    fn mul(self, vector: IntervalBox<C>) -> IntervalBox<R> {
        if self.is_empty() || vector.is_empty() {
            return IntervalBox::EMPTY;
        }
        IntervalBox::from(self.rows.map(|row| dot(&row, |index| vector[index])))
    }
}

/// Every entry times the same set of numbers.
impl<const R: usize, const C: usize> Mul<Interval> for IntervalMatrix<R, C> {
    type Output = IntervalMatrix<R, C>;

    #[inline]
    fn mul(self, factor: Interval) -> IntervalMatrix<R, C> {
        self.map(|entry| entry * factor)
    }
}

/// Every entry times the same number; a NaN stands for any number.
impl<const R: usize, const C: usize> Mul<f64> for IntervalMatrix<R, C> {
    type Output = IntervalMatrix<R, C>;

    #[inline]
    fn mul(self, factor: f64) -> IntervalMatrix<R, C> {
        self.map(|entry| entry * factor)
    }
}

impl<const R: usize, const C: usize> Add for IntervalMatrix<R, C> {
    type Output = IntervalMatrix<R, C>;

    #[inline]
    fn add(self, other: IntervalMatrix<R, C>) -> IntervalMatrix<R, C> {
        self.zip(&other, |a, b| a + b)
    }
}

impl<const R: usize, const C: usize> Sub for IntervalMatrix<R, C> {
    type Output = IntervalMatrix<R, C>;

    #[inline]
    fn sub(self, other: IntervalMatrix<R, C>) -> IntervalMatrix<R, C> {
        self.zip(&other, |a, b| a - b)
    }
}

impl<const R: usize, const C: usize> Neg for IntervalMatrix<R, C> {
    type Output = IntervalMatrix<R, C>;

    #[inline]
    fn neg(self) -> IntervalMatrix<R, C> {
        self.map(|entry| -entry)
    }
}
