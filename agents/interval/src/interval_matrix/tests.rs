use super::*;
use crate::interval_box::IntervalBox;
use nalgebra::{Matrix2, Matrix2x3, Matrix3, Vector3};
use proptest::prelude::*;
use pxfm::f_sincos;

fn between(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap()
}

/// The Euler matrix in plain rounding, with slightly wrong entries: each within a few units of 2^-52.
fn euler(yaw: f64, pitch: f64, roll: f64) -> Matrix3<f64> {
    let [(sin_yaw, cos_yaw), (sin_pitch, cos_pitch), (sin_roll, cos_roll)] = [yaw, pitch, roll].map(f_sincos);
    let about_third = Matrix3::new(cos_yaw, -sin_yaw, 0.0, sin_yaw, cos_yaw, 0.0, 0.0, 0.0, 1.0);
    let about_second = Matrix3::new(cos_pitch, 0.0, sin_pitch, 0.0, 1.0, 0.0, -sin_pitch, 0.0, cos_pitch);
    let about_first = Matrix3::new(1.0, 0.0, 0.0, 0.0, cos_roll, -sin_roll, 0.0, sin_roll, cos_roll);
    about_third * about_second * about_first
}

fn product(yaw: Interval, pitch: Interval, roll: Interval) -> IntervalMatrix<3, 3> {
    IntervalMatrix::rotation_z(yaw) * IntervalMatrix::rotation_y(pitch) * IntervalMatrix::rotation_x(roll)
}

#[test]
fn one_empty_entry_empties_the_matrix() {
    let mut holed = IntervalMatrix::<2, 2>::identity();
    holed[(1, 0)] = Interval::EMPTY;
    let full = IntervalMatrix::<2, 2>::ENTIRE;
    assert!(holed.is_empty() && holed.width().is_nan() && holed.mid().iter().all(|x| x.is_nan()));
    assert!(holed.is_subset_of(&IntervalMatrix::EMPTY) && holed.is_bounded());
    for result in [holed + full, full - holed, holed * full, full * holed, holed & full, holed * 2.0, -holed]
    {
        assert_eq!(result, IntervalMatrix::EMPTY);
    }
    assert_eq!(holed | full, full);
    assert!(holed.determinant().is_empty());
    assert_eq!(full * IntervalBox::EMPTY, IntervalBox::EMPTY);
    assert_eq!(IntervalMatrix::rotation_2d(Interval::EMPTY), IntervalMatrix::EMPTY);
    assert_eq!(IntervalMatrix::rotation_y(Interval::EMPTY), IntervalMatrix::EMPTY);
    assert_eq!(
        IntervalMatrix::rotation(Interval::ZERO, Interval::EMPTY, Interval::ZERO),
        IntervalMatrix::EMPTY
    );
}

#[test]
fn products_of_whole_numbers_are_exact() {
    let left = Matrix2x3::new(1.0, -2.0, 3.0, 0.0, 5.0, -1.0);
    let right = Matrix3::new(2.0, 1.0, 0.0, -1.0, 3.0, 4.0, 6.0, -2.0, 1.0);
    let (wide_left, wide_right) = (IntervalMatrix::from(left), IntervalMatrix::from(right));
    assert_eq!(wide_left * wide_right, IntervalMatrix::from(left * right));
    assert_eq!(wide_left.transpose(), IntervalMatrix::from(left.transpose()));
    assert_eq!((wide_left + wide_left, wide_left - wide_left), (wide_left * 2.0, IntervalMatrix::ZERO));
    let vector = Vector3::new(1.0, -1.0, 2.0);
    assert_eq!(wide_left * IntervalBox::from(vector), IntervalBox::from(left * vector));
    assert_eq!(wide_right.determinant(), Interval::point(47.0).unwrap());
    assert_eq!(wide_right * IntervalMatrix::identity(), wide_right);
    let entries: SMatrix<Interval, 2, 3> = wide_left.into();
    assert_eq!(IntervalMatrix::from(entries), wide_left);
    assert_eq!((wide_left.mid(), wide_left.width()), (left, 0.0));
}

#[test]
fn a_determinant_uses_each_entry_once() {
    let x = between(1.0, 2.0);
    let matrix = IntervalMatrix::from([[x, Interval::ZERO], [x, between(-1.0, 3.0)]]);
    assert_eq!(matrix.determinant(), between(-2.0, 6.0));
    assert_eq!(format!("{matrix:.0}"), "[[1, 2], [0, 0]], [[1, 2], [-1, 3]]");
    assert_eq!(IntervalMatrix::<2, 2>::EMPTY.to_string(), "empty");
}

#[test]
fn unknown_angles_give_every_rotation() {
    let any = Interval::ENTIRE;
    let attitude = IntervalMatrix::rotation(any, any, any);
    assert!(attitude.is_bounded() && attitude.contains(&euler(1e6, -2.0, 3.0)));
    assert_eq!(attitude[(2, 0)], between(-1.0, 1.0));
    let half_known = IntervalMatrix::rotation(Interval::NON_NEGATIVE, Interval::ZERO, Interval::ZERO);
    assert!(half_known.contains(&Matrix3::identity()));
    assert_eq!(half_known[(2, 2)], Interval::ONE);
}

