//! The key `command` of a group: its AUVs are programs of the user's own.

use toml::de::DeValue;

use crate::reader::Table;

const WANTED: &str = "a list of texts: a program and its arguments";

/// The program and its arguments; `None` inside for AUVs that are Shoal's own.
pub(crate) fn command(table: &Table<'_>) -> Option<Option<Vec<String>>> {
    let Some(value) = table.get("command") else { return Some(None) };
    let DeValue::Array(words) = value.get_ref() else {
        table.wrong_type("command", value, WANTED);
        return None;
    };
    if words.is_empty() {
        table.refuse(
            "command",
            "the `command` is empty: there is no program to start",
            "needs a program",
            format!("write for example `{}`, or leave it out for Shoal's own AUVs", table.example("command")),
        );
        return None;
    }
    let mut command = Vec::with_capacity(words.len());
    for word in words.iter() {
        match word.get_ref() {
            DeValue::String(text)
                if text.contains('\0') || (command.is_empty() && text.trim().is_empty()) =>
            {
                table.findings.add(
                    word.span(),
                    "a `command` begins with the name of a program, and has no NUL characters",
                    "no program can be called so",
                    format!("write for example `{}`", table.example("command")),
                );
                return None;
            }
            DeValue::String(text) => command.push(text.to_string()),
            _ => {
                table.wrong_type("command", word, WANTED);
                return None;
            }
        }
    }
    if table.has("sabotage") {
        table.refuse(
            "sabotage",
            "a group with a `command` breaks no promise for Shoal: its AUVs are programs of your own",
            "not for programs of your own",
            "break the promise in the program, or remove `command`",
        );
        return None;
    }
    Some(Some(command))
}
