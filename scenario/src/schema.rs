//! The JSON Schema of scenario files, for editors.
//!
//! Words are those of `keys.md`, names those of the presets; which keys there are and of which type, the tests compare with the
//! reader. A schema says nothing of how keys fit together (a circle that leaves the area): what the reader accepts is valid, and
//! `shoal check` finds the rest.

mod describe;
mod forms;
mod groups;
mod water;

use serde_json::{Value, json};

use crate::body::Named;
use crate::model::{Clock, Kind, Noise, Sensors};
use crate::{AUVS_MAX, TABLES_MAX};
use forms::{choice, names, table, text, time, vec3, whole};
use groups::{clock, group, kind, sensors};
use water::environment;

/// Where the schema is said to be: a name, not an address.
pub const SCHEMA_ID: &str = "urn:shoal:scenario:1";

/// The JSON Schema (draft 2020-12) of scenario files, as the text of a file.
///
/// Whatever [`parse`](crate::parse) accepts is valid; unknown keys, missing keys, wrong types and unknown names are not.
///
/// ```
/// let schema: serde_json::Value = serde_json::from_str(&shoal_scenario::schema())?;
/// assert_eq!(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
/// assert!(schema["properties"]["duration_s"]["description"].as_str().is_some());
/// # Ok::<(), serde_json::Error>(())
/// ```
pub fn schema() -> String {
    format!("{:#}\n", document())
}

fn document() -> Value {
    let mut schema = table(
        "",
        "",
        &["name", "duration_s", "environment", "group"],
        vec![
            ("name", text_of_a_name()),
            ("summary", text()),
            ("source", text()),
            ("seed", json!({ "type": "integer", "minimum": 0, "maximum": u64::MAX })),
            ("duration_s", time(0.0)),
            ("window_ms", time(0.0)),
            ("knot_ms", json!({ "type": "number", "minimum": 0.1 })),
            ("noise", choice(&names(Noise::NAMES))),
            ("on_crash", choice(&["drift", "abort"])),
            ("environment", environment()),
            ("kind", own::<Kind>("#/$defs/kind")),
            ("clock", own::<Clock>("#/$defs/clock")),
            ("sensors", own::<Sensors>("#/$defs/sensors")),
            (
                "group",
                json!({ "type": "array", "minItems": 1, "maxItems": TABLES_MAX, "items": { "$ref": "#/$defs/group" } }),
            ),
            ("sabotage", sabotage()),
            ("fault", json!({ "type": "array", "maxItems": TABLES_MAX, "items": fault() })),
        ],
    );
    if let Some(head) = schema.as_object_mut() {
        let mut whole = serde_json::Map::new();
        whole.insert("$schema".into(), "https://json-schema.org/draft/2020-12/schema".into());
        whole.insert("$id".into(), SCHEMA_ID.into());
        whole.insert("title".into(), "Scenario of Shoal".into());
        whole.insert(
            "description".into(),
            "What a run of Shoal simulates. Times are decimal, vectors are [east, north, up], the surface is at 0.".into(),
        );
        whole.append(head);
        whole.insert(
            "$defs".into(),
            json!({ "kind": kind(), "clock": clock(), "sensors": sensors(), "group": group() }),
        );
        *head = whole;
    }
    schema
}

/// A name that can be part of file names.
fn text_of_a_name() -> Value {
    json!({ "type": "string", "pattern": "^[A-Za-z0-9_-]{1,64}$" })
}

/// Tables of the user's own, by names that no preset has.
fn own<T: Named>(definition: &str) -> Value {
    json!({
        "type": "object",
        "maxProperties": TABLES_MAX,
        "propertyNames": { "not": { "enum": names(T::PRESETS) } },
        "additionalProperties": { "$ref": definition },
    })
}

fn sabotage() -> Value {
    let whom = table(
        "[sabotage]",
        "shifted_truth.",
        &["auv", "at_s"],
        vec![("auv", whole(0, AUVS_MAX.into())), ("at_s", json!({ "type": "number", "minimum": 0 }))],
    );
    table("[sabotage]", "", &["shifted_truth"], vec![("shifted_truth", whom)])
}

fn fault() -> Value {
    table(
        "[[fault]]",
        "",
        &["kind", "auv", "at_s", "to_m"],
        vec![
            ("kind", choice(&["kidnap"])),
            ("auv", whole(0, AUVS_MAX.into())),
            ("at_s", json!({ "type": "number", "minimum": 0 })),
            ("to_m", vec3(forms::number())),
        ],
    )
}

#[cfg(test)]
mod tests;