#[test]
fn narrow_angles_lose_nothing_to_their_second_use() {
    let about = |angle_rad: f64| Interval::centred(angle_rad, 1e-6);
    let (yaw, pitch, roll) = (about(0.7), about(0.4), about(0.3));
    let attitude = IntervalMatrix::rotation(yaw, pitch, roll);
    // To first order the width is twice the radius times the sum of the absolute slopes.
    let [(sin_yaw, cos_yaw), (_, cos_pitch), (sin_roll, _)] = [0.7, 0.4, 0.3].map(f_sincos);
    let at_mid = euler(0.7, 0.4, 0.3);
    let slopes_with_pitch = [cos_pitch * sin_roll * cos_yaw, cos_pitch * sin_roll * sin_yaw];
    for (row, slope_with_pitch) in slopes_with_pitch.into_iter().enumerate() {
        let slopes = at_mid[(1 - row, 1)].abs() + slope_with_pitch.abs() + at_mid[(row, 2)].abs();
        let width = attitude[(row, 1)].width();
        assert!((width / (2e-6 * slopes) - 1.0).abs() < 1e-5, "{width}");
    }
    let natural = product(yaw, pitch, roll);
    assert!(natural[(1, 1)].width() > 1.2 * attitude[(1, 1)].width());
}

fn angle() -> impl Strategy<Value = (Interval, f64)> {
    let width = prop_oneof![2 => Just(0.0), 3 => 0.0..0.1_f64, 2 => 0.0..7.0_f64];
    (-7.0..7.0_f64, width, 0.0..=1.0_f64).prop_map(|(lower, width, share)| {
        let angle = Interval::spanning(lower, lower + width);
        (angle, (lower + share * width).clamp(angle.lower(), angle.upper()))
    })
}

proptest! {
    #[test]
    fn rotations_hold_those_by_members((yaw, psi) in angle(), (pitch, theta) in angle(), (roll, phi) in angle()) {
        let attitude = IntervalMatrix::rotation(yaw, pitch, roll);
        let truth = euler(psi, theta, phi);
        prop_assert!(attitude.map(|entry| entry.inflate(1e-15)).contains(&truth));
        prop_assert!(attitude.is_subset_of(&product(yaw, pitch, roll)));
        let point = |x: f64| Interval::spanning(x, x);
        let narrow = IntervalMatrix::rotation(point(psi), point(theta), point(phi));
        prop_assert!(!(narrow & attitude).is_empty());
        prop_assert!(narrow.width() < 4e-15 && (narrow.mid() - truth).norm() < 4e-15);
        let identity = attitude * attitude.transpose();
        prop_assert!(identity.contains(&Matrix3::identity()));
        prop_assert!(attitude.determinant().contains(1.0));
    }

    #[test]
    fn plane_rotations_are_those_about_the_third_axis((heading, psi) in angle()) {
        let plane = IntervalMatrix::rotation_2d(heading);
        let space = IntervalMatrix::rotation_z(heading);
        prop_assert_eq!(plane.rows()[0], [space[(0, 0)], space[(0, 1)]]);
        let (sin, cos) = f_sincos(psi);
        prop_assert!(plane.map(|entry| entry.inflate(1e-15)).contains(&Matrix2::new(cos, -sin, sin, cos)));
        prop_assert!((plane * plane.transpose()).contains(&Matrix2::identity()));
        prop_assert!(plane.determinant().contains(1.0));
    }

    /// Entries are small whole numbers, so the plain operations on members are exact.
    #[test]
    fn operations_hold_those_on_members(
        entries in prop::array::uniform18((-50_i32..50, 0_i32..9, 0.0..=1.0_f64)),
        sides in prop::array::uniform3((-50_i32..50, 0_i32..9, 0.0..=1.0_f64)),
    ) {
        let set = |(lower, width, _): (i32, i32, f64)| between(lower.into(), (lower + width).into());
        let member = |(lower, width, share): (i32, i32, f64)| (f64::from(lower) + share * f64::from(width)).round();
        let at = |offset: usize| move |row: usize, column: usize| offset + 3 * row + column;
        let (first, second) = (at(0), at(9));
        let x = IntervalMatrix::<3, 3>::from_fn(|row, column| set(entries[first(row, column)]));
        let y = IntervalMatrix::<3, 3>::from_fn(|row, column| set(entries[second(row, column)]));
        let a = Matrix3::from_fn(|row, column| member(entries[first(row, column)]));
        let b = Matrix3::from_fn(|row, column| member(entries[second(row, column)]));
        prop_assert!((x * y).contains(&(a * b)) && (x + y).contains(&(a + b)) && (x - y).contains(&(a - b)));
        prop_assert!((x | y).contains(&a) && (x | y).contains(&b) && (x & y).contains(&a) == y.contains(&a));
        prop_assert!(x.is_subset_of(&(x | y)) && x.contains(&x.mid()));
        let minors = a[(0, 0)] * (a[(1, 1)] * a[(2, 2)] - a[(1, 2)] * a[(2, 1)])
            - a[(0, 1)] * (a[(1, 0)] * a[(2, 2)] - a[(1, 2)] * a[(2, 0)])
            + a[(0, 2)] * (a[(1, 0)] * a[(2, 1)] - a[(1, 1)] * a[(2, 0)]);
        prop_assert!(x.determinant().contains(minors));
        let vector = Vector3::from(sides.map(member));
        prop_assert!((x * IntervalBox::from(sides.map(set))).contains(&(a * vector)));
    }
}
