//! Which fields the messages of a topic can have: those that its schema describes.

use std::collections::BTreeSet;
use std::ops::Range;

use serde_json::Value;
use shoal_bus::record::Topic;

/// The names of a topic's fields; without a JSON schema, any.
pub struct Fields {
    known: Option<BTreeSet<String>>,
}

impl Fields {
    /// Those of `topic`.
    pub fn of(topic: Topic) -> Self {
        let schema = serde_json::from_str::<Value>(topic.schema_text());
        Self {
            known: schema.ok().map(|schema| {
                let mut known: BTreeSet<String> = ["t_s", "t_ns"].map(str::to_owned).into();
                properties(&schema, &mut known);
                known
            }),
        }
    }

    /// Whether a message can have something at `path`; if not, which part of it is unknown, and a fix.
    pub fn check(&self, path: &str) -> Result<(), (Range<usize>, String)> {
        let Some(known) = &self.known else { return Ok(()) };
        let mut at = 0;
        for step in path.split('.') {
            if step.parse::<usize>().is_err() && !known.contains(step) {
                let fix = match similar(step, known.iter().map(String::as_str)) {
                    Some(similar) => format!("did you mean `{similar}`?"),
                    None => format!(
                        "fields are {}",
                        known.iter().map(String::as_str).collect::<Vec<_>>().join(", ")
                    ),
                };
                return Err((at..at + step.len(), fix));
            }
            at += step.len() + 1;
        }
        Ok(())
    }
}

/// The names of all properties anywhere in a schema.
fn properties(schema: &Value, known: &mut BTreeSet<String>) {
    match schema {
        Value::Object(fields) => {
            if let Some(Value::Object(properties)) = fields.get("properties") {
                known.extend(properties.keys().cloned());
            }
            fields.values().for_each(|value| properties_in(value, known));
        }
        other => properties_in(other, known),
    }
}

fn properties_in(value: &Value, known: &mut BTreeSet<String>) {
    match value {
        Value::Object(_) => properties(value, known),
        Value::Array(elements) => elements.iter().for_each(|element| properties_in(element, known)),
        _ => {}
    }
}

/// The known name nearest to what was written, when it is near enough to be meant.
pub fn similar<'k>(written: &str, known: impl Iterator<Item = &'k str>) -> Option<&'k str> {
    // A long text is no slip of the finger, and comparing it would take time.
    if written.len() > 64 {
        return None;
    }
    let likeness = |name: &'k str| {
        // A name without its unit is meant.
        let prefix = name.strip_prefix(written).is_some_and(|rest| rest.starts_with('_'));
        (if prefix { 1.0 } else { strsim::jaro_winkler(written, name) }, name)
    };
    known
        .map(likeness)
        .filter(|(likeness, _)| *likeness > 0.8)
        .max_by(|(a, _), (b, _)| a.total_cmp(b))
        .map(|(_, name)| name)
}
