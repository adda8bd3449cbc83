//! Rays against closed forms, image sources, a numerical integration and each other.

use proptest::prelude::*;

use super::*;
use crate::acoustics::profile::{Node, Profile};

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

#[test]
fn straight_rays_of_uniform_water_meet_the_image_sources() {
    let (speed_m_s, bottom_m) = (1480.0, 120.0);
    let water = WaterColumn::new(Profile::uniform(speed_m_s).unwrap(), bottom_m);
    for (from_m, to_m, range_m) in
        [(10.0, 70.0, 400.0), (70.0, 10.0, 35.0), (0.0, 120.0, 1.0), (60.0, 60.0, 0.0)]
    {
        for first in [Boundary::Surface, Boundary::Bottom] {
            for bounces in 1..=7_u8 {
                // Mirror the receiver at each boundary that is met, the last one first.
                let mut image_m = to_m;
                for bounce in (0..bounces).rev() {
                    let at_surface = (first == Boundary::Surface) == (bounce % 2 == 0);
                    image_m = if at_surface { -image_m } else { 2.0 * bottom_m - image_m };
                }
                let length_m = (range_m * range_m + (image_m - from_m) * (image_m - from_m)).sqrt();
                let ray = water.bounced(first, bounces, from_m, to_m, range_m, None).unwrap();
                assert!(is_same(ray.length_m, length_m), "{} {length_m}", ray.length_m);
                assert!(is_same(ray.travel_s, length_m / speed_m_s));
                assert!((ray.departure.cos - range_m / length_m).abs() < 1e-12);
                assert!((ray.departure.sin + (image_m - from_m) / length_m).abs() < 1e-12);
                let parity = if bounces % 2 == 0 { 1.0 } else { -1.0 };
                assert!((ray.arrival.sin - parity * ray.departure.sin).abs() < 1e-12);
            }
        }
    }
}

/// Layers that may be anything but steeper than `steepest_1_s`: fast and slow, thick and thin, uniform ones among them.
fn layers(steepest_1_s: f64) -> impl Strategy<Value = Vec<(f64, f64)>> {
    let speed_m_s = prop_oneof![2 => 1_430.0..1_560.0_f64, 1 => Just(1_500.0), 1 => Just(1_520.0)];
    let thickness_m = prop_oneof![3 => 1.0..80.0_f64, 1 => 0.01..1.0_f64, 1 => Just(20.0)];
    (0.0..10.0_f64, prop::collection::vec((thickness_m, speed_m_s), 1..8)).prop_map(
        move |(start_m, steps)| {
            let (mut depth_m, mut speed_m_s) = (start_m, steps[0].1);
            let mut nodes = vec![(depth_m, speed_m_s)];
            for (thickness_m, aim_m_s) in steps {
                let most_m_s = steepest_1_s * thickness_m;
                depth_m += thickness_m;
                speed_m_s += (aim_m_s - speed_m_s).clamp(-most_m_s, most_m_s);
                nodes.push((depth_m, speed_m_s));
            }
            nodes
        },
    )
}

/// Water and two points in it, at nodes and at the same depth more often than chance has it.
fn places() -> impl Strategy<Value = (WaterColumn, f64, f64, f64)> {
    places_in(f64::INFINITY)
}

fn places_in(steepest_1_s: f64) -> impl Strategy<Value = (WaterColumn, f64, f64, f64)> {
    let range_m = prop_oneof![4 => 0.1..3_000.0_f64, 1 => 0.0..1.0_f64];
    (layers(steepest_1_s), 0.0..1.0_f64, 0.0..1.0_f64, range_m, 0..8_u8, 20.0..400.0_f64).prop_map(
        |(layers, from, to, range_m, kind, bottom_m)| {
            let (mut from_m, mut to_m) = (from * bottom_m, to * bottom_m);
            if kind == 1 || kind == 2 {
                from_m = layers[layers.len() / 2].0.min(bottom_m);
            }
            if kind == 2 || kind == 3 {
                to_m = layers[0].0.min(bottom_m);
            }
            if kind == 4 {
                to_m = from_m;
            }
            (water(&layers, bottom_m), from_m, to_m, range_m)
        },
    )
}

fn paths() -> impl Strategy<Value = SoundPath> {
    let first = prop_oneof![Just(Boundary::Surface), Just(Boundary::Bottom)];
    prop_oneof![
        Just(SoundPath::Direct),
        (first, 1..5_u8).prop_map(|(first, bounces)| SoundPath::Bounced { first, bounces }),
    ]
}

