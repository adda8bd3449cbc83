//! The budgets that the scenario crate works out by hand for each modem are what the channel's acoustics compute, and what a
//! modem decodes at a range follows from them.

use shoal_bus::message::AuvId;
use shoal_bus::time::SimTime;
use shoal_bus::traffic::SoundPath;
use shoal_channel::acoustics::absorption::thorp_stojanovic;
use shoal_channel::acoustics::decibel::power_from_db;
use shoal_channel::acoustics::modulation::{
    Fading as BitFading, Modulation as Keying, bit_error_rate, packet_error_rate,
};
use shoal_channel::acoustics::noise::AmbientNoise;
use shoal_channel::budget::{Link, noise_db};
use shoal_channel::draw::{Draws, Purpose};
use shoal_channel::reception::{Arrival, ArrivalKind, Ear, EarSettings, Verdict};
use shoal_scenario::PING_BYTES;
use shoal_scenario::model::{
    Absorption, Bottom, Fading, FadingKind, FadingPer, Modulation, Noise, PhysicalLayer, Sea, SoundSpeed,
};
use shoal_scenario::presets::{BUDGET_SHIPPING, BUDGET_WIND_M_S, BUDGETS, Budget, MODEMS};

const BITS: u32 = 8 * PING_BYTES as u32;

/// The water of the budgets, with spreading of this exponent.
fn sea(spreading_exponent: f64, fading: Fading) -> Sea {
    Sea {
        sound_speed: SoundSpeed::Uniform,
        bottom_depth_m: 100.0,
        temperature_c: 10.0,
        salinity_psu: 35.0,
        ph: 8.0,
        absorption: Absorption::ThorpStojanovic,
        spreading_exponent,
        shipping: BUDGET_SHIPPING,
        wind_m_s: BUDGET_WIND_M_S,
        surface_loss_db: None,
        bottom: Bottom { density_kg_m3: 1900.0, sound_speed_m_s: 1650.0, attenuation_db_wavelength: 0.8 },
        bounces_max: 0,
        fading,
    }
}

const STEADY: Fading = Fading { kind: FadingKind::Gaussian, per: FadingPer::Packet };

fn layers() -> impl Iterator<Item = (&'static Budget, PhysicalLayer)> {
    BUDGETS.iter().map(|budget| {
        let (_, modem) = MODEMS.iter().find(|(name, _)| *name == budget.modem).unwrap();
        (budget, modem.physical.unwrap())
    })
}

/// Equal to the printed hundredths.
#[track_caller]
fn same_hundredths(printed_db: f64, computed_db: f64) {
    assert!(
        (printed_db - computed_db).abs() <= 0.005 + 1e-9,
        "{printed_db} is printed, {computed_db} computed"
    );
}

#[test]
fn every_figure_of_the_budgets_is_what_the_acoustics_compute() {
    for (budget, layer) in layers() {
        let frequency_khz = layer.centre_hz * 1e-3;
        let absorption_db = thorp_stojanovic(frequency_khz) * budget.range_m * 1e-3;
        same_hundredths(budget.absorption_db_km, thorp_stojanovic(frequency_khz));
        let noise = AmbientNoise { shipping: BUDGET_SHIPPING, wind_m_s: BUDGET_WIND_M_S };
        same_hundredths(budget.noise_db_hz, noise.spectral_level_db(frequency_khz));
        assert!((budget.packet_s - layer.packet_s(PING_BYTES)).abs() <= 0.5e-4, "{}", budget.modem);
        // By hand, the noise at the centre stands for that of the band.
        let by_hand_db = noise.spectral_level_db(frequency_khz) + 10.0 * pxfm::f_log10(layer.bandwidth_hz);
        for (exponent, spreading_db, snr_db) in [
            (1.5, budget.practical_spreading_db, budget.practical_snr_db),
            (2.0, budget.spherical_spreading_db, budget.spherical_snr_db),
        ] {
            let sea = sea(exponent, STEADY);
            let link = Link::new(&sea, &layer, &layer);
            let level_db = link.level_db(budget.range_m, 0.0);
            same_hundredths(spreading_db, layer.source_level_db - level_db - absorption_db);
            same_hundredths(snr_db, level_db - by_hand_db);
            // Integrated over the band it is a little louder, as the lower end of a wide band is.
            let louder_db = noise_db(&sea, &layer) - by_hand_db;
            assert!((0.0..0.5).contains(&louder_db), "{}: {louder_db}", budget.modem);
            // The ranges that makers promise are careful ones.
            assert!(link.reach_m > budget.range_m, "{}", budget.modem);
        }
    }
}

