//! Modems by name, each with its sources.
//!
//! Of every figure the comment beside it says whose it is: *maker* for the maker's own, found in a copy of the source named
//! above it or quoted from it by others; *maker, unchecked* for one known from the maker's paper or data sheet that was not
//! held against a copy; *ours* for an estimate, because nobody publishes it. Whoever owns one of these modems should write
//! a `[group.modem]` that is `like` the preset and says what was measured.
//!
//! What the figures amount to stands, worked by hand, with each preset and as numbers in [`BUDGETS`](super::BUDGETS). They
//! have one thing in common: noise alone would let nearly all of them be heard much farther than their makers promise. In
//! water it is echoes, motion and the vehicle's own noise that end the range, and a promise has to hold on a bad day.

use crate::model::{FalseArrivals, MediumAccess, Modem, Modulation, PhysicalLayer};

/// None, unless a scenario asks for them.
const OUTLIERS: FalseArrivals = FalseArrivals { rate: 0.0, delay_s: 0.1 };

/// Modem of a group that does not say its modem.
pub const MODEM_DEFAULT: &str = "ideal";

/// Modems by name.
pub const MODEMS: &[(&str, Modem)] = &[
    (IDEAL.name, IDEAL),
    (MICROMODEM_FSK.name, MICROMODEM_FSK),
    (MICROMODEM_PSK.name, MICROMODEM_PSK),
    (EVOLOGICS_18_34.name, EVOLOGICS_18_34),
    (SEATRAC.name, SEATRAC),
    (POPOTO.name, POPOTO),
];

const fn every(period_s: i64) -> MediumAccess {
    MediumAccess::Periodic { period_ns: period_s * 1_000_000_000, phase_ns: None }
}

/// Heard by all up to 500 m and by nobody beyond, for level `ideal`: all figures are ours, and no device has them.
pub const IDEAL: Modem = Modem {
    name: "ideal",
    range_m: 500.0,
    access: every(1),
    timestamp_error_s: 1e-5,
    bearing_error_rad: None,
    outliers: OUTLIERS,
    frame_bytes: 64,
    physical: None,
    addresses: None,
    duty_cycle: None,
};

/// WHOI Micro-Modem, frequency-hopped FSK (packet type 0) around 25 kHz.
///
/// Freitag, Grund, Singh, Partan, Koski and Ball, "The WHOI Micro-Modem: an acoustic communications and navigation system for
/// multiple platforms", OCEANS 2005 (bands from 3 to 30 kHz, FH-FSK and PSK, up to 16 units). Eustice, Whitcomb, Singh and
/// Grund, "Experimental results in synchronous-clock one-way-travel-time acoustic navigation", ICRA 2007 (time of arrival
/// to 125 µs). Its 50 W and its code, convolutional of rate 1/2, are also what the network simulator ns-3 models.
///
/// Packet: 1 s + 248 bit / (80 bit/s) = 1 s + 3.1 s = 4.1 s.
///
/// Budget at 2,000 m, in the water of [`BUDGETS`](super::BUDGETS):
///
/// ```text
/// source level                                             185.0 dB re 1 µPa at 1 m
/// spreading     15 lg 2000 = 15 × 3.301                   - 49.5 dB
/// absorption    6.10 dB/km × 2 km  (Thorp, 25 kHz)        - 12.2 dB
/// received level                                           123.3 dB re 1 µPa
/// noise         36.8 dB/Hz + 10 lg 4000 = 36.8 + 36.0     - 72.8 dB
/// SNR in the band                                           50.5 dB
/// Eb/N0         50.5 + 10 lg (4000 / 80) = 50.5 + 17.0      67.5 dB
/// ```
///
/// With spherical spreading, 20 lg 2000 = 66.0 dB, 16.5 dB less: SNR 34.0 dB.
pub const MICROMODEM_FSK: Modem = Modem {
    name: "micromodem-fsk",
    range_m: 2000.0, // ours: kilometres are usual at 25 kHz
    access: every(10),
    timestamp_error_s: 1.25e-4, // ICRA 2007, unchecked
    bearing_error_rad: None,
    outliers: OUTLIERS,
    frame_bytes: 32, // maker: one frame of 32 bytes
    physical: Some(PhysicalLayer {
        source_level_db: 185.0, // ours: 50 W (maker) at 50 %, to all sides: 170.8 + 10 lg 25 = 184.8
        centre_hz: 25_000.0,    // maker, unchecked: the highest of its bands
        bandwidth_hz: 4_000.0,  // maker, unchecked
        bit_rate_bit_s: 80.0,   // maker
        preamble_s: 1.0,        // ours: the packet that opens the cycle, and the probe signal
        modulation: Modulation::Fsk,
        coding_gain_db: 4.0,         // ours, for a convolutional code of rate 1/2
        detection_threshold_db: 0.0, // ours
        capture_db: 6.0,             // ours
    }),
    addresses: Some(16), // maker: OCEANS 2005
    duty_cycle: None,
};

