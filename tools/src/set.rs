//! `--set KEY=VALUE`: changes one value in the text of a scenario, so that the result is a scenario file like any other.

use std::fmt;

use toml_edit::{DocumentMut, Item, Key, Table, Value};

use crate::failure::Failure;

/// A change of one value.
#[derive(Clone, Debug)]
pub struct Setting {
    /// Where, as it was written.
    key: String,
    /// The parts of the key.
    path: Vec<String>,
    /// What to put there.
    value: Value,
}

impl Setting {
    /// Reads `KEY=VALUE`. VALUE is TOML; a word that is not becomes a string.
    pub fn parse(text: &str) -> Result<Self, String> {
        let (key, value) = split(text)?;
        Ok(Self { key: key.to_owned(), path: path(key)?, value: parse_value(value)? })
    }

    /// Reads `KEY=A,B,C`: one setting for each value. Commas inside brackets, braces and quotes belong to a value.
    pub fn parse_list(text: &str) -> Result<Vec<Self>, String> {
        let (key, values) = split(text)?;
        let path = path(key)?;
        pieces(values)
            .into_iter()
            .map(|value| Ok(Self { key: key.to_owned(), path: path.clone(), value: parse_value(value)? }))
            .collect()
    }

    /// Where it puts its value, as it was written.
    pub fn key(&self) -> &str {
        &self.key
    }

    /// Its value as people read it: strings without quotes.
    pub fn shown(&self) -> String {
        self.value.as_str().map_or_else(|| self.value.to_string(), str::to_owned)
    }

    /// Its value as it stands in a scenario.
    pub fn toml(&self) -> String {
        self.value.to_string()
    }

    /// The text of a scenario with `settings` made one after the other; all else stays as it is.
    ///
    /// A part of a key that is a number picks one element of an array, counted from 0; where an array meets a name, the
    /// name is looked up in all of its elements. Tables that are missing are made.
    pub fn apply(source_name: &str, text: &str, settings: &[Self]) -> Result<String, Failure> {
        if settings.is_empty() {
            return Ok(text.to_owned());
        }
        let mut document: DocumentMut = text.parse().map_err(|error: toml_edit::TomlError| {
            Failure::usage(format!("{source_name} is not TOML, so --set cannot change it: {error}"))
        })?;
        for setting in settings {
            set_in_item(document.as_item_mut(), &setting.path, &setting.value)
                .map_err(|error| Failure::usage(format!("--set {setting}: {error}")))?;
        }
        Ok(document.to_string())
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.key, self.shown())
    }
}

fn split(text: &str) -> Result<(&str, &str), String> {
    match text.split_once('=') {
        Some((key, value)) if !key.trim().is_empty() => Ok((key.trim(), value.trim())),
        _ => Err("write KEY=VALUE, such as `group.modem.range_m=500`".to_owned()),
    }
}

fn path(key: &str) -> Result<Vec<String>, String> {
    let parts = Key::parse(key).map_err(|_| {
        format!("`{key}` is no key: write names and numbers with dots between them, such as `group.0.count`")
    })?;
    Ok(parts.iter().map(|part| part.get().to_owned()).collect())
}

fn parse_value(text: &str) -> Result<Value, String> {
    let is_word = |text: &str| text.chars().all(|c| c.is_alphanumeric() || matches!(c, '_' | '-' | '.'));
    match text.parse::<Value>() {
        Ok(mut value) => {
            value.decor_mut().clear();
            Ok(value)
        }
        Err(_) if text.is_empty() => Err("a value is missing: write KEY=VALUE".to_owned()),
        Err(_) if is_word(text) => Ok(Value::from(text)),
        Err(_) => Err(format!(
            "`{text}` is no TOML value: write a number, a word, a \"text\", `[1, 2]` or `{{ a = 1 }}`"
        )),
    }
}

/// The text cut at the commas that stand outside of brackets, braces and quotes.
fn pieces(text: &str) -> Vec<&str> {
    let (mut depth, mut quote, mut begin) = (0_usize, None, 0);
    let mut pieces = Vec::new();
    for (at, character) in text.char_indices() {
        match (quote, character) {
            (Some(open), _) if open == character => quote = None,
            (Some(_), _) => {}
            (None, '"' | '\'') => quote = Some(character),
            (None, '[' | '{') => depth += 1,
            (None, ']' | '}') => depth = depth.saturating_sub(1),
            (None, ',') if depth == 0 => {
                pieces.push(text[begin..at].trim());
                begin = at + 1;
            }
            _ => {}
        }
    }
    pieces.push(text[begin..].trim());
    pieces
}

fn set_in_item(item: &mut Item, path: &[String], value: &Value) -> Result<(), String> {
    let Some((part, rest)) = path.split_first() else {
        match item {
            Item::Value(old) => replace(old, value),
            _ => *item = Item::Value(value.clone()),
        }
        return Ok(());
    };
    match item {
        Item::None => {
            *item = Item::Table(Table::new());
            set_in_item(item, path, value)
        }
        Item::Table(table) => set_in_item(table.entry(part).or_insert(Item::None), rest, value),
        Item::ArrayOfTables(tables) => {
            let count = tables.len();
            let set = |table: &mut Table, path: &[String]| match path.split_first() {
                Some((part, rest)) => set_in_item(table.entry(part).or_insert(Item::None), rest, value),
                None => Err(format!("`{part}` is a table; name one of its keys")),
            };
            match part.parse::<usize>() {
                Ok(index) => set(tables.get_mut(index).ok_or_else(|| missing(part, count))?, rest),
                Err(_) => tables.iter_mut().try_for_each(|table| set(table, path)),
            }
        }
        Item::Value(inside) => set_in_value(inside, path, value),
    }
}

