//! Turned boxes: what keeps the set of states from being wrapped.

use super::orthonormal::{axes_along, inverse};
use nalgebra::SVector;
use shoal_interval::{Interval, IntervalBox, IntervalMatrix};

/// The vectors `centre + axes r` for `r` in the box of coordinates.
#[derive(Debug, Clone, Copy)]
pub(super) struct Parallelepiped<const N: usize> {
    /// Exactly one vector.
    centre: IntervalBox<N>,
    /// Exactly one matrix, nearly orthonormal.
    axes: IntervalMatrix<N, N>,
    inverse: IntervalMatrix<N, N>,
    coordinates: IntervalBox<N>,
}

impl<const N: usize> Parallelepiped<N> {
    /// The box itself, which must be bounded and not empty.
    pub(super) fn upright(states: &IntervalBox<N>) -> Parallelepiped<N> {
        let centre = point(states.mid());
        let identity = IntervalMatrix::identity();
        Parallelepiped { centre, axes: identity, inverse: identity, coordinates: *states - centre }
    }

    pub(super) fn centre(&self) -> &IntervalBox<N> {
        &self.centre
    }

    pub(super) fn hull(&self) -> IntervalBox<N> {
        self.centre + self.axes * self.coordinates
    }

    /// A parallelepiped that holds what is in this one and in `states`.
    pub(super) fn met_with(&self, states: &IntervalBox<N>) -> Parallelepiped<N> {
        let coordinates = self.coordinates & (self.inverse * (*states - self.centre));
        // Axes of length one: volumes can be compared.
        if coordinates.is_empty() || coordinates.volume() <= states.volume() || !states.is_bounded() {
            return Parallelepiped { coordinates, ..*self };
        }
        Parallelepiped::upright(states)
    }

    /// A parallelepiped that holds `c + m (x - centre)` for every `x` of this one, `c` of `centre_image` and `m` of
    /// `slopes`. `None` if nothing bounded does.
    pub(super) fn image(
        &self,
        centre_image: &IntervalBox<N>,
        slopes: &IntervalMatrix<N, N>,
    ) -> Option<Parallelepiped<N>> {
        let turned = *slopes * self.axes;
        let middle = turned.mid();
        // What is long in the set counts, not what is long in the matrix.
        let sides = std::array::from_fn(|row| {
            std::array::from_fn(|column| middle[(row, column)] * self.coordinates[column].width())
        });
        let axes = IntervalMatrix::from(axes_along(&sides).map(|row| row.map(exactly)));
        let inverse = inverse(&axes)?;
        let centre = point(centre_image.mid());
        let coordinates = (inverse * turned) * self.coordinates + inverse * (*centre_image - centre);
        (!coordinates.is_empty() && coordinates.is_bounded()).then_some(Parallelepiped {
            centre,
            axes,
            inverse,
            coordinates,
        })
    }
}

/// A finite number, as an interval.
fn exactly(value: f64) -> Interval {
    Interval::spanning(value, value)
}

fn point<const N: usize>(vector: SVector<f64, N>) -> IntervalBox<N> {
    IntervalBox::from(std::array::from_fn(|axis| exactly(vector[axis])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector2;

    #[test]
    fn eight_eighths_of_a_turn_wrap_nothing() {
        let states = IntervalBox::from([Interval::new(1.0, 2.0).unwrap(), Interval::new(-0.1, 0.1).unwrap()]);
        let eighth = IntervalMatrix::rotation_2d(exactly(std::f64::consts::FRAC_PI_4).inflate(1e-16));
        let mut turned = Parallelepiped::upright(&states);
        let mut wrapped = states;
        for _ in 0..8 {
            turned = turned.image(&(eighth * *turned.centre()), &eighth).unwrap();
            wrapped = eighth * wrapped;
        }
        assert!(turned.hull().contains(&Vector2::new(2.0, 0.1)));
        assert!(states.is_subset_of(&turned.hull()));
        assert!(turned.hull().width() < 1.0 + 1e-12);
        assert!(wrapped.width() > 9.0);
    }

    #[test]
    fn a_small_box_is_kept_upright() {
        let states = IntervalBox::from([Interval::new(-1.0, 1.0).unwrap(); 2]);
        let shear = IntervalMatrix::from([[1.0, 9.0], [0.0, 1.0]].map(|row| row.map(exactly)));
        let sheared = Parallelepiped::upright(&states).image(&point(Vector2::zeros()), &shear).unwrap();
        let small = IntervalBox::from([Interval::new(0.0, 0.1).unwrap(); 2]);
        assert!(sheared.met_with(&small).hull().width() < 0.11);
        assert!(sheared.met_with(&small.map(|side| side + 100.0)).hull().is_empty());
        assert_eq!(sheared.met_with(&IntervalBox::ENTIRE).coordinates, sheared.coordinates);
    }
}
