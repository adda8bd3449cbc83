//! The sonar equation: how loud a modem's packets are somewhere else, and how far away they matter.

use shoal_scenario::model::{Absorption, FadingKind, FadingPer, PhysicalLayer, Sea};

use crate::acoustics::absorption::{AbsorptionFormula, SeaWater};
use crate::acoustics::decibel::db_from_power;
use crate::acoustics::noise::AmbientNoise;

/// What arrives fainter than ambient noise by more than so many dB is left out: it adds less than 0.5 dB to the noise.
pub const FLOOR_DB: f64 = 10.0;

/// Fading of a whole packet may raise its level; from so many dB below the threshold on it is taken never to be noticed (for
/// Rayleigh fading that happens to one in 20,000).
const FADE_MARGIN_DB: f64 = 10.0;

/// Levels are those of a source at one metre, so nothing is nearer.
const NEAREST_M: f64 = 1.0;

/// Farther than any sound in here is followed, in metres.
const FARTHEST_M: f64 = 1e7;

/// Ambient noise in a modem's band, in dB re 1 µPa.
pub fn noise_db(sea: &Sea, physical: &PhysicalLayer) -> f64 {
    AmbientNoise { shipping: sea.shipping, wind_m_s: sea.wind_m_s }
        .band_level_db(physical.centre_hz, physical.bandwidth_hz)
}

/// The way from one make of modem to another through one sea.
///
/// Received level = source level - 10 k lg r - a r - losses of bounces, with the exponent k of spreading, the absorption a at the
/// centre of the band, and the length r of the path in metres, one at least (R. J. Urick, "Principles of Underwater
/// Sound", 3rd ed., chapters 2 and 5).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Link {
    source_level_db: f64,
    spreading_db: f64,
    absorption_db_m: f64,
    /// Centre of the emitter's band in kHz.
    pub frequency_khz: f64,
    /// Fainter than this, in dB re 1 µPa, nothing even disturbs.
    pub floor_db: f64,
    /// Whether the receiver can decode what the emitter sends: same band, modulation and bit rate.
    pub known: bool,
    /// A path longer than this, in metres, is too faint to be noticed even in quiet water.
    pub reach_m: f64,
    /// A path longer than this, in metres, does not even disturb.
    pub floor_m: f64,
}

impl Link {
    /// The link from emitters to receivers with these physical layers.
    pub fn new(sea: &Sea, emitter: &PhysicalLayer, receiver: &PhysicalLayer) -> Self {
        let mut link = Self {
            source_level_db: emitter.source_level_db + db_from_power(overlap(emitter, receiver)),
            spreading_db: 10.0 * sea.spreading_exponent,
            absorption_db_m: absorption_db_m(sea, emitter.centre_hz),
            frequency_khz: emitter.centre_hz * 1e-3,
            floor_db: 0.0,
            known: emitter.centre_hz == receiver.centre_hz
                && emitter.bandwidth_hz == receiver.bandwidth_hz
                && emitter.bit_rate_bit_s == receiver.bit_rate_bit_s
                && emitter.modulation == receiver.modulation,
            reach_m: 0.0,
            floor_m: 0.0,
        };
        let noise_db = noise_db(sea, receiver);
        link.reach_m = link.length_at_m(noise_db + receiver.detection_threshold_db - fade_margin_db(sea));
        link.floor_db =
            (noise_db - FLOOR_DB).min(noise_db + receiver.detection_threshold_db - fade_margin_db(sea));
        link.floor_m = link.length_at_m(link.floor_db);
        link
    }

    /// Received level in dB re 1 µPa in the receiver's band, after `length_m` metres and bounces that took `bounces_db`.
    pub fn level_db(&self, length_m: f64, bounces_db: f64) -> f64 {
        let length_m = length_m.max(NEAREST_M);
        let transmission_loss_db =
            self.spreading_db * pxfm::f_log10(length_m) + self.absorption_db_m * length_m;
        self.source_level_db - transmission_loss_db - bounces_db
    }

    /// The longest path in metres on which the level stays at `level_db` or above; zero when there is none.
    pub fn length_at_m(&self, level_db: f64) -> f64 {
        let (mut loud_m, mut faint_m) = (NEAREST_M, FARTHEST_M);
        if self.level_db(loud_m, 0.0) < level_db {
            return 0.0;
        }
        while faint_m - loud_m > 1e-6 * loud_m {
            let middle_m = 0.5 * (loud_m + faint_m);
            if self.level_db(middle_m, 0.0) < level_db { faint_m = middle_m } else { loud_m = middle_m }
        }
        faint_m
    }
}

/// How far a modem of this make is noticed by its like on average, in metres: without luck or bad luck in fading.
pub fn nominal_reach_m(sea: &Sea, physical: &PhysicalLayer) -> f64 {
    let link = Link::new(sea, physical, physical);
    link.length_at_m(noise_db(sea, physical) + physical.detection_threshold_db)
}

/// Part of the emitter's band that lies in the receiver's.
fn overlap(emitter: &PhysicalLayer, receiver: &PhysicalLayer) -> f64 {
    let edges =
        |of: &PhysicalLayer| (of.centre_hz - 0.5 * of.bandwidth_hz, of.centre_hz + 0.5 * of.bandwidth_hz);
    let ((from, to), (lower, upper)) = (edges(emitter), edges(receiver));
    ((to.min(upper) - from.max(lower)) / emitter.bandwidth_hz).clamp(0.0, 1.0)
}

/// Absorption in dB per metre, in the water halfway to the bottom.
fn absorption_db_m(sea: &Sea, frequency_hz: f64) -> f64 {
    let formula = match sea.absorption {
        Absorption::ThorpStojanovic => AbsorptionFormula::ThorpStojanovic,
        Absorption::ThorpJkps => AbsorptionFormula::ThorpJensen,
        Absorption::FrancoisGarrison => AbsorptionFormula::FrancoisGarrison,
        Absorption::AinslieMcColm => AbsorptionFormula::AinslieMcColm,
    };
    let water = SeaWater {
        temperature_c: sea.temperature_c,
        salinity_psu: sea.salinity_psu,
        depth_m: 0.5 * sea.bottom_depth_m,
        ph: sea.ph,
    };
    formula.absorption_db_per_km(frequency_hz * 1e-3, &water) * 1e-3
}

fn fade_margin_db(sea: &Sea) -> f64 {
    match (sea.fading.kind, sea.fading.per) {
        (FadingKind::Gaussian, _) | (_, FadingPer::Bit) => 0.0,
        (FadingKind::Rayleigh | FadingKind::Rician { .. }, FadingPer::Packet) => FADE_MARGIN_DB,
    }
}
