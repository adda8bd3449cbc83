use proptest::prelude::*;

use super::super::decibel::power_from_db;
use super::*;

#[test]
fn figures_of_the_reference_hold() {
    let ber = |fading, db| bit_error_rate(Modulation::Bpsk, fading, power_from_db(db));
    let steady = ber(Fading::None, 7.0);
    assert!((steady - 7.727e-4).abs() < 5e-8, "{steady}");
    assert!((packet_error_rate(steady, 256) - 0.1795).abs() < 5e-5);
    assert!((packet_error_rate(ber(Fading::None, 9.6), 256) - 0.0025).abs() < 5e-5);
    assert!((ber(Fading::Rayleigh, 7.0) - 4.3474e-2).abs() < 5e-7);
}

/// k, Eb/N0 in dB, then BPSK and FSK: the error rates in Gaussian noise, averaged in 25 digits over the density of a Rician
/// envelope's power (with its Bessel function), which shares nothing with the code.
const RICIAN: [(f64, f64, [f64; 2]); 12] = [
    (1.0, 3.0, [0.08073879794, 0.2391584752]),
    (1.0, 7.0, [0.03550229921, 0.1272582558]),
    (1.0, 10.0, [0.0182097614, 0.06993452279]),
    (1.0, 15.0, [0.005809922898, 0.02310860234]),
    (5.0, 3.0, [0.04698957675, 0.2101792988]),
    (5.0, 7.0, [0.01114158332, 0.08084646929]),
    (5.0, 10.0, [0.003299056684, 0.02809931004]),
    (5.0, 15.0, [0.0005233548695, 0.003666962276]),
    (10.0, 3.0, [0.03587368155, 0.1995910855]),
    (10.0, 7.0, [0.004958601685, 0.06368448165]),
    (10.0, 10.0, [0.0007014439902, 0.01510332093]),
    (10.0, 15.0, [2.66391263e-5, 0.0005634993198]),
];

#[test]
fn rician_fading_averages_the_gaussian_rates() {
    for (k, db, expected) in RICIAN {
        for (modulation, expected) in [Modulation::Bpsk, Modulation::Fsk].into_iter().zip(expected) {
            let found = bit_error_rate(modulation, Fading::Rician { k }, power_from_db(db));
            assert!((found / expected - 1.0).abs() < 1e-8, "{modulation:?} {k} {db}: {found} for {expected}");
        }
    }
}

#[test]
fn rates_stay_exact_where_they_are_tiny() {
    // 1 / (4 g) to first order: 1 - sqrt(g / (1 + g)) alone would have lost all digits.
    let rayleigh = bit_error_rate(Modulation::Bpsk, Fading::Rayleigh, 1e18);
    assert!((rayleigh * 4e18 - 1.0).abs() < 1e-15);
    assert_eq!(packet_error_rate(0.0, 256), 0.0);
    assert!((packet_error_rate(1e-19, 256) / 2.56e-17 - 1.0).abs() < 1e-15);
    assert_eq!(packet_error_rate(0.5, 0), 0.0);
}

#[test]
fn an_unknown_ratio_ends_and_stays_unknown() {
    assert!(bit_error_rate(Modulation::Bpsk, Fading::Rician { k: f64::NAN }, 1.0).is_nan());
}

fn modulations() -> impl Strategy<Value = Modulation> {
    prop_oneof![Just(Modulation::Bpsk), Just(Modulation::Fsk)]
}

fn fadings() -> impl Strategy<Value = Fading> {
    prop_oneof![
        Just(Fading::None),
        Just(Fading::Rayleigh),
        (-3.0..6.0).prop_map(|log_k| Fading::Rician { k: pxfm::f_exp10(log_k) }),
    ]
}

proptest! {
    #[test]
    fn rates_fall_with_the_ratio(modulation in modulations(), fading in fadings(), db in -60.0..25.0) {
        let rate = bit_error_rate(modulation, fading, power_from_db(db));
        prop_assert!((0.0..=0.5).contains(&rate), "{rate}");
        prop_assert!(bit_error_rate(modulation, fading, power_from_db(db + 0.1)) < rate);
        prop_assert!((bit_error_rate(modulation, fading, 0.0) - 0.5).abs() < 1e-12);
    }

    #[test]
    fn a_rician_channel_lies_between_its_limits(modulation in modulations(), db in -30.0..16.0) {
        let g = power_from_db(db);
        let at = |k| bit_error_rate(modulation, Fading::Rician { k }, g);
        let rayleigh = bit_error_rate(modulation, Fading::Rayleigh, g);
        let steady = bit_error_rate(modulation, Fading::None, g);
        prop_assert!((at(0.0) / rayleigh - 1.0).abs() < 1e-12);
        prop_assert!((at(f64::INFINITY) - steady).abs() < 1e-11 * steady + 1e-20);
        prop_assert!((at(1e9) - steady).abs() < 1e-7 * steady.max(1e-3));
    }

    #[test]
    fn steadier_paths_err_less(modulation in modulations(), db in 0.0..12.0, log_k in -1.0..3.0) {
        let at = |k| bit_error_rate(modulation, Fading::Rician { k }, power_from_db(db));
        let k = pxfm::f_exp10(log_k);
        prop_assert!(at(1.1 * k) < at(k));
    }

    #[test]
    fn longer_packets_are_lost_more(rate in 1e-12..0.1, bits in 1_u32..4096) {
        let loss = packet_error_rate(rate, bits);
        prop_assert!(loss > 0.0 && loss <= f64::from(bits) * rate * (1.0 + 1e-14) && loss <= 1.0);
        prop_assert!(packet_error_rate(rate, 2 * bits) >= loss);
        let twice = 1.0 - (1.0 - loss) * (1.0 - loss);
        prop_assert!((packet_error_rate(rate, 2 * bits) - twice).abs() < 1e-14);
    }
}
