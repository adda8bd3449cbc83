//! The UNESCO formula, with the coefficients of both temperature scales.

use super::polynomial;

/// Speed of sound in m/s, by temperature on today's scale (ITS-90) and pressure above the atmosphere: 0 to 40 °C, 0 to
/// 40 psu, 0 to 1,000 bar.
///
/// C.-T. Chen and F. J. Millero, "Speed of sound in seawater at high pressures", J. Acoust. Soc. Am. 62 (1977), 1129-1135,
/// with the coefficients of G. S. K. Wong and S. Zhu, J. Acoust. Soc. Am. 97 (1995), 1732-1736.
pub fn chen_millero(temperature_c: f64, salinity_psu: f64, pressure_bar: f64) -> f64 {
    ITS_90.speed_m_s(temperature_c, salinity_psu, pressure_bar)
}

/// The same with the original coefficients, for temperatures on the scale of 1968 (IPTS-68, which reads 0.024 % more).
///
/// N. P. Fofonoff and R. C. Millard, "Algorithms for computation of fundamental properties of seawater", Unesco technical
/// papers in marine science 44 (1983).
///
/// ```
/// use shoal_channel::acoustics::sound_speed::chen_millero_ipts68;
///
/// // The check value of the paper.
/// assert!((chen_millero_ipts68(40.0, 40.0, 1000.0) - 1731.995).abs() < 5e-4);
/// ```
pub fn chen_millero_ipts68(temperature_c: f64, salinity_psu: f64, pressure_bar: f64) -> f64 {
    IPTS_68.speed_m_s(temperature_c, salinity_psu, pressure_bar)
}

/// c = Cw(T, P) + A(T, P) S + B(T, P) S^(3/2) + D(P) S², row i of each table holding the coefficients of Pⁱ by powers of T.
struct Coefficients {
    pure_water: [&'static [f64]; 4],
    linear: [&'static [f64]; 4],
    three_halves: [&'static [f64]; 2],
    square: [f64; 2],
}

impl Coefficients {
    fn speed_m_s(&self, t: f64, s: f64, p: f64) -> f64 {
        let pure_water = polynomial(p, &self.pure_water.map(|row| polynomial(t, row)));
        let linear = polynomial(p, &self.linear.map(|row| polynomial(t, row)));
        let three_halves = polynomial(p, &self.three_halves.map(|row| polynomial(t, row)));
        let square = polynomial(p, &self.square);
        pure_water + (linear + three_halves * s.sqrt() + square * s) * s
    }
}

const ITS_90: Coefficients = Coefficients {
    pure_water: [
        &[1402.388, 5.03830, -5.81090e-2, 3.3432e-4, -1.47797e-6, 3.1419e-9],
        &[0.153563, 6.8999e-4, -8.1829e-6, 1.3632e-7, -6.1260e-10],
        &[3.1260e-5, -1.7111e-6, 2.5986e-8, -2.5353e-10, 1.0415e-12],
        &[-9.7729e-9, 3.8513e-10, -2.3654e-12],
    ],
    linear: [
        &[1.389, -1.262e-2, 7.166e-5, 2.008e-6, -3.21e-8],
        &[9.4742e-5, -1.2583e-5, -6.4928e-8, 1.0515e-8, -2.0142e-10],
        &[-3.9064e-7, 9.1061e-9, -1.6009e-10, 7.994e-12],
        &[1.100e-10, 6.651e-12, -3.391e-13],
    ],
    three_halves: [&[-1.922e-2, -4.42e-5], &[7.3637e-5, 1.7950e-7]],
    square: [1.727e-3, -7.9836e-6],
};

const IPTS_68: Coefficients = Coefficients {
    pure_water: [
        &[1402.388, 5.03711, -5.80852e-2, 3.3420e-4, -1.47800e-6, 3.1464e-9],
        &[0.153563, 6.8982e-4, -8.1788e-6, 1.3621e-7, -6.1185e-10],
        &[3.1260e-5, -1.7107e-6, 2.5974e-8, -2.5335e-10, 1.0405e-12],
        &[-9.7729e-9, 3.8504e-10, -2.3643e-12],
    ],
    linear: [
        &[1.389, -1.262e-2, 7.164e-5, 2.006e-6, -3.21e-8],
        &[9.4742e-5, -1.2580e-5, -6.4885e-8, 1.0507e-8, -2.0122e-10],
        &[-3.9064e-7, 9.1041e-9, -1.6002e-10, 7.988e-12],
        &[1.100e-10, 6.649e-12, -3.389e-13],
    ],
    three_halves: [&[-1.922e-2, -4.42e-5], &[7.3637e-5, 1.7945e-7]],
    square: [1.727e-3, -7.9836e-6],
};
