use std::f64::consts::{FRAC_PI_2, PI};

use proptest::prelude::*;

use super::*;

/// T, S, D, then Mackenzie, Medwin and Coppens in m/s, to four digits. From the project's table of acoustic reference
/// values, where the first is confirmed by an independent package.
const BY_DEPTH: [([f64; 3], [f64; 3]); 12] = [
    ([27.0, 35.0, 10.0], [1539.0866, 1539.1731, 1539.1553]),
    ([25.0, 35.0, 20.0], [1534.6204, 1534.6762, 1534.6685]),
    ([10.0, 35.0, 100.0], [1491.4351, 1491.5900, 1491.4194]),
    ([0.0, 35.0, 0.0], [1448.9600, 1449.2000, 1449.0500]),
    ([2.0, 34.7, 6000.0], [1561.0575, 1553.7863, 1562.2169]),
    ([4.0, 34.5, 1000.0], [1482.3057, 1482.0886, 1482.3701]),
    ([15.0, 35.0, 200.0], [1509.9588, 1510.0038, 1509.9782]),
    ([20.0, 30.0, 50.0], [1516.6036, 1516.6200, 1516.6943]),
    ([30.0, 40.0, 0.0], [1550.5263, 1550.7300, 1550.6500]),
    ([5.0, 0.0, 10.0], [1425.6754, 1425.8713, 1426.2595]),
    ([10.0, 35.0, 0.0], [1489.8034, 1489.9900, 1489.7700]),
    ([8.0, 34.0, 4000.0], [1548.6715, 1545.3685, 1548.9624]),
];

/// T, S, P in bar, then Wong and Zhu's and the original coefficients in m/s, of the same table.
const CHEN_MILLERO: [([f64; 3], [f64; 2]); 6] = [
    ([0.0, 35.0, 0.0], [1449.1388, 1449.1388]),
    ([10.0, 35.0, 0.0], [1489.8321, 1489.8223]),
    ([10.0, 35.0, 100.0], [1506.3480, 1506.3382]),
    ([20.0, 35.0, 0.0], [1521.4780, 1521.4620]),
    ([40.0, 40.0, 1000.0], [1732.0175, 1731.9954]),
    ([25.0, 35.0, 0.0], [1534.4108, 1534.3926]),
];

/// T, S, P in dbar, then m/s, of the same table: it prints the last pressure as 101.972 kg/cm², which is 1,000 dbar rounded.
const DEL_GROSSO: [([f64; 3], f64); 4] = [
    ([0.0, 35.0, 0.0], 1449.0834),
    ([10.0, 35.0, 0.0], 1489.7894),
    ([20.0, 35.0, 0.0], 1521.4798),
    ([10.0, 35.0, 1000.0], 1506.1382),
];

/// Half of the last printed digit, and a little for the table's own rounding of a half.
const PRINTED: f64 = 5.001e-5;

#[test]
fn formulas_by_depth_give_the_reference_values() {
    for ([t, s, d], expected) in BY_DEPTH {
        for (found, expected) in
            [mackenzie(t, s, d), medwin(t, s, d), coppens(t, s, d)].into_iter().zip(expected)
        {
            assert!((found - expected).abs() < PRINTED, "{t} {s} {d}: {found} for {expected}");
        }
    }
}

#[test]
fn formulas_by_pressure_give_the_reference_values() {
    for ([t, s, p], expected) in CHEN_MILLERO {
        for (found, expected) in
            [chen_millero(t, s, p), chen_millero_ipts68(t, s, p)].into_iter().zip(expected)
        {
            assert!((found - expected).abs() < PRINTED, "{t} {s} {p}: {found} for {expected}");
        }
    }
    for ([t, s, p], expected) in DEL_GROSSO {
        let found = del_grosso(t, s, kg_cm2_from_dbar(p));
        assert!((found - expected).abs() < PRINTED, "{t} {s} {p}: {found} for {expected}");
    }
}

#[test]
fn latitude_matters_little() {
    for (t, d) in [(4.0, 1000.0), (2.0, 4000.0)] {
        let at = |latitude| chen_millero(t, 35.0, pressure_dbar_from_depth(d, latitude) / 10.0);
        let middle = SoundSpeedFormula::ChenMillero.speed_m_s(t, 35.0, d);
        for latitude in [0.0, FRAC_PI_2] {
            assert!((at(latitude) - middle).abs() < 0.05 * d / 1000.0);
        }
    }
}

/// Del Grosso's own coefficients of 1974, for temperatures of IPTS-68.
fn del_grosso_1974(t: f64, s: f64, p: f64) -> f64 {
    1402.392
        + t * (5.01109398873 + t * (-5.50946843172e-2 + t * 2.21535969240e-4))
        + s * (1.32952290781 + s * 1.28955756844e-4)
        + p * (1.56059257041e-1 + p * (2.44998688441e-5 - p * 8.83392332513e-9))
        + s * t * (-1.27562783426e-2 + t * 9.68403156410e-5 + p * (s * 4.85639620015e-6 - 3.40597039004e-4))
        + t * p * (6.35191613389e-3 - p * 1.59349479045e-6 + p * p * 5.22116437235e-10)
        + t * t * p * (p * 2.65484716608e-8 - t * 4.38031096213e-7)
        - s * s * p * p * 1.61674495909e-9
}

/// Two sets of coefficients for one function: what the table's few rows do not reach (deep, hot, salt), the other set does.
#[test]
fn both_temperature_scales_mean_the_same_sound() {
    let (mut grosso, mut millero) = (0.0_f64, 0.0_f64);
    for t in (0..=30).map(f64::from) {
        for s in (30..=40).map(f64::from) {
            for p in (0..=10).map(|i| f64::from(i) * 100.0) {
                let t68 = 1.00024 * t;
                grosso = grosso.max((del_grosso(t, s, p) - del_grosso_1974(t68, s, p)).abs());
                millero = millero.max((chen_millero(t, s, p) - chen_millero_ipts68(t68, s, p)).abs());
            }
        }
    }
    assert!(grosso < 0.001 && millero < 0.006, "{grosso} {millero}");
}

proptest! {
    #[test]
    fn all_formulas_agree_where_all_are_valid(t in 2.0..30.0, s in 33.0..37.0, d in 0.0..1000.0) {
        use SoundSpeedFormula::*;
        let reference = mackenzie(t, s, d);
        for formula in [Medwin, ChenMillero, DelGrosso, Coppens] {
            let found = formula.speed_m_s(t, s, d);
            prop_assert!((found - reference).abs() < 0.9, "{formula:?} {found} for {reference}");
        }
    }

    #[test]
    fn pressure_gives_saunders_depth_back(depth in 0.0..11_000.0, latitude in -PI / 2.0..PI / 2.0) {
        let p = pressure_dbar_from_depth(depth, latitude);
        let sin = pxfm::f_sin(latitude);
        let back = (1.0 - (5.92 + 5.25 * sin * sin) * 1e-3) * p - 2.21e-6 * p * p;
        prop_assert!((back - depth).abs() < 1e-9 * (1.0 + depth));
    }
}
