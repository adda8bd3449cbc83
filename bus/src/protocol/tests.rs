//! The documentation is what the code is: tables made from the source text of the types, examples from the code that writes messages.

pub(crate) mod examples;
mod tables;

use std::path::Path;

/// Compares a part of the documentation with what it should be; with `SHOAL_BLESS` set, writes it instead.
#[track_caller]
fn holds(name: &str, documented: &str, made: &str) {
    if std::env::var_os("SHOAL_BLESS").is_some() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/protocol").join(name);
        std::fs::write(path, made).unwrap();
        return;
    }
    let difference = documented.lines().zip(made.lines()).find(|(documented, made)| documented != made);
    assert!(
        documented == made,
        "{name} is out of date (run this test with SHOAL_BLESS=1): {difference:?}, {} and {} lines",
        documented.lines().count(),
        made.lines().count()
    );
}

#[test]
fn the_tables_are_the_types() {
    holds("messages.md", include_str!("messages.md"), &tables::made());
}

#[test]
fn the_examples_are_messages() {
    holds("examples.md", include_str!("examples.md"), &examples::made());
}
