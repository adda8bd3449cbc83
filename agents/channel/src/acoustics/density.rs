//! Density of sea water.

/// Density in kg/m³ at the surface, by temperature (IPTS-68, -2 to 40 °C) and practical salinity (0 to 42).
///
/// Pressure adds 0.45 % per 1,000 m of depth, which is left out: reflection needs a ratio of densities, and the bottom's is not
/// known that well. The one-atmosphere equation of state of sea water, EOS-80: F. J. Millero and A. Poisson, Deep-Sea Res.
/// 28A (1981), 625-629; Unesco technical papers in marine science 44 (1983).
///
/// ```
/// use shoal_channel::acoustics::density::sea_water_density_kg_m3;
///
/// // The check value of the standard.
/// assert!((sea_water_density_kg_m3(5.0, 35.0) - 1027.67547).abs() < 5e-6);
/// ```
pub fn sea_water_density_kg_m3(temperature_c: f64, salinity_psu: f64) -> f64 {
    let (t, s) = (temperature_c, salinity_psu);
    let pure_water = 999.842594
        + t * (6.793952e-2 + t * (-9.095290e-3 + t * (1.001685e-4 + t * (-1.120083e-6 + t * 6.536332e-9))));
    let linear = 8.24493e-1 + t * (-4.0899e-3 + t * (7.6438e-5 + t * (-8.2467e-7 + t * 5.3875e-9)));
    let three_halves = -5.72466e-3 + t * (1.0227e-4 - t * 1.6546e-6);
    pure_water + s * (linear + three_halves * s.sqrt() + 4.8314e-4 * s)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// From the project's table of acoustic reference values, and three check values of the standard.
    #[test]
    fn density_is_the_standards() {
        for (t, s, density, tolerance) in [
            (27.0, 35.0, 1022.7198310217424, 1e-12 * 1022.7),
            (5.0, 0.0, 999.96675, 5e-6),
            (25.0, 0.0, 997.04796, 5e-6),
            (25.0, 35.0, 1023.34306, 5e-6),
        ] {
            let found = sea_water_density_kg_m3(t, s);
            assert!((found - density).abs() <= tolerance, "{t} {s}: {found} for {density}");
        }
    }
}
