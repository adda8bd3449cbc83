//! `[[group]]`, and what groups name: bodies, clocks, sensors, modems.

use std::f64::consts::{FRAC_PI_2, PI};

use serde_json::{Value, json};

use super::forms::{
    any_of, boolean, choice, name_or_table, names, not_negative, number, or_false, points, positive, range,
    table, text, time, vec3, whole, within,
};
use super::text_of_a_name;
use crate::estimating::{FUSIONS, RECOVERIES, RINGS_MAX};
use crate::modem::MODULATIONS;
use crate::presets::{CLOCKS, DVLS, GNSS, KINDS, MODEMS, SENSORS};
use crate::relative::{MEASURES, REMEMBERED_MAX};
use crate::sensing::{PERIOD_MAX_NS, PERIOD_MIN_NS};
use crate::{AUVS_MAX, FRAME_BYTES_MAX, LISTEN_MAX_NS, PING_BYTES};

const PERIOD_MIN_S: f64 = PERIOD_MIN_NS as f64 * 1e-9;

/// Everything, unless it is like something else.
fn unless_like(mut table: Value, required: &[&str]) -> Value {
    table["anyOf"] = json!([{ "required": ["like"] }, { "required": required }]);
    table
}

/// A name: presets for editors to offer, and any other that the file defines.
fn named(presets: &[&str]) -> Value {
    json!({ "type": "string", "examples": presets })
}

pub(super) fn kind() -> Value {
    let keys = vec![
        ("like", named(&names(KINDS))),
        ("speed_max_m_s", positive()),
        ("acceleration_max_m_s2", positive()),
        ("turn_rate_max_rad_s", positive()),
        ("pitch_max_rad", within(0.0, FRAC_PI_2)),
        ("disturbance_m_s", vec3(not_negative())),
        ("length_m", positive()),
    ];
    unless_like(
        table("[kind.NAME]", "", &[], keys),
        &["speed_max_m_s", "acceleration_max_m_s2", "turn_rate_max_rad_s"],
    )
}

pub(super) fn clock() -> Value {
    let keys = vec![
        ("like", named(&names(CLOCKS))),
        ("drift_bound", json!({ "type": "number", "minimum": 0, "exclusiveMaximum": 1 })),
        ("wander_fraction", within(0.0, 1.0)),
        ("offset_bound_s", not_negative()),
    ];
    unless_like(table("[clock.NAME]", "", &[], keys), &["drift_bound"])
}

pub(super) fn sensors() -> Value {
    const SECTION: &str = "[sensors.NAME]";
    let dvl = table(
        SECTION,
        "dvl.",
        &[],
        vec![("altitude_max_m", positive()), ("velocity_error_m_s", not_negative())],
    );
    let gnss = table(
        SECTION,
        "gnss.",
        &[],
        vec![
            ("depth_max_m", not_negative()),
            ("period_s", time(PERIOD_MIN_S)),
            ("position_error_m", vec3(not_negative())),
            ("time_error_s", not_negative()),
        ],
    );
    table(
        SECTION,
        "",
        &[],
        vec![
            ("like", named(&names(SENSORS))),
            ("heading_error_rad", not_negative()),
            ("pitch_error_rad", not_negative()),
            ("speed_error_m_s", not_negative()),
            ("depth_error_m", or_false(not_negative())),
            ("dvl", or_false(any_of(vec![choice(&names(DVLS)), dvl]))),
            ("gnss", or_false(any_of(vec![choice(&names(GNSS)), gnss]))),
        ],
    )
}

pub(super) fn group() -> Value {
    let named_or =
        |presets: &[&str], definition: &str| any_of(vec![named(presets), json!({ "$ref": definition })]);
    table(
        "[[group]]",
        "",
        &["name", "count"],
        vec![
            ("name", text_of_a_name()),
            ("count", whole(1, AUVS_MAX.into())),
            ("kind", named_or(&names(KINDS), "#/$defs/kind")),
            ("clock", named_or(&names(CLOCKS), "#/$defs/clock")),
            ("sensors", named_or(&names(SENSORS), "#/$defs/sensors")),
            ("modem", any_of(vec![choice(&names(MODEMS)), modem()])),
            ("start", start()),
            ("control_period_s", within(PERIOD_MIN_S, PERIOD_MAX_NS as f64 * 1e-9)),
            ("reaction_s", time(PERIOD_MIN_S)),
            ("estimator", estimator()),
            ("relative", relative()),
            ("controller", controller()),
            ("command", json!({ "type": "array", "items": text(), "minItems": 1 })),
            ("sabotage", choice(&["halved-clock", "lying-ping", "empty-set"])),
        ],
    )
}

