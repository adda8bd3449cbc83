//! Nearly orthonormal axes for a parallelepiped, and a proof of their inverse.
//!
//! Written out for small matrices so that the bits do not depend on how a library arranges its sums.

use shoal_interval::{Interval, IntervalMatrix};

/// Columns that are about orthonormal and span, one after the other, the same spaces as the columns of `matrix` from the
/// longest on (a QR factorisation with pivoting, by Gram-Schmidt).
pub(super) fn axes_along<const N: usize>(matrix: &[[f64; N]; N]) -> [[f64; N]; N] {
    let mut order: [usize; N] = std::array::from_fn(|column| column);
    let length = |column: usize| matrix.iter().map(|row| row[column] * row[column]).sum::<f64>();
    order.sort_by(|&one, &other| length(other).total_cmp(&length(one)));

    // Row `i` is axis `i`, to be transposed at the end.
    let mut axes = [[0.0; N]; N];
    for rank in 0..N {
        let candidate: [f64; N] = std::array::from_fn(|row| matrix[row][order[rank]]);
        axes[rank] = orthogonal_to(&axes, rank, candidate)
            .or_else(|| (0..N).find_map(|unit| orthogonal_to(&axes, rank, unit_vector(unit))))
            .unwrap_or(unit_vector(rank));
    }
    std::array::from_fn(|row| std::array::from_fn(|column| axes[column][row]))
}

/// An enclosure of the inverse of nearly orthonormal axes; `None` if they are not.
///
/// With `R` the transpose and `E = I - R A`, the inverse is `(I - E)^-1 R`, and each entry of `(I - E)^-1 - I` is at most
/// `e / (1 - e)` for `e` the largest sum of a row of `|E|`.
pub(super) fn inverse<const N: usize>(axes: &IntervalMatrix<N, N>) -> Option<IntervalMatrix<N, N>> {
    let transpose = axes.transpose();
    let error = IntervalMatrix::identity() - transpose * *axes;
    let norm = row_sum_norm(&error);
    // NaN is no proof.
    if !(norm.upper() < 0.5) {
        return None;
    }
    let excess = (norm / (Interval::ONE - norm)).upper();
    let around = Interval::spanning(-excess, excess);
    let correction = IntervalMatrix::identity() + IntervalMatrix::from_fn(|_, _| around);
    Some(correction * transpose)
}

/// The largest sum of the magnitudes of a row, from above.
pub(super) fn row_sum_norm<const N: usize>(matrix: &IntervalMatrix<N, N>) -> Interval {
    matrix.rows().iter().fold(Interval::ZERO, |largest, row| {
        let sum = row.iter().fold(Interval::ZERO, |sum, entry| sum + entry.abs());
        largest.max(sum)
    })
}

/// `candidate` without its parts along the first `count` axes, at length one; `None` if little is left.
fn orthogonal_to<const N: usize>(
    axes: &[[f64; N]; N],
    count: usize,
    candidate: [f64; N],
) -> Option<[f64; N]> {
    let mut rest = normalised(candidate)?;
    // Twice is enough for full accuracy.
    for _ in 0..2 {
        for axis in &axes[..count] {
            let along = dot(axis, &rest);
            rest = std::array::from_fn(|row| rest[row] - along * axis[row]);
        }
        if dot(&rest, &rest) < 1e-4 {
            return None;
        }
        rest = normalised(rest)?;
    }
    Some(rest)
}

fn normalised<const N: usize>(vector: [f64; N]) -> Option<[f64; N]> {
    let largest = vector.iter().fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
    if !(largest > 0.0 && largest.is_finite()) {
        return None;
    }
    let scaled = vector.map(|entry| entry / largest);
    let length = dot(&scaled, &scaled).sqrt();
    Some(scaled.map(|entry| entry / length))
}

fn dot<const N: usize>(one: &[f64; N], other: &[f64; N]) -> f64 {
    one.iter().zip(other).map(|(a, b)| a * b).sum()
}

fn unit_vector<const N: usize>(axis: usize) -> [f64; N] {
    std::array::from_fn(|row| if row == axis { 1.0 } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn axes_can_be_inverted_whatever_the_matrix(
            entries in prop::array::uniform9(prop_oneof![
                -1e3..1e3_f64, Just(0.0), Just(1.0), Just(1e-200), Just(f64::INFINITY), Just(f64::NAN)
            ])
        ) {
            let [a, b, c, d, e, f, g, h, i] = entries;
            let axes = axes_along(&[[a, b, c], [d, e, f], [g, h, i]]);
            let axes = IntervalMatrix::from(axes.map(|row| row.map(|entry| Interval::point(entry).unwrap())));
            let inverse = inverse(&axes).expect("nearly orthonormal");
            let product = inverse * axes;
            prop_assert!(IntervalMatrix::<3, 3>::identity().is_subset_of(&product), "{}", product);
            prop_assert!(product.width() < 1e-13);
        }
    }

    #[test]
    fn what_is_far_from_orthonormal_is_refused() {
        let skew = IntervalMatrix::from([[Interval::ONE, Interval::ONE], [Interval::ZERO, Interval::ONE]]);
        assert!(inverse(&skew).is_none());
        assert!(inverse(&IntervalMatrix::<2, 2>::ENTIRE).is_none());
    }
}
