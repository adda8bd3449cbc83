//! The ping as the modem sends it: 31 bytes, every interval rounded **outwards** to the few bits it gets.
//!
//! The three high bits of the first byte say what a frame is: 2 is a [`Ping`], intervals that are promised to hold the truth, as
//! below; 3 is a [`GaussianPing`], a belief that promises nothing.
//!
//! | bytes | field | unit |
//! |---|---|---|
//! | 0 | kind 2 (3 high bits), exponent `e` of the emission width (5 low bits) | |
//! | 1-2 | sender, `u16` | |
//! | 3 | sequence number modulo 256, `u8` | |
//! | 4-9 | earliest true time of emission, `i48` | 2⁻²⁰ s |
//! | 10 | width of the emission interval, `u8` | 2^(e-20) s |
//! | 11 | exponent `p` of the position, `i8` | |
//! | 12-20 | least x, y, z, three `i24` | 2^p m |
//! | 21-23 | widths of x, y, z, three `u8` | 2^p m |
//! | 24 | exponent `v` of the velocity, `i8` | |
//! | 25-27 | least velocity, three `i8` | 2^v m/s |
//! | 28-30 | widths of the velocity, three `u8` | 2^v m/s |
//!
//! All integers are little-endian. Scaling by a power of two is exact in binary floating point, floor and ceiling are too,
//! so the decoded intervals always hold the encoded ones.

mod gaussian;

use std::fmt;

use serde::de::{self, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use thiserror::Error;

use crate::message::{AuvId, Bounds, BoundsBox};

pub use gaussian::GaussianPing;

/// Length of an encoded ping.
pub const FRAME_BYTES: usize = 31;

const INTERVALS: u8 = 2;
const GAUSSIAN: u8 = 3;
const TIME_UNIT_EXPONENT: i32 = -20;
const EXPONENTS: std::ops::RangeInclusive<i32> = -60..=60;

/// Longest frame that any modem carries.
pub const FRAME_BYTES_MAX: usize = 64;

/// The bytes that a modem carries, at most [`FRAME_BYTES_MAX`]. May hold anything: decode before you believe.
#[derive(Clone, Copy)]
pub struct Frame {
    length: u8,
    bytes: [u8; FRAME_BYTES_MAX],
}

impl Frame {
    /// The frame of these bytes; `None` if they are too many for any modem.
    ///
    /// ```
    /// use shoal_bus::ping::Frame;
    /// assert_eq!(Frame::new(&[1, 2, 3]).unwrap().bytes(), [1, 2, 3]);
    /// assert!(Frame::new(&[0; 65]).is_none());
    /// ```
    pub fn new(of: &[u8]) -> Option<Self> {
        let mut bytes = [0; FRAME_BYTES_MAX];
        bytes.get_mut(..of.len())?.copy_from_slice(of);
        Some(Self { length: of.len() as u8, bytes })
    }

    /// The bytes.
    #[inline]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes[..usize::from(self.length)]
    }
}

impl PartialEq for Frame {
    fn eq(&self, other: &Self) -> bool {
        self.bytes() == other.bytes()
    }
}

impl Eq for Frame {}

impl fmt::Debug for Frame {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Frame").field(&self.bytes()).finish()
    }
}

impl Serialize for Frame {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if serializer.is_human_readable() {
            let digits = self.bytes().iter().flat_map(|byte| [byte >> 4, byte & 15]);
            let text: String = digits.filter_map(|digit| char::from_digit(digit.into(), 16)).collect();
            return serializer.serialize_str(&text);
        }
        serializer.serialize_bytes(self.bytes())
    }
}

impl<'de> Deserialize<'de> for Frame {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Bytes;
        impl Visitor<'_> for Bytes {
            type Value = Frame;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "at most {FRAME_BYTES_MAX} bytes, in text two hexadecimal digits each")
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<Frame, E> {
                let wrong = || E::invalid_value(de::Unexpected::Str(text), &self);
                let mut bytes = Vec::with_capacity(FRAME_BYTES_MAX);
                for pair in text.as_bytes().chunks(2).take(FRAME_BYTES_MAX + 1) {
                    let &[high, low] = pair else { return Err(wrong()) };
                    let digit = |of: u8| char::from(of).to_digit(16).ok_or_else(wrong);
                    bytes.push((digit(high)? << 4 | digit(low)?) as u8);
                }
                self.visit_bytes(&bytes)
            }

            fn visit_bytes<E: de::Error>(self, bytes: &[u8]) -> Result<Frame, E> {
                Frame::new(bytes).ok_or_else(|| E::invalid_length(bytes.len(), &self))
            }
        }
        if deserializer.is_human_readable() {
            return deserializer.deserialize_str(Bytes);
        }
        deserializer.deserialize_bytes(Bytes)
    }
}

