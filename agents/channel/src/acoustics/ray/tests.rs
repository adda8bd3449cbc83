//! Rays against closed forms, image sources, a numerical integration and each other.

use proptest::prelude::*;

use super::*;
use crate::acoustics::profile::Node;

mod independent;

use independent::{brute_force_s, landed, straight_s};

fn water(nodes: &[(f64, f64)], bottom_depth_m: f64) -> WaterColumn {
    let nodes: Vec<Node> = nodes.iter().map(|&(depth_m, speed_m_s)| Node { depth_m, speed_m_s }).collect();
    WaterColumn::new(Profile::new(&nodes).unwrap(), bottom_depth_m)
}

fn linear(bottom_depth_m: f64) -> WaterColumn {
    water(&[(0.0, 1500.0), (1_000.0, 1517.0)], bottom_depth_m)
}

/// Whether two numbers are the same but for rounding.
fn is_same(one: f64, other: f64) -> bool {
    (one - other).abs() <= 1e-12 * one.abs().max(other.abs())
}

#[test]
fn the_closed_form_of_a_linear_profile_is_met_to_a_nanosecond() {
    // References, acoustics: c = 1500 + 0.017 depth.
    let table = [
        (100.0, 10.0, 10.0, 0.066659108),
        (1_000.0, 50.0, 50.0, 0.666285541),
        (2_000.0, 20.0, 200.0, 1.337027492),
        (5_000.0, 100.0, 100.0, 3.329115518),
    ];
    // The same water with nodes that change nothing: other branches of the code, the same sound.
    let split = water(
        &[
            (0.0, 1500.0),
            (15.0, 1500.255),
            (50.0, 1500.85),
            (100.0, 1501.7),
            (110.0, 1501.87),
            (1_000.0, 1517.0),
        ],
        1_000.0,
    );
    for water in [linear(1_000.0), split] {
        for (range_m, from_m, to_m, travel_s) in table {
            let ray = water.direct(from_m, to_m, range_m, None).unwrap();
            assert!((ray.travel_s - travel_s).abs() < 1e-9, "{range_m}: {} {travel_s}", ray.travel_s);
        }
    }
}

#[test]
fn a_numerical_integration_lands_where_the_ray_does_and_when() {
    let places = [
        (5.0, 40.0, 300.0),
        (30.0, 30.0, 700.0),
        (80.0, 12.0, 900.0),
        (150.0, 150.0, 1_000.0),
        (20.0, 190.0, 3_000.0),
        (1_000.0, 1_300.0, 9_000.0),
        (1_300.0, 1_300.0, 5_000.0),
        (60.0, 100.0, 500.0),
    ];
    let mut seen = 0;
    for profile in [
        Profile::summer_thermocline(2_000.0),
        Profile::mixed_layer(2_000.0),
        Profile::arctic(2_000.0),
        Profile::munk(5_000.0),
    ] {
        let bottom_depth_m = 2_000.0;
        let water = WaterColumn::new(profile, bottom_depth_m);
        for (from_m, to_m, range_m) in places {
            let Some(ray) = water.direct(from_m, to_m, range_m, None) else { continue };
            let (depth_m, travel_s) = landed(&water, from_m, ray.departure, range_m);
            assert!((depth_m - to_m).abs() < 1e-5, "{from_m} {to_m} {range_m}: {depth_m}");
            assert!((travel_s - ray.travel_s).abs() < 1e-9, "{travel_s} {}", ray.travel_s);
            seen += 1;
        }
    }
    assert!(seen > 20, "{seen}");
}
