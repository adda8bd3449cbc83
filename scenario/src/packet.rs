//! How long a packet takes.

use crate::model::{Level, Modem, PhysicalLayer};

/// Bytes of a ping: sender, sequence, emission interval, position box and velocity box. It is all that modems send here; a
/// frame that could hold more is not filled.
///
/// The message itself is defined with the bus, which a scenario does not know: a test holds the two against each other.
pub const PING_BYTES: u16 = 31;

/// Longest frame that the bus carries in bytes.
pub const FRAME_BYTES_MAX: u16 = 64;

impl PhysicalLayer {
    /// How long a packet with so many bytes is, in seconds: the preamble, and eight bits a byte.
    ///
    /// ```
    /// use shoal_scenario::presets::SEATRAC;
    ///
    /// let physical = SEATRAC.physical.unwrap();
    /// assert_eq!(physical.packet_s(31), 0.4 + 248.0 / 100.0);
    /// ```
    pub fn packet_s(&self, bytes: u16) -> f64 {
        self.preamble_s + 8.0 * f64::from(bytes) / self.bit_rate_bit_s
    }
}

impl Modem {
    /// How long a packet with so many bytes is at this level of the channel, in seconds.
    ///
    /// At level `ideal` a packet is an instant, whatever modem sends it; so it is of a modem without a physical layer, which
    /// level `sea` does not allow.
    ///
    /// ```
    /// use shoal_scenario::presets::POPOTO;
    /// use shoal_scenario::{Level, PING_BYTES};
    ///
    /// assert_eq!(POPOTO.packet_s(&Level::Ideal, PING_BYTES), 0.0);
    /// ```
    pub fn packet_s(&self, level: &Level, bytes: u16) -> f64 {
        match (level, &self.physical) {
            (Level::Sea(_), Some(physical)) => physical.packet_s(bytes),
            _ => 0.0,
        }
    }
}
