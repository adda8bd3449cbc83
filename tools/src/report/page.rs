//! A page: what stands on it, whatever it is written in.

use crate::figure::Figure;

/// A page.
#[derive(Clone, Debug, PartialEq)]
pub struct Page {
    /// What it is called.
    pub title: String,
    /// Of what: the run, or both.
    pub subtitle: String,
    /// What stands on it.
    pub blocks: Vec<Block>,
}

/// A part of a page. Texts are as people read them: a writer escapes what its language needs escaped.
#[derive(Clone, Debug, PartialEq)]
pub enum Block {
    /// A section begins.
    Heading(String),
    /// A paragraph.
    Text(String),
    /// The one thing to know, and whether it is good.
    Verdict {
        /// Good or bad.
        is_good: bool,
        /// In a sentence.
        text: String,
    },
    /// Rows under a head.
    Table(Table),
    /// Figures side by side, by file name.
    Figures(Vec<(String, Figure)>),
    /// A text to be opened, as it is.
    Listing {
        /// What it is.
        title: String,
        /// The text.
        text: String,
    },
}

/// A table: the first column says what the row is, the others are aligned to the right if they are numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// One for each column.
    pub head: Vec<String>,
    /// As many in each row.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// A table without rows.
    pub fn new(head: &[&str]) -> Self {
        Self { head: head.iter().map(|text| (*text).to_owned()).collect(), rows: Vec::new() }
    }

    /// Appends a row.
    pub fn row(&mut self, cells: impl IntoIterator<Item = impl Into<String>>) {
        self.rows.push(cells.into_iter().map(Into::into).collect());
    }

    /// Whether all of a column are numbers, with or without a unit, or missing.
    pub fn is_of_numbers(&self, column: usize) -> bool {
        let is_number = |text: &str| {
            let text = text.trim_start_matches(['+', '-', '−']);
            text.is_empty() || text == "–" || text.starts_with(|first: char| first.is_ascii_digit())
        };
        column > 0 && self.rows.iter().all(|row| row.get(column).is_none_or(|text| is_number(text)))
    }
}

impl Page {
    /// The figures with their file names, in the order of the page.
    pub fn figures(&self) -> impl Iterator<Item = (&str, &Figure)> {
        self.blocks
            .iter()
            .filter_map(|block| match block {
                Block::Figures(figures) => Some(figures.iter()),
                _ => None,
            })
            .flatten()
            .map(|(name, figure)| (name.as_str(), figure))
    }
}
