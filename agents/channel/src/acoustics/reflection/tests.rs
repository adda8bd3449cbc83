use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use proptest::prelude::*;

use super::super::density::sea_water_density_kg_m3;
use super::super::sound_speed::mackenzie;
use super::*;

/// From the project's table of acoustic reference values: 45 degrees, water of 27 °C and 35 psu at 10 m.
#[test]
fn a_lossless_bottom_gives_the_reference_value() {
    let bottom =
        FluidBottom { density_kg_m3: 1200.0, sound_speed_m_s: 1600.0, attenuation_db_per_wavelength: 0.0 };
    let found =
        bottom.reflection(sea_water_density_kg_m3(27.0, 35.0), mackenzie(27.0, 35.0, 10.0), FRAC_PI_4);
    assert!((found - 0.11979872749145926).abs() < 1e-15, "{found}");
    // Head-on the impedances alone count: 20 lg (2.28 / 0.28).
    assert!((bottom.loss_db(1000.0, 1500.0, FRAC_PI_2) - 18.215536).abs() < 1e-6);
}

/// Grazing angle in radians and reflection of sand (1900 kg/m³, 1650 m/s, 0.8 dB per wavelength) under water of 1000 kg/m³ and
/// 1500 m/s: the same formula in complex arithmetic of 30 digits.
const SAND: [(f64, f64); 5] = [
    (0.1, 0.9452925955522938),
    (0.3, 0.892542919095326),
    (0.5, 0.5811045677212896),
    (1.0, 0.37243243372701606),
    (1.5, 0.35301001218793118),
];

#[test]
fn a_lossy_bottom_gives_the_complex_formulas_value() {
    let sand =
        FluidBottom { density_kg_m3: 1900.0, sound_speed_m_s: 1650.0, attenuation_db_per_wavelength: 0.8 };
    for (grazing_rad, expected) in SAND {
        let found = sand.reflection(1000.0, 1500.0, grazing_rad);
        assert!((found - expected).abs() < 1e-14, "{grazing_rad}: {found} for {expected}");
    }
}

#[test]
fn all_sound_comes_back_below_the_critical_angle() {
    let bottom =
        FluidBottom { density_kg_m3: 1900.0, sound_speed_m_s: 1650.0, attenuation_db_per_wavelength: 0.0 };
    let critical_rad = pxfm::f_acos(1500.0 / 1650.0);
    assert!((0.0..1e-12).contains(&bottom.loss_db(1000.0, 1500.0, 0.99 * critical_rad)));
    assert!(bottom.loss_db(1000.0, 1500.0, 1.01 * critical_rad) > 1.0);
}

#[test]
fn a_bottom_of_water_gives_nothing_back() {
    let water =
        FluidBottom { density_kg_m3: 1000.0, sound_speed_m_s: 1500.0, attenuation_db_per_wavelength: 0.0 };
    assert!(water.reflection(1000.0, 1500.0, 0.5) < 1e-15);
    assert_eq!(water.reflection(1000.0, 1500.0, 0.0), 1.0);
}

/// 1.26e-3 / sin 30° · 10^1.57 · 25^0.85, and the fading below 6 m/s.
#[test]
fn bubbles_follow_the_handbook() {
    let grazing_rad = std::f64::consts::FRAC_PI_6;
    assert!((bubble_loss_db(10.0, 25.0, grazing_rad) - 1.4443).abs() < 1e-4);
    let breaking = bubble_loss_db(6.0, 25.0, grazing_rad);
    let light = bubble_loss_db(5.0, 25.0, grazing_rad);
    assert!((light / breaking - 0.301194211912202).abs() < 1e-14);
    assert_eq!(bubble_loss_db(15.0, 25.0, 0.0), BUBBLE_LOSS_CEILING_DB);
    assert_eq!(SurfaceLoss::Constant { loss_db: 2.0 }.loss_db(25.0, 0.1), 2.0);
}

proptest! {
    #[test]
    fn no_bottom_returns_more_than_it_gets(
        density_kg_m3 in 1000.0..3000.0, sound_speed_m_s in 1400.0..5000.0,
        attenuation_db_per_wavelength in 0.0..3.0, grazing_rad in 0.0..=FRAC_PI_2,
    ) {
        let bottom = FluidBottom { density_kg_m3, sound_speed_m_s, attenuation_db_per_wavelength };
        let pressure = bottom.reflection(1025.0, 1500.0, grazing_rad);
        prop_assert!((0.0..=1.0).contains(&pressure), "{pressure}");
        prop_assert!(bottom.loss_db(1025.0, 1500.0, grazing_rad) >= 0.0);
        prop_assert_eq!(bottom.reflection(1025.0, 1500.0, 0.0), 1.0);
    }

    #[test]
    fn wind_never_makes_the_surface_louder(
        wind_m_s in 0.0..25.0, frequency_khz in 10.0..100.0, grazing_rad in 0.01..=FRAC_PI_2,
    ) {
        let loss_db = bubble_loss_db(wind_m_s, frequency_khz, grazing_rad);
        prop_assert!((0.0..=BUBBLE_LOSS_CEILING_DB).contains(&loss_db));
        prop_assert!(bubble_loss_db(wind_m_s + 0.5, frequency_khz, grazing_rad) >= loss_db);
        prop_assert!(bubble_loss_db(wind_m_s, frequency_khz, 0.9 * grazing_rad) >= loss_db);
    }
}
