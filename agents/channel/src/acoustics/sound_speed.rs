//! Speed of sound in sea water, by five published formulas.
//!
//! They are fits to laboratory measurements and agree to better than 1 m/s where all are valid (salinity 33 to 37, the upper
//! 1,000 m); outside of its range each is an extrapolation. [`SoundSpeedFormula`] names one and evaluates it by depth.
//!
//! | formula | temperature °C | salinity psu | down to |
//! |---|---|---|---|
//! | [`mackenzie`] | 2 to 30 | 25 to 40 | 8,000 m |
//! | [`medwin`] | 0 to 35 | 0 to 45 | 1,000 m |
//! | [`coppens`] | 0 to 35 | 0 to 45 | 4,000 m |
//! | [`chen_millero`] | 0 to 40 | 0 to 40 | 1,000 bar |
//! | [`del_grosso`] | 0 to 30 | 30 to 40 | 1,000 kg/cm² |

mod chen_millero;
mod del_grosso;

pub use chen_millero::{chen_millero, chen_millero_ipts68};
pub use del_grosso::{del_grosso, kg_cm2_from_dbar};

/// One of the published formulas, to be evaluated by depth.
///
/// ```
/// use shoal_channel::acoustics::sound_speed::SoundSpeedFormula;
///
/// let m_s = SoundSpeedFormula::Mackenzie.speed_m_s(10.0, 35.0, 100.0);
/// assert!((m_s - 1491.4351).abs() < 1e-4);
/// let unesco_m_s = SoundSpeedFormula::ChenMillero.speed_m_s(10.0, 35.0, 100.0);
/// assert!((m_s - unesco_m_s).abs() < 0.1);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SoundSpeedFormula {
    /// [`mackenzie`].
    Mackenzie,
    /// [`medwin`].
    Medwin,
    /// [`chen_millero`], the UNESCO standard, on the ITS-90 temperature scale.
    ChenMillero,
    /// [`del_grosso`], on the ITS-90 temperature scale.
    DelGrosso,
    /// [`coppens`].
    Coppens,
}

impl SoundSpeedFormula {
    /// Speed of sound in m/s at a depth in metres, positive down.
    ///
    /// The formulas by pressure get it from [`pressure_dbar_from_depth`] at a latitude of 45°: the true latitude changes
    /// their result by less than 0.05 m/s per 1,000 m of depth.
    pub fn speed_m_s(self, temperature_c: f64, salinity_psu: f64, depth_m: f64) -> f64 {
        let pressure_dbar = || pressure_dbar_from_depth(depth_m, std::f64::consts::FRAC_PI_4);
        match self {
            Self::Mackenzie => mackenzie(temperature_c, salinity_psu, depth_m),
            Self::Medwin => medwin(temperature_c, salinity_psu, depth_m),
            Self::ChenMillero => chen_millero(temperature_c, salinity_psu, pressure_dbar() / 10.0),
            Self::DelGrosso => del_grosso(temperature_c, salinity_psu, kg_cm2_from_dbar(pressure_dbar())),
            Self::Coppens => coppens(temperature_c, salinity_psu, depth_m),
        }
    }
}

/// Speed of sound in m/s by nine terms: 2 to 30 °C, 25 to 40 psu, 0 to 8,000 m, standard error 0.07 m/s.
///
/// K. V. Mackenzie, "Nine-term equation for sound speed in the oceans", J. Acoust. Soc. Am. 70 (1981), 807-812.
///
/// ```
/// use shoal_channel::acoustics::sound_speed::mackenzie;
///
/// // The check value of the paper.
/// assert!((mackenzie(25.0, 35.0, 1000.0) - 1550.744).abs() < 5e-4);
/// ```
pub fn mackenzie(temperature_c: f64, salinity_psu: f64, depth_m: f64) -> f64 {
    let (t, s, d) = (temperature_c, salinity_psu - 35.0, depth_m);
    1448.96 + 4.591 * t - 5.304e-2 * t * t
        + 2.374e-4 * t * t * t
        + 1.340 * s
        + 1.630e-2 * d
        + 1.675e-7 * d * d
        - 1.025e-2 * t * s
        - 7.139e-13 * t * d * d * d
}

/// Speed of sound in m/s by six terms: 0 to 35 °C, 0 to 45 psu, 0 to 1,000 m.
///
/// H. Medwin, "Speed of sound in water: a simple equation for realistic parameters", J. Acoust. Soc. Am. 58 (1975),
/// 1318-1319.
pub fn medwin(temperature_c: f64, salinity_psu: f64, depth_m: f64) -> f64 {
    let (t, s, d) = (temperature_c, salinity_psu - 35.0, depth_m);
    1449.2 + 4.6 * t - 0.055 * t * t + 0.00029 * t * t * t + (1.34 - 0.01 * t) * s + 0.016 * d
}

/// Speed of sound in m/s by a fit to Del Grosso's: 0 to 35 °C, 0 to 45 psu, 0 to 4,000 m.
///
/// A. B. Coppens, "Simple equations for the speed of sound in Neptunian waters", J. Acoust. Soc. Am. 69 (1981), 862-863.
pub fn coppens(temperature_c: f64, salinity_psu: f64, depth_m: f64) -> f64 {
    // The paper counts in tens of degrees and in kilometres.
    let (t, s, d) = (temperature_c / 10.0, salinity_psu - 35.0, depth_m / 1000.0);
    1449.05 + 45.7 * t - 5.21 * t * t
        + 0.23 * t * t * t
        + (1.333 - 0.126 * t + 0.009 * t * t) * s
        + (16.23 + 0.253 * t) * d
        + (0.213 - 0.1 * t) * d * d
        + (0.016 + 0.0002 * s) * s * t * d
}

/// Pressure of the sea in dbar above the atmosphere, at a depth in metres (positive down, to 11,000 m) and a latitude.
///
/// For a standard ocean of 0 °C and 35 psu: fresh water presses 3 % less. P. M. Saunders, "Practical conversion
/// of pressure to depth", J. Phys. Oceanogr. 11 (1981), 573-574, solved for the pressure.
///
/// ```
/// use shoal_channel::acoustics::sound_speed::pressure_dbar_from_depth;
///
/// // The check value that goes with the formula: 7321.45 m at 30° is 7500 dbar.
/// let latitude_rad = std::f64::consts::PI / 6.0;
/// assert!((pressure_dbar_from_depth(7321.45, latitude_rad) - 7500.0).abs() < 0.01);
/// ```
pub fn pressure_dbar_from_depth(depth_m: f64, latitude_rad: f64) -> f64 {
    let sin = pxfm::f_sin(latitude_rad);
    let linear = 1.0 - (5.92e-3 + 5.25e-3 * sin * sin);
    // The root of depth = linear p - 2.21e-6 p², in the form that cancels nothing near the surface.
    2.0 * depth_m / (linear + (linear * linear - 8.84e-6 * depth_m).sqrt())
}

/// `coefficients[0] + coefficients[1] x + ...`.
fn polynomial(x: f64, coefficients: &[f64]) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * x + coefficient)
}

#[cfg(test)]
mod tests;
