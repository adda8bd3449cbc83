//! `shoal record export`: the topics of a record as tables.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use serde_json::Value;
use shoal_bus::record::Topic;

use super::columns::{columns, object, rows, value};
use super::events::events;
use super::select::Selection;
use super::source::Record;
use crate::exit::Exit;
use crate::failure::Failure;

/// Which tables of what record.
#[derive(Debug, Args)]
pub struct ExportArgs {
    /// The record
    #[arg(required_unless_present = "columns")]
    file: Option<PathBuf>,
    /// Folder for the tables; made if it is not there. Without it, one --topic goes to standard output
    #[arg(long, short, value_name = "DIR")]
    out: Option<PathBuf>,
    /// How to write them
    #[arg(long, value_enum, default_value_t = Format::Csv)]
    format: Format,
    /// Print what every column of every table is, and end
    #[arg(long)]
    columns: bool,
    #[command(flatten)]
    selection: Selection,
}

/// How a table is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    /// Comma-separated values, with a line of names first; what is missing or not finite is empty
    Csv,
    /// An object of JSON a line; what is missing or not finite is absent
    Jsonl,
}

/// Writes them.
pub fn export(args: &ExportArgs) -> Result<Exit, Failure> {
    let Some(file) = args.file.as_ref().filter(|_| !args.columns) else {
        // Whoever closed our output has read enough.
        let _closed = io::stdout().lock().write_all(description().as_bytes());
        return Ok(Exit::Good);
    };
    args.selection.check()?;
    let mut record = Record::open(file)?;
    let mut tables = Tables::new(args)?;
    let mut left = args.selection.count.unwrap_or(u64::MAX);
    let mut selected = None;
    let mut is_heard = true;
    while left > 0 && is_heard {
        let Some(message) = record.next()? else { break };
        let Some(topic) = message.topic.filter(|topic| args.selection.wants(*topic)) else { continue };
        let found = match events(topic, message.at, message.data) {
            Ok(found) => found,
            Err(error) => return Err(record.wrong(&error)),
        };
        let selected = match &selected {
            Some(selected) => selected,
            None => selected.insert(args.selection.in_record(&record)?),
        };
        for event in found.into_iter().filter(|event| selected.takes(topic, event)) {
            for row in rows(topic, event.value) {
                if left > 0 {
                    left -= 1;
                    is_heard &= tables.write(topic, &row)?;
                }
            }
        }
    }
    tables.finish()?;
    Ok(if left == 0 || !is_heard { Exit::Good } else { record.end() })
}

/// The tables that have been begun.
struct Tables<'a> {
    folder: Option<&'a Path>,
    format: Format,
    open: BTreeMap<&'static str, (PathBuf, Table)>,
}

impl<'a> Tables<'a> {
    fn new(args: &'a ExportArgs) -> Result<Self, Failure> {
        let mut open = BTreeMap::new();
        match (&args.out, args.selection.topics.as_slice()) {
            (Some(folder), _) => std::fs::create_dir_all(folder).map_err(|error| wrong(folder, &error))?,
            (None, [topic]) => {
                let out = Box::new(BufWriter::new(io::stdout().lock()));
                open.insert(
                    topic.name(),
                    (PathBuf::from("standard output"), Table::begin(out, *topic, args.format)),
                );
            }
            (None, _) => {
                return Err(Failure::usage(
                    "there is one table for each topic: give a folder with -o DIR, or choose one with --topic, such as \
                     `--topic /pings`",
                ));
            }
        }
        Ok(Self { folder: args.out.as_deref(), format: args.format, open })
    }

    /// Writes a row; `false` when nobody reads it.
    fn write(&mut self, topic: Topic, row: &Value) -> Result<bool, Failure> {
        if let (Some(folder), false) = (self.folder, self.open.contains_key(topic.name())) {
            let extension = if self.format == Format::Csv { "csv" } else { "jsonl" };
            let path = folder.join(format!("{}.{extension}", topic.name().trim_start_matches('/')));
            let file = File::create(&path).map_err(|error| wrong(&path, &error))?;
            let table = Table::begin(Box::new(BufWriter::new(file)), topic, self.format);
            self.open.insert(topic.name(), (path, table));
        }
        let Some((path, table)) = self.open.get_mut(topic.name()) else { return Ok(true) };
        match table.write(topic, row) {
            Ok(()) => Ok(true),
            // A reader that has gone is content; a disk is not.
            Err(_) if self.folder.is_none() => Ok(false),
            Err(error) => Err(wrong(path, &error)),
        }
    }

    fn finish(self) -> Result<(), Failure> {
        for (path, table) in self.open.into_values() {
            match table.finish() {
                Err(error) if self.folder.is_some() => return Err(wrong(&path, &error)),
                _ => {}
            }
        }
        Ok(())
    }
}

fn wrong(path: &Path, error: &dyn std::fmt::Display) -> Failure {
    Failure::failed(format!("{}: {error}; choose another folder with --out", path.display()))
}

/// One table.
enum Table {
    Csv { writer: Box<csv::Writer<Box<dyn Write>>>, has_head: bool },
    Jsonl(Box<dyn Write>),
}

impl Table {
    fn begin(out: Box<dyn Write>, _: Topic, format: Format) -> Self {
        match format {
            Format::Csv => Self::Csv { writer: Box::new(csv::Writer::from_writer(out)), has_head: false },
            Format::Jsonl => Self::Jsonl(out),
        }
    }

    fn write(&mut self, topic: Topic, row: &Value) -> io::Result<()> {
        match self {
            Self::Csv { writer, has_head } => {
                if !std::mem::replace(has_head, true) {
                    writer.write_record(columns(topic).iter().map(|column| column.0))?;
                }
                let cell = |column| match value(topic, row, column) {
                    Value::Null => String::new(),
                    Value::String(text) => text,
                    other => other.to_string(),
                };
                Ok(writer.write_record(columns(topic).iter().map(cell))?)
            }
            Self::Jsonl(out) => writeln!(out, "{}", object(topic, row)),
        }
    }

    fn finish(self) -> io::Result<()> {
        match self {
            Self::Csv { mut writer, .. } => writer.flush(),
            Self::Jsonl(mut out) => out.flush(),
        }
    }
}

/// What every column is.
fn description() -> String {
    let mut text = String::from("SI units, in the names of the columns. Frame: x east, y north, z up.\n");
    for topic in Topic::ALL {
        let name = topic.name().trim_start_matches('/');
        text += &format!("\n{name}.csv\n");
        let width = columns(topic).iter().map(|column| column.0.len()).max().unwrap_or(0);
        for (name, _, meaning) in columns(topic) {
            text += format!("  {name:width$}  {meaning}").trim_end();
            text.push('\n');
        }
    }
    text
}
