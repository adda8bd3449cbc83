//! The table `[environment]`: the water and the sound in it.

use crate::model::{CurrentField, Environment, Level, Region, Vec3};
use crate::number::Rule;
use crate::reader::Table;

/// Levels by name.
pub(crate) const LEVELS: &[(&str, LevelName)] = &[("ideal", LevelName::Ideal)];

#[derive(Clone, Copy)]
pub(crate) enum LevelName {
    Ideal,
}

pub(crate) fn environment(document: &Table<'_>) -> Option<Environment> {
    if !document.has("environment") {
        document.get("environment");
        document
            .missing_as("environment", "[environment]` with `area_m = [[0, 1000], [0, 1000], [-1000, 0]]");
        return None;
    }
    let table = document.table("environment", "[environment]")?;
    if !table.has("area_m") {
        table.missing("area_m");
    }
    let area_m = table.region("area_m").filter(|area| has_volume(&table, area));
    let level = table.choice("level", LEVELS, LevelName::Ideal);
    let sound_speed_m_s = table.number("sound_speed_m_s", Some(1500.0), Rule::Positive);
    let sound_speed_error_m_s = table.number("sound_speed_error_m_s", Some(0.0), Rule::NotNegative);
    let current_m_s = table.vec3("current_m_s", Some([0.0; 3]), Rule::Finite);
    let current_error_m_s = table.vec3("current_error_m_s", Some([0.0; 3]), Rule::NotNegative);
    table.finish();
    Some(Environment {
        area_m: area_m?,
        level: match level? {
            LevelName::Ideal => Level::Ideal,
        },
        sound_speed_m_s: sound_speed_m_s?,
        sound_speed_error_m_s: sound_speed_error_m_s?,
        current_m_s: current_m_s?,
        current_error_m_s: current_error_m_s?,
        current_field: CurrentField::Uniform,
    })
}

fn has_volume(table: &Table<'_>, area: &Region) -> bool {
    let flat = area.iter().any(|[least, greatest]| least >= greatest);
    if flat {
        table.refuse(
            "area_m",
            "`area_m` has no volume",
            "one of the ranges has no width",
            "give each of east, north and up a range such as `[0, 1000]`; for a flat mission make the water deep \
             enough and hold the depth",
        );
    }
    !flat
}

/// Length of a vector.
pub(crate) fn norm(vector: Vec3) -> f64 {
    vector.iter().map(|part| part * part).sum::<f64>().sqrt()
}

/// Whether a point lies in a region.
pub(crate) fn contains(region: &Region, point: Vec3) -> bool {
    region.iter().zip(point).all(|([least, greatest], part)| (*least..=*greatest).contains(&part))
}
