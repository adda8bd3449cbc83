//! The ping of an AUV that believes in a Gaussian: as long as the ping of intervals, and without its promise.
//!
//! | bytes | field | unit |
//! |---|---|---|
//! | 0 | kind 3 (3 high bits), exponent `v` of the velocity plus 20 (5 low bits) | |
//! | 1-2 | sender, `u16` | |
//! | 3 | sequence number modulo 256, `u8` | |
//! | 4-9 | mean true time of emission, `i48` | 2⁻²⁰ s |
//! | 10 | exponent `p` of the position, `i8` | |
//! | 11-19 | mean x, y, z, three `i24` | 2^p m |
//! | 20-22 | standard deviations of x, y, z, `u8` each | 2^(k/8 - 12) m |
//! | 23 | standard deviation of the emission time, `u8` | 2^(k/8 - 24) s |
//! | 24-27 | correlations xy, xz, xt, yz, yt, zt, five bits each from the lowest on, 15 for none | 1/15 |
//! | 28-30 | mean velocity, three `i8` | 2^v m/s |
//!
//! All integers are little-endian. The covariance is rounded **outwards**: what is read, less what was written, has no negative
//! eigenvalue. With the standard deviations s that are sent as units, rounding moves each correlation by `q = 1/30` at most, and no
//! s is sent that is smaller than `sqrt(C_ii / (1 - 3 q))`: so each entry of the difference's diagonal outweighs the other three of its row
//! (Gershgorin).

use super::{
    EXPONENTS, FRAME_BYTES, Frame, FrameError, GAUSSIAN, TIME_UNIT_EXPONENT, binary_exponent, emission_s,
    header, i24, kind, power_of_two, sender,
};
use crate::message::{AuvId, Bounds, BoundsBox};

/// 2^(1/8), 2^(2/8), ... to the nearest double: eight steps to an octave.
const EIGHTHS: [f64; 8] = [
    1.0,
    1.090_507_732_665_257_7,
    1.189_207_115_002_721,
    1.296_839_554_651_009_6,
    std::f64::consts::SQRT_2,
    1.542_210_825_407_940_8,
    1.681_792_830_507_429,
    1.834_008_086_409_342_4,
];
const POSITION_OCTAVE: i32 = -12;
const TIME_OCTAVE: i32 = -24;
/// Correlations are multiples of one part in so many.
const STEPS: f64 = 15.0;
const VELOCITY_EXPONENT_LEAST: i32 = -20;
/// Where row i of the upper triangle of a 4 x 4 matrix begins.
const ROWS: [usize; 4] = [0, 4, 7, 9];

/// What an AUV tells others that believes in a Gaussian over its position and clock. Nobody promises anything.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaussianPing {
    /// The emitter.
    pub sender: AuvId,
    /// Its number modulo 256.
    pub sequence: u8,
    /// Mean of the true time of emission, in seconds.
    pub emission_s: f64,
    /// Mean of the emitter's position at the emission, in metres.
    pub position_m: [f64; 3],
    /// Covariance of x, y, z and the emission time: the upper triangle, row by row, in metres and seconds.
    pub covariance: [f64; 10],
    /// Mean velocity over ground at the emission, in m/s: for steering, so it comes without an error.
    pub velocity_m_s: [f64; 3],
}

