//! The key `sensors`: what is sensed and how well, by name or in full.

use toml::Spanned;
use toml::de::DeValue;

use crate::body::Named;
use crate::model::{Dvl, Gnss, Sensors};
use crate::number::Rule;
use crate::presets::{DVLS, GNSS, NOMINAL, SENSORS, SENSORS_DEFAULT};
use crate::reader::{Table, TextOrTable};

/// Fastest that anything periodic on an AUV may happen.
pub(crate) const PERIOD_MIN_NS: i64 = 1_000_000;
/// Slowest that an AUV may wake.
pub(crate) const PERIOD_MAX_NS: i64 = 1_000_000_000_000;

impl Named for Sensors {
    const KEY: &'static str = "sensors";
    const DEFAULT: &'static str = SENSORS_DEFAULT;
    const PRESETS: &'static [(&'static str, Self)] = SENSORS;

    fn read(table: &Table<'_>, like: Option<&Self>) -> Option<Self> {
        let like = like.unwrap_or(&NOMINAL);
        let error = |key, bound| table.number(key, Some(bound), Rule::NotNegative);
        let heading_error_rad = error("heading_error_rad", like.heading_error_rad);
        let pitch_error_rad = error("pitch_error_rad", like.pitch_error_rad);
        let speed_error_m_s = error("speed_error_m_s", like.speed_error_m_s);
        let depth_error_m = match table.get("depth_error_m") {
            None => Some(like.depth_error_m),
            Some(value) if is_false(value) => Some(None),
            Some(value) => table.number_in("depth_error_m", value, Rule::NotNegative).map(Some),
        };
        let dvl = or_none(table, "dvl", like.dvl.as_ref(), dvl);
        let gnss = or_none(table, "gnss", like.gnss.as_ref(), gnss);
        Some(Sensors {
            heading_error_rad: heading_error_rad?,
            pitch_error_rad: pitch_error_rad?,
            speed_error_m_s: speed_error_m_s?,
            depth_error_m: depth_error_m?,
            dvl: dvl?,
            gnss: gnss?,
        })
    }
}

fn is_false(value: &Spanned<DeValue<'_>>) -> bool {
    matches!(value.get_ref(), DeValue::Boolean(false))
}

/// What stands under `key`, `false` for none; as in `like` when nothing does.
fn or_none<T: Clone>(
    table: &Table<'_>,
    key: &'static str,
    like: Option<&T>,
    read: fn(&Table<'_>, Option<&T>) -> Option<T>,
) -> Option<Option<T>> {
    match table.get(key) {
        None => Some(like.cloned()),
        Some(value) if is_false(value) => Some(None),
        Some(_) => read(table, like).map(Some),
    }
}

fn dvl(sensors: &Table<'_>, like: Option<&Dvl>) -> Option<Dvl> {
    let table = match sensors.text_or_table("dvl", "[group.sensors.dvl]")? {
        TextOrTable::Text(name) => return sensors.chosen("dvl", name, DVLS),
        TextOrTable::Table(table) => table,
    };
    let altitude_max_m = table.number("altitude_max_m", like.map(|dvl| dvl.altitude_max_m), Rule::Positive);
    let velocity_error_m_s =
        table.number("velocity_error_m_s", like.map(|dvl| dvl.velocity_error_m_s), Rule::NotNegative);
    table.finish();
    Some(Dvl { altitude_max_m: altitude_max_m?, velocity_error_m_s: velocity_error_m_s? })
}

fn gnss(sensors: &Table<'_>, like: Option<&Gnss>) -> Option<Gnss> {
    const DEFAULT: Gnss =
        Gnss { depth_max_m: 1.0, period_ns: 1_000_000_000, position_error_m: [1.0; 3], time_error_s: 1e-6 };
    let table = match sensors.text_or_table("gnss", "[group.sensors.gnss]")? {
        TextOrTable::Text(name) => return sensors.chosen("gnss", name, GNSS),
        TextOrTable::Table(table) => table,
    };
    let like = like.unwrap_or(&DEFAULT);
    let depth_max_m = table.number("depth_max_m", Some(like.depth_max_m), Rule::NotNegative);
    let period_ns = table.time_ns("period_s", Some(like.period_ns), PERIOD_MIN_NS);
    let position_error_m = table.vec3("position_error_m", Some(like.position_error_m), Rule::NotNegative);
    let time_error_s = table.number("time_error_s", Some(like.time_error_s), Rule::NotNegative);
    table.finish();
    Some(Gnss {
        depth_max_m: depth_max_m?,
        period_ns: period_ns?,
        position_error_m: position_error_m?,
        time_error_s: time_error_s?,
    })
}
