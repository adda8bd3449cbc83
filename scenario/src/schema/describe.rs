//! What `keys.md` says of a key.

/// The documentation of all keys, which is also that of the crate.
const KEYS: &str = include_str!("../keys.md");

/// The meaning of a key with its unit and default; `section` is a part of the bold row above it, empty for the first rows.
pub(super) fn describe(section: &str, key: &str) -> Option<String> {
    // The row of a table's head speaks of the table.
    let path = section.trim_matches(['[', ']']).split('.').chain([key]).filter(|part| !part.is_empty());
    let path = path.collect::<Vec<_>>().join(".");
    let heads = [format!("[{path}]"), format!("[{path}.NAME]")];
    let mut is_in_section = section.is_empty();
    for row in KEYS.lines().skip(2) {
        let mut cells = cells(row).into_iter();
        let (Some(keys), Some(unit), Some(default), Some(meaning)) =
            (cells.next(), cells.next(), cells.next(), cells.next())
        else {
            continue;
        };
        if keys.contains("**") {
            is_in_section = !section.is_empty() && keys.contains(section);
            if heads.iter().any(|head| keys.contains(head)) {
                return Some(plain(&meaning).trim_end_matches(':').to_owned());
            }
            continue;
        }
        if is_in_section && names(&keys).any(|name| name == key) {
            let mut words = plain(&meaning).trim_end_matches(':').to_owned();
            let details = [("in ", plain(&unit)), ("default: ", plain(&default))];
            let details: Vec<String> = details
                .into_iter()
                .filter(|(_, text)| !text.is_empty() && text != "needed")
                .map(|(word, text)| format!("{word}{text}"))
                .collect();
            if !details.is_empty() {
                let gap = if words.is_empty() { "" } else { " " };
                words = format!("{words}{gap}({})", details.join("; "));
            }
            return Some(words);
        }
    }
    None
}

/// The cells of a row. No key, unit or meaning has a bar.
fn cells(row: &str) -> Vec<String> {
    row.trim().trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect()
}

/// Every name that a cell lists: what begins with a dot goes on from the one before.
fn names(cell: &str) -> impl Iterator<Item = String> + '_ {
    let mut table = String::new();
    cell.split('`').skip(1).step_by(2).map(move |name| {
        if name.starts_with('.') {
            return format!("{table}{name}");
        }
        table = name.rsplit_once('.').map_or(String::new(), |(table, _)| table.to_owned());
        name.to_owned()
    })
}

/// Words without links and marks for code.
fn plain(words: &str) -> String {
    words.replace("[`", "").replace("`]", "").replace('`', "")
}

/// Every key of the documentation with its section.
#[cfg(test)]
pub(super) fn documented() -> Vec<(String, String)> {
    let mut section = String::new();
    let mut found = Vec::new();
    for row in KEYS.lines().skip(2) {
        let Some(keys) = cells(row).into_iter().next() else { continue };
        if keys.contains("**") {
            section = keys;
        } else {
            found.extend(names(&keys).map(|name| (section.clone(), name)));
        }
    }
    found
}
