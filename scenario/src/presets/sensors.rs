//! Sensors, Doppler logs and satellite receivers by name.

use crate::model::{Dvl, Gnss, Sensors};

/// Sensors of a group that does not say its sensors.
pub const SENSORS_DEFAULT: &str = "nominal";

const DVL1000: Dvl = Dvl { altitude_max_m: 75.0, velocity_error_m_s: 0.02 };
const A50: Dvl = Dvl { altitude_max_m: 50.0, velocity_error_m_s: 0.02 };
const WORKHORSE_300: Dvl = Dvl { altitude_max_m: 200.0, velocity_error_m_s: 0.03 };

/// Doppler velocity logs by name.
///
/// Altitudes are the makers'. A velocity error is a bound for one ping of a body at up to 3 m/s: the makers' long-term
/// accuracy, plus three times the standard deviation of a ping (a few mm/s by most data sheets), rounded up.
pub const DVLS: &[(&str, Dvl)] = &[
    // Nortek DVL1000 (1 MHz), data sheet: 75 m, 0.2 % and 0.1 cm/s in the long term.
    ("dvl1000", DVL1000),
    // Water Linked DVL A50 (1 MHz), data sheet: 50 m, 0.1 cm/s in the long term.
    ("a50", A50),
    // Teledyne RDI Workhorse Navigator (300 kHz), data sheet: 200 m, 0.4 % and 0.2 cm/s in the long term.
    ("workhorse-300", WORKHORSE_300),
];

const STANDALONE: Gnss = Gnss {
    depth_max_m: 0.5,
    period_ns: 1_000_000_000,
    position_error_m: [7.0, 7.0, 12.0],
    time_error_s: 1e-6,
};

/// Satellite receivers by name.
pub const GNSS: &[(&str, Gnss)] = &[
    // Without corrections: 2.5 m circular error probable (u-blox NEO-M8 data sheet) is a standard deviation of 2.1 m per axis,
    // and up it is nearly twice that. The time is far better than our microsecond. The antenna must be out of the water:
    // on a mast half a metre above the middle of the body.
    ("standalone", STANDALONE),
];

/// What is sensed when nothing is said: round figures of our own for a well-calibrated vehicle.
pub(crate) const NOMINAL: Sensors = Sensors {
    heading_error_rad: 0.01,
    pitch_error_rad: 0.01,
    speed_error_m_s: 0.02,
    depth_error_m: Some(0.1),
    dvl: None,
    gnss: None,
};

/// Suites of sensors by name.
///
/// Data sheets state a root mean square, estimators need a bound: ours is three times that, which a normally distributed
/// error keeps in 99.7 of 100 samples (what lies beyond is no part of a run without declared faults). Logs: the error of a speed
/// worked out from the propeller's turns is our own estimate; one with a Doppler log has it from water tracking.
pub const SENSORS: &[(&str, Sensors)] = &[
    (SENSORS_DEFAULT, NOMINAL),
    // VectorNav VN-100 data sheet: 2 degrees of magnetic heading, 1 degree of pitch while moving. Pressure by a
    // TE MS5837-30BA: 50 mbar.
    (
        "mems-ahrs",
        Sensors {
            heading_error_rad: 0.105,
            pitch_error_rad: 0.053,
            speed_error_m_s: 0.1,
            depth_error_m: Some(0.5),
            dvl: None,
            gnss: Some(STANDALONE),
        },
    ),
    // Xsens MTi-30 data sheet: 1 degree of magnetic heading, 0.5 degrees of pitch while moving. Pressure: 0.05 % of 200 m.
    (
        "ahrs-dvl",
        Sensors {
            heading_error_rad: 0.053,
            pitch_error_rad: 0.027,
            speed_error_m_s: 0.02,
            depth_error_m: Some(0.1),
            dvl: Some(DVL1000),
            gnss: Some(STANDALONE),
        },
    ),
    // Fibre-optic gyros, iXblue ROVINS data sheet: 0.05 degrees of heading times the secant of the latitude, here 45 degrees,
    // and 0.01 degrees of pitch. Pressure by a Paroscientific Digiquartz: 0.01 % of 1,000 m.
    (
        "fog-ins",
        Sensors {
            heading_error_rad: 0.0038,
            pitch_error_rad: 0.0006,
            speed_error_m_s: 0.03,
            depth_error_m: Some(0.1),
            dvl: Some(WORKHORSE_300),
            gnss: Some(STANDALONE),
        },
    ),
];