/// What a ping says: where its emitter was when it left, and how it moved.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ping {
    /// Who emits.
    pub sender: AuvId,
    /// Counts the emitter's pings, modulo 256.
    pub sequence: u8,
    /// True time of the emission, in seconds.
    pub emission_s: Bounds,
    /// Position of the emitter at the emission, in metres.
    pub position_m: BoundsBox,
    /// Velocity over ground of the emitter at the emission, in m/s.
    pub velocity_m_s: BoundsBox,
}

/// Why a ping does not fit its frame, or a frame is not a ping.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum FrameError {
    /// A field is too wide, too far away or not a number.
    #[error("the {field} is unbounded or too large for a frame")]
    TooLarge {
        /// Which field.
        field: &'static str,
    },
    /// The sender's id does not fit.
    #[error("AUV {0} does not fit: a frame names at most 65,536 senders")]
    Sender(AuvId),
    /// The length is wrong.
    #[error("a ping has {FRAME_BYTES} bytes, this frame has {0}")]
    Length(usize),
    /// It is something else, or comes from another version.
    #[error(
        "the frame is of kind {0}, which is not what was asked for: {INTERVALS} has intervals, {GAUSSIAN} a Gaussian"
    )]
    Kind(u8),
}

/// What a frame may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Payload {
    /// Intervals that hold the truth.
    Intervals(Ping),
    /// A belief.
    Gaussian(GaussianPing),
}

impl Payload {
    /// Reads a frame of any kind.
    ///
    /// # Errors
    /// [`FrameError::Length`] and [`FrameError::Kind`].
    pub fn decode(frame: &Frame) -> Result<Self, FrameError> {
        match kind(header(frame)?) {
            GAUSSIAN => GaussianPing::decode(frame).map(Self::Gaussian),
            _ => Ping::decode(frame).map(Self::Intervals),
        }
    }

    /// Who says that it sent it.
    pub fn sender(&self) -> AuvId {
        match self {
            Self::Intervals(ping) => ping.sender,
            Self::Gaussian(ping) => ping.sender,
        }
    }
}

/// The bytes of a frame that has as many as it should.
#[inline]
fn header(frame: &Frame) -> Result<&[u8; FRAME_BYTES], FrameError> {
    frame.bytes().try_into().map_err(|_| FrameError::Length(frame.bytes().len()))
}

#[inline]
fn kind(bytes: &[u8; FRAME_BYTES]) -> u8 {
    bytes[0] >> 5
}

fn sender(of: AuvId) -> Result<[u8; 2], FrameError> {
    u16::try_from(of.0).map(u16::to_le_bytes).map_err(|_| FrameError::Sender(of))
}

impl Ping {
    /// The frame whose decoded intervals hold this ping's, each wider by less than 2 % of its block's widest or one unit.
    ///
    /// ```
    /// use shoal_bus::message::{AuvId, Bounds};
    /// use shoal_bus::ping::Ping;
    /// let side = Bounds::new(-0.3, 12.7);
    /// let ping = Ping { sender: AuvId(7), sequence: 3, emission_s: Bounds::new(9.99, 10.01),
    ///     position_m: [side; 3], velocity_m_s: [Bounds::new(0.9, 1.1); 3] };
    /// let heard = Ping::decode(&ping.encode()?)?;
    /// assert!(heard.position_m[0].lower <= -0.3 && heard.position_m[0].upper >= 12.7);
    /// assert!(heard.emission_s.lower <= 9.99 && heard.emission_s.upper >= 10.01);
    /// # Ok::<(), shoal_bus::ping::FrameError>(())
    /// ```
    pub fn encode(&self) -> Result<Frame, FrameError> {
        let sender = sender(self.sender)?;
        let (emission, widen) = quantise_time(self.emission_s)?;
        let position =
            Block::of(&self.position_m, 24).ok_or(FrameError::TooLarge { field: "position box" })?;
        let velocity =
            Block::of(&self.velocity_m_s, 8).ok_or(FrameError::TooLarge { field: "velocity box" })?;

        let mut bytes = Vec::with_capacity(FRAME_BYTES);
        bytes.push(INTERVALS << 5 | widen.exponent);
        bytes.extend(sender);
        bytes.push(self.sequence);
        bytes.extend(&emission.to_le_bytes()[..6]);
        bytes.push(widen.width);
        position.write(3, &mut bytes);
        velocity.write(1, &mut bytes);
        Frame::new(&bytes).ok_or(FrameError::Length(bytes.len()))
    }

