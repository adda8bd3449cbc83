//! Bodies, clocks, sensors and sea floors by name. What a scenario file calls `kind = "lauv"` or `clock = "tcxo"` is here and
//! nowhere else.

use crate::model::{Bottom, Clock, Dvl, Gnss, Kind, Sensors};

/// Kind of a group that does not say its kind.
pub const KIND_DEFAULT: &str = "lauv";
/// Clock of a group that does not say its clock.
pub const CLOCK_DEFAULT: &str = "tcxo";
/// Sensors of a group that does not say its sensors.
pub const SENSORS_DEFAULT: &str = "nominal";

/// How far from its commanded velocity moving water pushes a small body, in m/s per axis: our own round figure.
const DISTURBANCE_M_S: [f64; 3] = [0.05, 0.05, 0.02];

/// Bodies by name.
///
/// Lengths and greatest speeds are the makers' published figures, rounded. Makers do not publish accelerations, rates of
/// turn and the pitch that the controller allows: those are our own round estimates for bodies of that size. Bodies that
/// hover climb without pitching, but a kind has one greatest speed for all directions: theirs is that ahead.
pub const KINDS: &[(&str, Kind)] = &[
    // OceanScan-MST LAUV, data sheet: 1.8 to 2.5 m depending on payload, up to 5 knots.
    (
        "lauv",
        Kind {
            speed_max_m_s: 2.5,
            acceleration_max_m_s2: 0.3,
            turn_rate_max_rad_s: 0.35,
            pitch_max_rad: 0.5,
            disturbance_m_s: DISTURBANCE_M_S,
            length_m: 2.4,
        },
    ),
    // REMUS 100, data sheet: 1.6 m, up to 5 knots; Allen et al., OCEANS 1997.
    (
        "remus-100",
        Kind {
            speed_max_m_s: 2.5,
            acceleration_max_m_s2: 0.3,
            turn_rate_max_rad_s: 0.3,
            pitch_max_rad: 0.5,
            disturbance_m_s: DISTURBANCE_M_S,
            length_m: 1.6,
        },
    ),
    // Teledyne Slocum G3, data sheet: 1.5 m, 0.35 m/s on average and about 0.5 m/s at most, glide angle 26 degrees.
    (
        "glider",
        Kind {
            speed_max_m_s: 0.5,
            acceleration_max_m_s2: 0.02,
            turn_rate_max_rad_s: 0.05,
            pitch_max_rad: 0.4538,
            disturbance_m_s: DISTURBANCE_M_S,
            length_m: 1.5,
        },
    ),
    // REMUS 600, data sheet: 3.25 m, up to 5 knots.
    (
        "remus-600",
        Kind {
            speed_max_m_s: 2.5,
            acceleration_max_m_s2: 0.2,
            turn_rate_max_rad_s: 0.2,
            pitch_max_rad: 0.5,
            disturbance_m_s: DISTURBANCE_M_S,
            length_m: 3.25,
        },
    ),
    // Iver3, OceanServer data sheet: 1.5 to 2.2 m depending on payload, 1 to 4 knots.
    (
        "iver3",
        Kind {
            speed_max_m_s: 2.0,
            acceleration_max_m_s2: 0.3,
            turn_rate_max_rad_s: 0.35,
            pitch_max_rad: 0.5,
            disturbance_m_s: DISTURBANCE_M_S,
            length_m: 1.9,
        },
    ),
    // YSI EcoMapper, data sheet: an Iver2 of 1.5 m, 1 to 4 knots.
    (
        "ecomapper",
        Kind {
            speed_max_m_s: 2.0,
            acceleration_max_m_s2: 0.3,
            turn_rate_max_rad_s: 0.35,
            pitch_max_rad: 0.5,
            disturbance_m_s: DISTURBANCE_M_S,
            length_m: 1.5,
        },
    ),
    // Kongsberg HUGIN 1000, data sheet: 4.5 m, 2 to 6 knots.
    (
        "hugin",
        Kind {
            speed_max_m_s: 3.0,
            acceleration_max_m_s2: 0.15,
            turn_rate_max_rad_s: 0.15,
            pitch_max_rad: 0.5,
            disturbance_m_s: DISTURBANCE_M_S,
            length_m: 4.5,
        },
    ),
    // Sparus II, Carreras et al., IEEE J. Oceanic Eng. 43 (2018), and data sheet: 1.6 m, 3 to 4 knots; hovers.
    (
        "sparus-ii",
        Kind {
            speed_max_m_s: 2.0,
            acceleration_max_m_s2: 0.3,
            turn_rate_max_rad_s: 0.5,
            pitch_max_rad: 0.5,
            disturbance_m_s: DISTURBANCE_M_S,
            length_m: 1.6,
        },
    ),
    // Blue Robotics BlueROV2, data sheet: 0.457 m, 1.5 m/s (3 knots) ahead; hovers.
    (
        "bluerov2",
        Kind {
            speed_max_m_s: 1.5,
            acceleration_max_m_s2: 0.5,
            turn_rate_max_rad_s: 1.0,
            pitch_max_rad: 1.5,
            disturbance_m_s: DISTURBANCE_M_S,
            length_m: 0.46,
        },
    ),
    // CISCREA, the vehicle of the sea trials of seed 001 (figure 5.10); Yang et al., J. Intell. Robot. Syst. 80 (2015): 0.525 m,
    // 2 knots ahead, 1 knot up and sideways; hovers.
    (
        "ciscrea",
        Kind {
            speed_max_m_s: 1.0,
            acceleration_max_m_s2: 0.2,
            turn_rate_max_rad_s: 0.6,
            pitch_max_rad: 1.5,
            disturbance_m_s: DISTURBANCE_M_S,
            length_m: 0.53,
        },
    ),
];