impl GaussianPing {
    /// The frame whose decoded covariance is no smaller in any direction: its standard deviations are larger by 6 to 15 %.
    ///
    /// ```
    /// use shoal_bus::message::AuvId;
    /// use shoal_bus::ping::GaussianPing;
    /// let covariance = [4.0, 0.5, 0.0, 1e-3, 4.0, 0.0, 0.0, 0.01, 0.0, 1e-6];
    /// let ping = GaussianPing { sender: AuvId(7), sequence: 3, emission_s: 10.0, position_m: [1.0, 2.0, -30.0],
    ///     covariance, velocity_m_s: [1.0, 0.0, 0.0] };
    /// let heard = GaussianPing::decode(&ping.encode()?)?;
    /// assert_eq!((heard.emission_s, heard.position_m), (10.0, [1.0, 2.0, -30.0]));
    /// assert!((4.0..4.0 * 1.15 * 1.15).contains(&heard.covariance[0]));
    /// # Ok::<(), shoal_bus::ping::FrameError>(())
    /// ```
    ///
    /// # Errors
    /// [`FrameError::TooLarge`] for a mean or a covariance that is not finite or out of reach, or a variance below zero, and
    /// [`FrameError::Sender`].
    pub fn encode(&self) -> Result<Frame, FrameError> {
        let position = Means::of(&self.position_m, 24, *EXPONENTS.start()..=*EXPONENTS.end())
            .ok_or(FrameError::TooLarge { field: "position" })?;
        let exponents = VELOCITY_EXPONENT_LEAST..=VELOCITY_EXPONENT_LEAST + 31;
        let velocity =
            Means::of(&self.velocity_m_s, 8, exponents).ok_or(FrameError::TooLarge { field: "velocity" })?;
        let emission = (self.emission_s * power_of_two(-TIME_UNIT_EXPONENT)).round();
        if emission.is_nan() || emission.abs() >= power_of_two(46) {
            return Err(FrameError::TooLarge { field: "emission time" });
        }
        let half_units = [position.exponent, position.exponent, position.exponent, TIME_UNIT_EXPONENT]
            .map(|exponent| power_of_two(exponent - 1));
        let covariance =
            Rounded::of(&self.covariance, &half_units).ok_or(FrameError::TooLarge { field: "covariance" })?;

        let mut bytes = Vec::with_capacity(FRAME_BYTES);
        bytes.push(GAUSSIAN << 5 | (velocity.exponent - VELOCITY_EXPONENT_LEAST) as u8);
        bytes.extend(sender(self.sender)?);
        bytes.push(self.sequence);
        bytes.extend(&(emission as i64).to_le_bytes()[..6]);
        bytes.push(position.exponent as i8 as u8);
        position.means.iter().for_each(|mean| bytes.extend(&mean.to_le_bytes()[..3]));
        bytes.extend(covariance.deviations);
        bytes.extend(covariance.correlations.to_le_bytes());
        bytes.extend(velocity.means.map(|mean| mean as i8 as u8));
        Frame::new(&bytes).ok_or(FrameError::Length(bytes.len()))
    }

    /// Three standard deviations to either side of the mean position, in metres.
    pub fn position_box_m(&self) -> BoundsBox {
        std::array::from_fn(|axis| {
            let reach_m = 3.0 * self.covariance[ROWS[axis]].max(0.0).sqrt();
            Bounds::new(self.position_m[axis] - reach_m, self.position_m[axis] + reach_m)
        })
    }

    /// Reads a frame. Any 31 bytes of the right kind have finite means and variances; correlations that no Gaussian has may
    /// come from a hostile sender.
    ///
    /// # Errors
    /// [`FrameError::Length`] and [`FrameError::Kind`].
    pub fn decode(frame: &Frame) -> Result<Self, FrameError> {
        let bytes = header(frame)?;
        if kind(bytes) != GAUSSIAN {
            return Err(FrameError::Kind(kind(bytes)));
        }
        let unit_m = power_of_two(i32::from(bytes[10] as i8).clamp(*EXPONENTS.start(), *EXPONENTS.end()));
        let unit_m_s = power_of_two(VELOCITY_EXPONENT_LEAST + i32::from(bytes[0] & 31));
        let covariance = Rounded {
            deviations: [bytes[20], bytes[21], bytes[22], bytes[23]],
            correlations: u32::from_le_bytes([bytes[24], bytes[25], bytes[26], bytes[27]]),
        };
        Ok(Self {
            sender: AuvId(u32::from(u16::from_le_bytes([bytes[1], bytes[2]]))),
            sequence: bytes[3],
            emission_s: emission_s(bytes),
            position_m: std::array::from_fn(|axis| f64::from(i24(bytes, 11 + 3 * axis)) * unit_m),
            covariance: covariance.read(),
            velocity_m_s: std::array::from_fn(|axis| f64::from(bytes[28 + axis] as i8) * unit_m_s),
        })
    }
}

