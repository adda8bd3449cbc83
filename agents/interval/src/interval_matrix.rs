//! The interval matrix: a matrix whose entries are only known to lie in intervals.

use crate::interval::Interval;
use nalgebra::SMatrix;
use std::fmt;
use std::ops::{BitAnd, BitOr, Index, IndexMut};

mod arithmetic;
mod rotation;

/// The matrices of `R` rows and `C` columns whose every entry is in the interval of its place.
///
/// A matrix with one empty entry is empty, whatever its other entries; what the operations return is then
/// [`IntervalMatrix::EMPTY`]. Matrices are small and of fixed size: they are copied, and nothing is allocated.
///
/// ```
/// use shoal_interval::{Interval, IntervalBox, IntervalMatrix};
///
/// let quarter_turn = Interval::point(std::f64::consts::FRAC_PI_2)?.inflate(0.01);
/// let velocity_m_s = IntervalBox::from([Interval::new(1.0, 1.25)?, Interval::ZERO]);
/// let turned_m_s = IntervalMatrix::rotation_2d(quarter_turn) * velocity_m_s;
/// assert_eq!(format!("{turned_m_s:.2}"), "[-0.02, 0.02] x [0.99, 1.25]");
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
///
/// Source: seed 003, section 5 (rotations); L. Jaulin et al., *Applied Interval Analysis*, 2001, section 2.3.5.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IntervalMatrix<const R: usize, const C: usize> {
    rows: [[Interval; C]; R],
}

impl<const R: usize, const C: usize> IntervalMatrix<R, C> {
    /// No matrix at all.
    pub const EMPTY: IntervalMatrix<R, C> = IntervalMatrix { rows: [[Interval::EMPTY; C]; R] };

    /// Every matrix.
    pub const ENTIRE: IntervalMatrix<R, C> = IntervalMatrix { rows: [[Interval::ENTIRE; C]; R] };

    /// The matrix of zeros.
    pub const ZERO: IntervalMatrix<R, C> = IntervalMatrix { rows: [[Interval::ZERO; C]; R] };

    /// The matrix whose entry in each row and column is what `entry(row, column)` gives.
    #[inline]
    pub fn from_fn(mut entry: impl FnMut(usize, usize) -> Interval) -> IntervalMatrix<R, C> {
        // Loops, because nested closures are not inlined where it matters.
        let mut rows = [[Interval::ZERO; C]; R];
        for (row, entries) in rows.iter_mut().enumerate() {
            for (column, place) in entries.iter_mut().enumerate() {
                *place = entry(row, column);
            }
        }
        IntervalMatrix { rows }
    }

    /// The rows, each an array of the entries of its columns.
    #[inline]
    pub const fn rows(&self) -> &[[Interval; C]; R] {
        &self.rows
    }

    /// Whether no matrix is in the set.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.rows.iter().flatten().any(|entry| entry.is_empty())
    }

    /// Whether every entry lies between two finite numbers. The empty set does.
    pub fn is_bounded(&self) -> bool {
        self.is_empty() || self.rows.iter().flatten().all(|entry| entry.is_bounded())
    }

    /// Whether `matrix` is in the set. One with an entry that is NaN or infinite is in none.
    ///
    /// ```
    /// use nalgebra::Matrix2;
    /// use shoal_interval::{Interval, IntervalMatrix};
    ///
    /// let level = IntervalMatrix::rotation_2d(Interval::new(-0.1, 0.1)?);
    /// assert!(level.contains(&Matrix2::identity()));
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    pub fn contains(&self, matrix: &SMatrix<f64, R, C>) -> bool {
        (0..R).all(|row| (0..C).all(|column| self.rows[row][column].contains(matrix[(row, column)])))
    }

    /// Whether every matrix of `self` is in `other`. The empty set is inside every set.
    pub fn is_subset_of(&self, other: &IntervalMatrix<R, C>) -> bool {
        self.is_empty()
            || (0..R).all(|row| (0..C).all(|column| self[(row, column)].is_subset_of(other[(row, column)])))
    }

    /// The matrices that are in both; also written `x & y`. Exact.
    #[inline]
    pub fn intersection(&self, other: &IntervalMatrix<R, C>) -> IntervalMatrix<R, C> {
        self.zip(other, Interval::intersection)
    }

    /// The smallest interval matrix that holds both; also written `x | y`. Exact.
    #[inline]
    pub fn hull(&self, other: &IntervalMatrix<R, C>) -> IntervalMatrix<R, C> {
        if self.is_empty() {
            return other.or_empty();
        }
        if other.is_empty() {
            return *self;
        }
        self.zip(other, Interval::hull)
    }

    /// A matrix near the middle, always finite and in the set; all NaN for the empty set.
    pub fn mid(&self) -> SMatrix<f64, R, C> {
        let entries = self.or_empty();
        SMatrix::from_fn(|row, column| entries[(row, column)].mid())
    }

    /// The width of the widest entry, rounded up; NaN for the empty set.
    pub fn width(&self) -> f64 {
        if self.is_empty() {
            return f64::NAN;
        }
        self.rows.iter().flatten().map(|entry| entry.width()).fold(0.0, f64::max)
    }

    /// Rows as columns. Exact.
    ///
    /// The transpose of a rotation turns back.
    #[inline]
    pub fn transpose(&self) -> IntervalMatrix<C, R> {
        IntervalMatrix::from_fn(|row, column| self.rows[column][row])
    }

    /// The matrix with `change` applied to each entry.
    #[inline]
    pub fn map(&self, mut change: impl FnMut(Interval) -> Interval) -> IntervalMatrix<R, C> {
        if self.is_empty() {
            return IntervalMatrix::EMPTY;
        }
        IntervalMatrix::from_fn(|row, column| change(self.rows[row][column])).or_empty()
    }

    /// The same set, empty in all entries if it was in one.
    #[inline]
    fn or_empty(&self) -> IntervalMatrix<R, C> {
        if self.is_empty() { IntervalMatrix::EMPTY } else { *self }
    }

    #[inline]
    fn zip(
        &self,
        other: &IntervalMatrix<R, C>,
        combine: impl Fn(Interval, Interval) -> Interval,
    ) -> IntervalMatrix<R, C> {
        if self.is_empty() || other.is_empty() {
            return IntervalMatrix::EMPTY;
        }
        IntervalMatrix::from_fn(|row, column| combine(self.rows[row][column], other.rows[row][column]))
            .or_empty()
    }
}

