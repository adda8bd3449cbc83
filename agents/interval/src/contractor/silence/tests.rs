//! The slanted rectangle in front of a wall, and only that, is removed.

use super::*;
use nalgebra::Vector2;
use proptest::prelude::*;

fn over(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap()
}

/// A wall that is seen from below left, with the direction of its perpendicular.
fn slanted() -> (Wall, f64) {
    (Wall::new(Vector2::new(4.0, 0.0), Vector2::new(0.0, 4.0)), std::f64::consts::FRAC_PI_4)
}

#[test]
fn oblique_pings_say_nothing() {
    let (wall, perpendicular) = slanted();
    let domain = IntervalBox::from([over(0.9, 1.0), over(0.9, 1.0)]);
    let left = |bearing: f64, spread: f64| {
        Silence::new(wall, Interval::centred(bearing, spread), over(0.5, 2.0), 0.1).contract(domain)
    };
    assert!(left(perpendicular, 0.05).is_empty());
    assert!(left(perpendicular + 0.09, 0.005).is_empty());
    assert_eq!(left(perpendicular + 0.09, 0.02), domain);
    assert_eq!(left(perpendicular + 3.2, 0.05), domain);
    assert_eq!(
        Silence::new(wall.reversed(), Interval::centred(perpendicular, 0.01), over(0.5, 2.0), 0.1)
            .contract(domain),
        domain
    );
    for tolerance in [f64::NAN, -0.1, f64::INFINITY, 2.0] {
        assert_eq!(
            Silence::new(wall, Interval::centred(perpendicular, 0.0), over(0.5, 2.0), tolerance)
                .contract(domain),
            domain
        );
    }
}

#[test]
fn odd_silences_and_walls() {
    let (wall, perpendicular) = slanted();
    let bearing = Interval::centred(perpendicular, 0.01);
    let domain = IntervalBox::from([over(0.9, 1.0), over(0.9, 1.0)]);
    let left = |wall, silent| Silence::new(wall, bearing, silent, 0.1).contract(domain);
    assert!(left(wall, Interval::ENTIRE).is_empty());
    assert!(left(wall, over(0.5, f64::INFINITY)).is_empty());
    assert_eq!(left(wall, Interval::EMPTY), domain);
    assert_eq!(left(wall, over(-3.0, -1.0)), domain);
    assert_eq!(left(wall, over(1.4, 1.4)), domain);
    let corner = Vector2::new(4.0, 0.0);
    assert_eq!(left(Wall::new(corner, corner), over(0.5, 2.0)), domain);
    assert_eq!(left(Wall::new(corner, Vector2::new(f64::NAN, 1.0)), over(0.5, 2.0)), domain);
    assert!(Silence::new(wall, bearing, over(0.5, 2.0), 0.1).contract(IntervalBox::EMPTY).is_empty());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn exactly_the_rectangle_is_removed((x, y) in (-3.0..6.0_f64, -3.0..6.0_f64), (near, width) in (0.0..3.0_f64, 0.0..2.0_f64), radius in prop_oneof![Just(0.0), 0.0..3.0_f64]) {
        let (wall, perpendicular) = slanted();
        let silence = Silence::new(wall, Interval::centred(perpendicular, 0.01), over(near, near + width), 0.1);
        let point = Vector2::new(x, y);
        let height = (4.0 - x - y) / std::f64::consts::SQRT_2;
        let place = (y - x + 4.0) / 8.0;
        let inside = |margin: f64| {
            height > near + margin && height < near + width - margin && place > margin && place < 1.0 - margin
        };
        let domain = IntervalBox::centred(&point, radius);
        let left = silence.contract(domain);
        prop_assert!(left.is_subset_of(&domain));
        if !inside(-1e-9) {
            prop_assert!(left.contains(&point));
        }
        if inside(1e-9) {
            prop_assert!(silence.contract(IntervalBox::centred(&point, 0.0)).is_empty());
        }
    }
}