/// Three numbers in units of one power of two, each off by half a unit at most.
struct Means {
    exponent: i32,
    means: [i64; 3],
}

impl Means {
    /// In the finest unit with which they fit `bits`.
    fn of(values: &[f64; 3], bits: u32, exponents: std::ops::RangeInclusive<i32>) -> Option<Self> {
        if !values.iter().all(|value| value.is_finite()) {
            return None;
        }
        let limit = power_of_two(bits as i32 - 1);
        let farthest = values.iter().fold(0.0_f64, |far, value| far.max(value.abs()));
        let guess = binary_exponent(farthest / limit).clamp(*exponents.start(), *exponents.end());
        (guess..=*exponents.end()).find_map(|exponent| {
            let scaled = values.map(|value| (value * power_of_two(-exponent)).round());
            let fits = scaled.iter().all(|value| value.abs() < limit);
            fits.then(|| Self { exponent, means: scaled.map(|value| value as i64) })
        })
    }
}

/// A covariance as it is sent.
struct Rounded {
    deviations: [u8; 4],
    correlations: u32,
}

impl Rounded {
    /// Rounded outwards, with room for means that are off by up to `half_units`.
    fn of(covariance: &[f64; 10], half_units: &[f64; 4]) -> Option<Self> {
        if !covariance.iter().all(|entry| entry.is_finite()) {
            return None;
        }
        // One part in a million more than Gershgorin asks for, against the rounding of this arithmetic.
        let room = 1.000_001 / (1.0 - 1.5 / STEPS);
        let mut deviations = [0; 4];
        for axis in 0..4 {
            let variance = covariance[ROWS[axis]];
            if variance < 0.0 {
                return None;
            }
            let wanted = ((variance + half_units[axis] * half_units[axis]) * room).sqrt();
            deviations[axis] = (0..=u8::MAX).find(|&code| deviation(axis, code) >= wanted)?;
        }
        let mut correlations = 0;
        for (place, (first, second)) in pairs().enumerate() {
            let scale = deviation(first, deviations[first]) * deviation(second, deviations[second]);
            let steps = (covariance[ROWS[first] + second - first] / scale * STEPS).round();
            correlations |= ((steps.clamp(-STEPS, STEPS) + STEPS) as u32) << (5 * place);
        }
        Some(Self { deviations, correlations })
    }

    fn read(&self) -> [f64; 10] {
        let mut covariance = [0.0; 10];
        for (axis, &code) in self.deviations.iter().enumerate() {
            let deviation = deviation(axis, code);
            covariance[ROWS[axis]] = deviation * deviation;
        }
        for (place, (first, second)) in pairs().enumerate() {
            let scale = deviation(first, self.deviations[first]) * deviation(second, self.deviations[second]);
            let steps = f64::from(self.correlations >> (5 * place) & 31) - STEPS;
            covariance[ROWS[first] + second - first] = scale * (steps / STEPS).min(1.0);
        }
        covariance
    }
}

/// xy, xz, xt, yz, yt, zt.
fn pairs() -> impl Iterator<Item = (usize, usize)> {
    (0..4).flat_map(|first| (first + 1..4).map(move |second| (first, second)))
}

/// The standard deviation that a code stands for, in metres or (the last axis) seconds.
fn deviation(axis: usize, code: u8) -> f64 {
    let octave = if axis == 3 { TIME_OCTAVE } else { POSITION_OCTAVE };
    EIGHTHS[usize::from(code % 8)] * power_of_two(octave + i32::from(code / 8))
}

#[cfg(test)]
mod tests;