fn set_in_value(at: &mut Value, path: &[String], value: &Value) -> Result<(), String> {
    let Some((part, rest)) = path.split_first() else {
        replace(at, value);
        return Ok(());
    };
    match at {
        Value::InlineTable(table) => {
            if !table.contains_key(part) {
                let new =
                    if rest.is_empty() { value.clone() } else { Value::InlineTable(Default::default()) };
                table.insert(part, new);
            }
            table.get_mut(part).map_or(Ok(()), |inside| set_in_value(inside, rest, value))
        }
        Value::Array(array) => {
            let count = array.len();
            match part.parse::<usize>() {
                Ok(index) => {
                    set_in_value(array.get_mut(index).ok_or_else(|| missing(part, count))?, rest, value)
                }
                Err(_) => array.iter_mut().try_for_each(|element| set_in_value(element, path, value)),
            }
        }
        other => {
            other.decor_mut().clear();
            Err(format!(
                "`{part}` cannot be looked up in `{other}`, which is of type {} and no table",
                other.type_name()
            ))
        }
    }
}

/// Puts `value` where `old` was, with the spaces and the comment around it.
fn replace(old: &mut Value, value: &Value) {
    let decor = old.decor().clone();
    *old = value.clone();
    *old.decor_mut() = decor;
}

fn missing(part: &str, count: usize) -> String {
    format!("there is no element {part}: there are {count}, counted from 0")
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "# Two groups.\nseed = 1   # a comment\narea_m = [[0, 1], [0, 2]]\n\n[[group]]\nname = \"a\"\n\
        controller = { name = \"hold\" }\n\n[group.modem]\nrange_m = 100 # far\n\n[[group]]\nname = \"b\"\n";

    fn set(settings: &[&str]) -> Result<String, String> {
        let settings: Vec<Setting> =
            settings.iter().map(|text| Setting::parse(text)).collect::<Result<_, _>>()?;
        Setting::apply("x.toml", TEXT, &settings).map_err(|failure| failure.message)
    }

    #[test]
    fn only_the_named_value_changes() {
        assert_eq!(set(&["seed=7"]).unwrap(), TEXT.replace("seed = 1 ", "seed = 7 "));
        assert_eq!(set(&["area_m.1.0=-5"]).unwrap(), TEXT.replace("[0, 2]", "[-5, 2]"));
        assert_eq!(set(&["group.0.name=hold-it"]).unwrap(), TEXT.replace("\"a\"", "\"hold-it\""));
        assert_eq!(set(&["group.0.modem.range_m=[1, 2]"]).unwrap(), TEXT.replace("100", "[1, 2]"));
        assert_eq!(set(&["group.0.controller.name=circle"]).unwrap(), TEXT.replace("\"hold\"", "\"circle\""));
    }

    #[test]
    fn a_name_behind_an_array_means_all_and_missing_tables_are_made() {
        let text = set(&["group.modem.access=slotted", "environment.sea.wind_m_s=4"]).unwrap();
        let table: toml_edit::Document<String> = text.parse().unwrap();
        for group in 0..2 {
            assert_eq!(table["group"][group]["modem"]["access"].as_str(), Some("slotted"), "{text}");
        }
        assert_eq!(table["group"][0]["modem"]["range_m"].as_integer(), Some(100), "{text}");
        assert_eq!(table["environment"]["sea"]["wind_m_s"].as_integer(), Some(4), "{text}");
        assert!(text.starts_with("# Two groups.\nseed = 1   # a comment\n"), "{text}");
    }

    #[test]
    fn a_list_is_cut_at_its_own_commas() {
        let shown = |text| {
            Setting::parse_list(text).unwrap().iter().map(|setting| setting.shown()).collect::<Vec<_>>()
        };
        assert_eq!(shown("a=periodic, aloha,3"), ["periodic", "aloha", "3"]);
        assert_eq!(shown("a=[1, 2],{ b = 1, c = 2 },\"x, y\""), ["[1, 2]", "{ b = 1, c = 2 }", "x, y"]);
    }

    #[test]
    fn what_cannot_be_set_is_refused_with_the_reason() {
        let errors = [
            ("seed", "KEY=VALUE"),
            ("seed=", "a value is missing"),
            ("seed=[1", "`[1` is no TOML value"),
            ("a b=1", "`a b` is no key"),
            ("seed.x=1", "`x` cannot be looked up in `1`, which is of type integer and no table"),
            ("group.2.name=c", "there is no element 2: there are 2, counted from 0"),
            ("group.0=c", "name one of its keys"),
        ];
        for (text, expected) in errors {
            let error = set(&[text]).unwrap_err();
            assert!(error.contains(expected), "{text}: {error}");
        }
    }
}
