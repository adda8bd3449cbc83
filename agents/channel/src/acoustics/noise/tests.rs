use proptest::prelude::*;

use super::*;

/// kHz, shipping, wind in m/s, then the four parts and their sum in dB re 1 µPa²/Hz, to four digits. From the project's table
/// of acoustic reference values.
const COATES: [([f64; 3], [f64; 5]); 11] = [
    ([0.1, 0.5, 0.0], [47.0000, 67.1634, 42.0412, -35.0000, 67.2182]),
    ([0.5, 0.5, 5.0], [26.0309, 48.7167, 62.5802, -21.0206, 62.7560]),
    ([1.0, 0.0, 0.0], [17.0000, 29.2298, 44.1549, -15.0000, 44.3005]),
    ([1.0, 0.5, 0.0], [17.0000, 39.2298, 44.1549, -15.0000, 45.3726]),
    ([1.0, 1.0, 10.0], [17.0000, 49.2298, 67.8720, -15.0000, 67.9310]),
    ([10.0, 0.5, 5.0], [-13.0000, 5.9219, 46.0892, 5.0000, 46.0899]),
    ([12.0, 0.5, 5.0], [-15.3754, 3.2428, 44.6173, 6.5836, 44.6183]),
    ([25.0, 0.5, 5.0], [-24.9382, -7.5612, 38.5360, 12.9588, 38.5481]),
    ([25.0, 0.5, 10.0], [-24.9382, -7.5612, 45.4825, 12.9588, 45.4850]),
    ([50.0, 0.0, 0.0], [-33.9691, -27.7806, 15.8822, 18.9794, 20.7116]),
    ([100.0, 0.5, 10.0], [-43.0000, -28.0078, 33.6477, 25.0000, 34.2035]),
];

#[test]
fn parts_and_sum_give_the_reference_values() {
    for ([f, shipping, wind_m_s], expected) in COATES {
        let total = AmbientNoise { shipping, wind_m_s }.spectral_level_db(f);
        let found = [turbulence_db(f), shipping_db(f, shipping), wind_db(f, wind_m_s), thermal_db(f), total];
        for (found, expected) in found.into_iter().zip(expected) {
            assert!(
                (found - expected).abs() < 5.001e-5,
                "{f} kHz, {shipping}, {wind_m_s}: {found} for {expected}"
            );
        }
    }
}

/// The power in a band by the midpoint rule, and by another variable: sixty thousand even steps of the cube root of the
/// frequency.
fn fine_sum_db(noise: &AmbientNoise, lower_hz: f64, upper_hz: f64) -> f64 {
    let steps = 60_000;
    let (lower, upper) = (pxfm::f_cbrt(lower_hz), pxfm::f_cbrt(upper_hz));
    let step = (upper - lower) / f64::from(steps);
    let sum: f64 = (0..steps)
        .map(|i| {
            let root = lower + (f64::from(i) + 0.5) * step;
            3.0 * root * root * noise.power_density(root * root * root / 1000.0)
        })
        .sum();
    db_from_power(sum * step)
}

#[test]
fn band_levels_agree_with_a_much_finer_sum() {
    for (shipping, wind_m_s) in [(0.0, 0.0), (1.0, 0.0), (0.5, 5.0), (0.0, 20.0)] {
        let noise = AmbientNoise { shipping, wind_m_s };
        for (lower_hz, upper_hz, tolerance_db) in [
            (22.5e3, 27.5e3, 1e-7),
            (20e3, 40e3, 1e-7),
            (18e3, 34e3, 1e-7),
            (3e3, 30e3, 1e-4),
            (10.0, 100e3, 0.01),
            (1.0, 1e3, 0.01),
            (1.0, 1e6, 0.01),
        ] {
            let found = noise.band_level_db(0.5 * (lower_hz + upper_hz), upper_hz - lower_hz);
            let fine = fine_sum_db(&noise, lower_hz, upper_hz);
            assert!(
                (found - fine).abs() < tolerance_db,
                "{lower_hz} to {upper_hz} Hz, {noise:?}: {found} for {fine}"
            );
        }
    }
}

#[test]
fn a_narrow_band_holds_its_spectral_level() {
    let noise = AmbientNoise { shipping: 0.5, wind_m_s: 5.0 };
    assert!((noise.band_level_db(25e3, 1.0) - noise.spectral_level_db(25.0)).abs() < 1e-6);
}

#[test]
fn a_band_is_cut_at_one_hertz() {
    let noise = AmbientNoise { shipping: 0.5, wind_m_s: 5.0 };
    let whole = noise.band_level_db(50.5, 99.0);
    assert!((noise.band_level_db(50.0, 100.0) - whole).abs() < 1e-12);
}

proptest! {
    #[test]
    fn noise_is_finite_and_louder_than_each_part(
        log_f in -3.0..2.7, shipping in 0.0..=1.0, wind_m_s in 0.0..40.0,
    ) {
        let f = pxfm::f_exp10(log_f);
        let total = AmbientNoise { shipping, wind_m_s }.spectral_level_db(f);
        prop_assert!(total.is_finite());
        for part in [turbulence_db(f), shipping_db(f, shipping), wind_db(f, wind_m_s), thermal_db(f)] {
            prop_assert!(part <= total + 1e-9);
        }
    }

    #[test]
    fn two_halves_of_a_band_add_up(centre in 8e3..60e3, share in 0.05..1.0, wind_m_s in 0.0..30.0) {
        let noise = AmbientNoise { shipping: 0.5, wind_m_s };
        let width = share * centre;
        let whole = power_from_db(noise.band_level_db(centre, width));
        let halves = power_from_db(noise.band_level_db(centre - 0.25 * width, 0.5 * width))
            + power_from_db(noise.band_level_db(centre + 0.25 * width, 0.5 * width));
        prop_assert!((halves / whole - 1.0).abs() < 1e-6);
    }
}
