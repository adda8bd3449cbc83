use proptest::prelude::*;

use super::*;

/// Half of the last printed digit, and a little for the table's own rounding of a half.
const PRINTED: f64 = 5.001e-7;

/// Kilohertz, then Stojanovic's and Jensen's variants in dB/km, Urick's in dB/kyd, and Urick's times 1.0936. From the
/// project's table of acoustic reference values.
const THORP: [(f64, [f64; 4]); 11] = [
    (0.1, [0.004199, 0.004499, 0.004090, 0.004473]),
    (0.5, [0.027752, 0.028058, 0.025508, 0.027895]),
    (1.0, [0.069004, 0.069329, 0.063029, 0.068928]),
    (5.0, [0.382311, 0.383236, 0.348453, 0.381068]),
    (10.0, [1.187030, 1.189830, 1.081891, 1.183156]),
    (12.0, [1.644773, 1.648673, 1.499121, 1.639438]),
    (20.0, [4.133837, 4.144137, 3.768306, 4.121020]),
    (25.0, [6.104805, 6.120730, 5.565721, 6.086672]),
    (30.0, [8.280378, 8.303178, 7.550389, 8.257105]),
    (50.0, [17.467123, 17.529923, 15.941975, 17.434144]),
    (100.0, [34.068663, 34.318963, 31.221784, 34.144143]),
];

/// kHz, °C, psu, m, pH, then Francois-Garrison, the same by a widely used package, and Ainslie-McColm, in dB/km. From the
/// same table. The package takes the warmer fit at 20 °C sharp, where it differs in the fifth digit.
const BY_WATER: [([f64; 5], [f64; 3]); 12] = [
    ([1.0, 10.0, 35.0, 0.0, 8.0], [0.060126, 0.060126, 0.061323]),
    ([10.0, 10.0, 35.0, 0.0, 8.0], [0.962637, 0.962637, 0.986572]),
    ([12.0, 4.0, 35.0, 1000.0, 7.8], [1.360851, 1.360851, 1.364898]),
    ([25.0, 10.0, 35.0, 100.0, 8.0], [4.928066, 4.928066, 5.027164]),
    ([26.0, 15.0, 35.0, 50.0, 8.1], [4.634451, 4.634451, 4.712465]),
    ([50.0, 27.0, 35.0, 10.0, 8.1], [10.710333, 10.710333, 10.431545]),
    ([100.0, 10.0, 35.0, 0.0, 8.0], [33.630316, 33.630316, 34.341022]),
    ([10.0, 4.0, 35.0, 1000.0, 8.0], [1.005293, 1.005293, 1.009861]),
    ([25.0, 20.0, 35.0, 10.0, 8.0], [3.682704, 3.682642, 3.699973]),
    ([30.0, 0.0, 34.0, 500.0, 8.0], [7.120505, 7.120505, 7.104136]),
    ([50.0, 5.0, 0.01, 10.0, 8.0], [0.968217, 0.968217, 1.023119]),
    ([200.0, 25.0, 36.0, 10.0, 8.1], [88.448104, 88.448104, 92.122367]),
];

#[test]
fn thorps_variants_give_the_reference_values() {
    for (f, expected) in THORP {
        let urick = thorp_urick_db_per_kyd(f);
        let all = [thorp_stojanovic(f), thorp_jensen(f), urick, urick * 1.0936];
        for (found, expected) in all.into_iter().zip(expected) {
            assert!((found - expected).abs() < PRINTED, "{f} kHz: {found} for {expected}");
        }
    }
}

#[test]
fn formulas_by_water_give_the_reference_values() {
    for ([f, temperature_c, salinity_psu, depth_m, ph], [own, package, simple]) in BY_WATER {
        let water = SeaWater { temperature_c, salinity_psu, depth_m, ph };
        let found = francois_garrison(f, &water);
        assert!((found - own).abs() < PRINTED, "{f} kHz, {water:?}: {found} for {own}");
        let found = ainslie_mccolm(f, &water);
        assert!((found - simple).abs() < PRINTED, "{f} kHz, {water:?}: {found} for {simple}");

        let at = if temperature_c == 20.0 { f64::next_up(temperature_c) } else { temperature_c };
        let found = francois_garrison(f, &SeaWater { temperature_c: at, ..water });
        assert!((found - package).abs() < PRINTED, "{f} kHz, {water:?}: {found} for {package}");
    }
}

proptest! {
    #[test]
    fn absorption_is_positive_and_grows_with_frequency(
        f in 0.1..1000.0, t in -2.0..30.0, s in 0.0..42.0, d in 0.0..7000.0, ph in 7.7..8.3,
    ) {
        use AbsorptionFormula::*;
        let water = SeaWater { temperature_c: t, salinity_psu: s, depth_m: d, ph };
        for formula in [ThorpStojanovic, ThorpJensen, FrancoisGarrison, AinslieMcColm] {
            let found = formula.absorption_db_per_km(f, &water);
            prop_assert!(found > 0.0 && found.is_finite(), "{formula:?}: {found}");
            prop_assert!(formula.absorption_db_per_km(1.01 * f, &water) > found);
        }
    }

    #[test]
    fn the_simple_formula_follows_the_long_one(f in 0.4..500.0, t in 0.0..25.0, d in 0.0..3000.0) {
        let water = SeaWater { temperature_c: t, salinity_psu: 35.0, depth_m: d, ph: 8.0 };
        let ratio = ainslie_mccolm(f, &water) / francois_garrison(f, &water);
        prop_assert!((ratio - 1.0).abs() < 0.15, "{ratio}");
    }
}
