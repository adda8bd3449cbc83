//! Tests that the schema and `keys.md` speak of the same keys; which keys there are, `tests/schema` compares with the reader.

use serde_json::Value;

use super::describe::documented;
use super::*;

/// Calls `visit` with the name and the schema of every property of every table.
fn properties(of: &Value, visit: &mut dyn FnMut(&str, &Value)) {
    match of {
        Value::Object(fields) => {
            let listed =
                fields.get("additionalProperties").and(fields.get("properties")).and_then(Value::as_object);
            for (key, form) in listed.into_iter().flatten() {
                visit(key, form);
            }
            fields.values().for_each(|value| properties(value, visit));
        }
        Value::Array(values) => values.iter().for_each(|value| properties(value, visit)),
        _ => {}
    }
}

#[test]
fn every_key_has_the_words_of_the_documentation() {
    let mut without = Vec::new();
    properties(&document(), &mut |key, form| {
        if form["description"].as_str().is_none_or(str::is_empty) {
            without.push(key.to_owned());
        }
    });
    // Names choose a table, whose key is described; the two of `shifted_truth` are explained there.
    without.retain(|key| {
        !["name", "kind", "auv", "at_s", "density_kg_m3", "sound_speed_m_s"].contains(&key.as_str())
    });
    assert!(without.is_empty(), "{without:?}");
    let schema = document();
    let environment = &schema["properties"]["environment"];
    assert_eq!(environment["description"], "the water");
    assert_eq!(
        environment["properties"]["sound_speed_error_m_s"]["description"],
        "error of the stated speed, the same everywhere (in m/s; default: 0)"
    );
    let modem = &schema["$defs"]["group"]["properties"]["modem"]["anyOf"][1]["properties"];
    assert_eq!(
        modem["range_m"]["description"],
        "others hear it so far; only at level \"ideal\" (in m; default: 500)"
    );
    assert_eq!(schema["properties"]["group"]["description"], "like AUVs; TABLES_MAX groups at most");
}

#[test]
fn every_documented_key_is_in_the_schema() {
    let mut known = std::collections::BTreeSet::new();
    properties(&document(), &mut |key, _| _ = known.insert(key.to_owned()));
    let keys = documented();
    assert!(keys.len() > 140, "{}", keys.len());
    for (section, key) in keys {
        let last = key.rsplit('.').next().unwrap();
        assert!(known.contains(last), "{key} of {section}");
    }
}
