//! `shoal record diff`: where two runs part.

use std::fmt::Write as _;
use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use serde::Serialize;
use serde_json::Value;
use shoal_bus::record::Topic;

use super::batches::{Batch, Batches, Told};
use super::compare::{Difference, differences};
use super::source::Record;
use crate::exit::Exit;
use crate::failure::{Failure, While};
use crate::summary_text::grouped;

/// Format of the line that `--json` prints.
pub const DIFF_FORMAT: &str = "shoal.record_diff/1";

/// So many fields of the first event that differs are shown.
const FIELDS_MAX: usize = 8;

/// Which records.
#[derive(Debug, Args)]
pub struct DiffArgs {
    /// One record
    a: PathBuf,
    /// The other
    b: PathBuf,
    /// One JSON line
    #[arg(long)]
    json: bool,
}

/// What the comparison says.
#[derive(Debug, Default, Serialize)]
struct Outcome {
    format: &'static str,
    equal: bool,
    /// Facts of the runs themselves that differ: scenario, seed, digest.
    runs: Vec<FieldOutcome>,
    /// The first event that differs.
    #[serde(skip_serializing_if = "Option::is_none")]
    first: Option<First>,
    topics: Vec<Count>,
}

#[derive(Debug, Serialize)]
struct FieldOutcome {
    field: String,
    a: Value,
    b: Value,
}

impl From<Difference> for FieldOutcome {
    fn from(Difference { field, a, b }: Difference) -> Self {
        Self { field, a, b }
    }
}

#[derive(Debug, Serialize)]
struct First {
    t_s: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    auv: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    topic: &'static str,
    /// `a` or `b` when only that one has the event.
    #[serde(skip_serializing_if = "Option::is_none")]
    only_in: Option<&'static str>,
    fields: Vec<FieldOutcome>,
}

/// Messages of a topic.
#[derive(Debug, Serialize)]
struct Count {
    topic: &'static str,
    a: u64,
    b: u64,
    /// Messages that are not the same in both; a message of either alone counts.
    different: u64,
}

/// Compares them and prints what it found.
pub fn diff(args: &DiffArgs) -> Result<Exit, Failure> {
    let [mut a, mut b] = [Record::open(&args.a)?, Record::open(&args.b)?].map(Batches::new);
    let mut outcome = Outcome { format: DIFF_FORMAT, ..Outcome::default() };
    outcome.topics = Topic::ALL.map(|topic| Count { topic: topic.name(), a: 0, b: 0, different: 0 }).into();
    let [mut one, mut other] = [a.next()?, b.next()?];
    about_the_runs(&a.record, &b.record, &mut outcome);
    loop {
        // A batch that only one of them has stands against nothing.
        let place = match (&one, &other) {
            (None, None) => break,
            (Some(one), Some(other)) => one.place().min(other.place()),
            (Some(only), None) | (None, Some(only)) => only.place(),
        };
        let [in_a, in_b] = [&one, &other].map(|side| side.as_ref().filter(|batch| batch.place() == place));
        outcome.count(in_a, in_b);
        let are_equal = matches!((in_a, in_b), (Some(in_a), Some(in_b)) if in_a.messages == in_b.messages);
        if !are_equal && outcome.first.is_none() {
            let events = |batch: Option<&Batch>, of: &Batches| {
                batch.map_or(Ok(Vec::new()), |batch| batch.events(&of.record))
            };
            outcome.first = first(&events(in_a, &a)?, &events(in_b, &b)?, &a.record.names);
        }
        let (takes_a, takes_b) = (in_a.is_some(), in_b.is_some());
        if takes_a {
            one = a.next()?;
        }
        if takes_b {
            other = b.next()?;
        }
    }
    let different: u64 = outcome.topics.iter().map(|count| count.different).sum();
    outcome.equal = different == 0 && outcome.runs.is_empty();
    let text = match args.json {
        true => serde_json::to_string(&outcome).while_doing("print the differences")? + "\n",
        false => outcome.text(&args.a.display().to_string(), &args.b.display().to_string()),
    };
    // Whoever closed our output does not want it; the exit code still tells.
    let _closed = std::io::stdout().lock().write_all(text.as_bytes());
    let readings = [a.record.end(), b.record.end()];
    Ok(match outcome.equal {
        false => Exit::Failed,
        // As far as they go.
        true if readings.contains(&Exit::Loss) => Exit::Loss,
        true => Exit::Good,
    })
}

