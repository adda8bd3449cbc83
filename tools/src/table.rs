//! Plain tables that fit the width there is.

use std::fmt::Write;

/// A table of text. Titles that begin with `>` stand, with all their column, at the right.
pub struct Table<const N: usize> {
    titles: [String; N],
    is_right: [bool; N],
    rows: Vec<[String; N]>,
}

impl<const N: usize> Table<N> {
    /// An empty one.
    pub fn new(titles: &[&str; N]) -> Self {
        Self {
            titles: titles.map(|title| title.trim_start_matches('>').to_owned()),
            is_right: titles.map(|title| title.starts_with('>')),
            rows: Vec::new(),
        }
    }

    /// One more line.
    pub fn push(&mut self, row: [String; N]) {
        self.rows.push(row);
    }

    /// The lines. Where they would be longer than `columns`, the last columns are left out, but never the first.
    pub fn render(&self, columns: Option<usize>) -> String {
        let mut lines = vec![String::new(); self.rows.len() + 1];
        let mut used = 0;
        for column in 0..N {
            let cells = || std::iter::once(&self.titles).chain(&self.rows).map(|row| row[column].as_str());
            let width = cells().map(|cell| cell.chars().count()).max().unwrap_or(0);
            let gap = if column == 0 { 0 } else { 2 };
            if column > 0 && columns.is_some_and(|columns| used + gap + width > columns) {
                break;
            }
            used += gap + width;
            for (line, cell) in lines.iter_mut().zip(cells()) {
                // Writing to a string does not fail.
                let _written = if self.is_right[column] {
                    write!(line, "{:gap$}{cell:>width$}", "")
                } else {
                    write!(line, "{:gap$}{cell:width$}", "")
                };
            }
        }
        lines.iter().map(|line| line.trim_end().to_owned() + "\n").collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_fit_is_left_out() {
        let mut table = Table::new(&["auv", ">box m", "state"]);
        table.push(["green-0".into(), "3.1".into(), "alive".into()]);
        table.push(["é".into(), "12.0".into(), "lost".into()]);
        assert_eq!(
            table.render(None),
            "auv      box m  state\ngreen-0    3.1  alive\né         12.0  lost\n"
        );
        assert_eq!(table.render(Some(14)), "auv      box m\ngreen-0    3.1\né         12.0\n");
        assert_eq!(table.render(Some(3)), "auv\ngreen-0\né\n");
    }
}
