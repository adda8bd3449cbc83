//! Whether a message satisfies an expression.

use serde_json::Value;

use super::{Comparison, Expression, Literal};

impl Expression {
    pub(super) fn matches(&self, message: &Value) -> bool {
        match self {
            Self::Or(one, other) => one.matches(message) || other.matches(message),
            Self::And(one, other) => one.matches(message) && other.matches(message),
            Self::Not(inner) => !inner.matches(message),
            Self::Has(path) => {
                any(message, &path.name, &mut |value| !matches!(value, Value::Null | Value::Bool(false)))
            }
            Self::In(path, literals) => {
                any(message, &path.name, &mut |value| literals.iter().any(|literal| literal.is(value)))
            }
            Self::Compare(path, Comparison::NotEqual, literal) => {
                any(message, &path.name, &mut |_| true)
                    && !any(message, &path.name, &mut |value| literal.is(value))
            }
            Self::Compare(path, comparison, literal) => {
                any(message, &path.name, &mut |value| literal.compares(value, *comparison))
            }
        }
    }
}

impl Literal {
    fn is(&self, value: &Value) -> bool {
        match (self, value) {
            (Self::Number(number), Value::Number(found)) => found.as_f64() == Some(*number),
            (Self::Text(text), Value::String(found)) => text == found,
            (Self::Bool(truth), Value::Bool(found)) => truth == found,
            (Self::Null, Value::Null) => true,
            _ => false,
        }
    }

    fn compares(&self, value: &Value, comparison: Comparison) -> bool {
        if comparison == Comparison::Equal {
            return self.is(value);
        }
        match (self, value) {
            (Self::Text(part), Value::String(found)) => {
                comparison == Comparison::Contains && found.contains(part.as_str())
            }
            (Self::Number(number), Value::Number(found)) => {
                let Some(found) = found.as_f64() else { return false };
                match comparison {
                    Comparison::Less => found < *number,
                    Comparison::LessOrEqual => found <= *number,
                    Comparison::Greater => found > *number,
                    Comparison::GreaterOrEqual => found >= *number,
                    _ => false,
                }
            }
            _ => false,
        }
    }
}

/// The first value at `path` in `message`; whole lists and objects as well.
pub fn find(message: &Value, path: &str) -> Option<Value> {
    let pointer: Option<&Value> = path.split('.').try_fold(message, |value, step| match value {
        Value::Array(elements) => elements.get(step.parse::<usize>().ok()?),
        _ => value.get(step),
    });
    pointer.cloned().or_else(|| seconds(message, path))
}

/// `t_s` of a message that has `t_ns`.
fn seconds(message: &Value, path: &str) -> Option<Value> {
    if path != "t_s" {
        return None;
    }
    Some(Value::from(message.get("t_ns")?.as_i64()? as f64 / 1e9))
}

/// Whether `is_so` for any value at `path`: of lists, for any element.
fn any(message: &Value, path: &str, is_so: &mut dyn FnMut(&Value) -> bool) -> bool {
    if let Some(seconds) = seconds(message, path) {
        return is_so(&seconds);
    }
    any_of(message, Some(path), is_so)
}

fn any_of(value: &Value, path: Option<&str>, is_so: &mut dyn FnMut(&Value) -> bool) -> bool {
    let Some(steps) = path else {
        return match value {
            Value::Array(elements) => elements.iter().any(|element| any_of(element, None, is_so)),
            Value::Object(_) => is_so(value),
            scalar => is_so(scalar),
        };
    };
    let (step, rest) = steps.split_once('.').map_or((steps, None), |(step, rest)| (step, Some(rest)));
    match value {
        Value::Array(elements) => match step.parse::<usize>() {
            Ok(index) => elements.get(index).is_some_and(|element| any_of(element, rest, is_so)),
            Err(_) => elements.iter().any(|element| any_of(element, path, is_so)),
        },
        Value::Object(fields) => fields.get(step).is_some_and(|field| any_of(field, rest, is_so)),
        _ => false,
    }
}
