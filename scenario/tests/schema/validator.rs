//! As much of JSON Schema as that of scenarios uses; anything else in a schema is a panic.

use std::collections::BTreeSet;

use serde_json::Value;

/// What is valid, and which properties valid documents have shown.
pub struct Validator {
    schema: Value,
    seen: BTreeSet<String>,
}

impl Validator {
    /// Of this schema.
    pub fn new(schema: Value) -> Self {
        Self { schema, seen: BTreeSet::new() }
    }

    /// Whether a document is valid; the properties of those that are count as seen.
    pub fn accepts(&mut self, document: &Value) -> bool {
        let mut seen = BTreeSet::new();
        let is_valid = self.holds(&self.schema, "", document, &mut seen);
        if is_valid {
            self.seen.append(&mut seen);
        }
        is_valid
    }

    /// The places of properties that no valid document has shown.
    pub fn unseen(&self) -> Vec<String> {
        let mut all = BTreeSet::new();
        places(&self.schema, "", &mut all);
        all.difference(&self.seen).cloned().collect()
    }

    fn holds(&self, schema: &Value, place: &str, value: &Value, seen: &mut BTreeSet<String>) -> bool {
        let Value::Object(words) = schema else {
            return schema.as_bool().expect("a schema is a table or a truth value");
        };
        let mut tried = |schema: &Value, word: &str| {
            let mut shown = BTreeSet::new();
            let is_valid = self.holds(schema, &format!("{place}/{word}"), value, &mut shown);
            if is_valid {
                seen.append(&mut shown);
            }
            is_valid
        };
        let listed = |schemas: &Value| schemas.as_array().unwrap().clone();
        words.iter().all(|(word, wanted)| match word.as_str() {
            "$schema" | "$id" | "$defs" | "title" | "description" | "examples" => true,
            "properties" | "additionalProperties" | "items" | "then" => true,
            "type" => is_of(wanted.as_str().unwrap(), value),
            "enum" => wanted.as_array().unwrap().contains(value),
            "const" => wanted == value,
            "$ref" => {
                let name = wanted.as_str().unwrap().strip_prefix('#').unwrap();
                tried(self.schema.pointer(name).unwrap(), &format!("->{name}"))
            }
            "not" => !tried(wanted, "not"),
            "anyOf" => {
                let forms = listed(wanted);
                let held =
                    (0..forms.len()).filter(|index| tried(&forms[*index], &format!("anyOf/{index}"))).count();
                held > 0
            }
            "oneOf" => {
                let forms = listed(wanted);
                (0..forms.len()).filter(|index| tried(&forms[*index], &format!("oneOf/{index}"))).count() == 1
            }
            "if" => !tried(wanted, "if") || tried(&words["then"], "then"),
            "required" => value.as_object().is_none_or(|fields| {
                listed(wanted).iter().all(|key| fields.contains_key(key.as_str().unwrap()))
            }),
            "propertyNames" => value.as_object().is_none_or(|fields| {
                fields.keys().all(|key| self.holds(wanted, "", &key.as_str().into(), &mut BTreeSet::new()))
            }),
            "minimum" => number(value).is_none_or(|value| value >= number(wanted).unwrap()),
            "maximum" => number(value).is_none_or(|value| value <= number(wanted).unwrap()),
            "exclusiveMinimum" => number(value).is_none_or(|value| value > number(wanted).unwrap()),
            "exclusiveMaximum" => number(value).is_none_or(|value| value < number(wanted).unwrap()),
            "minItems" => value.as_array().is_none_or(|items| items.len() as u64 >= wanted.as_u64().unwrap()),
            "maxItems" => value.as_array().is_none_or(|items| items.len() as u64 <= wanted.as_u64().unwrap()),
            "maxProperties" => {
                value.as_object().is_none_or(|fields| fields.len() as u64 <= wanted.as_u64().unwrap())
            }
            "pattern" => {
                assert_eq!(wanted, "^[A-Za-z0-9_-]{1,64}$");
                value.as_str().is_none_or(|text| {
                    (1..=64).contains(&text.len())
                        && text.bytes().all(|byte| byte.is_ascii_alphanumeric() || b"-_".contains(&byte))
                })
            }
            other => panic!("`{other}` is new here"),
        }) && self.children_hold(words, place, value, seen)
    }

    fn children_hold(
        &self,
        words: &serde_json::Map<String, Value>,
        place: &str,
        value: &Value,
        seen: &mut BTreeSet<String>,
    ) -> bool {
        match value {
            Value::Array(items) => words.get("items").is_none_or(|form| {
                items.iter().all(|item| self.holds(form, &format!("{place}/items"), item, seen))
            }),
            Value::Object(fields) => fields.iter().all(|(key, field)| {
                match words.get("properties").and_then(|forms| forms.get(key)) {
                    Some(form) => {
                        let place = format!("{place}/properties/{key}");
                        seen.insert(place.clone());
                        self.holds(form, &place, field, seen)
                    }
                    None => words.get("additionalProperties").is_none_or(|form| {
                        self.holds(form, &format!("{place}/additionalProperties"), field, seen)
                    }),
                }
            }),
            _ => true,
        }
    }
}

fn number(value: &Value) -> Option<f64> {
    value.as_f64()
}

fn is_of(wanted: &str, value: &Value) -> bool {
    match wanted {
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "number" => value.is_number(),
        // A whole number with a point is one to JSON, and none to TOML.
        "integer" => value.is_i64() || value.is_u64(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        other => panic!("the type `{other}` is new here"),
    }
}

/// Every property of a table that has no others.
fn places(schema: &Value, place: &str, all: &mut BTreeSet<String>) {
    let Value::Object(words) = schema else { return };
    for (word, below) in words {
        match (word.as_str(), below) {
            ("properties", Value::Object(forms)) if words.contains_key("additionalProperties") => {
                for (key, form) in forms {
                    let place = format!("{place}/properties/{key}");
                    places(form, &place, all);
                    all.insert(place);
                }
            }
            ("anyOf", Value::Array(forms)) => {
                (0..)
                    .zip(forms)
                    .for_each(|(index, form)| places(form, &format!("{place}/anyOf/{index}"), all));
            }
            ("items" | "additionalProperties", form) => places(form, &format!("{place}/{word}"), all),
            _ => {}
        }
    }
}
