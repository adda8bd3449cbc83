//! Walks the tables of a TOML document, and reports what is missing, unknown or of the wrong type.

use std::cell::RefCell;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::diagnostics::Findings;
use crate::examples::example_in;

/// A value with its place.
pub(crate) type Value<'t> = Spanned<DeValue<'t>>;

/// What may be named or spelled out.
pub(crate) enum TextOrTable<'t> {
    Text(&'t str),
    Table(Table<'t>),
}

/// One table of the document. Every key that is asked for becomes known; [`Table::finish`] reports the others.
pub(crate) struct Table<'t> {
    entries: &'t DeTable<'t>,
    header: Range<usize>,
    /// What a person calls it, such as `[group.modem]`.
    pub(crate) name: String,
    known: RefCell<Vec<&'static str>>,
    missing: RefCell<Vec<(&'static str, String)>>,
    pub(crate) findings: &'t Findings<'t>,
}

impl<'t> Table<'t> {
    pub(crate) fn new(
        entries: &'t DeTable<'t>,
        header: Range<usize>,
        name: impl Into<String>,
        findings: &'t Findings<'t>,
    ) -> Self {
        Self {
            entries,
            header,
            name: name.into(),
            known: RefCell::default(),
            missing: RefCell::default(),
            findings,
        }
    }

    /// The value of `key`, which is known from now on.
    pub(crate) fn get(&self, key: &'static str) -> Option<&'t Value<'t>> {
        self.known.borrow_mut().push(key);
        self.entries.get(key)
    }

    /// Whether `key` is there, right or wrong.
    pub(crate) fn has(&self, key: &str) -> bool {
        self.entries.contains_key(key)
    }

    /// Where the value of `key` is, or the head of the table when it is missing.
    pub(crate) fn span(&self, key: &str) -> Range<usize> {
        self.entries.get(key).map_or(self.header.clone(), Spanned::span)
    }

    /// The keys and values, for tables whose keys are names that the user chooses.
    pub(crate) fn named(&self) -> impl Iterator<Item = (&'t str, Range<usize>, &'t Value<'t>)> {
        self.entries.iter().map(|(key, value)| (key.get_ref().as_ref(), key.span(), value))
    }

    /// The head of the table.
    pub(crate) fn header(&self) -> Range<usize> {
        self.header.clone()
    }

    /// Reports an error at the value of `key`.
    pub(crate) fn refuse(
        &self,
        key: &str,
        cause: impl Into<String>,
        label: impl Into<String>,
        fix: impl Into<String>,
    ) {
        self.findings.add(self.span(key), cause, label, fix);
    }

    /// What a good line for `key` looks like in this table.
    pub(crate) fn example(&self, key: &str) -> String {
        example_in(&self.name, key)
    }

    /// Notes that `key` is missing; [`Table::finish`] reports it.
    pub(crate) fn missing(&self, key: &'static str) {
        self.missing_as(key, &self.example(key));
    }

    /// Notes that `key` is missing; `add` is what to write.
    pub(crate) fn missing_as(&self, key: &'static str, add: &str) {
        self.missing.borrow_mut().push((key, format!("add `{add}`")));
    }

    /// Reports the missing keys.
    pub(crate) fn report_missing(&self) {
        for (key, fix) in self.missing.take() {
            let cause = format!("{} needs `{key}`", self.name);
            self.findings.add(self.header(), cause, format!("no `{key}` here"), fix);
        }
    }

    /// Reports a value of another type than `wanted`, such as "a number".
    pub(crate) fn wrong_type(&self, key: &str, value: &Value<'_>, wanted: &str) {
        self.wrong_type_as(key, value, wanted, &self.example(key));
    }

    /// Reports a value of another type than `wanted`; `write` is what to write instead.
    pub(crate) fn wrong_type_as(&self, key: &str, value: &Value<'_>, wanted: &str, write: &str) {
        let key = key.escape_debug();
        self.findings.add(
            value.span(),
            format!("`{key}` must be {wanted}, not {}", article(value.get_ref().type_str())),
            format!("expected {wanted}"),
            format!("write for example `{write}`"),
        );
    }

    /// The table under `key`.
    pub(crate) fn table(&self, key: &'static str, name: &str) -> Option<Table<'t>> {
        let value = self.get(key)?;
        match value.get_ref() {
            DeValue::Table(entries) => Some(Table::new(entries, value.span(), name, self.findings)),
            _ => {
                self.wrong_type_as(key, value, "a table", name);
                None
            }
        }
    }

    /// What has a name under `key`: the name alone, or a table with a `name` and more, which errors call `title`.
    pub(crate) fn name_or_table(
        &self,
        key: &'static str,
        title: &str,
    ) -> Option<(&'t str, Option<Table<'t>>)> {
        let value = self.get(key)?;
        match value.get_ref() {
            DeValue::String(name) => Some((name.as_ref(), None)),
            DeValue::Table(entries) => {
                let table = Table::new(entries, value.span(), title, self.findings);
                let name = table.text("name", None);
                table.report_missing();
                Some((name?, Some(table)))
            }
            _ => {
                self.wrong_type(key, value, "a name or a table with a name");
                None
            }
        }
    }

    /// The table under `key`, which errors call `name`, or the text when there is only that.
    pub(crate) fn text_or_table(&self, key: &'static str, name: &str) -> Option<TextOrTable<'t>> {
        let value = self.get(key)?;
        match value.get_ref() {
            DeValue::String(text) => Some(TextOrTable::Text(text.as_ref())),
            DeValue::Table(entries) => {
                Some(TextOrTable::Table(Table::new(entries, value.span(), name, self.findings)))
            }
            _ => {
                self.wrong_type(key, value, "a name or a table");
                None
            }
        }
    }

    /// The text under `key`.
    pub(crate) fn text(&self, key: &'static str, default: Option<&'static str>) -> Option<&'t str> {
        match self.get(key).map(|value| (value, value.get_ref())) {
            Some((_, DeValue::String(text))) => Some(text.as_ref()),
            Some((value, _)) => {
                self.wrong_type(key, value, "a text in quotes");
                None
            }
            None if default.is_some() => default,
            None => {
                self.missing(key);
                None
            }
        }
    }

    /// The truth value under `key`.
    pub(crate) fn boolean(&self, key: &'static str, default: bool) -> Option<bool> {
        match self.get(key).map(|value| (value, value.get_ref())) {
            Some((_, DeValue::Boolean(value))) => Some(*value),
            Some((value, _)) => {
                self.wrong_type(key, value, "true or false");
                None
            }
            None => Some(default),
        }
    }

    /// One of a few names under `key`.
    pub(crate) fn choice<T: Copy>(
        &self,
        key: &'static str,
        choices: &[(&'static str, T)],
        default: T,
    ) -> Option<T> {
        let value = self.get(key);
        if value.is_none() {
            return Some(default);
        }
        self.chosen(key, self.text(key, None)?, choices)
    }

    /// What the text under `key` means; an error when it is none of the choices.
    pub(crate) fn chosen<T: Clone>(
        &self,
        key: &'static str,
        text: &str,
        choices: &[(&'static str, T)],
    ) -> Option<T> {
        let found = choices.iter().find(|(name, _)| *name == text).map(|(_, choice)| choice.clone());
        if found.is_none() {
            self.unknown_name(self.span(key), key, text, choices.iter().map(|(name, _)| *name));
        }
        found
    }

    /// Reports a name that is none of the `known` ones.
    pub(crate) fn unknown_name<'k>(
        &self,
        span: Range<usize>,
        key: &str,
        text: &str,
        known: impl Iterator<Item = &'k str>,
    ) {
        let known: Vec<&str> = known.collect();
        let listed = known.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        let fix = match closest(text, known.iter().copied()) {
            Some(similar) => format!("did you mean `{similar}`? choose one of {listed}"),
            None => format!("choose one of {listed}"),
        };
        self.findings.add(span, format!("unknown `{key}`: `{}`", text.escape_debug()), "not known", fix);
    }

    /// Reports every key that was never asked for, and every one that is missing.
    pub(crate) fn finish(self) {
        let mut known = self.known.take();
        known.sort_unstable();
        known.dedup();
        for (key, _) in self.entries {
            let text = key.get_ref().as_ref();
            if known.binary_search(&text).is_ok() {
                continue;
            }
            let absent = known.iter().copied().filter(|name| !self.has(name));
            let fix = match closest(text, absent) {
                Some(similar) => {
                    // A slip in a key that must be there is one error, not two.
                    self.missing.borrow_mut().retain(|(missing, _)| *missing != similar);
                    format!("did you mean `{similar}`?")
                }
                None => format!("{} has the keys {}", self.name, known.join(", ")),
            };
            self.findings.add(
                key.span(),
                format!("unknown key `{}` in {}", text.escape_debug(), self.name),
                "unknown key",
                fix,
            );
        }
        self.report_missing();
    }
}

/// The known name nearest to what was written, when it is near enough to be meant.
pub(crate) fn closest<'k>(written: &str, known: impl Iterator<Item = &'k str>) -> Option<&'k str> {
    // A long text is no slip of the finger, and comparing it would take time.
    if written.len() > 64 {
        return None;
    }
    known
        .map(|name| {
            let likeness = strsim::jaro_winkler(written, name);
            let prefix = name.strip_prefix(written).is_some_and(|rest| rest.starts_with('_'));
            (if prefix { likeness.max(0.99) } else { likeness }, name)
        })
        .filter(|(likeness, _)| *likeness > 0.8)
        .max_by(|(a, _), (b, _)| a.total_cmp(b))
        .map(|(_, name)| name)
}

/// A type of TOML with its article.
pub(crate) fn article(type_name: &str) -> String {
    match type_name.chars().next() {
        Some('a' | 'e' | 'i' | 'o' | 'u') => format!("an {type_name}"),
        _ => format!("a {type_name}"),
    }
}
