use proptest::prelude::*;

use super::*;

fn nodes(rows: &[(f64, f64)]) -> Vec<Node> {
    rows.iter().map(|&(depth_m, speed_m_s)| Node { depth_m, speed_m_s }).collect()
}

#[test]
fn what_is_no_profile_is_refused_with_its_place() {
    let new = |rows: &[(f64, f64)]| Profile::new(&nodes(rows)).unwrap_err();
    assert_eq!(new(&[]), ProfileError::Empty);
    let repeated = new(&[(0.0, 1500.0), (10.0, 1490.0), (10.0, 1480.0)]);
    assert_eq!(repeated, ProfileError::Order { index: 2, depth_m: 10.0, previous_m: 10.0 });
    assert!(repeated.to_string().contains("depths must increase"), "{repeated}");
    assert!(matches!(new(&[(5.0, 1500.0), (1.0, 1500.0)]), ProfileError::Order { index: 1, .. }));
    assert!(matches!(new(&[(0.0, 1500.0), (1.0, -3.0)]), ProfileError::Speed { index: 1, .. }));
    assert!(matches!(new(&[(0.0, f64::NAN)]), ProfileError::Speed { index: 0, .. }));
    assert!(matches!(new(&[(f64::INFINITY, 1500.0)]), ProfileError::Depth { index: 0, .. }));
    assert!(matches!(Profile::uniform(0.0), Err(ProfileError::Speed { .. })));
}

#[test]
fn a_shift_moves_every_speed_and_no_depth() {
    let profile = Profile::summer_thermocline(150.0);
    let shifted = profile.shifted_m_s(-2.5).unwrap();
    for depth_m in [-3.0, 0.0, 17.0, 25.0, 149.0, 400.0] {
        assert!((shifted.speed_m_s(depth_m) - profile.speed_m_s(depth_m) + 2.5).abs() < 1e-9);
    }
    assert!(matches!(profile.shifted_m_s(-1_600.0), Err(ProfileError::Speed { index: 0, .. })));
}

#[test]
fn named_profiles_end_at_the_bottom_and_are_what_they_say() {
    let named = [Profile::mixed_layer, Profile::summer_thermocline, Profile::arctic, Profile::munk];
    for profile in named {
        for bottom_m in [0.5, 15.0, 37.0, 200.0, 3_000.0, 10_994.0] {
            let profile = profile(bottom_m);
            assert!(Profile::new(profile.nodes()).is_ok());
            assert_eq!(profile.nodes()[0].depth_m, 0.0);
            assert_eq!(profile.nodes().last().unwrap().depth_m, bottom_m);
        }
        for bottom_m in [0.0, -5.0, f64::NAN, f64::INFINITY] {
            assert!(Profile::new(profile(bottom_m).nodes()).is_ok(), "{bottom_m}");
        }
    }
    // A duct above a thermocline; nothing but down below it; nothing but up under ice.
    let slope =
        |profile: &Profile, depth_m: f64| profile.speed_m_s(depth_m + 0.5) - profile.speed_m_s(depth_m - 0.5);
    let mixed = Profile::mixed_layer(1_000.0);
    assert!(slope(&mixed, 30.0) > 0.015 && slope(&mixed, 100.0) < -0.05);
    assert!((20..100).all(|m| slope(&Profile::summer_thermocline(1_000.0), f64::from(m)) < 0.0));
    assert!((1..3_000).all(|m| slope(&Profile::arctic(3_000.0), f64::from(m)) > 0.0));
}

#[test]
fn the_sound_channel_is_sampled_as_finely_as_it_says() {
    let profile = Profile::munk(5_000.0);
    assert!(profile.nodes().len() < 20, "{}", profile.nodes().len());
    let mut worst_m_s = 0.0_f64;
    for depth_m in (0..5_000).map(f64::from) {
        let eta = 2.0 * (depth_m - 1_300.0) / 1_300.0;
        let munk_m_s = 1500.0 * (1.0 + 0.00737 * (eta - 1.0 + pxfm::f_exp(-eta)));
        worst_m_s = worst_m_s.max((profile.speed_m_s(depth_m) - munk_m_s).abs());
    }
    assert!(worst_m_s < 0.16, "{worst_m_s}");
    // The axis, and the value at the surface that the formula gives by hand: 1500 (1 + 0.00737 (e² - 3)).
    assert!((profile.speed_m_s(1_300.0) - 1_500.0).abs() < 0.16);
    assert!((profile.speed_m_s(0.0) - 1_548.52).abs() < 0.01, "{}", profile.speed_m_s(0.0));
}

proptest! {
    #[test]
    fn speeds_lie_between_their_nodes_and_bounds_hold(
        steps in prop::collection::vec((0.01..100.0_f64, 1_400.0..1_600.0_f64), 1..12),
        from in -20.0..600.0_f64, to in -20.0..600.0_f64, share in 0.0..1.0_f64,
    ) {
        let mut depth_m = 0.0;
        let rows: Vec<(f64, f64)> = steps.iter().map(|&(step_m, speed_m_s)| { depth_m += step_m; (depth_m, speed_m_s) }).collect();
        let profile = Profile::new(&nodes(&rows)).unwrap();
        for node in profile.nodes() {
            prop_assert_eq!(profile.speed_m_s(node.depth_m), node.speed_m_s);
        }
        let (least, greatest) = profile.speed_bounds_m_s(from, to);
        let between = profile.speed_m_s(from + share * (to - from));
        prop_assert!(least - 1e-9 <= between && between <= greatest + 1e-9);
        let mut inside =
            profile.nodes().iter().filter(|node| node.depth_m > from.min(to) && node.depth_m < from.max(to));
        prop_assert!(inside.all(|node| (least..=greatest).contains(&node.speed_m_s)));
    }
}
