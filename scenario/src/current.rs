//! The key `current_field` of `[environment]`: how the current differs from place to place.

use toml::de::DeValue;

use crate::environment::norm;
use crate::model::{CurrentField, Environment, Vec3};
use crate::number::Rule;
use crate::reader::Table;

const FIELDS: [&str; 3] = ["uniform", "shear", "vortex"];

pub(crate) fn current_field(environment: &Table<'_>) -> Option<CurrentField> {
    const KEY: &str = "current_field";
    if !environment.has(KEY) {
        environment.get(KEY);
        return Some(CurrentField::Uniform);
    }
    let (name, table) = environment.name_or_table(KEY, "[environment.current_field]")?;
    if !FIELDS.contains(&name) {
        let span = table.as_ref().map_or(environment.span(KEY), |table| table.span("name"));
        environment.unknown_name(span, KEY, name, FIELDS.into_iter());
        return None;
    }
    let Some(table) = table else {
        if name == "uniform" {
            return Some(CurrentField::Uniform);
        }
        environment.refuse(
            KEY,
            format!("the current field `{name}` needs more than its name"),
            "needs a table",
            match name {
                "vortex" => {
                    "write `current_field = { name = \"vortex\", centre_m = [500, 500], core_radius_m = 100, \
                     speed_m_s = 0.3 }`"
                }
                _ => {
                    "write `current_field = { name = \"shear\", surface_m_s = [0.4, 0, 0], deep_m_s = [0, 0, 0], \
                     depth_m = 50 }`"
                }
            },
        );
        return None;
    };
    let field = match name {
        "shear" => shear(&table),
        "vortex" => vortex(&table),
        _ => Some(CurrentField::Uniform),
    };
    table.finish();
    field
}

fn shear(table: &Table<'_>) -> Option<CurrentField> {
    let surface_m_s = table.vec3("surface_m_s", None, Rule::Finite);
    let deep_m_s = table.vec3("deep_m_s", None, Rule::Finite);
    let depth_m = table.number("depth_m", None, Rule::Positive);
    Some(CurrentField::Shear { surface_m_s: surface_m_s?, deep_m_s: deep_m_s?, depth_m: depth_m? })
}

fn vortex(table: &Table<'_>) -> Option<CurrentField> {
    let centre_m = horizontal_point(table, "centre_m");
    let core_radius_m = table.number("core_radius_m", None, Rule::Positive);
    let speed_m_s = table.number("speed_m_s", None, Rule::Finite);
    Some(CurrentField::Vortex { centre_m: centre_m?, core_radius_m: core_radius_m?, speed_m_s: speed_m_s? })
}

/// East and north under `key`.
fn horizontal_point(table: &Table<'_>, key: &'static str) -> Option<[f64; 2]> {
    let Some(value) = table.get(key) else {
        table.missing(key);
        return None;
    };
    let parts = match value.get_ref() {
        DeValue::Array(parts) if parts.len() == 2 => parts,
        _ => {
            table.refuse(
                key,
                format!("`{key}` must be two numbers: the axis is vertical"),
                "expected two numbers: east, north",
                format!("write for example `{}`", table.example(key)),
            );
            return None;
        }
    };
    let read: Vec<_> = parts.iter().map(|part| table.number_in(key, part, Rule::Finite)).collect();
    match read.as_slice() {
        [Some(east), Some(north)] => Some([*east, *north]),
        _ => None,
    }
}

/// No true current in this environment is faster anywhere, in m/s.
pub(crate) fn fastest_current_m_s(environment: &Environment) -> f64 {
    let uniform = environment.current_m_s;
    let with = |added: Vec3| norm(std::array::from_fn(|axis| uniform[axis] + added[axis]));
    match environment.current_field {
        CurrentField::Uniform => norm(uniform),
        // Linear in between, so that one of the ends is the fastest.
        CurrentField::Shear { surface_m_s, deep_m_s, .. } => with(surface_m_s).max(with(deep_m_s)),
        CurrentField::Vortex { speed_m_s, .. } => norm(uniform) + speed_m_s.abs(),
    }
}
