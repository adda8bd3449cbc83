//! Bit and packet errors of a modem's modulation, in steady and in fading water.
//!
//! Everything is by Eb/N0, the energy of a bit over the spectral density of noise, as a *linear* ratio and not in decibels (see
//! [`power_from_db`](super::decibel::power_from_db)); under fading it is the mean.

use pxfm::{f_erfc, f_exp, f_expm1, f_log1p};

/// How bits are put on the carrier.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Modulation {
    /// Binary phase shift keying, coherently detected.
    Bpsk,
    /// Binary frequency shift keying with orthogonal tones, noncoherently detected.
    Fsk,
}

/// How the amplitude of what arrives varies: slowly, so that it is the same for all of a bit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fading {
    /// One steady path: only Gaussian noise.
    None,
    /// Many paths of equal standing.
    Rayleigh,
    /// One steady path among many weak ones.
    Rician {
        /// Power of the steady path over that of all others together: 0 is Rayleigh, infinity none.
        k: f64,
    },
}

/// Probability that a bit is wrong, by the linear mean Eb/N0: finite, not negative.
///
/// Falls with Eb/N0 from 0.5 at none. Closed forms, but for BPSK under Rician fading: J. G. Proakis and M. Salehi, "Digital
/// Communications", 5th ed. (2008), sections 4.3, 4.5 and 13.3; M. K. Simon and M.-S. Alouini, "Digital Communication over Fading
/// Channels", 2nd ed. (2005), chapter 8. The exception is summed: off by less than 1e-11 of itself where it is above 1e-9, by
/// less than 1e-20 where it is below.
///
/// ```
/// use shoal_channel::acoustics::decibel::power_from_db;
/// use shoal_channel::acoustics::modulation::{Fading, Modulation, bit_error_rate};
///
/// let eb_n0 = power_from_db(7.0);
/// assert!((bit_error_rate(Modulation::Bpsk, Fading::None, eb_n0) - 7.727e-4).abs() < 5e-8);
/// assert!((bit_error_rate(Modulation::Bpsk, Fading::Rayleigh, eb_n0) - 4.3474e-2).abs() < 5e-7);
/// ```
pub fn bit_error_rate(modulation: Modulation, fading: Fading, eb_n0: f64) -> f64 {
    match (modulation, fading) {
        (Modulation::Bpsk, Fading::None) => 0.5 * f_erfc(eb_n0.sqrt()),
        // (1 - sqrt(g / (1 + g))) / 2, in the form that cancels nothing when g is large.
        (Modulation::Bpsk, Fading::Rayleigh) => {
            0.5 / ((1.0 + eb_n0) * (1.0 + (eb_n0 / (1.0 + eb_n0)).sqrt()))
        }
        (Modulation::Bpsk, Fading::Rician { k }) => bpsk_rician(k, eb_n0),
        (Modulation::Fsk, Fading::None) => 0.5 * f_exp(-0.5 * eb_n0),
        (Modulation::Fsk, Fading::Rayleigh) => 1.0 / (2.0 + eb_n0),
        (Modulation::Fsk, Fading::Rician { k }) => 0.5 * mean_exponential(k, 0.5 * eb_n0),
    }
}

/// Probability that a packet of `bits` bits, each wrong with probability `bit_error_rate` (below 1) on its own, has a wrong
/// one: 1 - (1 - p)ⁿ, to full precision for tiny p as well.
///
/// ```
/// use shoal_channel::acoustics::modulation::packet_error_rate;
///
/// assert!((packet_error_rate(7.727e-4, 256) - 0.1795).abs() < 5e-5);
/// assert!((packet_error_rate(1e-20, 100) / 1e-18 - 1.0).abs() < 1e-15);
/// ```
pub fn packet_error_rate(bit_error_rate: f64, bits: u32) -> f64 {
    -f_expm1(f64::from(bits) * f_log1p(-bit_error_rate))
}

/// The mean of exp(-x) over Rician fading with the mean `x`: the moment-generating function of its power.
fn mean_exponential(k: f64, x: f64) -> f64 {
    // By the share of the weak paths, so that an infinite k is no special case.
    let scattered = 1.0 / (1.0 + k);
    let stretch = 1.0 + scattered * x;
    f_exp(-(1.0 - scattered) * x / stretch) / stretch
}

/// The mean of Craig's form of the Gaussian tail, 1/pi times the integral of M(-g / sin² a) over a from 0 to pi/2 (Simon and
/// Alouini, equation 8.102), M being the function above.
///
/// With sin a = 1 / cosh u it becomes the integral of M(-g cosh² u) / cosh u over u from 0 to infinity. Its singularities are no
/// closer than pi/2 to the real axis whatever k and g are, so that the trapezoidal rule converges exponentially.
fn bpsk_rician(k: f64, eb_n0: f64) -> f64 {
    const STEP: f64 = 0.125;
    const EXP_STEP: f64 = 1.1331484530668263;
    /// Terms fall at least by exp(-STEP) each: what is left out is below eight times the last.
    const NEGLIGIBLE: f64 = 1e-13;
    let mut exp_u = 1.0;
    let mut term = mean_exponential(k, eb_n0);
    let mut sum = 0.5 * term;
    while term > NEGLIGIBLE * sum {
        exp_u *= EXP_STEP;
        let cosh_u = 0.5 * (exp_u + 1.0 / exp_u);
        term = mean_exponential(k, eb_n0 * cosh_u * cosh_u) / cosh_u;
        sum += term;
    }
    let rate = sum * STEP * std::f64::consts::FRAC_1_PI;
    // Rounding may lift it by a hair; `min` would hide what is not a number.
    if rate > 0.5 { 0.5 } else { rate }
}

#[cfg(test)]
mod tests;
