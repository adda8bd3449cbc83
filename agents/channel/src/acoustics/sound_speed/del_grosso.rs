//! Del Grosso's formula, on today's temperature scale.

use super::polynomial;

/// Speed of sound in m/s, by temperature on today's scale (ITS-90) and pressure above the atmosphere in kilograms (of
/// force) per square centimetre, the paper's unit: 0 to 30 °C, 30 to 40 psu, 0 to 1,000 kg/cm². See [`kg_cm2_from_dbar`].
///
/// V. A. Del Grosso, "New equation for the speed of sound in natural waters", J. Acoust. Soc. Am. 56 (1974), 1084-1091, with
/// the coefficients of G. S. K. Wong and S. Zhu, J. Acoust. Soc. Am. 97 (1995), 1732-1736.
///
/// ```
/// use shoal_channel::acoustics::sound_speed::del_grosso;
///
/// assert!((del_grosso(10.0, 35.0, 0.0) - 1489.7894).abs() < 5e-5);
/// ```
pub fn del_grosso(temperature_c: f64, salinity_psu: f64, pressure_kg_cm2: f64) -> f64 {
    let (t, s, p) = (temperature_c, salinity_psu, pressure_kg_cm2);
    let of_temperature = polynomial(t, &[0.0, 5.012285, -5.51184e-2, 2.21649e-4]);
    let of_salinity = polynomial(s, &[0.0, 1.329530, 1.288598e-4]);
    let of_pressure = polynomial(p, &[0.0, 0.1560592, 2.449993e-5, -8.833959e-9]);
    let mixed = -1.275936e-2 * s * t + 6.353509e-3 * t * p + 2.656174e-8 * t * t * p * p
        - 1.593895e-6 * t * p * p
        + 5.222483e-10 * t * p * p * p
        - 4.383615e-7 * t * t * t * p
        - 1.616745e-9 * s * s * p * p
        + 9.688441e-5 * s * t * t
        + 4.857614e-6 * s * s * t * p
        - 3.406824e-4 * s * t * p;
    1402.392 + of_temperature + of_salinity + of_pressure + mixed
}

/// Pressure in kilograms (of force) per square centimetre, of which one is 9.80665 dbar.
pub fn kg_cm2_from_dbar(pressure_dbar: f64) -> f64 {
    pressure_dbar / 9.80665
}
