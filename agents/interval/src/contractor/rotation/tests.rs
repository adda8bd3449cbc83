//! Turned vectors: nothing lost, and angles found.

use super::*;
use proptest::prelude::*;

fn over(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap()
}

fn point(x: f64) -> Interval {
    over(x, x)
}

fn around(truth: Interval, (width, share): (f64, f64)) -> Interval {
    truth | over(truth.mid() - share * width, truth.mid() + (1.0 - share) * width)
}

fn width() -> impl Strategy<Value = (f64, f64)> {
    (prop_oneof![Just(0.0), 0.0..1e-3_f64, 0.0..2.0_f64, 0.0..40.0_f64], 0.0..1.0_f64)
}

/// `R(angle) (x, y)`, to rounding.
fn turned([x, y]: [Interval; 2], angle: Interval) -> [Interval; 2] {
    let (sine, cosine) = angle.sin_cos();
    [x * cosine - y * sine, x * sine + y * cosine]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn no_turned_vector_is_lost(
        (x, y) in (-9.0..9.0_f64, -9.0..9.0_f64),
        angle in prop_oneof![-3.2..3.2_f64, -50.0..50.0_f64, -1e15..1e15_f64],
        widths in prop::array::uniform5(width()),
    ) {
        let to = turned([point(x), point(y)], point(angle));
        let truth = [point(x), point(y), point(angle), to[0], to[1]];
        let before = IntervalBox::from(std::array::from_fn(|axis| around(truth[axis], widths[axis])));
        let after = Rotation.contract(before);
        prop_assert!(after.is_subset_of(&before));
        for axis in 0..5 {
            prop_assert!(!(after[axis] & truth[axis]).is_empty(), "axis {}: {} -> {}", axis, before, after);
        }
    }

    #[test]
    fn known_vectors_give_the_angle((x, y) in (0.5..9.0_f64, -9.0..9.0_f64), angle in -3.0..3.0_f64) {
        let to = turned([point(x), point(y)], point(angle));
        let domain = IntervalBox::from([point(x), point(y), over(-3.1, 3.1), to[0], to[1]]);
        let found = Rotation.contract(domain)[2];
        prop_assert!(found.contains(angle) && found.width() < 1e-12, "{} {}", angle, found);
    }

    #[test]
    fn no_euler_rotation_is_lost(
        vector in prop::array::uniform3(-9.0..9.0_f64),
        angles in prop::array::uniform3(-4.0..4.0_f64),
        widths in prop::array::uniform9(width()),
    ) {
        let [x, y, z] = vector.map(point);
        let [yaw, pitch, roll] = angles.map(point);
        let [y, z] = turned([y, z], roll);
        let [z, x] = turned([z, x], pitch);
        let [x, y] = turned([x, y], yaw);
        let to = [x, y, z];
        let before = (
            IntervalBox::from(std::array::from_fn(|i| around(point(vector[i]), widths[i]))),
            std::array::from_fn(|i| around(point(angles[i]), widths[3 + i])),
            IntervalBox::from(std::array::from_fn::<_, 3, _>(|i| around(to[i], widths[6 + i]))),
        );
        let mut after = before;
        prop_assert_ne!(contract_euler_rotation(&mut after.0, &mut after.1, &mut after.2), Contracted::Empty);
        for i in 0..3 {
            prop_assert!(after.0[i].contains(vector[i]) && after.1[i].contains(angles[i]));
            prop_assert!(!(after.2[i] & to[i]).is_empty());
            prop_assert!(after.0[i].is_subset_of(before.0[i]) && after.1[i].is_subset_of(before.1[i]));
            prop_assert!(after.2[i].is_subset_of(before.2[i]));
        }
    }
}

#[test]
fn lengths_contradict() {
    let domain = IntervalBox::from([
        Interval::ONE,
        Interval::ZERO,
        Interval::ENTIRE,
        over(2.0, 3.0),
        Interval::ENTIRE,
    ]);
    assert!(Rotation.contract(domain).is_empty());
    assert!(Rotation.contract(IntervalBox::EMPTY).is_empty());
    let (mut body, mut angles, mut world) = (IntervalBox::EMPTY, [Interval::ENTIRE; 3], IntervalBox::ENTIRE);
    assert_eq!(contract_euler_rotation(&mut body, &mut angles, &mut world), Contracted::Empty);
    assert!(world.is_empty() && angles[1].is_empty());
}

#[test]
fn an_angle_is_found_among_many_turns() {
    // A quarter turn, between two and three whole turns further.
    let domain =
        IntervalBox::from([Interval::ONE, Interval::ZERO, over(10.0, 20.0), Interval::ZERO, Interval::ONE]);
    let angle = Rotation.contract(domain)[2];
    assert!((angle.mid() - 14.137166941154069).abs() < 1e-12 && angle.width() < 1e-12, "{angle}");
}
