//! How much louder or fainter than its mean one packet arrives by one path.

use std::f64::consts::{LN_2, TAU};

use pxfm::{f_cos, f_log};
use shoal_scenario::model::{Fading, FadingKind, FadingPer};

use crate::acoustics::decibel::power_from_db;
use crate::draw::Draws;

/// No gain is drawn below this (-150 dB), so that every level stays finite.
const LEAST_GAIN: f64 = 1e-15;

/// The distribution of a packet's power gain; its mean is one.
///
/// The amplitude is a steady part plus a complex Gaussian one (Proakis, Digital Communications, section 13.1-2): without the
/// steady part its square is exponentially distributed (Rayleigh fading), with it Rician with K = steady² / scattered.
#[derive(Clone, Copy, Debug)]
pub(super) enum Gain {
    /// Always one: no fading, or fading so fast that it averages out within each bit.
    Steady,
    /// Both parts, with this amplitude and this power; their powers sum to one.
    Scattered { steady: f64, scattered: f64 },
}

impl Gain {
    /// The gain of whole packets under `fading`.
    pub(super) fn new(fading: Fading) -> Self {
        match (fading.per, fading.kind) {
            (FadingPer::Bit, _) | (_, FadingKind::Gaussian) => Self::Steady,
            (FadingPer::Packet, FadingKind::Rayleigh) => Self::Scattered { steady: 0.0, scattered: 1.0 },
            (FadingPer::Packet, FadingKind::Rician { k_db }) => {
                let k = power_from_db(k_db);
                // K beyond what f64 holds is no fading.
                match k.is_finite() {
                    true => Self::Scattered { steady: (k / (1.0 + k)).sqrt(), scattered: 1.0 / (1.0 + k) },
                    false => Self::Steady,
                }
            }
        }
    }

    /// One gain: one draw for Rayleigh, two for Rician, none without fading.
    pub(super) fn draw(self, draws: &mut Draws) -> f64 {
        let Self::Scattered { steady, scattered } = self else { return 1.0 };
        let diffuse = -f_log(1.0 - draws.unit()) * scattered;
        let gain = if steady == 0.0 {
            diffuse
        } else {
            let phase_rad = TAU * draws.unit();
            steady * steady + diffuse + 2.0 * steady * diffuse.sqrt() * f_cos(phase_rad)
        };
        gain.max(LEAST_GAIN)
    }

    /// No draw is greater.
    pub(super) fn greatest(self) -> f64 {
        let Self::Scattered { steady, scattered } = self else { return 1.0 };
        // A unit draw has 53 bits and is less than one.
        let diffuse = 53.0 * LN_2 * scattered;
        (1.0 + 1e-9) * (steady + diffuse.sqrt()) * (steady + diffuse.sqrt())
    }
}
