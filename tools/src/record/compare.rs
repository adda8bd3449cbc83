//! Two events of the same kind, field by field.

use serde_json::Value;

/// A field in which two events differ.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// Which: names with dots, indexes in brackets, such as `position_m[0][1]`.
    pub field: String,
    /// What one says; `null` when it says nothing.
    pub a: Value,
    /// What the other says.
    pub b: Value,
}

/// The fields in which two events differ, in the order of the first; at most so many.
pub fn differences(a: &Value, b: &Value, most: usize) -> Vec<Difference> {
    let mut found = Vec::new();
    walk(String::new(), a, b, most, &mut found);
    found
}

fn walk(field: String, a: &Value, b: &Value, most: usize, found: &mut Vec<Difference>) {
    if found.len() >= most || a == b {
        return;
    }
    match (a, b) {
        (Value::Object(one), Value::Object(other)) => {
            let more = other.keys().filter(|key| !one.contains_key(*key));
            for key in one.keys().chain(more) {
                let below = if field.is_empty() { key.clone() } else { format!("{field}.{key}") };
                walk(below, &a[key], &b[key], most, found);
            }
        }
        (Value::Array(one), Value::Array(other)) => {
            for index in 0..one.len().max(other.len()) {
                let side = |of: &[Value]| of.get(index).cloned().unwrap_or_default();
                walk(format!("{field}[{index}]"), &side(one), &side(other), most, found);
            }
        }
        _ => found.push(Difference { field, a: a.clone(), b: b.clone() }),
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn fields_are_named_where_they_stand() {
        let a = json!({"t_ns": 5, "position_m": [[1.0, 2.0], [3.0, null]], "booked": [{"at": 1}]});
        let b = json!({"t_ns": 5, "position_m": [[1.0, 2.5], [3.0, null]], "emptied": "ping"});
        let found: Vec<String> = differences(&a, &b, 9)
            .into_iter()
            .map(|one| format!("{} {} {}", one.field, one.a, one.b))
            .collect();
        assert_eq!(
            found,
            ["position_m[0][1] 2.0 2.5", r#"booked [{"at":1}] null"#, r#"emptied null "ping""#]
        );
        assert_eq!(differences(&a, &b, 1).len(), 1);
        assert_eq!(differences(&a, &a, 9), []);
    }
}