/// WHOI Micro-Modem, phase-coherent (packet type 2: direct sequence, 15 chips a symbol) around 25 kHz.
///
/// Sources as for [`MICROMODEM_FSK`]; packet types and rates as its drivers list them: 250, 500, 1200, 1300 and 5300 bit/s
/// for types 1 to 5. Type 2 has frames of 64 bytes and, being slow and spread, is meant for poor channels.
///
/// Packet: 0.5 s + 248 bit / (500 bit/s) = 0.5 s + 0.496 s = 0.996 s.
///
/// Budget at 2,000 m, in the water of [`BUDGETS`](super::BUDGETS):
///
/// ```text
/// source level                                             185.0 dB re 1 µPa at 1 m
/// spreading     15 lg 2000 = 15 × 3.301                   - 49.5 dB
/// absorption    6.10 dB/km × 2 km  (Thorp, 25 kHz)        - 12.2 dB
/// received level                                           123.3 dB re 1 µPa
/// noise         36.8 dB/Hz + 10 lg 5000 = 36.8 + 37.0     - 73.8 dB
/// SNR in the band                                           49.5 dB
/// Eb/N0         49.5 + 10 lg (5000 / 500) = 49.5 + 10.0     59.5 dB
/// ```
///
/// With spherical spreading, 20 lg 2000 = 66.0 dB, 16.5 dB less: SNR 33.0 dB.
pub const MICROMODEM_PSK: Modem = Modem {
    name: "micromodem-psk",
    range_m: 2000.0, // ours
    access: every(5),
    timestamp_error_s: 1.25e-4, // ICRA 2007, unchecked
    bearing_error_rad: None,
    outliers: OUTLIERS,
    frame_bytes: 64, // maker
    physical: Some(PhysicalLayer {
        source_level_db: 185.0, // ours, as for FSK
        centre_hz: 25_000.0,    // maker, unchecked
        bandwidth_hz: 5_000.0,  // maker, unchecked
        bit_rate_bit_s: 500.0,  // maker
        preamble_s: 0.5,        // ours: probe, training and header
        modulation: Modulation::Bpsk,
        coding_gain_db: 3.0,         // ours
        detection_threshold_db: 0.0, // ours
        capture_db: 6.0,             // ours
    }),
    addresses: Some(16), // maker: OCEANS 2005
    duty_cycle: None,
};

/// EvoLogics S2C R 18/34, instant messages.
///
/// EvoLogics, product information of the S2C R 18/34: 18 to 34 kHz, up to 13.9 kbit/s, 3,500 m; 2.8 W to be heard at 1,000 m
/// and 35 W at 3,500 m. The 13.9 kbit/s hold for a connection of two modems; what is broadcast without one is an *instant
/// message* of up to 64 bytes, much slower.
///
/// Packet: 0.2 s + 248 bit / (976 bit/s) = 0.2 s + 0.254 s = 0.454 s.
///
/// Budget at 3,500 m, in the water of [`BUDGETS`](super::BUDGETS):
///
/// ```text
/// source level                                             184.0 dB re 1 µPa at 1 m
/// spreading     15 lg 3500 = 15 × 3.544                   - 53.2 dB
/// absorption    6.53 dB/km × 3.5 km  (Thorp, 26 kHz)      - 22.8 dB
/// received level                                           108.0 dB re 1 µPa
/// noise         36.5 dB/Hz + 10 lg 16000 = 36.5 + 42.0    - 78.5 dB
/// SNR in the band                                           29.5 dB
/// Eb/N0         29.5 + 10 lg (16000 / 976) = 29.5 + 12.1    41.6 dB
/// ```
///
/// With spherical spreading, 20 lg 3500 = 70.9 dB, 17.7 dB less: SNR 11.8 dB.
pub const EVOLOGICS_18_34: Modem = Modem {
    name: "evologics-18-34",
    range_m: 3500.0, // maker
    access: every(2),
    timestamp_error_s: 1e-5, // ours: the maker states ranges to 0.01 m, which is 7 µs
    bearing_error_rad: None,
    outliers: OUTLIERS,
    frame_bytes: 64, // maker, unchecked: instant messages
    physical: Some(PhysicalLayer {
        source_level_db: 184.0, // ours: 35 W (maker) at 30 %, into a half-sphere: 170.8 + 10 lg 10.5 + 3 = 184.0
        centre_hz: 26_000.0,    // maker
        bandwidth_hz: 16_000.0, // maker
        bit_rate_bit_s: 976.0,  // maker, unchecked: instant messages
        preamble_s: 0.2,        // ours
        modulation: Modulation::Bpsk,
        coding_gain_db: 3.0,         // ours
        detection_threshold_db: 0.0, // ours
        capture_db: 6.0,             // ours
    }),
    addresses: Some(254), // maker, unchecked: the highest local address that can be set
    duty_cycle: None,
};

