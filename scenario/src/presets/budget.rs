//! The sonar equation for each modem at its nominal range, as numbers.

/// A sonar-equation budget: what is left of a modem's signal at its nominal range, and how far above the noise that is.
///
/// Lurton, *An Introduction to Underwater Acoustics*, 2nd ed., chapter on the sonar equation: `SNR = SL - TL - NL`, with
/// `TL = k 10 lg(r) + a r` and `NL = N(f) + 10 lg(B)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// Name of the modem among [`MODEMS`](super::MODEMS).
    pub modem: &'static str,
    /// Range in metres.
    pub range_m: f64,
    /// Loss by practical spreading, `15 lg(r)`, in dB.
    pub practical_spreading_db: f64,
    /// Loss by spherical spreading, `20 lg(r)`, in dB.
    pub spherical_spreading_db: f64,
    /// Absorption at the band's centre in dB/km: Thorp in the variant of Stojanovic.
    pub absorption_db_km: f64,
    /// Noise at the band's centre in dB re 1 µPa²/Hz: Coates' formulas of the Wenz curves, all four parts.
    pub noise_db_hz: f64,
    /// Signal over noise in the band with practical spreading, in dB.
    pub practical_snr_db: f64,
    /// Signal over noise in the band with spherical spreading, in dB.
    pub spherical_snr_db: f64,
    /// Length of a ping in seconds.
    pub packet_s: f64,
}

/// Shipping of the noise in [`BUDGETS`].
pub const BUDGET_SHIPPING: f64 = 0.5;
/// Wind of the noise in [`BUDGETS`] in m/s.
pub const BUDGET_WIND_M_S: f64 = 4.0;

/// The budgets of all modems with a physical layer, to hundredths of a decibel: moderate shipping and a wind of 4 m/s.
///
/// At these frequencies the wind makes the noise. At 25 kHz and 4 m/s, with sqrt(4) = 2:
///
/// ```text
/// turbulence  17 - 30 lg 25                            = 17 - 41.94                 = -24.94 dB
/// shipping    40 + 26 lg 25 - 60 lg 25.03              = 40 + 36.35 - 83.91         =  -7.56 dB
/// wind        50 + 7.5 × 2 + 20 lg 25 - 40 lg 25.4     = 50 + 15 + 27.96 - 56.19    =  36.77 dB
/// thermal     -15 + 20 lg 25                           = -15 + 27.96                =  12.96 dB
/// sum         10 lg (10^-2.494 + 10^-0.756 + 10^3.677 + 10^1.296)                   =  36.78 dB re 1 µPa²/Hz
/// ```
///
/// and absorption, Thorp at 25 kHz, f² = 625:
///
/// ```text
/// 0.11 × 625/626 + 44 × 625/4725 + 2.75e-4 × 625 + 0.003 = 0.110 + 5.820 + 0.172 + 0.003 = 6.10 dB/km
/// ```
pub const BUDGETS: &[Budget] = &[
    Budget {
        modem: "micromodem-fsk",
        range_m: 2000.0,
        practical_spreading_db: 49.52,
        spherical_spreading_db: 66.02,
        absorption_db_km: 6.10,
        noise_db_hz: 36.78,
        practical_snr_db: 50.47,
        spherical_snr_db: 33.97,
        packet_s: 4.1,
    },
    Budget {
        modem: "micromodem-psk",
        range_m: 2000.0,
        practical_spreading_db: 49.52,
        spherical_spreading_db: 66.02,
        absorption_db_km: 6.10,
        noise_db_hz: 36.78,
        practical_snr_db: 49.50,
        spherical_snr_db: 33.00,
        packet_s: 0.996,
    },
    Budget {
        modem: "evologics-18-34",
        range_m: 3500.0,
        practical_spreading_db: 53.16,
        spherical_spreading_db: 70.88,
        absorption_db_km: 6.53,
        noise_db_hz: 36.46,
        practical_snr_db: 29.50,
        spherical_snr_db: 11.78,
        packet_s: 0.4541,
    },
    Budget {
        modem: "seatrac",
        range_m: 1000.0,
        practical_spreading_db: 45.00,
        spherical_spreading_db: 60.00,
        absorption_db_km: 7.39,
        noise_db_hz: 35.84,
        practical_snr_db: 48.74,
        spherical_snr_db: 33.74,
        packet_s: 2.88,
    },
    Budget {
        modem: "popoto",
        range_m: 3000.0,
        practical_spreading_db: 52.16,
        spherical_spreading_db: 69.54,
        absorption_db_km: 6.10,
        noise_db_hz: 36.78,
        practical_snr_db: 32.75,
        spherical_snr_db: 15.36,
        packet_s: 0.5875,
    },
];

#[cfg(test)]
mod tests {
    use pxfm::f_log10;

    use super::BUDGETS;
    use crate::PING_BYTES;
    use crate::presets::MODEMS;

    #[test]
    fn every_modem_of_the_sea_has_a_budget_that_adds_up() {
        let at_sea: Vec<_> = MODEMS.iter().filter(|(_, modem)| modem.physical.is_some()).collect();
        assert_eq!(at_sea.len(), BUDGETS.len());
        for ((name, modem), budget) in at_sea.into_iter().zip(BUDGETS) {
            let physical = modem.physical.unwrap();
            assert_eq!((budget.modem, budget.range_m), (*name, modem.range_m));
            let near = |worked: f64, computed: f64| {
                assert!((worked - computed).abs() < 0.02, "{name}: {worked} {computed}")
            };
            near(budget.practical_spreading_db, 15.0 * f_log10(budget.range_m));
            near(budget.spherical_spreading_db, 20.0 * f_log10(budget.range_m));
            let noise_db = budget.noise_db_hz + 10.0 * f_log10(physical.bandwidth_hz);
            let left_db =
                physical.source_level_db - budget.absorption_db_km * budget.range_m * 1e-3 - noise_db;
            near(budget.practical_snr_db, left_db - budget.practical_spreading_db);
            near(budget.spherical_snr_db, left_db - budget.spherical_spreading_db);
            assert!((budget.packet_s - physical.packet_s(PING_BYTES)).abs() < 1e-4, "{name}");
        }
    }
}
