//! Ambient noise of the sea: turbulence, distant ships, wind on the surface and the heat of the water.
//!
//! Spectral levels are in dB re 1 µPa²/Hz, band levels in dB re 1 µPa. The four parts are Coates' fits to the curves of
//! G. M. Wenz, "Acoustic ambient noise in the ocean: spectra and sources", J. Acoust. Soc. Am. 34 (1962), 1936-1956:
//! R. F. W. Coates, "Underwater Acoustic Systems" (1989), in the form of M. Stojanovic, ACM SIGMOBILE Mob. Comput. Commun.
//! Rev. 11 (2007), equation 7. They hold from 1 Hz to some hundred kilohertz.

use pxfm::{f_exp, f_log, f_log10};

use super::decibel::{db_from_power, power_from_db};

/// Spectral level of turbulence, the loudest part below 10 Hz.
pub fn turbulence_db(frequency_khz: f64) -> f64 {
    17.0 - 30.0 * f_log10(frequency_khz)
}

/// Spectral level of distant ships, loudest from 10 to 100 Hz, by their density from 0 (none near) to 1 (busy lanes).
pub fn shipping_db(frequency_khz: f64, shipping: f64) -> f64 {
    40.0 + 20.0 * (shipping - 0.5) + 26.0 * f_log10(frequency_khz) - 60.0 * f_log10(frequency_khz + 0.03)
}

/// Spectral level of waves driven by wind, loudest from 100 Hz to 100 kHz, where modems live.
pub fn wind_db(frequency_khz: f64, wind_m_s: f64) -> f64 {
    50.0 + 7.5 * wind_m_s.sqrt() + 20.0 * f_log10(frequency_khz) - 40.0 * f_log10(frequency_khz + 0.4)
}

/// Spectral level of the water's own heat, loudest above 100 kHz.
pub fn thermal_db(frequency_khz: f64) -> f64 {
    -15.0 + 20.0 * f_log10(frequency_khz)
}

/// What the noise of a place depends on.
///
/// ```
/// use shoal_channel::acoustics::noise::AmbientNoise;
///
/// let noise = AmbientNoise { shipping: 0.5, wind_m_s: 5.0 };
/// assert!((noise.spectral_level_db(25.0) - 38.5481).abs() < 1e-4);
/// // A band of 5 kHz holds 10 lg 5000 = 37 dB more than one of 1 Hz, and the noise falls with frequency.
/// assert!((noise.band_level_db(25e3, 5e3) - 75.55).abs() < 0.05);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AmbientNoise {
    /// Density of distant ships, from 0 to 1.
    pub shipping: f64,
    /// Wind speed in m/s, not negative.
    pub wind_m_s: f64,
}

impl AmbientNoise {
    /// Spectral level of all four parts, added as powers, in dB re 1 µPa²/Hz.
    pub fn spectral_level_db(&self, frequency_khz: f64) -> f64 {
        db_from_power(self.power_density(frequency_khz))
    }

    /// Level in dB re 1 µPa of the noise in a band, centre and bandwidth in hertz, both positive.
    ///
    /// Off by less than 0.01 dB for any band between 1 Hz and 1 MHz, by less than 1e-7 dB for a modem's (one octave or less).
    /// What of the band lies below 1 Hz is not counted: the formulas do not reach there.
    pub fn band_level_db(&self, centre_hz: f64, bandwidth_hz: f64) -> f64 {
        let lower_hz = (centre_hz - 0.5 * bandwidth_hz).max(1.0);
        let upper_hz = (centre_hz + 0.5 * bandwidth_hz).max(1.0);
        // Simpson's rule over ln f, in which every part is nearly an exponential.
        const INTERVALS: u32 = 64;
        let lower = f_log(lower_hz);
        let step = (f_log(upper_hz) - lower) / f64::from(INTERVALS);
        let sum: f64 = (0..=INTERVALS)
            .map(|i| {
                let weight = if i == 0 || i == INTERVALS { 1.0 } else { 2.0 + 2.0 * f64::from(i % 2) };
                let frequency_hz = f_exp(lower + f64::from(i) * step);
                weight * frequency_hz * self.power_density(frequency_hz / 1000.0)
            })
            .sum();
        db_from_power(sum * step / 3.0)
    }

    /// µPa²/Hz.
    fn power_density(&self, frequency_khz: f64) -> f64 {
        power_from_db(turbulence_db(frequency_khz))
            + power_from_db(shipping_db(frequency_khz, self.shipping))
            + power_from_db(wind_db(frequency_khz, self.wind_m_s))
            + power_from_db(thermal_db(frequency_khz))
    }
}

#[cfg(test)]
mod tests;
