use shoal_scenario::model::{Absorption, Bottom, Fading, FadingKind, FadingPer, Noise};

use super::*;

/// A sea with these speeds of sound, and nothing special about the rest.
pub fn sea(sound_speed: SoundSpeed, bottom_depth_m: f64) -> Level {
    Level::Sea(Sea {
        sound_speed,
        bottom_depth_m,
        temperature_c: 10.0,
        salinity_psu: 35.0,
        ph: 8.0,
        absorption: Absorption::FrancoisGarrison,
        spreading_exponent: 2.0,
        shipping: 0.5,
        wind_m_s: 5.0,
        surface_loss_db: None,
        bottom: Bottom { density_kg_m3: 1900.0, sound_speed_m_s: 1650.0, attenuation_db_wavelength: 0.8 },
        bounces_max: 0,
        fading: Fading { kind: FadingKind::Gaussian, per: FadingPer::Packet },
    })
}

fn scenario(sound_speed: SoundSpeed, error_m_s: f64, bottom_depth_m: f64) -> Scenario {
    let (source_name, text) = shoal_scenario::load("two-circles").unwrap();
    let mut scenario = shoal_scenario::parse(&source_name, &text).unwrap();
    scenario.noise = Noise::Adversarial;
    scenario.environment.sound_speed_m_s = 1490.0;
    scenario.environment.sound_speed_error_m_s = error_m_s;
    scenario.environment.level = sea(sound_speed, bottom_depth_m);
    scenario
}

fn speeds() -> SoundSpeed {
    SoundSpeed::Speeds {
        depths_m: vec![5.0, 20.0, 60.0, 200.0],
        speeds_m_s: vec![1520.0, 1518.0, 1500.0, 1530.0],
    }
}

#[test]
fn truth_is_the_stated_profile_off_by_one_error_at_all_depths_and_inside_what_is_told() {
    let named =
        [NamedProfile::MixedLayer, NamedProfile::SummerThermocline, NamedProfile::Arctic, NamedProfile::Munk];
    let all = named.map(SoundSpeed::Named).into_iter().chain([SoundSpeed::Uniform, speeds()]);
    for sound_speed in all {
        let scenario = scenario(sound_speed.clone(), 1.5, 120.0);
        let Level::Sea(sea) = &scenario.environment.level else { panic!("made for level sea") };
        let stated = stated_profile(&scenario.environment, sea).unwrap();
        let water = Water::new(&scenario).unwrap();
        let column = water.column.unwrap();
        // Below the bottom too: bodies stray.
        for depth_m in (-10..300).map(f64::from) {
            let truth_m_s = column.profile().speed_m_s(depth_m);
            let off_m_s = (truth_m_s - stated.speed_m_s(depth_m)).abs();
            assert!((off_m_s - 1.5).abs() < 1e-9, "{off_m_s} m/s at {depth_m} m of {sound_speed:?}");
            assert!(water.told_sound_speed_m_s.contains(truth_m_s), "{depth_m} m of {sound_speed:?}");
        }
    }
}

#[test]
fn what_is_told_is_no_wider_than_the_column_and_the_error() {
    for (bottom_m, slowest_m_s, fastest_m_s) in
        [(200.0, 1500.0, 1530.0), (60.0, 1500.0, 1520.0), (40.0, 1509.0, 1520.0), (3.0, 1520.0, 1520.0)]
    {
        let Bounds { lower, upper } =
            Water::new(&scenario(speeds(), 0.5, bottom_m)).unwrap().told_sound_speed_m_s;
        let off_m_s = [slowest_m_s - 0.5 - lower, upper - fastest_m_s - 0.5];
        assert!(off_m_s.iter().all(|off| (0.0..1e-7).contains(off)), "{off_m_s:?} to {bottom_m} m");
    }
}

#[test]
fn every_direct_ray_of_a_named_profile_keeps_what_is_told() {
    let mut rays = 0;
    for name in [NamedProfile::MixedLayer, NamedProfile::SummerThermocline, NamedProfile::Munk] {
        let water = Water::new(&scenario(SoundSpeed::Named(name), 0.5, 150.0)).unwrap();
        let column = water.column.unwrap();
        for (from_m, to_m, range_m) in [
            (5.0, 140.0, 300.0),
            (70.0, 90.0, 900.0),
            (30.0, 30.0, 50.0),
            (1.0, 2.0, 40.0),
            (10.0, 149.0, 0.0),
        ] {
            let Some(ray) = column.direct(from_m, to_m, range_m, None) else { continue };
            let (deeper_m, range_m): (f64, f64) = (to_m - from_m, range_m);
            let effective_m_s = (range_m * range_m + deeper_m * deeper_m).sqrt() / ray.travel_s;
            assert!(water.told_sound_speed_m_s.contains(effective_m_s), "{effective_m_s} in {name:?}");
            rays += 1;
        }
    }
    assert!(rays >= 12, "{rays} rays are too few to tell");
}

#[test]
fn temperature_and_salinity_make_the_speed_of_their_formula_at_their_depths() {
    // Mackenzie at 10 °C, 35 psu, 100 m.
    let water = |formula| SoundSpeed::Water {
        depths_m: vec![0.0, 100.0],
        temperatures_c: vec![12.0, 10.0],
        salinities_psu: vec![34.0, 35.0],
        formula,
    };
    let speed_m_s = |formula, depth_m| {
        let water = Water::new(&scenario(water(formula), 0.0, 100.0)).unwrap();
        water.column.unwrap().profile().speed_m_s(depth_m)
    };
    assert!((speed_m_s(FormulaName::Mackenzie, 100.0) - 1491.4351).abs() < 1e-4);
    for (named, formula) in [
        (FormulaName::Mackenzie, SoundSpeedFormula::Mackenzie),
        (FormulaName::Medwin, SoundSpeedFormula::Medwin),
        (FormulaName::ChenMillero, SoundSpeedFormula::ChenMillero),
        (FormulaName::DelGrosso, SoundSpeedFormula::DelGrosso),
    ] {
        assert_eq!(speed_m_s(named, 0.0), formula.speed_m_s(12.0, 34.0, 0.0));
        assert_eq!(speed_m_s(named, 100.0), formula.speed_m_s(10.0, 35.0, 100.0));
    }
}

#[test]
fn what_is_no_profile_is_an_error_and_no_panic() {
    let repeated = SoundSpeed::Speeds { depths_m: vec![5.0, 5.0], speeds_m_s: vec![1500.0, 1510.0] };
    assert!(matches!(Water::new(&scenario(repeated, 0.0, 50.0)), Err(ProfileError::Order { .. })));
    let empty = SoundSpeed::Speeds { depths_m: vec![], speeds_m_s: vec![] };
    assert!(matches!(Water::new(&scenario(empty, 0.0, 50.0)), Err(ProfileError::Empty)));
}

#[test]
fn water_less_deep_than_two_nodes_are_apart_has_one_speed() {
    for bottom_m in [1e-9, 5e-4, 1.999e-3, 2e-3, 3e-3] {
        let water = Water::new(&scenario(speeds(), 0.0, bottom_m)).unwrap();
        assert!(water.told_sound_speed_m_s.contains(1520.0));
        assert_eq!(water.column.unwrap().profile().speed_m_s(bottom_m), 1520.0);
    }
}
