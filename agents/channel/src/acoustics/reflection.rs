//! What surface and bottom give back of sound that hits them.
//!
//! Angles are *grazing* angles, measured from the plane of the boundary: 0 runs along it, pi/2 hits it head-on. A loss is
//! the positive number of decibels that one bounce takes from the level.

use pxfm::{f_exp, f_pow, f_sincos};

use super::decibel::db_from_power;

/// A bottom that carries no shear waves, such as mud, silt or sand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FluidBottom {
    /// Density in kg/m³.
    pub density_kg_m3: f64,
    /// Sound speed in m/s.
    pub sound_speed_m_s: f64,
    /// What it swallows over the way of one wavelength, in decibels: 0 to about 1.
    pub attenuation_db_per_wavelength: f64,
}

impl FluidBottom {
    /// The part of the sound pressure that comes back from this bottom under water of the given density and sound speed, from 0
    /// to 1: the magnitude of Rayleigh's reflection coefficient.
    ///
    /// All comes back below the critical angle of a faster bottom that swallows nothing. F. B. Jensen et al.,
    /// "Computational Ocean Acoustics", 2nd ed. (2011), section 1.6, with attenuation as an imaginary part of the index of
    /// refraction.
    ///
    /// ```
    /// use shoal_channel::acoustics::reflection::FluidBottom;
    ///
    /// let bottom = FluidBottom { density_kg_m3: 1200.0, sound_speed_m_s: 1600.0, attenuation_db_per_wavelength: 0.0 };
    /// let pressure = bottom.reflection(1022.72, 1539.09, std::f64::consts::FRAC_PI_4);
    /// assert!((pressure - 0.1198).abs() < 1e-4);
    /// assert_eq!(bottom.reflection(1022.72, 1539.09, 0.1), 1.0);
    /// ```
    pub fn reflection(&self, water_density_kg_m3: f64, water_sound_speed_m_s: f64, grazing_rad: f64) -> f64 {
        let (sin, cos) = f_sincos(grazing_rad);
        // V = (t - q) / (t + q), t = m sin g, q = sqrt(n² - cos² g), n = (c_water / c_bottom) (1 + i loss), q = x + i y.
        let t = self.density_kg_m3 / water_density_kg_m3 * sin;
        let loss =
            self.attenuation_db_per_wavelength / (40.0 * std::f64::consts::PI * std::f64::consts::LOG10_E);
        let ratio = water_sound_speed_m_s / self.sound_speed_m_s;
        let (x, y) =
            principal_root(ratio * ratio * (1.0 - loss * loss) - cos * cos, 2.0 * ratio * ratio * loss);
        let denominator = (t + x) * (t + x) + y * y;
        if denominator == 0.0 {
            // Along a bottom as fast as the water: there is no bounce.
            return 1.0;
        }
        (((t - x) * (t - x) + y * y) / denominator).sqrt()
    }

    /// The loss in dB of a bounce off this bottom: see [`FluidBottom::reflection`]. Infinite at the one angle, if any, at which
    /// a bottom that swallows nothing lets everything in.
    pub fn loss_db(&self, water_density_kg_m3: f64, water_sound_speed_m_s: f64, grazing_rad: f64) -> f64 {
        let pressure = self.reflection(water_density_kg_m3, water_sound_speed_m_s, grazing_rad);
        db_from_power(1.0 / (pressure * pressure))
    }
}

/// The root of `re + i im`, `im` not negative, that has no negative part.
fn principal_root(re: f64, im: f64) -> (f64, f64) {
    let larger = (0.5 * ((re * re + im * im).sqrt() + re.abs())).sqrt();
    if larger == 0.0 {
        return (0.0, 0.0);
    }
    // The other part from the product, since the difference would cancel.
    let smaller = 0.5 * im / larger;
    if re >= 0.0 { (larger, smaller) } else { (smaller, larger) }
}

/// How much a bounce off the surface costs. The surface releases the pressure: what comes back is turned upside down, and
/// all of it when the sea is calm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SurfaceLoss {
    /// The same at every angle and frequency.
    Constant {
        /// Loss in dB, not negative.
        loss_db: f64,
    },
    /// By the bubbles that the wind beats into the water: [`bubble_loss_db`].
    Wind {
        /// Wind speed in m/s, 10 m above the sea, not negative.
        wind_m_s: f64,
    },
}

impl SurfaceLoss {
    /// The loss of one bounce in dB, not negative.
    ///
    /// ```
    /// use shoal_channel::acoustics::reflection::SurfaceLoss;
    ///
    /// let fresh_breeze = SurfaceLoss::Wind { wind_m_s: 10.0 };
    /// assert!((fresh_breeze.loss_db(25.0, 0.5) - 1.51).abs() < 0.01);
    /// ```
    pub fn loss_db(&self, frequency_khz: f64, grazing_rad: f64) -> f64 {
        match *self {
            Self::Constant { loss_db } => loss_db,
            Self::Wind { wind_m_s } => bubble_loss_db(wind_m_s, frequency_khz, grazing_rad),
        }
    }
}

/// The most that [`bubble_loss_db`] says: bubbles that swallow more scatter as well.
///
/// Users of the handbook quote 15 dB (F. McQuarrie et al., 2025), others 30 dB, as its ceiling. This is the lower, which errs
/// on the side of more multipath.
pub const BUBBLE_LOSS_CEILING_DB: f64 = 15.0;

/// Loss in dB of *all* the sound that leaves a windy surface forward, mirrored or scattered: what bubbles swallow. 10 to
/// 100 kHz, fitted to measurements between 20 and 40 kHz within 3 dB.
///
/// Waves alone take nothing. Where their Rayleigh parameter k s sin g exceeds one (wave number, rms height, grazing angle) they
/// scatter: the mirrored pressure falls as exp(-2 k² s² sin² g), but the energy still arrives, spread over angles and delays.
/// A receiver that needs the mirrored part hears less than this says.
///
/// APL-UW High-Frequency Ocean Environmental Acoustic Models Handbook, technical report 9407 (1994), section II, equations
/// 28; also the surface of UnderwaterAcoustics.jl, which models links of modems in shallow water.
pub fn bubble_loss_db(wind_m_s: f64, frequency_khz: f64, grazing_rad: f64) -> f64 {
    /// Slower wind breaks no waves: the loss fades out.
    const BREAKING_M_S: f64 = 6.0;
    let calm = f_exp(1.2 * (wind_m_s - BREAKING_M_S).min(0.0));
    let (sin, _) = f_sincos(grazing_rad);
    let loss_db = 1.26e-3 / sin * f_pow(wind_m_s.max(BREAKING_M_S), 1.57) * f_pow(frequency_khz, 0.85) * calm;
    loss_db.min(BUBBLE_LOSS_CEILING_DB)
}

#[cfg(test)]
mod tests;
