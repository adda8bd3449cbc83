//! `[environment]` and what is in it.

use serde_json::{Value, json};

use super::forms::{
    any_of, choice, name_or_table, names, not_negative, number, positive, range, table, vec3, whole, within,
};
use crate::presets::BOTTOMS;
use crate::sea::{ABSORPTIONS, BOUNCES_MAX, DEPTH_MAX_M, FADING_KINDS, FADING_PERS};
use crate::sound_speed::{DEPTHS_MAX, FORMULAS, PROFILES, SOUND_SPEED_MAX_M_S, SOUND_SPEED_MIN_M_S};

const ENVIRONMENT: &str = "[environment]";
const SEA: &str = "[environment.sea]";

pub(super) fn environment() -> Value {
    let mut environment = table(
        ENVIRONMENT,
        "",
        &["area_m"],
        vec![
            ("area_m", vec3(range(number()))),
            ("level", choice(&["ideal", "sea"])),
            ("sound_speed_m_s", positive()),
            ("sound_speed_error_m_s", not_negative()),
            ("current_m_s", vec3(number())),
            ("current_error_m_s", vec3(not_negative())),
            ("current_field", current_field()),
            ("sea", sea()),
        ],
    );
    let at_sea = json!({ "properties": { "level": { "const": "sea" } }, "required": ["level"] });
    environment["if"] = json!({ "not": at_sea });
    environment["then"] = json!({ "properties": { "sea": false } });
    environment
}

fn current_field() -> Value {
    let of = |required: &[&str], keys| table(ENVIRONMENT, "current_field.", required, keys);
    let shear = of(
        &["surface_m_s", "deep_m_s", "depth_m"],
        vec![("surface_m_s", vec3(number())), ("deep_m_s", vec3(number())), ("depth_m", positive())],
    );
    let vortex = of(
        &["centre_m", "core_radius_m", "speed_m_s"],
        vec![("centre_m", range(number())), ("core_radius_m", positive()), ("speed_m_s", number())],
    );
    name_or_table(&["uniform"], vec![("uniform", of(&[], vec![])), ("shear", shear), ("vortex", vortex)])
}

fn sea() -> Value {
    let bottom = table(
        SEA,
        "bottom.",
        &["density_kg_m3", "sound_speed_m_s", "attenuation_db_wavelength"],
        vec![
            ("density_kg_m3", within(1000.0, 5000.0)),
            ("sound_speed_m_s", within(1000.0, 8000.0)),
            ("attenuation_db_wavelength", within(0.0, 10.0)),
        ],
    );
    let fading = table(
        SEA,
        "fading.",
        &["kind"],
        vec![
            ("kind", choice(&names(FADING_KINDS))),
            ("k_db", within(-40.0, 40.0)),
            ("per", choice(&names(FADING_PERS))),
        ],
    );
    table(
        SEA,
        "",
        &[],
        vec![
            ("bottom_depth_m", positive()),
            ("sound_speed", sound_speed()),
            ("temperature_c", within(-3.0, 45.0)),
            ("salinity_psu", within(0.0, 45.0)),
            ("ph", within(6.5, 9.0)),
            ("absorption", choice(&names(ABSORPTIONS))),
            ("spreading_exponent", within(1.0, 2.0)),
            ("shipping", within(0.0, 1.0)),
            ("wind_m_s", within(0.0, 100.0)),
            ("surface_loss_db", within(0.0, 100.0)),
            ("bottom", any_of(vec![choice(&names(BOTTOMS)), bottom])),
            ("bounces_max", whole(0, BOUNCES_MAX)),
            ("fading", any_of(vec![choice(&names(FADING_KINDS)), fading])),
        ],
    )
}

fn sound_speed() -> Value {
    let column = |of: Value| json!({ "type": "array", "items": of, "minItems": 2, "maxItems": DEPTHS_MAX });
    let mut profile = table(
        SEA,
        "sound_speed.",
        &["depths_m"],
        vec![
            ("depths_m", column(within(0.0, DEPTH_MAX_M))),
            ("speeds_m_s", column(within(SOUND_SPEED_MIN_M_S, SOUND_SPEED_MAX_M_S))),
            ("temperatures_c", column(within(-3.0, 45.0))),
            ("salinities_psu", column(within(0.0, 45.0))),
            ("formula", choice(&names(FORMULAS))),
        ],
    );
    profile["oneOf"] = json!([
        {
            "required": ["speeds_m_s"],
            "properties": { "temperatures_c": false, "salinities_psu": false, "formula": false },
        },
        { "required": ["temperatures_c", "salinities_psu"], "properties": { "speeds_m_s": false } },
    ]);
    any_of(vec![choice(&names(PROFILES)), profile])
}
