//! The schema of scenario files and the reader agree: what is read is valid, and what has an unknown key, no needed one or a wrong
//! type is neither.

mod documents;
#[path = "../unknown_keys/mod.rs"]
mod unknown_keys;
mod validator;

use std::collections::BTreeSet;

use serde_json::{Map, Value, json};
use shoal_scenario::{library, parse};
use validator::Validator;

fn schema() -> Value {
    serde_json::from_str(&shoal_scenario::schema()).unwrap()
}

fn json_of(text: &str) -> Value {
    let table: toml::Table = text.parse().unwrap();
    serde_json::to_value(table).unwrap()
}

/// A document with its values in line.
fn toml_of(document: &Value) -> String {
    let fields = document.as_object().unwrap();
    fields.iter().map(|(key, value)| format!("{} = {}\n", in_line(&json!(key)), in_line(value))).collect()
}

fn in_line(value: &Value) -> String {
    let listed = |parts: Vec<String>| parts.join(", ");
    match value {
        Value::Array(items) => format!("[{}]", listed(items.iter().map(in_line).collect())),
        Value::Object(fields) => {
            let field =
                |(key, value): (&String, &Value)| format!("{} = {}", in_line(&json!(key)), in_line(value));
            format!("{{ {} }}", listed(fields.iter().map(field).collect()))
        }
        // Numbers, texts in quotes and truth values are written alike in both.
        other => other.to_string(),
    }
}

/// All that is known to be good: the library, and scenarios that have every key.
fn good() -> impl Iterator<Item = &'static str> {
    library().iter().map(|entry| entry.text).chain(documents::ALL.iter().copied())
}

#[test]
fn what_is_read_is_valid_and_every_key_of_the_schema_is_one_of_the_reader() {
    let mut validator = Validator::new(schema());
    for text in good() {
        parse("good.toml", text).unwrap_or_else(|errors| panic!("{errors}"));
        assert!(validator.accepts(&json_of(text)), "{text}");
    }
    // What is behind a reference is found under the place that refers to it.
    assert_eq!(validator.unseen(), [""; 0]);
}

#[test]
fn every_table_has_the_keys_of_the_reader() {
    let mut of_schema = BTreeSet::new();
    tables(&schema(), &mut of_schema);
    let mut of_reader = BTreeSet::new();
    for text in [
        unknown_keys::UNKNOWN_EVERYWHERE,
        unknown_keys::UNKNOWN_IN_THE_SEA,
        unknown_keys::UNKNOWN_IN_OTHER_FORMS,
        documents::UNKNOWN_IN_NAMED_TABLES,
    ] {
        for error in parse("unknown.toml", text).unwrap_err().errors {
            let (_, keys) = error.fix.split_once(" has the keys ").unwrap_or_else(|| panic!("{error:?}"));
            of_reader.insert(keys.split(", ").map(str::to_owned).collect::<BTreeSet<_>>());
        }
    }
    let only = |a: &BTreeSet<BTreeSet<String>>, b: &BTreeSet<BTreeSet<String>>| -> Vec<BTreeSet<String>> {
        a.difference(b).cloned().collect()
    };
    assert_eq!(only(&of_reader, &of_schema), [], "tables of the reader alone");
    assert_eq!(only(&of_schema, &of_reader), [], "tables of the schema alone");
}

/// The keys of every table that has no others.
fn tables(schema: &Value, found: &mut BTreeSet<BTreeSet<String>>) {
    match schema {
        Value::Object(words) => {
            if words.get("additionalProperties") == Some(&Value::Bool(false)) {
                found.insert(words["properties"].as_object().unwrap().keys().cloned().collect());
            }
            words.values().for_each(|below| tables(below, found));
        }
        Value::Array(forms) => forms.iter().for_each(|form| tables(form, found)),
        _ => {}
    }
}

/// What stands at each place instead, one at a time.
fn mutants(document: &Value) -> Vec<Value> {
    let replacements = [
        json!(true),
        json!(false),
        json!("zz"),
        json!(-7),
        json!(0),
        json!(3),
        json!(0.5),
        json!([]),
        json!([1.0]),
        json!({}),
        json!({ "zz": 1 }),
    ];
    let mut mutants = Vec::new();
    let mut places = Vec::new();
    pointers(document, "", &mut places);
    for place in places {
        for replacement in &replacements {
            let mut mutant = document.clone();
            *mutant.pointer_mut(&place).unwrap() = replacement.clone();
            mutants.push(mutant);
        }
        let mut with_more = document.clone();
        if let Some(Value::Object(fields)) = with_more.pointer_mut(&place) {
            fields.insert("zz".to_owned(), json!(1));
            mutants.push(with_more);
        }
        let (parent, key) = place.rsplit_once('/').unwrap();
        let mut without = document.clone();
        if let Some(Value::Object(fields)) = without.pointer_mut(parent) {
            fields.remove(key);
            mutants.push(without);
        }
    }
    mutants
}

fn pointers(document: &Value, place: &str, found: &mut Vec<String>) {
    match document {
        Value::Object(fields) => {
            for (key, value) in fields {
                let place = format!("{place}/{key}");
                pointers(value, &place, found);
                found.push(place);
            }
        }
        Value::Array(items) => {
            // The others are like the first two.
            for (index, value) in items.iter().enumerate().take(2) {
                let place = format!("{place}/{index}");
                pointers(value, &place, found);
                found.push(place);
            }
        }
        _ => {}
    }
}

/// A slip that a schema can see: an unknown key or name, a missing key, a wrong type. It does not see which bodies, clocks and
/// sensors the file itself defines, nor what those have that are like others.
fn is_of_form(cause: &str) -> bool {
    let own = ["like", "kind", "clock", "sensors"].map(|key| format!("unknown `{key}`"));
    (cause.starts_with("unknown ") && !own.iter().any(|own| cause.starts_with(own)))
        || (cause.contains("` must be ") && cause.contains(", not "))
        || (cause.contains(" needs `")
            && (cause.starts_with('[') || cause.starts_with("the scenario"))
            && !cause.contains(".dvl]"))
}

#[test]
fn mutants_that_the_reader_takes_are_valid_and_those_of_wrong_form_are_not() {
    let mut validator = Validator::new(schema());
    let (mut taken, mut refused, mut both) = (0, 0, 0);
    for text in documents::ALL {
        for mutant in mutants(&json_of(text)) {
            let written = toml_of(&mutant);
            // Whole numbers with a point are one thing in JSON, and two in TOML.
            let mutant = json_of(&written);
            let is_valid = validator.accepts(&mutant);
            match parse("mutant.toml", &written) {
                Ok(_) => {
                    assert!(is_valid, "read, but not valid:\n{written}");
                    taken += 1;
                }
                Err(errors) => {
                    let of_form = errors.errors.iter().find(|error| is_of_form(&error.cause));
                    if let Some(error) = of_form {
                        assert!(!is_valid, "valid, but refused: {}\n{written}", error.cause);
                        both += 1;
                    }
                    refused += 1;
                }
            }
        }
    }
    assert!(taken > 300 && refused > 3_000 && both > 2_500, "{taken} {refused} {both}");
}

#[test]
fn nothing_is_valid_that_is_no_scenario() {
    let mut validator = Validator::new(schema());
    let bare = Value::Object(Map::new());
    for document in [bare, json!([]), json!("name"), json!({ "name": "a" })] {
        assert!(!validator.accepts(&document), "{document}");
    }
}
