//! Bodies, clocks, sensors, modems and sea floors by name. What a scenario file calls `kind = "lauv"`, `clock = "tcxo"` or
//! `modem = "popoto"` is here and nowhere else.

mod budget;
mod modem;
mod sensors;

pub use budget::{BUDGET_SHIPPING, BUDGET_WIND_M_S, BUDGETS, Budget};
pub use modem::{
    EVOLOGICS_18_34, IDEAL, MICROMODEM_FSK, MICROMODEM_PSK, MODEM_DEFAULT, MODEMS, POPOTO, SEATRAC,
};
pub(crate) use sensors::NOMINAL;
pub use sensors::{DVLS, GNSS, SENSORS, SENSORS_DEFAULT};

use crate::model::{Bottom, Clock, Kind};

/// Kind of a group that does not say its kind.
pub const KIND_DEFAULT: &str = "lauv";
/// Clock of a group that does not say its clock.
pub const CLOCK_DEFAULT: &str = "tcxo";

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
