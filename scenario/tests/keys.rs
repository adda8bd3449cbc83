//! The table of keys in the documentation, `src/keys.md`, lists every key that the reader knows.

use shoal_scenario::parse;

mod unknown_keys;

use unknown_keys::{UNKNOWN_EVERYWHERE, UNKNOWN_IN_OTHER_FORMS, UNKNOWN_IN_THE_SEA};

#[test]
fn every_key_is_documented() {
    every_unknown_key_lists_documented_ones(UNKNOWN_EVERYWHERE, 20);
    every_unknown_key_lists_documented_ones(UNKNOWN_IN_THE_SEA, 7);
    every_unknown_key_lists_documented_ones(UNKNOWN_IN_OTHER_FORMS, 6);
}

fn every_unknown_key_lists_documented_ones(text: &str, tables: usize) {
    let documented = include_str!("../src/keys.md");
    let errors = parse("all.toml", text).unwrap_err();
    assert_eq!((errors.errors.len(), errors.omitted), (tables, 0), "{errors}");
    for error in &errors.errors {
        let (_, keys) = error.fix.split_once(" has the keys ").unwrap_or_else(|| panic!("{errors}"));
        for key in keys.split(", ") {
            let forms = [
                format!("`{key}`"),
                format!(".{key}`"),
                format!("[{key}]"),
                format!("[{key}."),
                format!(".{key}]"),
                format!("{key} = "),
            ];
            assert!(forms.iter().any(|form| documented.contains(form)), "`{key}` is not in keys.md");
        }
    }
}