/// The same way, gone backwards.
fn backwards(path: SoundPath) -> SoundPath {
    match path {
        SoundPath::Bounced { first, bounces } if bounces % 2 == 0 => {
            SoundPath::Bounced { first: first.other(), bounces }
        }
        path => path,
    }
}

fn assert_sound(ray: &Ray) {
    for number in [ray.travel_s, ray.length_m, ray.slowness_s_m] {
        assert!(number.is_finite() && number >= 0.0, "{ray:?}");
    }
    for direction in [ray.departure, ray.arrival] {
        let square = direction.cos * direction.cos + direction.sin * direction.sin;
        assert!((square - 1.0).abs() < 1e-12 && direction.cos >= 0.0, "{ray:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2_000))]

    #[test]
    fn both_ways_are_the_same((water, from_m, to_m, range_m) in places(), path in paths()) {
        let there = water.ray(path, from_m, to_m, range_m, None);
        let back = water.ray(backwards(path), to_m, from_m, range_m, None);
        prop_assert_eq!(there.map(|ray| ray.travel_s), back.map(|ray| ray.travel_s));
        if let (Some(there), Some(back)) = (there, back) {
            assert_sound(&there);
            prop_assert_eq!(there.length_m, back.length_m);
            prop_assert_eq!(there.slowness_s_m, back.slowness_s_m);
            if from_m != to_m {
                prop_assert_eq!((there.departure.cos, there.departure.sin), (back.arrival.cos, -back.arrival.sin));
            }
        }
    }

    #[test]
    fn no_sound_is_faster_than_sound((water, from_m, to_m, range_m) in places(), path in paths()) {
        if let Some(ray) = water.ray(path, from_m, to_m, range_m, None) {
            let straight_m = (range_m * range_m + (from_m - to_m) * (from_m - to_m)).sqrt();
            let (slowest, fastest) = water.profile().speed_bounds_m_s(0.0, water.bottom_depth_m());
            prop_assert!(ray.length_m >= straight_m * (1.0 - 1e-9));
            prop_assert!(ray.travel_s >= ray.length_m / fastest * (1.0 - 1e-9));
            prop_assert!(ray.travel_s <= ray.length_m / slowest * (1.0 + 1e-9));
        }
    }

    #[test]
    fn a_ray_that_keeps_going_is_never_slower_than_a_detour(
        (water, from_m, to_m, range_m) in places_in(2.0),
        bends in prop::collection::vec(-1.0..1.0_f64, 4),
        size in 0.0..1.0_f64,
    ) {
        if let Some(ray) = water.direct(from_m, to_m, range_m, None) && ray.keeps_going() {
            let bends_m = [0.0].into_iter().chain(bends).chain([0.0]);
            let detour: Vec<(f64, f64)> = bends_m
                .enumerate()
                .map(|(index, bend)| {
                    let share = index as f64 / 5.0;
                    // Between the depths of the ends: beyond them, a layer of fast water may make a detour worth its while.
                    let depth_m = from_m + (to_m - from_m) * (share + 0.2 * size * bend).clamp(0.0, 1.0);
                    (share * range_m, depth_m)
                })
                .collect();
            let detour_s = independent::polyline_s(water.profile(), &detour);
            prop_assert!(ray.travel_s <= detour_s * (1.0 + 1e-6), "{} {detour_s}", ray.travel_s);
            prop_assert!(ray.travel_s <= straight_s(water.profile(), from_m, to_m, range_m) * (1.0 + 1e-6));
        }
    }

    #[test]
    fn the_travel_time_changes_as_the_ray_points((water, from_m, to_m, range_m) in places_in(1.0), path in paths()) {
        let step_m = 1e-3;
        let at = |to_m: f64, range_m: f64| water.ray(path, from_m, to_m, range_m, None);
        let speed_m_s = water.profile().speed_m_s(to_m);
        let near = |ray: &Ray, other: &Ray| (ray.slowness_s_m - other.slowness_s_m).abs() < 1e-8;
        if let (Some(ray), Some(less), Some(more)) = (at(to_m, range_m), at(to_m, range_m - step_m), at(to_m, range_m + step_m))
            && near(&ray, &less) && near(&ray, &more)
        {
            let slope_s_m = (more.travel_s - less.travel_s) / (2.0 * step_m);
            prop_assert!((slope_s_m - ray.slowness_s_m).abs() < 1e-9, "{slope_s_m} {}", ray.slowness_s_m);
        }
        if let (Some(ray), Some(less), Some(more)) = (at(to_m, range_m), at(to_m - step_m, range_m), at(to_m + step_m, range_m))
            && near(&ray, &less) && near(&ray, &more) && to_m > step_m && to_m + step_m < water.bottom_depth_m()
        {
            // Sound that travels upwards takes longer to what is higher.
            let slope_s_m = (more.travel_s - less.travel_s) / (2.0 * step_m);
            let expected_s_m = -ray.arrival.sin / speed_m_s;
            // A layer's border in between changes the second derivative.
            prop_assert!((slope_s_m - expected_s_m).abs() < 3e-8, "{slope_s_m} {expected_s_m}");
        }
    }

    #[test]
    fn a_guess_changes_nothing_but_the_last_bits(
        (water, from_m, to_m, range_m) in places(),
        path in paths(),
        moved_m in -20.0..20.0_f64,
    ) {
        let guess = water.ray(path, from_m, to_m, (range_m + moved_m).abs(), None);
        let cold = water.ray(path, from_m, to_m, range_m, None);
        let warm = water.ray(path, from_m, to_m, range_m, guess.as_ref());
        prop_assert_eq!(cold.is_some(), warm.is_some());
        if let (Some(cold), Some(warm)) = (cold, warm) {
            prop_assert!(is_same(cold.travel_s, warm.travel_s), "{} {}", cold.travel_s, warm.travel_s);
        }
    }

    #[test]
    fn hostile_numbers_are_answered(
        layers in layers(f64::INFINITY),
        numbers in prop::array::uniform4(prop_oneof![any::<f64>(), -1e3..1e3_f64, Just(0.0), Just(20.0), Just(f64::NAN)]),
        path in paths(),
    ) {
        let [from_m, to_m, range_m, bottom_m] = numbers;
        let water = water(&layers, bottom_m);
        if let Some(ray) = water.ray(path, from_m, to_m, range_m, None) {
            assert_sound(&ray);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2_000))]

    #[test]
    fn nodes_that_change_nothing_change_nothing(
        gradient_1_s in prop_oneof![-0.1..0.1_f64, -0.02..0.02_f64, Just(0.0)],
        cuts in prop::collection::vec(1.0..999.0_f64, 1..9),
        (from_m, to_m, range_m) in (0.0..1_000.0_f64, 0.0..1_000.0_f64, 0.0..10_000.0_f64),
    ) {
        // One layer is solved in closed form, many by search.
        let speed_m_s = |depth_m: f64| 1_500.0 + gradient_1_s * depth_m;
        let whole = water(&[(0.0, speed_m_s(0.0)), (1_000.0, speed_m_s(1_000.0))], 1_000.0);
        let mut depths_m: Vec<f64> = [0.0, 1_000.0].into_iter().chain(cuts).collect();
        depths_m.sort_by(f64::total_cmp);
        depths_m.dedup_by(|one, other| *one - *other < 0.01);
        let nodes: Vec<(f64, f64)> = depths_m.iter().map(|&depth_m| (depth_m, speed_m_s(depth_m))).collect();
        let cut = water(&nodes, 1_000.0);
        if let (Some(one), Some(other)) =
            (whole.direct(from_m, to_m, range_m, None), cut.direct(from_m, to_m, range_m, None))
        {
            prop_assert!((one.travel_s - other.travel_s).abs() < 1e-11, "{} {}", one.travel_s, other.travel_s);
            prop_assert!((one.length_m - other.length_m).abs() < 1e-6 * one.length_m + 1e-9);
            prop_assert!((one.departure.sin - other.departure.sin).abs() < 1e-7);
        } else {
            // A ray that all but touches a boundary may be let through by the one and not by the other.
            let apex = |ray: Ray| 1.0 / ray.slowness_s_m;
            let touches = |ray: Ray| [0.0, 1_000.0].iter().any(|&m| (apex(ray) / speed_m_s(m) - 1.0).abs() < 1e-9);
            let only = whole.direct(from_m, to_m, range_m, None).or(cut.direct(from_m, to_m, range_m, None));
            prop_assert!(only.is_none_or(touches));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn every_direct_ray_arrives((water, from_m, to_m, range_m) in places_in(2.0)) {
        if let Some(ray) = water.direct(from_m, to_m, range_m, None) {
            let (depth_m, travel_s) = landed(&water, from_m, ray.departure, range_m);
            // A ray that all but touches a node goes on with a direction that no bit of its departure tells.
            let touches = water.profile().nodes().iter().any(|node| (ray.slowness_s_m * node.speed_m_s - 1.0).abs() < 5e-6);
            if range_m > 1e-3 && ray.departure.cos > 1e-6 && !touches {
                let miss_m = (depth_m - to_m).abs() * ray.arrival.cos;
                prop_assert!(miss_m < 1e-3, "lands at {depth_m}, not {to_m}");
                let along_s = ray.arrival.sin / water.profile().speed_m_s(to_m) * (to_m - depth_m);
                prop_assert!((travel_s - along_s - ray.travel_s).abs() < 1e-9, "{travel_s} {}", ray.travel_s);
            }
        }
    }

    #[test]
    fn no_faster_ray_is_overlooked((water, from_m, to_m, range_m) in places_in(2.0)) {
        let brute_s = brute_force_s(&water, from_m, to_m, range_m);
        let ray = water.direct(from_m, to_m, range_m, None);
        if let Some(brute_s) = brute_s && from_m != to_m {
            let travel_s = ray.map_or(f64::INFINITY, |ray| ray.travel_s);
            prop_assert!(travel_s <= brute_s * (1.0 + 1e-7), "{travel_s} {brute_s}");
        }
    }
}

#[test]
fn one_place_is_reached_at_once_and_a_plumb_line_is_straight() {
    let water = WaterColumn::new(Profile::summer_thermocline(200.0), 200.0);
    let met = water.direct(30.0, 30.0, 0.0, None).unwrap();
    assert_eq!((met.travel_s, met.length_m, met.departure.cos), (0.0, 0.0, 1.0));
    let plumb = water.direct(10.0, 150.0, 0.0, None).unwrap();
    assert_eq!(
        (plumb.length_m, plumb.slowness_s_m, plumb.departure),
        (140.0, 0.0, Direction { cos: 0.0, sin: -1.0 })
    );
    let echo = water.bounced(Boundary::Surface, 1, 10.0, 150.0, 0.0, None).unwrap();
    assert!(is_same(echo.length_m, 160.0) && echo.departure.sin == 1.0 && echo.arrival.sin == -1.0);
}

#[test]
fn a_thermocline_casts_a_shadow_and_a_blocked_ray_is_none() {
    let water = WaterColumn::new(Profile::summer_thermocline(200.0), 200.0);
    // Both in water where sound is faster above: the ray between them arches upwards, into the surface if it must.
    let near = water.direct(20.0, 20.0, 100.0, None).unwrap();
    assert!(near.departure.sin > 0.0 && near.arrival.sin < 0.0);
    assert_eq!(water.direct(20.0, 20.0, 1_500.0, None), None);
    // What the surface reflects still gets there.
    assert!(water.bounced(Boundary::Bottom, 1, 20.0, 20.0, 1_500.0, None).is_some());
}

#[test]
fn points_beyond_the_boundaries_have_direct_rays_only() {
    let water = WaterColumn::new(Profile::uniform(1500.0).unwrap(), 100.0);
    let ray = water.direct(-3.0, 104.0, 150.0, None).unwrap();
    assert!(is_same(ray.length_m, (107.0_f64 * 107.0 + 150.0 * 150.0).sqrt()));
    assert_eq!(water.bounced(Boundary::Surface, 1, -3.0, 50.0, 10.0, None), None);
    assert_eq!(water.bounced(Boundary::Bottom, 1, 3.0, 101.0, 10.0, None), None);
    assert_eq!(water.bounced(Boundary::Bottom, 0, 3.0, 50.0, 10.0, None), None);
}

#[test]
fn the_ray_tells_how_it_meets_a_boundary() {
    let water = linear(200.0);
    let ray = water.bounced(Boundary::Bottom, 1, 50.0, 50.0, 300.0, None).unwrap();
    let grazing = ray.grazing(water.speed_at_m_s(Boundary::Bottom));
    // Nearly the straight line's.
    assert!((grazing.sin / grazing.cos - 1.0).abs() < 0.01, "{grazing:?}");
    assert_eq!(ray.grazing(1e6).sin, 0.0);
}