/// Clocks by name. Half of each bound is a constant rate error, half wanders; they start synchronised.
pub const CLOCKS: &[(&str, Clock)] = &[
    // Never drifts.
    ("ideal", Clock { drift_bound: 0.0, wander_fraction: 0.0, offset_bound_s: 0.0 }),
    // A plain quartz: 20 ppm of tolerance and about as much again over temperature and age, rounded up to 50 ppm.
    ("quartz", Clock { drift_bound: 5e-5, wander_fraction: 0.5, offset_bound_s: 0.0 }),
    // Temperature-compensated quartz: 1 ppm, the usual grade of data loggers.
    ("tcxo", Clock { drift_bound: 1e-6, wander_fraction: 0.5, offset_bound_s: 0.0 }),
    // Quartz in an oven, Isotemp 143 data sheet: ageing of up to 1e-7 a year, beside which temperature is little.
    ("ocxo", Clock { drift_bound: 1e-7, wander_fraction: 0.5, offset_bound_s: 0.0 }),
    // Chip-scale atomic clock, Microchip SA.45s data sheet: some 1e-10 after warming up, at a steady temperature and soon
    // after calibration. Its whole range of temperatures adds up to 5e-10, a month of ageing up to 9e-10.
    ("csac", Clock { drift_bound: 1e-10, wander_fraction: 0.5, offset_bound_s: 0.0 }),
];

/// Sea floors by name, as fluids: F. B. Jensen, W. A. Kuperman, M. B. Porter and H. Schmidt, *Computational Ocean Acoustics*,
/// 2nd edition (Springer 2011), table 1.3, with water of 1,000 kg/m³ and 1,500 m/s; the table goes back to E. L. Hamilton,
/// "Geoacoustic modeling of the sea floor", J. Acoust. Soc. Am. 68 (1980), 1313-1340.
pub const BOTTOMS: &[(&str, Bottom)] = &[
    ("clay", Bottom { density_kg_m3: 1500.0, sound_speed_m_s: 1500.0, attenuation_db_wavelength: 0.2 }),
    ("silt", Bottom { density_kg_m3: 1700.0, sound_speed_m_s: 1575.0, attenuation_db_wavelength: 1.0 }),
    ("sand", Bottom { density_kg_m3: 1900.0, sound_speed_m_s: 1650.0, attenuation_db_wavelength: 0.8 }),
    ("gravel", Bottom { density_kg_m3: 2000.0, sound_speed_m_s: 1800.0, attenuation_db_wavelength: 0.6 }),
    // Basalt. Its shear waves, which take energy at steep angles, are left out: real rock reflects a little less.
    ("rock", Bottom { density_kg_m3: 2700.0, sound_speed_m_s: 5250.0, attenuation_db_wavelength: 0.1 }),
];

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
