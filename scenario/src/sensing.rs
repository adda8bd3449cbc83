//! The table `[group.sensors]`.

use toml::de::DeValue;

use crate::model::{Gnss, Sensors};
use crate::number::Rule;
use crate::reader::Table;

/// Fastest that anything periodic on an AUV may happen.
pub(crate) const PERIOD_MIN_NS: i64 = 1_000_000;
/// Slowest that an AUV may wake.
pub(crate) const PERIOD_MAX_NS: i64 = 1_000_000_000_000;
const SECOND_NS: i64 = 1_000_000_000;

pub(crate) fn sensors(group: &Table<'_>) -> Option<Sensors> {
    if !group.has("sensors") {
        group.get("sensors");
        return Some(Sensors {
            heading_error_rad: 0.01,
            pitch_error_rad: 0.01,
            speed_error_m_s: 0.02,
            depth_error_m: Some(0.1),
            dvl: None,
            gnss: None,
        });
    }
    let table = group.table("sensors", "[group.sensors]")?;
    let heading_error_rad = table.number("heading_error_rad", Some(0.01), Rule::NotNegative);
    let pitch_error_rad = table.number("pitch_error_rad", Some(0.01), Rule::NotNegative);
    let speed_error_m_s = table.number("speed_error_m_s", Some(0.02), Rule::NotNegative);
    let depth_error_m = match table.get("depth_error_m") {
        None => Some(Some(0.1)),
        Some(value) if matches!(value.get_ref(), DeValue::Boolean(false)) => Some(None),
        Some(value) => table.number_in("depth_error_m", value, Rule::NotNegative).map(Some),
    };
    let gnss = match table.get("gnss").map(toml::Spanned::get_ref) {
        None | Some(DeValue::Boolean(false)) => Some(None),
        Some(_) => gnss(&table).map(Some),
    };
    table.finish();
    Some(Sensors {
        heading_error_rad: heading_error_rad?,
        pitch_error_rad: pitch_error_rad?,
        speed_error_m_s: speed_error_m_s?,
        depth_error_m: depth_error_m?,
        dvl: None,
        gnss: gnss?,
    })
}

fn gnss(sensors: &Table<'_>) -> Option<Gnss> {
    let table = sensors.table("gnss", "[group.sensors.gnss]")?;
    let depth_max_m = table.number("depth_max_m", Some(1.0), Rule::NotNegative);
    let period_ns = table.time_ns("period_s", Some(SECOND_NS), PERIOD_MIN_NS);
    let position_error_m = table.vec3("position_error_m", Some([1.0; 3]), Rule::NotNegative);
    let time_error_s = table.number("time_error_s", Some(1e-6), Rule::NotNegative);
    table.finish();
    Some(Gnss {
        depth_max_m: depth_max_m?,
        period_ns: period_ns?,
        position_error_m: position_error_m?,
        time_error_s: time_error_s?,
    })
}