/// What the runs say of themselves, before anything happened.
fn about_the_runs(a: &Record, b: &Record, outcome: &mut Outcome) {
    for key in ["scenario", "seed", "auvs"] {
        let [a, b] = [a, b].map(|record| record.run.get(key).cloned().unwrap_or_default());
        if a != b {
            outcome.runs.push(FieldOutcome { field: key.to_owned(), a: a.into(), b: b.into() });
        }
    }
    if a.scenario != b.scenario {
        let lines = a.scenario.lines().zip(b.scenario.lines()).enumerate();
        let line = lines.clone().find(|(_, (a, b))| a != b).map_or_else(
            || a.scenario.lines().count().min(b.scenario.lines().count()) + 1,
            |(index, _)| index + 1,
        );
        let whole = |of: &str| of.lines().nth(line - 1).unwrap_or_default().trim().to_owned();
        let is_in_comment = code(&whole(&a.scenario)) == code(&whole(&b.scenario));
        let text = |of: &str| if is_in_comment { whole(of) } else { code(&whole(of)).to_owned() };
        outcome.runs.push(FieldOutcome {
            field: format!("scenario.toml line {line}"),
            a: text(&a.scenario).into(),
            b: text(&b.scenario).into(),
        });
    }
}

/// A line of TOML without its comment.
fn code(line: &str) -> &str {
    line.split(" #").next().unwrap_or(line).trim_end()
}

/// The first event that is not in both.
fn first(a: &[Told], b: &[Told], names: &[String]) -> Option<First> {
    let index = (0..a.len().max(b.len())).find(|&index| match (a.get(index), b.get(index)) {
        (Some(one), Some(other)) => one.key() != other.key() || one.event != other.event,
        _ => true,
    })?;
    let (told, only_in, fields) = match (a.get(index), b.get(index)) {
        (Some(one), Some(other)) if one.key() == other.key() => {
            (one, None, differences(&one.event, &other.event, FIELDS_MAX))
        }
        (Some(one), Some(other)) if other.key() < one.key() => (other, Some("b"), Vec::new()),
        (Some(one), _) => (one, Some("a"), Vec::new()),
        (None, other) => (other?, Some("b"), Vec::new()),
    };
    let name = told.auv.and_then(|auv| names.get(auv as usize)).cloned();
    let fields = fields.into_iter().map(FieldOutcome::from).collect();
    Some(First { t_s: told.at.as_s(), auv: told.auv, name, topic: told.topic.name(), only_in, fields })
}

impl Outcome {
    fn count(&mut self, a: Option<&Batch>, b: Option<&Batch>) {
        for (count, topic) in self.topics.iter_mut().zip(Topic::ALL) {
            let of = |batch: Option<&Batch>| batch.map_or(0, |batch| batch.count(topic));
            count.a += of(a);
            count.b += of(b);
            let messages = |batch: Option<&Batch>| -> Vec<Vec<u8>> {
                batch.map_or(Vec::new(), |batch| {
                    batch
                        .messages
                        .iter()
                        .filter(|(of, _)| *of == topic)
                        .map(|(_, data)| data.clone())
                        .collect()
                })
            };
            if matches!((a, b), (Some(a), Some(b)) if a.messages == b.messages) {
                continue;
            }
            let (a, b) = (messages(a), messages(b));
            let same = a.iter().zip(&b).filter(|(a, b)| a == b).count();
            count.different += (a.len().max(b.len()) - same) as u64;
        }
    }

    fn text(&self, a: &str, b: &str) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _infallible = self.write(&mut text, a, b);
        text
    }

    fn write(&self, text: &mut String, a: &str, b: &str) -> std::fmt::Result {
        if self.equal {
            let messages: u64 = self.topics.iter().map(|count| count.a).sum();
            return writeln!(text, "the runs are equal: {} messages", grouped(messages));
        }
        writeln!(text, "A  {a}\nB  {b}")?;
        for FieldOutcome { field, a, b } in &self.runs {
            writeln!(text, "different {field}: {} in A, {} in B", plain(a), plain(b))?;
        }
        if let Some(first) = &self.first {
            let who = match (&first.auv, &first.name) {
                (Some(auv), Some(name)) => format!("AUV {auv} ({name}), "),
                (Some(auv), None) => format!("AUV {auv}, "),
                (None, _) => String::new(),
            };
            write!(text, "the first event that differs: {who}{:.9} s, {}", first.t_s, first.topic)?;
            match first.only_in {
                Some("a") => writeln!(text, ", only in A")?,
                Some(_) => writeln!(text, ", only in B")?,
                None => writeln!(text)?,
            }
            let width = first.fields.iter().map(|field| field.field.len()).max().unwrap_or(0);
            for FieldOutcome { field, a, b } in &first.fields {
                writeln!(text, "  {field:width$}  {} in A, {} in B", plain(a), plain(b))?;
            }
        }
        writeln!(text, "\n{:10}  {:>10}  {:>10}  {:>10}", "messages", "in A", "in B", "different")?;
        for Count { topic, a, b, different } in self.topics.iter().filter(|count| count.a + count.b > 0) {
            writeln!(
                text,
                "{topic:10}  {:>10}  {:>10}  {:>10}",
                grouped(*a),
                grouped(*b),
                grouped(*different)
            )?;
        }
        Ok(())
    }
}

/// A value as people write it.
pub fn plain(of: &Value) -> String {
    match of {
        Value::Null => "nothing".to_owned(),
        Value::String(text) => format!("`{text}`"),
        other => other.to_string(),
    }
}
