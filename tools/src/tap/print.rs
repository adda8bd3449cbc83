//! Prints messages: as lines for people, as JSON lines, as comma-separated values, or some of their fields.

use std::io::{self, BufWriter, Stdout, Write};

use serde_json::Value;
use shoal_bus::record::{Row, Topic};

use super::args::FormArgs;
use super::text::Line;
use crate::failure::Failure;
use crate::filter::{Fields, find};

/// Format tag of a JSON line.
const FORMAT: &str = "shoal.tap/1";

/// What is known of pings, as columns.
const PING_COLUMNS: &[&str] = &[
    "t_ns",
    "fate",
    "from",
    "to",
    "sequence",
    "range_m",
    "travel_s",
    "reason",
    "box_width_m",
    "reception.sinr_db",
    "reception.level_db",
    "reception.path",
    "outlier",
    "bytes",
    "beyond_range",
];

const TICK_COLUMNS: &[&str] = &[
    "t_ns",
    "auv",
    "tick",
    "local_ns",
    "position_m.0",
    "position_m.1",
    "position_m.2",
    "velocity_m_s.0",
    "velocity_m_s.1",
    "velocity_m_s.2",
    "heading_rad",
    "pitch_rad",
];

const REPORT_COLUMNS: &[&str] = &[
    "t_ns",
    "auv",
    "tick",
    "local_ns",
    "position_m.0.0",
    "position_m.0.1",
    "position_m.1.0",
    "position_m.1.1",
    "position_m.2.0",
    "position_m.2.1",
    "clock_offset_s.0",
    "clock_offset_s.1",
    "neighbours",
    "contractions",
    "rejected",
    "components",
];

const LOG_COLUMNS: &[&str] = &["timestamp.sec", "timestamp.nsec", "level", "name", "message"];

const FLOCK_COLUMNS: &[&str] = &[
    "t_ns",
    "polarization",
    "min_separation_m",
    "collisions",
    "connectivity",
    "algebraic_connectivity",
    "components",
    "largest_component",
];

/// Prints messages of one topic on the standard output.
pub struct Printer {
    out: BufWriter<Stdout>,
    form: Form,
    topic: Topic,
}

enum Form {
    Text,
    Json,
    /// Values of these fields, with tabs between them.
    Fields(Vec<String>),
    /// A JSON object of these fields.
    JsonFields(Vec<String>),
    Csv(Vec<String>),
}

/// Why printing stops.
pub enum Stop {
    /// Whoever read us has gone: so do we.
    Closed,
    /// The output cannot be written.
    Failed(io::Error),
}

impl From<io::Error> for Stop {
    fn from(error: io::Error) -> Self {
        if error.kind() == io::ErrorKind::BrokenPipe { Self::Closed } else { Self::Failed(error) }
    }
}

impl Printer {
    /// As `args` say. For values with commas, the titles are printed at once.
    ///
    /// # Errors
    /// When a field is none of the topic's, or its messages have no columns.
    pub fn new(args: &FormArgs, topic: Topic) -> Result<Self, Failure> {
        let fields = Fields::of(topic);
        for path in &args.field {
            fields.check(path).map_err(|(_, fix)| {
                Failure::usage(format!(
                    "--field {path}: messages of {} have no such field; {fix}",
                    topic.name()
                ))
            })?;
        }
        let chosen = args.field.clone();
        let form = match (args.json, args.csv, chosen.is_empty()) {
            (true, _, true) => Form::Json,
            (true, _, false) => Form::JsonFields(chosen),
            (_, true, true) => Form::Csv(columns(topic)?),
            (_, true, false) => Form::Csv(chosen),
            (_, _, false) => Form::Fields(chosen),
            (_, _, true) => Form::Text,
        };
        let mut printer = Self { out: BufWriter::with_capacity(1 << 16, io::stdout()), form, topic };
        if let Form::Csv(columns) = &printer.form {
            let titles = columns.clone();
            // A reader that has gone is noticed with the first row.
            let _closed = printer.csv_line(&titles);
        }
        Ok(printer)
    }

    /// Prints one message; `json` is the same, if it is known.
    pub fn print(&mut self, row: &Row, json: Option<Value>) -> Result<(), Stop> {
        let json = || json.map_or_else(|| serde_json::to_value(row), Ok).unwrap_or_default();
        match &self.form {
            Form::Text => writeln!(self.out, "{}", Line(row))?,
            Form::Json => {
                let line = labelled(json(), self.topic);
                writeln!(self.out, "{line}")?;
            }
            Form::JsonFields(fields) => {
                let json = json();
                let found = fields.iter().map(|path| (path.clone(), find(&json, path).unwrap_or_default()));
                let line = labelled(found.collect(), self.topic);
                writeln!(self.out, "{line}")?;
            }
            Form::Fields(fields) => {
                let json = json();
                let found: Vec<String> = fields.iter().map(|path| plain(find(&json, path))).collect();
                writeln!(self.out, "{}", found.join("\t"))?;
            }
            Form::Csv(columns) => {
                let json = json();
                let found: Vec<String> = columns.iter().map(|path| plain(find(&json, path))).collect();
                self.csv_line(&found)?;
            }
        }
        Ok(())
    }

    /// What has been printed is seen at once, however little it is.
    pub fn flush(&mut self) -> Result<(), Stop> {
        Ok(self.out.flush()?)
    }

    fn csv_line(&mut self, cells: &[String]) -> io::Result<()> {
        let mut line = csv::Writer::from_writer(Vec::new());
        line.write_record(cells)?;
        self.out.write_all(&line.into_inner().map_err(|error| error.into_error())?)
    }
}

fn columns(topic: Topic) -> Result<Vec<String>, Failure> {
    let columns = match topic {
        Topic::Pings => PING_COLUMNS,
        Topic::Ticks => TICK_COLUMNS,
        Topic::Reports => REPORT_COLUMNS,
        Topic::Log => LOG_COLUMNS,
        Topic::Flock => FLOCK_COLUMNS,
        _ => {
            return Err(Failure::usage(format!(
                "messages of {} do not fit into columns: choose some with --field, or use --json",
                topic.name()
            )));
        }
    };
    Ok(columns.iter().map(|&name| name.to_owned()).collect())
}

/// With the format and the topic, unless it has a format of its own.
fn labelled(json: Value, topic: Topic) -> Value {
    let mut labelled = serde_json::Map::new();
    labelled.insert("format".to_owned(), FORMAT.into());
    labelled.insert("topic".to_owned(), topic.name().into());
    if let Value::Object(fields) = json {
        labelled.extend(fields);
    }
    labelled.into()
}

/// A value without quotes; nothing for what is not there.
fn plain(value: Option<Value>) -> String {
    match value {
        None | Some(Value::Null) => String::new(),
        Some(Value::String(text)) => text,
        Some(other) => other.to_string(),
    }
}