fn modem() -> Value {
    const SECTION: &str = "[group.modem]";
    let access = |keys| table(SECTION, "access.", &[], keys);
    let slotted = access(vec![
        ("slot_s", time(PERIOD_MIN_S)),
        ("slots", whole(1, AUVS_MAX.into())),
        ("guard_range_m", not_negative()),
    ]);
    let csma = access(vec![
        (
            "listen_s",
            json!({ "type": "number", "exclusiveMinimum": 0, "maximum": LISTEN_MAX_NS as f64 * 1e-9 }),
        ),
        ("backoff_s", time(0.0)),
    ]);
    let accesses =
        vec![("periodic", access(vec![])), ("aloha", access(vec![])), ("slotted", slotted), ("csma", csma)];
    let duty_cycle = table(
        SECTION,
        "duty_cycle.",
        &["period_s", "awake_s"],
        vec![("period_s", time(PERIOD_MIN_S)), ("awake_s", time(PERIOD_MIN_S))],
    );
    table(
        SECTION,
        "",
        &[],
        vec![
            ("like", choice(&names(MODEMS))),
            ("range_m", positive()),
            ("ping_period_s", or_false(time(PERIOD_MIN_S))),
            ("ping_phase_s", json!({ "type": "number", "minimum": 0 })),
            ("timestamp_error_s", not_negative()),
            ("bearing_error_rad", or_false(within(0.0, PI))),
            ("outlier_rate", within(0.0, 1.0)),
            ("outlier_delay_s", within(0.0, 10.0)),
            ("frame_bytes", whole(PING_BYTES.into(), FRAME_BYTES_MAX.into())),
            ("addresses", whole(1, u32::MAX.into())),
            ("access", name_or_table(&["periodic", "aloha", "slotted", "csma"], accesses)),
            ("duty_cycle", duty_cycle),
            ("source_level_db", within(0.0, 260.0)),
            ("centre_hz", positive()),
            ("bandwidth_hz", positive()),
            ("bit_rate_bit_s", positive()),
            ("preamble_s", not_negative()),
            ("modulation", choice(&names(MODULATIONS))),
            ("coding_gain_db", not_negative()),
            ("detection_threshold_db", number()),
            ("capture_db", not_negative()),
        ],
    )
}

fn start() -> Value {
    const SECTION: &str = "[group.start]";
    let grid = table(
        SECTION,
        "grid.",
        &["first_m", "spacing_m", "columns"],
        vec![
            ("first_m", vec3(number())),
            ("spacing_m", vec3(not_negative())),
            ("columns", whole(1, AUVS_MAX.into())),
            ("rows", whole(1, AUVS_MAX.into())),
            ("layers", whole(1, AUVS_MAX.into())),
            ("scatter_m", not_negative()),
        ],
    );
    table(
        SECTION,
        "",
        &[],
        vec![
            ("region_m", vec3(range(number()))),
            ("points_m", points()),
            ("grid", grid),
            ("place", choice(&["on-circle"])),
            ("box_width_m", any_of(vec![not_negative(), range(not_negative())])),
            ("known", boolean()),
            ("heading_rad", number()),
            ("speed_m_s", not_negative()),
        ],
    )
}

fn estimator() -> Value {
    const SECTION: &str = "[[group]]";
    let outliers = table(
        SECTION,
        "outliers.",
        &["tolerated"],
        vec![
            ("window", whole(1, RINGS_MAX)),
            ("tolerated", whole(0, RINGS_MAX)),
            ("margin", whole(0, RINGS_MAX)),
            ("inlier_probability", within(0.0, 1.0)),
        ],
    );
    let of = |keys| table(SECTION, "estimator.", &[], keys);
    let tube = of(vec![
        ("horizon_s", time(0.0)),
        ("rings", whole(0, RINGS_MAX)),
        ("stopping_ratio", within(0.001, 1.0)),
        ("on_empty", choice(&names(RECOVERIES))),
        ("outliers", or_false(outliers)),
    ]);
    let ekf = of(vec![("gate_sigma", or_false(positive())), ("fusion", choice(&names(FUSIONS)))]);
    name_or_table(
        &["tube", "ekf", "dead-reckoning"],
        vec![("tube", tube), ("ekf", ekf), ("dead-reckoning", of(vec![]))],
    )
}

fn relative() -> Value {
    or_false(table(
        "[[group]]",
        "relative.",
        &[],
        vec![
            ("measures", choice(&names(MEASURES))),
            ("exchanged", boolean()),
            ("remembered", whole(1, REMEMBERED_MAX)),
        ],
    ))
}

fn controller() -> Value {
    let of = |section: &str, required: &[&str], keys| {
        table(&format!("**`controller`** `\"{section}\"`"), "", required, keys)
    };
    let circle = of(
        "circle",
        &["centre_m", "radius_m", "rate_rad_s"],
        vec![
            ("centre_m", vec3(number())),
            ("radius_m", positive()),
            ("rate_rad_s", number()),
            ("phase_rad", number()),
            ("heave_m", not_negative()),
            ("heave_phase_rad", number()),
        ],
    );
    let waypoints = of(
        "waypoints",
        &["points_m"],
        vec![
            ("points_m", points()),
            ("speed_m_s", positive()),
            ("reach_m", positive()),
            ("repeat", boolean()),
        ],
    );
    let reynolds = of(
        "reynolds",
        &[],
        vec![
            ("speed_m_s", positive()),
            ("separation", not_negative()),
            ("cohesion", not_negative()),
            ("alignment", not_negative()),
            ("margin_m", not_negative()),
            ("forget_s", time(0.0)),
            ("trusts", json!({ "type": "array", "items": text() })),
        ],
    );
    name_or_table(
        &["hold", "station", "reynolds"],
        vec![
            ("hold", of("hold", &[], vec![])),
            ("station", of("station", &[], vec![("speed_m_s", positive())])),
            ("circle", circle),
            ("waypoints", waypoints),
            ("reynolds", reynolds),
        ],
    )
}
