//! What sea water swallows of sound: viscosity, magnesium sulphate and, at low frequency, boric acid turn it into heat.
//!
//! All of it in decibels per kilometre. Thorp's fit knows the frequency only and stands for deep, cold water (4 °C, 35 psu,
//! pH 8, 1,000 m); [`francois_garrison`] and [`ainslie_mccolm`] follow the water and agree to 10 %.

use pxfm::{f_exp, f_exp10};

/// What absorption depends on besides the frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeaWater {
    /// Temperature in °C.
    pub temperature_c: f64,
    /// Practical salinity, not negative.
    pub salinity_psu: f64,
    /// Depth in metres, positive down.
    pub depth_m: f64,
    /// Acidity on the NBS scale: 7.7 to 8.3 in the sea.
    pub ph: f64,
}

/// One of the published formulas.
///
/// ```
/// use shoal_channel::acoustics::absorption::{AbsorptionFormula, SeaWater};
///
/// let water = SeaWater { temperature_c: 10.0, salinity_psu: 35.0, depth_m: 100.0, ph: 8.0 };
/// let db_per_km = AbsorptionFormula::FrancoisGarrison.absorption_db_per_km(25.0, &water);
/// assert!((db_per_km - 4.928066).abs() < 1e-6);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AbsorptionFormula {
    /// [`thorp_stojanovic`].
    ThorpStojanovic,
    /// [`thorp_jensen`].
    ThorpJensen,
    /// [`francois_garrison`].
    FrancoisGarrison,
    /// [`ainslie_mccolm`].
    AinslieMcColm,
}

impl AbsorptionFormula {
    /// Absorption in dB/km; Thorp's variants do not look at the water.
    pub fn absorption_db_per_km(self, frequency_khz: f64, water: &SeaWater) -> f64 {
        match self {
            Self::ThorpStojanovic => thorp_stojanovic(frequency_khz),
            Self::ThorpJensen => thorp_jensen(frequency_khz),
            Self::FrancoisGarrison => francois_garrison(frequency_khz, water),
            Self::AinslieMcColm => ainslie_mccolm(frequency_khz, water),
        }
    }
}

/// Thorp's formula in dB/km as communication engineers write it: 0.1 to 60 kHz.
///
/// M. Stojanovic, "On the relationship between capacity and distance in an underwater acoustic communication channel",
/// ACM SIGMOBILE Mob. Comput. Commun. Rev. 11 (2007), 34-43, equation 3.
pub fn thorp_stojanovic(frequency_khz: f64) -> f64 {
    let f2 = frequency_khz * frequency_khz;
    0.11 * f2 / (1.0 + f2) + 44.0 * f2 / (4100.0 + f2) + 2.75e-4 * f2 + 0.003
}

/// Thorp's formula in dB/km as propagation models such as Bellhop write it: 0.1 to 60 kHz.
///
/// F. B. Jensen, W. A. Kuperman, M. B. Porter and H. Schmidt, "Computational Ocean Acoustics", 2nd ed. (2011),
/// equation 1.47.
pub fn thorp_jensen(frequency_khz: f64) -> f64 {
    let f2 = frequency_khz * frequency_khz;
    3.3e-3 + 0.11 * f2 / (1.0 + f2) + 44.0 * f2 / (4100.0 + f2) + 3.0e-4 * f2
}

/// Thorp's formula in decibels per *kiloyard* (914.4 m), as Urick prints it: the other two are this one, converted and
/// rounded in two ways.
///
/// W. H. Thorp, "Analytic description of the low-frequency attenuation coefficient", J. Acoust. Soc. Am. 42 (1967), 270;
/// R. J. Urick, "Principles of Underwater Sound", 3rd ed. (1983), section 5.3.
pub fn thorp_urick_db_per_kyd(frequency_khz: f64) -> f64 {
    let f2 = frequency_khz * frequency_khz;
    0.1 * f2 / (1.0 + f2) + 40.0 * f2 / (4100.0 + f2) + 2.75e-4 * f2 + 0.003
}

/// Absorption in dB/km: 0.4 to 1,000 kHz, -2 to 30 °C, 30 to 35 psu, 0 to 3,500 m; about 5 % off between 10 and 500 kHz.
///
/// R. E. Francois and G. R. Garrison, "Sound absorption based on ocean measurements, part II", J. Acoust. Soc. Am. 72
/// (1982), 1879-1890. At 20 °C the paper's two fits for pure water meet within 0.1 % of each other; here the colder one
/// holds there.
pub fn francois_garrison(frequency_khz: f64, water: &SeaWater) -> f64 {
    let &SeaWater { temperature_c: t, salinity_psu: s, depth_m: d, ph } = water;
    let f2 = frequency_khz * frequency_khz;
    let kelvin = t + 273.0;
    let sound_speed_m_s = 1412.0 + 3.21 * t + 1.19 * s + 0.0167 * d;

    let boric_khz = 2.8 * (s / 35.0).sqrt() * f_exp10(4.0 - 1245.0 / kelvin);
    let boric = 8.86 / sound_speed_m_s * f_exp10(0.78 * ph - 5.0) * relaxation(boric_khz, f2);

    let magnesium_khz = 8.17 * f_exp10(8.0 - 1990.0 / kelvin) / (1.0 + 0.0018 * (s - 35.0));
    let magnesium_pressure = 1.0 - 1.37e-4 * d + 6.2e-9 * d * d;
    let magnesium =
        21.44 * s / sound_speed_m_s * (1.0 + 0.025 * t) * magnesium_pressure * relaxation(magnesium_khz, f2);

    let viscosity = if t <= 20.0 {
        4.937e-4 - 2.59e-5 * t + 9.11e-7 * t * t - 1.50e-8 * t * t * t
    } else {
        3.964e-4 - 1.146e-5 * t + 1.45e-7 * t * t - 6.5e-10 * t * t * t
    };
    let viscosity_pressure = 1.0 - 3.83e-5 * d + 4.9e-10 * d * d;
    boric + magnesium + viscosity * viscosity_pressure * f2
}

/// Absorption in dB/km, simpler: 0.1 to 1,000 kHz, -6 to 35 °C, 5 to 50 psu, 0 to 7,000 m, pH 7.7 to 8.3; within 10 % of
/// [`francois_garrison`].
///
/// M. A. Ainslie and J. G. McColm, "A simplified formula for viscous and chemical absorption in sea water", J. Acoust. Soc.
/// Am. 103 (1998), 1671-1672.
pub fn ainslie_mccolm(frequency_khz: f64, water: &SeaWater) -> f64 {
    let &SeaWater { temperature_c: t, salinity_psu: s, depth_m, ph } = water;
    let f2 = frequency_khz * frequency_khz;
    let depth_km = depth_m / 1000.0;
    let boric_khz = 0.78 * (s / 35.0).sqrt() * f_exp(t / 26.0);
    let magnesium_khz = 42.0 * f_exp(t / 17.0);
    0.106 * relaxation(boric_khz, f2) * f_exp((ph - 8.0) / 0.56)
        + 0.52 * (1.0 + t / 43.0) * (s / 35.0) * relaxation(magnesium_khz, f2) * f_exp(-depth_km / 6.0)
        + 4.9e-4 * f2 * f_exp(-(t / 27.0 + depth_km / 17.0))
}

/// The share of one relaxing salt: nothing far below its frequency, level far above.
fn relaxation(relaxation_khz: f64, frequency2_khz2: f64) -> f64 {
    relaxation_khz * frequency2_khz2 / (relaxation_khz * relaxation_khz + frequency2_khz2)
}

#[cfg(test)]
mod tests;