    /// Reads a frame. Any 31 bytes of the right kind are some ping; whether it is true is another question.
    #[inline]
    pub fn decode(frame: &Frame) -> Result<Self, FrameError> {
        let bytes = header(frame)?;
        if kind(bytes) != INTERVALS {
            return Err(FrameError::Kind(kind(bytes)));
        }
        let earliest = emission_s(bytes);
        let width = f64::from(bytes[10]) * power_of_two(TIME_UNIT_EXPONENT + i32::from(bytes[0] & 31));
        let side = |axis: usize| (i24(bytes, 12 + 3 * axis), bytes[21 + axis]);
        let speed = |axis: usize| (i32::from(bytes[25 + axis] as i8), bytes[28 + axis]);
        Ok(Self {
            sender: AuvId(u32::from(u16::from_le_bytes([bytes[1], bytes[2]]))),
            sequence: bytes[3],
            emission_s: Bounds::new(earliest, earliest + width),
            position_m: block(bytes[11], [side(0), side(1), side(2)]),
            velocity_m_s: block(bytes[24], [speed(0), speed(1), speed(2)]),
        })
    }
}

/// Width of the emission interval: `width * 2^exponent` units.
struct Widen {
    exponent: u8,
    width: u8,
}

/// The earliest emission in units of 2⁻²⁰ s, and a width that reaches at least to the latest.
fn quantise_time(time_s: Bounds) -> Result<(i64, Widen), FrameError> {
    let too_large = FrameError::TooLarge { field: "emission interval" };
    let units_per_s = power_of_two(-TIME_UNIT_EXPONENT);
    let (least, greatest) = ((time_s.lower * units_per_s).floor(), (time_s.upper * units_per_s).ceil());
    let limit = power_of_two(46);
    if !(least.abs() < limit && greatest.abs() < limit && least <= greatest) {
        return Err(too_large);
    }
    let width = (greatest - least) as u64;
    for exponent in 0..32u8 {
        let rounded = width.div_ceil(1 << exponent);
        if let Ok(width) = u8::try_from(rounded) {
            return Ok((least as i64, Widen { exponent, width }));
        }
    }
    Err(too_large)
}

/// Three intervals in units of one power of two: integer lower bounds and 8-bit widths.
struct Block {
    exponent: i8,
    lower: [i64; 3],
    width: [u8; 3],
}

impl Block {
    /// The finest block whose lower bounds fit `bits`.
    fn of(sides: &BoundsBox, bits: u32) -> Option<Self> {
        if !sides.iter().all(|side| side.is_valid() && side.lower.is_finite() && side.upper.is_finite()) {
            return None;
        }
        // A first guess from the largest quantities; the loop settles what rounding adds.
        let widest = crate::message::box_width(sides);
        let farthest = sides.iter().fold(0.0_f64, |far, side| far.max(side.lower.abs()));
        let needed = (widest / 255.0).max(farthest / power_of_two(bits as i32 - 1));
        let guess = binary_exponent(needed).clamp(*EXPONENTS.start(), *EXPONENTS.end());
        (guess..=*EXPONENTS.end()).find_map(|exponent| Self::at(sides, bits, exponent))
    }

    fn at(sides: &BoundsBox, bits: u32, exponent: i32) -> Option<Self> {
        let units = power_of_two(-exponent);
        let limit = power_of_two(bits as i32 - 1);
        let mut block = Self { exponent: exponent as i8, lower: [0; 3], width: [0; 3] };
        for (axis, side) in sides.iter().enumerate() {
            let (least, greatest) = ((side.lower * units).floor(), (side.upper * units).ceil());
            if least < -limit || least >= limit || greatest - least > 255.0 {
                return None;
            }
            block.lower[axis] = least as i64;
            block.width[axis] = (greatest - least) as u8;
        }
        Some(block)
    }

    fn write(&self, lower_bytes: usize, bytes: &mut Vec<u8>) {
        bytes.push(self.exponent as u8);
        for lower in self.lower {
            bytes.extend(&lower.to_le_bytes()[..lower_bytes]);
        }
        bytes.extend(self.width);
    }
}

/// The true time of emission at the usual place, in seconds; of intervals, its earliest.
#[inline]
fn emission_s(bytes: &[u8; FRAME_BYTES]) -> f64 {
    let [_, _, _, _, a, b, c, d, e, f, ..] = *bytes;
    let units = i64::from_le_bytes([0, 0, a, b, c, d, e, f]) >> 16;
    units as f64 * power_of_two(TIME_UNIT_EXPONENT)
}

