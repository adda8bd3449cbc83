use proptest::prelude::*;

use super::*;

fn vec3(size: f64) -> impl Strategy<Value = [f64; 3]> {
    [-size..size, -size..size, -size..size]
}

fn field() -> impl Strategy<Value = CurrentField> {
    prop_oneof![
        Just(CurrentField::Uniform),
        (vec3(2.0), vec3(2.0), 1.0..500.0).prop_map(|(surface_m_s, deep_m_s, depth_m)| {
            CurrentField::Shear { surface_m_s, deep_m_s, depth_m }
        }),
        ([-300.0..300.0, -300.0..300.0], 1.0..300.0, -2.0..2.0).prop_map(
            |(centre_m, core_radius_m, speed_m_s)| CurrentField::Vortex {
                centre_m,
                core_radius_m,
                speed_m_s
            }
        ),
    ]
}

/// More than the field rounds.
const SLACK_M_S: f64 = 1e-12;

proptest! {
    #[test]
    fn field_stays_inside_its_hull_and_its_speed_below_its_bound(
        field in field(), uniform in vec3(1.0), place in vec3(1e3)
    ) {
        let hull_m_s = field_hull_m_s(&field);
        let current = Current::new(Vec3::from(uniform), field);
        let there_m_s = current.at(&Vec3::from(place));
        prop_assert!(there_m_s.norm() <= current.speed_bound_m_s());
        for axis in 0..3 {
            let added_m_s = there_m_s[axis] - uniform[axis];
            prop_assert!(hull_m_s[axis].lower - SLACK_M_S <= added_m_s);
            prop_assert!(added_m_s <= hull_m_s[axis].upper + SLACK_M_S);
        }
    }

    #[test]
    fn field_is_no_steeper_than_stated(field in field(), from in vec3(600.0), way in vec3(1.0), length in -6.0..2.5) {
        let (from, way) = (Vec3::from(from), Vec3::from(way) * pxfm::f_exp10(length));
        let bounds_m_s = field_change(&field, way.xy().norm(), way.z.abs());
        let current = Current::new(Vec3::zeros(), field);
        let change_m_s = current.at(&(from + way)) - current.at(&from);
        for axis in 0..3 {
            let bound_m_s = bounds_m_s[axis] + SLACK_M_S;
            prop_assert!(change_m_s[axis].abs() <= bound_m_s, "axis {axis}: {change_m_s} beyond {bound_m_s}");
        }
    }
}

#[test]
fn a_uniform_current_is_itself_to_the_bit() {
    let uniform_m_s = Vec3::new(0.1, -0.0, 1e-300);
    let current = Current::new(uniform_m_s, CurrentField::Uniform);
    let there_m_s = current.at(&Vec3::new(1e9, -3.0, 0.1));
    assert!((0..3).all(|axis| there_m_s[axis].to_bits() == uniform_m_s[axis].to_bits()));
    assert_eq!(current.speed_bound_m_s(), uniform_m_s.norm());
}

#[test]
fn a_vortex_turns_as_rankine_has_it() {
    let field = CurrentField::Vortex { centre_m: [10.0, 20.0], core_radius_m: 50.0, speed_m_s: 0.8 };
    let current = Current::new(Vec3::zeros(), field);
    // Counter-clockwise: north of the axis it flows west, east of it north. Half the speed half way out, and at twice the core.
    for (place_m, expected_m_s) in [
        ([10.0, 20.0, -5.0], [0.0, 0.0, 0.0]),
        ([35.0, 20.0, -5.0], [0.0, 0.4, 0.0]),
        ([60.0, 20.0, -5.0], [0.0, 0.8, 0.0]),
        ([10.0, 120.0, -9.0], [-0.4, 0.0, 0.0]),
        ([-90.0, 20.0, 0.0], [0.0, -0.4, 0.0]),
    ] {
        let off_m_s = (current.at(&Vec3::from(place_m)) - Vec3::from(expected_m_s)).norm();
        assert!(off_m_s < 1e-15, "{off_m_s} at {place_m:?}");
    }
}

#[test]
fn a_vortex_is_free_of_divergence_and_turns_only_inside_its_core() {
    let field = CurrentField::Vortex { centre_m: [0.0; 2], core_radius_m: 40.0, speed_m_s: -0.5 };
    let current = Current::new(Vec3::new(0.2, 0.0, 0.0), field);
    let step_m = 1e-4;
    let (east_m, north_m) = (Vec3::new(step_m, 0.0, 0.0), Vec3::new(0.0, step_m, 0.0));
    for place_m in [[3.0, -7.0, 0.0], [20.0, 30.0, -4.0], [-60.0, 25.0, -9.0], [0.0, 300.0, 0.0]] {
        let place_m = Vec3::from(place_m);
        let along =
            |way_m: Vec3| (current.at(&(place_m + way_m)) - current.at(&(place_m - way_m))) / (2.0 * step_m);
        let (by_east_per_s, by_north_per_s) = (along(east_m), along(north_m));
        let divergence_per_s = by_east_per_s.x + by_north_per_s.y;
        let vorticity_per_s = by_east_per_s.y - by_north_per_s.x;
        let expected_per_s = if place_m.xy().norm() < 40.0 { 2.0 * -0.5 / 40.0 } else { 0.0 };
        assert!(divergence_per_s.abs() < 1e-8, "{divergence_per_s} at {place_m}");
        assert!((vorticity_per_s - expected_per_s).abs() < 1e-8, "{vorticity_per_s} at {place_m}");
    }
}
