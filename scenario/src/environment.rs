//! The table `[environment]`: the water and the sound in it.

use crate::current::current_field;
use crate::model::{Environment, Level, Region, Vec3};
use crate::number::Rule;
use crate::reader::Table;
use crate::sea::{no_sea, sea, sound_of_a_sea};

const LEVELS: &[(&str, LevelName)] = &[("ideal", LevelName::Ideal), ("sea", LevelName::Sea)];

#[derive(Clone, Copy)]
enum LevelName {
    Ideal,
    Sea,
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
    let mut sound_speed_m_s = table.number("sound_speed_m_s", Some(1500.0), Rule::Positive);
    let level = match table.choice("level", LEVELS, LevelName::Ideal) {
        Some(LevelName::Ideal) => {
            no_sea(&table);
            Some(Level::Ideal)
        }
        Some(LevelName::Sea) => {
            sound_speed_m_s = sound_speed_m_s.and_then(|speed| sound_of_a_sea(&table, speed));
            sea(&table, area_m.as_ref()).map(Level::Sea)
        }
        // What the table says then means, nobody knows.
        None => {
            table.get("sea");
            None
        }
    };
    let sound_speed_error_m_s = table.number("sound_speed_error_m_s", Some(0.0), Rule::NotNegative);
    let current_m_s = table.vec3("current_m_s", Some([0.0; 3]), Rule::Finite);
    let current_error_m_s = table.vec3("current_error_m_s", Some([0.0; 3]), Rule::NotNegative);
    let current_field = current_field(&table);
    table.finish();
    Some(Environment {
        area_m: area_m?,
        level: level?,
        sound_speed_m_s: sound_speed_m_s?,
        sound_speed_error_m_s: sound_speed_error_m_s?,
        current_m_s: current_m_s?,
        current_error_m_s: current_error_m_s?,
        current_field: current_field?,
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
