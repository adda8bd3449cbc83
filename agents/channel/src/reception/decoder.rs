//! With which probability a packet is decoded while interference comes and goes.

use pxfm::{f_exp, f_log1p};
use shoal_bus::time::SimTime;
use shoal_scenario::model::{self, FadingKind, FadingPer, PhysicalLayer};

use super::Arrival;
use crate::acoustics::decibel::power_from_db;
use crate::acoustics::modulation::{Fading, Modulation, bit_error_rate};

/// More bits than the longest frame has.
const MOST_BITS: f64 = (1 << 20) as f64;
/// Half the distance from one to the next smaller `f64`: a failure less probable than this is none.
const NEGLIGIBLE: f64 = 1.0 / (1u64 << 54) as f64;

/// Interference that stays the same from a moment on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stretch {
    /// From when.
    pub since: SimTime,
    /// Power of all other packets together.
    pub interference: f64,
}

/// The decoder of one modem.
#[derive(Clone, Debug)]
pub(super) struct Decoder {
    modulation: Modulation,
    fading: Fading,
    noise: f64,
    /// Eb/N0 = SINR · bandwidth / bit rate · coding gain.
    eb_n0_per_sinr: f64,
    /// From this SINR on, the longest frame surely gets through, as far as `f64` can tell.
    certain_sinr: f64,
    preamble_s: f64,
    bit_rate_bit_s: f64,
}

impl Decoder {
    /// The decoder of `physical` in noise of this power in its band.
    pub(super) fn new(physical: &PhysicalLayer, fading: model::Fading, noise: f64) -> Self {
        let eb_n0_per_sinr =
            physical.bandwidth_hz / physical.bit_rate_bit_s * power_from_db(physical.coding_gain_db);
        let fading = match (fading.per, fading.kind) {
            // A whole packet's fading is in its level already.
            (FadingPer::Packet, _) | (_, FadingKind::Gaussian) => Fading::None,
            (FadingPer::Bit, FadingKind::Rayleigh) => Fading::Rayleigh,
            (FadingPer::Bit, FadingKind::Rician { k_db }) => Fading::Rician { k: power_from_db(k_db) },
        };
        let modulation = match physical.modulation {
            model::Modulation::Bpsk => Modulation::Bpsk,
            model::Modulation::Fsk => Modulation::Fsk,
        };
        let mut decoder = Self {
            modulation,
            fading,
            noise,
            eb_n0_per_sinr,
            certain_sinr: f64::INFINITY,
            preamble_s: physical.preamble_s,
            bit_rate_bit_s: physical.bit_rate_bit_s,
        };
        decoder.certain_sinr = decoder.search_certain_sinr();
        decoder
    }

    /// The probability that a copy received with `power` is decoded, with the interference of `stretches`, the first of
    /// which begins no later than its bits and each of which lasts until the next.
    ///
    /// Bits fail independently of each other: P = Π (1 - BER(SINR))^bits over the stretches of constant interference. They
    /// are spread evenly over what follows the preamble, which carries none.
    pub(super) fn success(&self, arrival: &Arrival, bits: u32, power: f64, stretches: &[Stretch]) -> f64 {
        let bits_start = self.bits_start(arrival, bits);
        let bits_ns = (arrival.end - bits_start) as f64;
        let mut log_success = 0.0;
        for (index, stretch) in stretches.iter().enumerate() {
            let end = stretches.get(index + 1).map_or(arrival.end, |next| next.since);
            let stretch_ns = end - stretch.since.max(bits_start);
            let sinr = power / (self.noise + stretch.interference);
            if stretch_ns > 0 && sinr < self.certain_sinr {
                let share = stretch_ns as f64 / bits_ns;
                let bit_error_rate = self.bit_error_rate(sinr);
                log_success += f64::from(bits) * share * f_log1p(-bit_error_rate);
            }
        }
        if log_success == 0.0 { 1.0 } else { f_exp(log_success) }
    }

    /// The same in ambient noise alone.
    pub(super) fn success_alone(&self, arrival: &Arrival, bits: u32, power: f64) -> f64 {
        self.success(arrival, bits, power, &[Stretch { since: arrival.start, interference: 0.0 }])
    }

    /// When the first bit arrives: after the preamble, which is stretched like the whole.
    fn bits_start(&self, arrival: &Arrival, bits: u32) -> SimTime {
        let packet_s = self.preamble_s + f64::from(bits) / self.bit_rate_bit_s;
        let share = if packet_s > 0.0 { self.preamble_s / packet_s } else { 0.0 };
        arrival.start + (share * (arrival.end - arrival.start) as f64) as i64
    }

    fn bit_error_rate(&self, sinr: f64) -> f64 {
        bit_error_rate(self.modulation, self.fading, sinr * self.eb_n0_per_sinr)
    }

    /// Bisection over the exponent; infinite where errors fade away too slowly, as in Rayleigh fading.
    fn search_certain_sinr(&self) -> f64 {
        let is_certain = |sinr_db: f64| self.bit_error_rate(power_from_db(sinr_db)) * MOST_BITS < NEGLIGIBLE;
        let (mut below_db, mut above_db) = (-100.0, 100.0);
        if !is_certain(above_db) {
            return f64::INFINITY;
        }
        for _ in 0..12 {
            let middle_db = 0.5 * (below_db + above_db);
            if is_certain(middle_db) { above_db = middle_db } else { below_db = middle_db }
        }
        power_from_db(above_db)
    }
}