/// Blueprint Subsea SeaTrac X150 and X110.
///
/// Blueprint Subsea, "SeaTrac serial command interface reference", UM-140-D00221-02: messages of up to 31 bytes, 80 ms a byte,
/// beacon numbers 1 to 15, 0 for all; and the product page: spread spectrum, 24 to 32 kHz, 1 km, 100 bit/s. A ping of 31
/// bytes is the longest message it has, where its maker recommends 16 to 20.
///
/// Packet: 0.4 s + 248 bit / (100 bit/s) = 0.4 s + 2.48 s = 2.88 s.
///
/// Budget at 1,000 m, in the water of [`BUDGETS`](super::BUDGETS):
///
/// ```text
/// source level                                             176.0 dB re 1 µPa at 1 m
/// spreading     15 lg 1000 = 15 × 3.000                   - 45.0 dB
/// absorption    7.39 dB/km × 1 km  (Thorp, 28 kHz)        -  7.4 dB
/// received level                                           123.6 dB re 1 µPa
/// noise         35.8 dB/Hz + 10 lg 8000 = 35.8 + 39.0     - 74.9 dB
/// SNR in the band                                           48.7 dB
/// Eb/N0         48.7 + 10 lg (8000 / 100) = 48.7 + 19.0     67.8 dB
/// ```
///
/// With spherical spreading, 20 lg 1000 = 60.0 dB, 15.0 dB less: SNR 33.7 dB.
pub const SEATRAC: Modem = Modem {
    name: "seatrac",
    range_m: 1000.0, // maker
    access: every(5),
    timestamp_error_s: 3.4e-5, // maker, unchecked: ranges to ±0.05 m, which is 33 µs
    bearing_error_rad: None,
    outliers: OUTLIERS,
    frame_bytes: 31, // maker
    physical: Some(PhysicalLayer {
        source_level_db: 176.0, // maker, unchecked
        centre_hz: 28_000.0,    // maker
        bandwidth_hz: 8_000.0,  // maker
        bit_rate_bit_s: 100.0,  // maker: 80 ms a byte
        preamble_s: 0.4,        // ours: five bytes of addresses, type, length and checksum
        // Ours: the maker says no more than spread spectrum; taken for two chirps told apart without their phase.
        modulation: Modulation::Fsk,
        coding_gain_db: 0.0,         // ours
        detection_threshold_db: 0.0, // ours
        capture_db: 6.0,             // ours
    }),
    addresses: Some(15), // maker
    duty_cycle: None,
};

/// Popoto S1000, its slowest PSK.
///
/// Product page of the S1000-N, which Subnero sells with Popoto's hardware: 20 to 30 kHz, FH-FSK at 80 bit/s, PSK at 640 to
/// 10,240 bit/s, 1 to 3 km depending on channel and modulation, 20 W.
///
/// Packet: 0.2 s + 248 bit / (640 bit/s) = 0.2 s + 0.3875 s = 0.5875 s.
///
/// Budget at 3,000 m, in the water of [`BUDGETS`](super::BUDGETS):
///
/// ```text
/// source level                                             180.0 dB re 1 µPa at 1 m
/// spreading     15 lg 3000 = 15 × 3.477                   - 52.2 dB
/// absorption    6.10 dB/km × 3 km  (Thorp, 25 kHz)        - 18.3 dB
/// received level                                           109.5 dB re 1 µPa
/// noise         36.8 dB/Hz + 10 lg 10000 = 36.8 + 40.0    - 76.8 dB
/// SNR in the band                                           32.7 dB
/// Eb/N0         32.7 + 10 lg (10000 / 640) = 32.7 + 11.9    44.7 dB
/// ```
///
/// With spherical spreading, 20 lg 3000 = 69.5 dB, 17.4 dB less: SNR 15.4 dB.
pub const POPOTO: Modem = Modem {
    name: "popoto",
    range_m: 3000.0, // maker: the upper end of "1 to 3 km"
    access: every(2),
    timestamp_error_s: 1e-4, // ours: one sample of its baseband of 10,240 samples/s
    bearing_error_rad: None,
    outliers: OUTLIERS,
    frame_bytes: 64, // ours: its packets are longer, the bus carries no more
    physical: Some(PhysicalLayer {
        source_level_db: 180.0, // ours: 20 W (maker) at 40 %, to all sides: 170.8 + 10 lg 8 = 179.8
        centre_hz: 25_000.0,    // maker
        bandwidth_hz: 10_000.0, // maker
        bit_rate_bit_s: 640.0,  // maker
        preamble_s: 0.2,        // ours
        modulation: Modulation::Bpsk,
        coding_gain_db: 3.0,         // ours
        detection_threshold_db: 0.0, // ours
        capture_db: 6.0,             // ours
    }),
    addresses: Some(255), // ours: numbers of one byte, one of them meaning all
    duty_cycle: None,
};
