//! One file of comma-separated values, of which every mistake has a line.

use std::path::{Path, PathBuf};

use csv::StringRecord;

use crate::failure::Failure;

/// A file with the columns that were asked for, in the order that they were asked for.
pub struct Table {
    path: PathBuf,
    /// One for each line after the header.
    pub rows: Vec<Row>,
}

/// One line.
pub struct Row {
    /// Its number in the file, from one.
    pub line: u64,
    cells: Vec<Cell>,
}

struct Cell {
    column: &'static str,
    text: String,
}

impl Table {
    /// Reads a file that has at least `columns`, named in its first line, in any order.
    ///
    /// # Errors
    /// A sentence with the file, and the line and the fix where there is one.
    pub fn read(path: &Path, columns: &[&'static str]) -> Result<Self, Failure> {
        let wanted = columns.join(",");
        let unreadable = |error: csv::Error| {
            let line = error.position().map_or_else(String::new, |at| format!(":{}", at.line()));
            let cause = match error.kind() {
                csv::ErrorKind::Io(error) if is_missing(error) => {
                    format!(
                        "there is no such file: a data set is a folder that has it, with the columns {wanted}"
                    )
                }
                csv::ErrorKind::Io(error) => error.to_string(),
                csv::ErrorKind::Utf8 { .. } => "this is no text in UTF-8".to_owned(),
                csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
                    format!("{len} values where the first line names {expected_len}: give as many")
                }
                _ => format!("not comma-separated values with the columns {wanted}"),
            };
            Failure::failed(format!("{}{line}: {cause}", path.display()))
        };
        let mut reader =
            csv::ReaderBuilder::new().trim(csv::Trim::All).from_path(path).map_err(unreadable)?;
        let header = reader.headers().map_err(unreadable)?.clone();
        let places = columns
            .iter()
            .map(|column| {
                let place = header.iter().position(|name| name.trim_start_matches('\u{feff}') == *column);
                place.map(|place| (*column, place)).ok_or_else(|| {
                    let cause = format!("there is no column `{column}`: begin with the line `{wanted}`");
                    Failure::failed(format!("{}:1: {cause}", path.display()))
                })
            })
            .collect::<Result<Vec<_>, _>>()?;
        let mut rows = Vec::new();
        for record in reader.records() {
            let record = record.map_err(unreadable)?;
            let line = record.position().map_or(0, |at| at.line());
            rows.push(Row { line, cells: places.iter().map(|place| cell(&record, *place)).collect() });
        }
        Ok(Self { path: path.to_owned(), rows })
    }

    /// That a line of it is wrong: `cause` says why, and how to mend it.
    pub fn wrong(&self, line: u64, cause: impl std::fmt::Display) -> Failure {
        Failure::failed(format!("{}:{line}: {cause}", self.path.display()))
    }

    /// The number in a column of a row.
    pub fn number(&self, row: &Row, column: usize) -> Result<f64, Failure> {
        let Cell { column, text } = &row.cells[column];
        // Beyond this, squares lose what they are for.
        match text.parse::<f64>() {
            Ok(number) if number.abs() <= 1e9 => Ok(number),
            Ok(_) => Err(self.wrong(row.line, format!("{column} is {text}: give a number of at most 1e9"))),
            Err(_) => Err(self.wrong(row.line, format!("{column} is `{text}`: give a number, such as 12.5"))),
        }
    }

    /// The whole number in a column of a row.
    pub fn index(&self, row: &Row, column: usize) -> Result<usize, Failure> {
        let Cell { column, text } = &row.cells[column];
        text.parse().map_err(|_| {
            self.wrong(row.line, format!("{column} is `{text}`: give the number of a pose, counted from 0"))
        })
    }

    /// The text in a column of a row.
    pub fn text<'a>(&self, row: &'a Row, column: usize) -> &'a str {
        &row.cells[column].text
    }
}

fn is_missing(error: &std::io::Error) -> bool {
    matches!(error.kind(), std::io::ErrorKind::NotFound | std::io::ErrorKind::NotADirectory)
}

fn cell(record: &StringRecord, (column, place): (&'static str, usize)) -> Cell {
    // The reader has checked that each record is as long as the header.
    Cell { column, text: record.get(place).unwrap_or_default().to_owned() }
}