impl<const N: usize> IntervalMatrix<N, N> {
    /// Ones on the diagonal, zeros elsewhere.
    #[inline]
    pub fn identity() -> IntervalMatrix<N, N> {
        IntervalMatrix::from_fn(|row, column| if row == column { Interval::ONE } else { Interval::ZERO })
    }
}

impl<const R: usize, const C: usize> From<[[Interval; C]; R]> for IntervalMatrix<R, C> {
    #[inline]
    fn from(rows: [[Interval; C]; R]) -> IntervalMatrix<R, C> {
        IntervalMatrix { rows }
    }
}

/// The set of exactly this matrix; an entry that is NaN or infinite gives what [`Interval::spanning`] does.
impl<const R: usize, const C: usize> From<SMatrix<f64, R, C>> for IntervalMatrix<R, C> {
    fn from(matrix: SMatrix<f64, R, C>) -> IntervalMatrix<R, C> {
        IntervalMatrix::from_fn(|row, column| {
            let entry = matrix[(row, column)];
            Interval::spanning(entry, entry)
        })
    }
}

impl<const R: usize, const C: usize> From<SMatrix<Interval, R, C>> for IntervalMatrix<R, C> {
    fn from(matrix: SMatrix<Interval, R, C>) -> IntervalMatrix<R, C> {
        IntervalMatrix::from_fn(|row, column| matrix[(row, column)])
    }
}

impl<const R: usize, const C: usize> From<IntervalMatrix<R, C>> for SMatrix<Interval, R, C> {
    fn from(matrix: IntervalMatrix<R, C>) -> SMatrix<Interval, R, C> {
        SMatrix::from_fn(|row, column| matrix.rows[row][column])
    }
}

/// The entry in a row and a column, counted from 0. Panics, like any index, when there is no such place.
impl<const R: usize, const C: usize> Index<(usize, usize)> for IntervalMatrix<R, C> {
    type Output = Interval;

    #[inline]
    fn index(&self, (row, column): (usize, usize)) -> &Interval {
        &self.rows[row][column]
    }
}

/// The entry in a row and a column, counted from 0. Panics, like any index, when there is no such place.
impl<const R: usize, const C: usize> IndexMut<(usize, usize)> for IntervalMatrix<R, C> {
    #[inline]
    fn index_mut(&mut self, (row, column): (usize, usize)) -> &mut Interval {
        &mut self.rows[row][column]
    }
}

impl<const R: usize, const C: usize> BitAnd for IntervalMatrix<R, C> {
    type Output = IntervalMatrix<R, C>;

    #[inline]
    fn bitand(self, other: IntervalMatrix<R, C>) -> IntervalMatrix<R, C> {
        self.intersection(&other)
    }
}

impl<const R: usize, const C: usize> BitOr for IntervalMatrix<R, C> {
    type Output = IntervalMatrix<R, C>;

    #[inline]
    fn bitor(self, other: IntervalMatrix<R, C>) -> IntervalMatrix<R, C> {
        self.hull(&other)
    }
}

/// Writes the rows in brackets, or `empty`; a precision is passed on to the entries.
impl<const R: usize, const C: usize> fmt::Display for IntervalMatrix<R, C> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_empty() {
            return formatter.write_str("empty");
        }
        for (index, row) in self.rows.iter().enumerate() {
            formatter.write_str(if index == 0 { "[" } else { ", [" })?;
            for (column, entry) in row.iter().enumerate() {
                formatter.write_str(if column == 0 { "" } else { ", " })?;
                entry.fmt(formatter)?;
            }
            formatter.write_str("]")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