/// Part of 4,000 packets that a modem loses at this range, alone in the water.
fn lost_part(sea: &Sea, layer: &PhysicalLayer, range_m: f64) -> f64 {
    const PACKETS: i64 = 4_000;
    let settings =
        EarSettings { noise_db: noise_db(sea, layer), physical: *layer, fading: sea.fading, sense_ns: 0 };
    let mut ear = Ear::new(settings, Draws::new(5, Purpose::Reception, AuvId(0), Noise::Uniform));
    let level_db = Link::new(sea, layer, layer).level_db(range_m, 0.0);
    let packet_ns = (layer.packet_s(PING_BYTES) * 1e9) as i64;
    for number in 0..PACKETS {
        let start = SimTime::from_ns(number * 2 * packet_ns);
        ear.expect(Arrival {
            from: AuvId(1),
            sequence: number as u32,
            path: SoundPath::Direct,
            start,
            end: start + packet_ns,
            level_db,
            doppler: 1.0,
            flight: 0,
            kind: ArrivalKind::Packet { copies: 1, bits: BITS, asleep: false, known: true },
        });
    }
    let mut outcomes = Vec::new();
    ear.settle(SimTime::from_ns(i64::MAX), &mut outcomes);
    assert_eq!(outcomes.len() as i64, PACKETS);
    let lost = outcomes.iter().filter(|outcome| outcome.verdict != Verdict::Heard).count();
    lost as f64 / PACKETS as f64
}

/// Packet error rate by the textbook, from the signal-to-noise ratio at a range.
fn expected_part(sea: &Sea, layer: &PhysicalLayer, range_m: f64) -> f64 {
    let snr_db = Link::new(sea, layer, layer).level_db(range_m, 0.0) - noise_db(sea, layer);
    let gain_db = 10.0 * pxfm::f_log10(layer.bandwidth_hz / layer.bit_rate_bit_s) + layer.coding_gain_db;
    let keying = match layer.modulation {
        Modulation::Bpsk => Keying::Bpsk,
        Modulation::Fsk => Keying::Fsk,
    };
    let fading = match sea.fading.kind {
        FadingKind::Rayleigh => BitFading::Rayleigh,
        FadingKind::Rician { k_db } => BitFading::Rician { k: power_from_db(k_db) },
        FadingKind::Gaussian => BitFading::None,
    };
    packet_error_rate(bit_error_rate(keying, fading, power_from_db(snr_db + gain_db)), BITS)
}

#[test]
fn packet_errors_follow_from_the_level_at_a_range() {
    let kinds = [FadingKind::Gaussian, FadingKind::Rayleigh, FadingKind::Rician { k_db: 6.0 }];
    let mut between = 0;
    for (budget, layer) in layers() {
        // Every packet is noticed, so that only bits decide; faster, so that some are wrong before that.
        let layer = PhysicalLayer {
            detection_threshold_db: -60.0,
            bit_rate_bit_s: 0.5 * layer.bandwidth_hz,
            ..layer
        };
        for kind in kinds {
            let sea = sea(2.0, Fading { kind, per: FadingPer::Bit });
            let mut before = 0.0;
            for factor in [0.5, 0.8, 1.0, 1.2, 1.4, 1.7, 2.0, 2.4, 3.0, 4.0] {
                let range_m = factor * budget.range_m;
                let (expected, lost) =
                    (expected_part(&sea, &layer, range_m), lost_part(&sea, &layer, range_m));
                // Five standard deviations of 4,000 draws, and a few packets where hardly any is expected.
                let near = 5.0 * (expected * (1.0 - expected) / 4_000.0).sqrt() + 1e-3;
                assert!(
                    (lost - expected).abs() <= near,
                    "{} {kind:?} {range_m}: {lost} {expected}",
                    budget.modem
                );
                assert!(expected >= before, "farther is never better");
                before = expected;
                between += u32::from((0.02..0.98).contains(&expected));
            }
        }
    }
    assert!(between >= 15, "{between} points say more than all or nothing");
}

#[test]
fn at_its_nominal_range_every_modem_gets_every_packet_through_steady_water() {
    for (budget, layer) in layers() {
        assert_eq!(lost_part(&sea(2.0, STEADY), &layer, budget.range_m), 0.0, "{}", budget.modem);
    }
}

#[test]
fn slow_fading_takes_the_part_that_fades_below_the_threshold() {
    // Of exponentially distributed power, 1 - exp(-x) lies below x times its mean; bits are not what decides there.
    for (budget, layer) in layers() {
        let layer = PhysicalLayer { detection_threshold_db: 10.0, ..layer };
        let sea = sea(2.0, Fading { kind: FadingKind::Rayleigh, per: FadingPer::Packet });
        let snr_db = Link::new(&sea, &layer, &layer).level_db(budget.range_m, 0.0) - noise_db(&sea, &layer);
        let expected = -pxfm::f_expm1(-power_from_db(10.0 - snr_db));
        let lost = lost_part(&sea, &layer, budget.range_m);
        let near = 5.0 * (expected * (1.0 - expected) / 4_000.0).sqrt() + 1e-3;
        assert!((lost - expected).abs() <= near, "{}: {lost} {expected}", budget.modem);
    }
}