/// The three bytes from `at` on as a number.
#[inline(always)]
fn i24(bytes: &[u8; FRAME_BYTES], at: usize) -> i32 {
    i32::from_le_bytes([0, bytes[at], bytes[at + 1], bytes[at + 2]]) >> 8
}

/// The intervals of a block: its exponent, and the lower bound and width of each in its unit.
#[inline(always)]
fn block(exponent: u8, sides: [(i32, u8); 3]) -> BoundsBox {
    // A hostile exponent is brought into the range that an honest encoder uses.
    let exponent = i32::from(exponent as i8).clamp(*EXPONENTS.start(), *EXPONENTS.end());
    let unit = power_of_two(exponent);
    let [x, y, z] = sides;
    let side = |(lower, width): (i32, u8)| {
        Bounds::new(f64::from(lower) * unit, f64::from(lower + i32::from(width)) * unit)
    };
    [side(x), side(y), side(z)]
}

/// 2^`exponent` exactly, for exponents of normal numbers.
#[inline]
fn power_of_two(exponent: i32) -> f64 {
    f64::from_bits(((1023 + exponent) as u64) << 52)
}

/// The largest e with 2^e <= `value`; very small for zero.
fn binary_exponent(value: f64) -> i32 {
    ((value.to_bits() >> 52 & 0x7ff) as i32) - 1023
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ping(position_m: BoundsBox, velocity_m_s: BoundsBox, emission_s: Bounds) -> Ping {
        Ping { sender: AuvId(513), sequence: 255, emission_s, position_m, velocity_m_s }
    }

    fn holds(outer: &Bounds, inner: &Bounds) -> bool {
        outer.lower <= inner.lower && inner.upper <= outer.upper
    }

    #[test]
    fn decoded_intervals_hold_the_encoded_ones_and_stay_tight() {
        let mut state = 0x9e37_79b9_7f4a_7c15_u64;
        let mut draw = move |scale: f64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 11) as f64 / (1u64 << 53) as f64 * 2.0 - 1.0) * scale
        };
        for _ in 0..20_000 {
            let scale = power_of_two(draw(20.0) as i32);
            let side = |draw: &mut dyn FnMut(f64) -> f64| {
                let lower = draw(5_000.0);
                Bounds::new(lower, lower + draw(scale).abs())
            };
            let position = [side(&mut draw), side(&mut draw), side(&mut draw)];
            let velocity = std::array::from_fn(|_| {
                let lower = draw(3.0);
                Bounds::new(lower, lower + draw(0.5).abs())
            });
            let emitted = draw(1e6);
            let original = ping(position, velocity, Bounds::new(emitted, emitted + draw(2.0).abs()));
            let decoded = Ping::decode(&original.encode().unwrap()).unwrap();
            assert_eq!((decoded.sender, decoded.sequence), (original.sender, original.sequence));
            assert!(holds(&decoded.emission_s, &original.emission_s));
            let loss = decoded.emission_s.width() - original.emission_s.width();
            assert!(loss <= original.emission_s.width() * 0.02 + 4e-6, "{loss}");
            let widest = crate::message::box_width(&position);
            for axis in 0..3 {
                assert!(holds(&decoded.position_m[axis], &position[axis]));
                assert!(holds(&decoded.velocity_m_s[axis], &velocity[axis]));
                let loss = decoded.position_m[axis].width() - position[axis].width();
                assert!(loss <= widest * 0.02 + 0.002, "{loss} of {widest}");
            }
        }
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let fine = [Bounds::new(0.0, 1.0); 3];
        let moment = Bounds::new(0.0, 1.0);
        let endless = [Bounds::new(f64::NEG_INFINITY, 0.0); 3];
        assert!(matches!(ping(endless, fine, moment).encode(), Err(FrameError::TooLarge { .. })));
        let nan = [Bounds::new(f64::NAN, 0.0); 3];
        assert!(matches!(ping(fine, nan, moment).encode(), Err(FrameError::TooLarge { .. })));
        assert!(matches!(ping(fine, fine, Bounds::new(0.0, 1e9)).encode(), Err(FrameError::TooLarge { .. })));
        let mut crowd = ping(fine, fine, moment);
        crowd.sender = AuvId(70_000);
        assert_eq!(crowd.encode(), Err(FrameError::Sender(AuvId(70_000))));
        assert_eq!(Ping::decode(&Frame::new(&[32; 3]).unwrap()), Err(FrameError::Length(3)));
        assert_eq!(Ping::decode(&Frame::new(&[0xff; 31]).unwrap()), Err(FrameError::Kind(7)));
    }
}
