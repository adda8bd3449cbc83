//! The types that a key can have.

use serde_json::{Map, Value, json};

use super::describe::describe;
use crate::number::MAGNITUDE_MAX;

/// A table with these keys and no others; `section` and `prefix` say where `keys.md` speaks of them.
pub(super) fn table(section: &str, prefix: &str, required: &[&str], keys: Vec<(&str, Value)>) -> Value {
    let described = keys.into_iter().map(|(key, form)| {
        let words = describe(section, &format!("{prefix}{key}"));
        (key.to_owned(), with_words(form, words))
    });
    let properties: Map<String, Value> = described.collect();
    let mut table = json!({ "type": "object", "additionalProperties": false, "properties": properties });
    if !required.is_empty() {
        table["required"] = json!(required);
    }
    table
}

fn with_words(form: Value, words: Option<String>) -> Value {
    let (Value::Object(form), Some(words)) = (form.clone(), words) else { return form };
    let mut described = Map::new();
    described.insert("description".to_owned(), words.into());
    described.extend(form);
    Value::Object(described)
}

/// Any text.
pub(super) fn text() -> Value {
    json!({ "type": "string" })
}

/// `true` or `false`.
pub(super) fn boolean() -> Value {
    json!({ "type": "boolean" })
}

/// Any number that the reader takes.
pub(super) fn number() -> Value {
    within(-MAGNITUDE_MAX, MAGNITUDE_MAX)
}

/// A number more than zero.
pub(super) fn positive() -> Value {
    json!({ "type": "number", "exclusiveMinimum": 0, "maximum": MAGNITUDE_MAX })
}

/// A number of zero or more.
pub(super) fn not_negative() -> Value {
    within(0.0, MAGNITUDE_MAX)
}

/// A number between two others.
pub(super) fn within(least: f64, greatest: f64) -> Value {
    json!({ "type": "number", "minimum": least, "maximum": greatest })
}

/// A whole number between two others.
pub(super) fn whole(least: u64, greatest: u64) -> Value {
    json!({ "type": "integer", "minimum": least, "maximum": greatest })
}

/// A time of so much or more, in the unit of the key; more than nothing for zero.
pub(super) fn time(least: f64) -> Value {
    match least {
        0.0 => json!({ "type": "number", "exclusiveMinimum": 0 }),
        _ => json!({ "type": "number", "minimum": least }),
    }
}

/// One of a few names.
pub(super) fn choice(names: &[&str]) -> Value {
    json!({ "enum": names })
}

/// The names of a list.
pub(super) fn names<T>(of: &'static [(&'static str, T)]) -> Vec<&'static str> {
    of.iter().map(|(name, _)| *name).collect()
}

/// Three values: east, north, up.
pub(super) fn vec3(of: Value) -> Value {
    json!({ "type": "array", "items": of, "minItems": 3, "maxItems": 3 })
}

/// Least and greatest.
pub(super) fn range(of: Value) -> Value {
    json!({ "type": "array", "items": of, "minItems": 2, "maxItems": 2 })
}

/// One point or more.
pub(super) fn points() -> Value {
    json!({ "type": "array", "items": vec3(number()), "minItems": 1 })
}

/// Any of these.
pub(super) fn any_of(forms: Vec<Value>) -> Value {
    json!({ "anyOf": forms })
}

/// What can be left out by saying so.
pub(super) fn or_false(form: Value) -> Value {
    any_of(vec![json!({ "const": false }), form])
}

/// A name that stands for itself, or a table with a name: those of `alone` need no more.
pub(super) fn name_or_table(alone: &[&str], tables: Vec<(&str, Value)>) -> Value {
    let named = tables.into_iter().map(|(name, mut table)| {
        let mut properties = Map::new();
        properties.insert("name".to_owned(), json!({ "const": name }));
        if let Some(others) = table["properties"].as_object_mut() {
            properties.append(others);
        }
        table["properties"] = Value::Object(properties);
        let required: Vec<Value> = table["required"].as_array().cloned().unwrap_or_default();
        table["required"] = [Value::from("name")].into_iter().chain(required).collect();
        table
    });
    let mut forms = vec![choice(alone)];
    forms.extend(named);
    any_of(forms)
}
