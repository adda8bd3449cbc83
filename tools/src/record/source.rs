//! A record that is read front to back, with its troubles.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::fs::File;
use std::path::{Path, PathBuf};

use shoal_bus::record::{Ending, Found, Message, RECORD_FORMAT, RecordReader, Topic, auvs_of};

use crate::exit::Exit;
use crate::failure::Failure;

/// A record, and what was said of it so far.
pub struct Record {
    path: PathBuf,
    reader: RecordReader<File>,
    /// What the first metadata record says.
    pub run: BTreeMap<String, String>,
    /// The scenario as it was run.
    pub scenario: String,
    /// Names of its AUVs, by index; known once `/auvs` was read.
    pub names: Vec<String>,
    damaged: u64,
    /// Whether it was read to its end.
    is_over: bool,
}

impl Record {
    /// Opens a record.
    pub fn open(path: &Path) -> Result<Self, Failure> {
        let file = File::open(path).map_err(|error| wrong(path, &error))?;
        let reader = RecordReader::new(file).map_err(|error| wrong(path, &error))?;
        Ok(Self {
            path: path.to_owned(),
            reader,
            run: BTreeMap::new(),
            scenario: String::new(),
            names: Vec::new(),
            damaged: 0,
            is_over: false,
        })
    }

    /// The next message; `None` at the end. What is damaged is told on stderr and stepped over.
    pub fn next(&mut self) -> Result<Option<Message<'_>>, Failure> {
        while let Some(found) = self.reader.next().map_err(|error| wrong(&self.path, &error))? {
            match found {
                Found::Metadata { name, entries } if name == "shoal" => {
                    let format = entries.get("format").cloned().unwrap_or_default();
                    if format != RECORD_FORMAT.to_string() {
                        return Err(wrong(
                            &self.path,
                            &format!(
                                "this record has format {format}, and this version of shoal reads format {RECORD_FORMAT}"
                            ),
                        ));
                    }
                    self.run = entries;
                }
                Found::Attachment { name, data } if name == "scenario.toml" => {
                    self.scenario = String::from_utf8_lossy(&data).into_owned();
                }
                Found::Damaged(wound) => {
                    self.damaged += 1;
                    eprintln!(
                        "warning: {}: damaged between bytes {} and {}: {}",
                        self.path.display(),
                        wound.from,
                        wound.to,
                        wound.damage
                    );
                }
                Found::Message(message) => {
                    if message.topic == Some(Topic::Auvs) {
                        let auvs = auvs_of(message.data).map_err(|error| wrong(&self.path, &error))?;
                        self.names = auvs.into_iter().map(|auv| auv.name).collect();
                    }
                    // The borrow checker cannot see that nothing is read any more once this is handed over.
                    return Ok(self.reader.last_message());
                }
                Found::Metadata { .. } | Found::Attachment { .. } => {}
            }
        }
        self.is_over = true;
        if self.run.is_empty() && self.damaged == 0 {
            let cause = match self.reader.ending() {
                Ending::Truncated { .. } => "it ends before it says of which run it is",
                Ending::Complete => "this MCAP file is not the record of a run",
            };
            return Err(wrong(&self.path, &cause));
        }
        Ok(None)
    }

    /// How its reading ended, for the exit code: said on stderr when something is missing. What was not read is not missed.
    pub fn end(&self) -> Exit {
        match self.reader.ending() {
            Ending::Truncated { readable_bytes } if self.is_over => {
                eprintln!(
                    "warning: {}: it was cut behind byte {readable_bytes}: `shoal record recover` makes a good record of the rest",
                    self.path.display()
                );
                Exit::Loss
            }
            _ if self.damaged > 0 => Exit::Loss,
            _ => Exit::Good,
        }
    }

    /// An error about this record.
    pub fn wrong(&self, error: &dyn Display) -> Failure {
        wrong(&self.path, error)
    }

    /// Who is meant by a number or a name; a sentence when nobody is.
    pub fn auv(&self, named: &str) -> Result<u32, Failure> {
        let by_number = named.parse().ok().filter(|auv: &u32| (*auv as usize) < self.names.len());
        let by_name = || self.names.iter().position(|name| name == named).map(|index| index as u32);
        by_number.or_else(by_name).ok_or_else(|| {
            let last = self.names.len().saturating_sub(1);
            Failure::usage(format!(
                "{}: there is no AUV `{named}`: give a number from 0 to {last}, or a name such as `{}`",
                self.path.display(),
                self.names.first().map_or("-", String::as_str)
            ))
        })
    }
}

/// An error about the record at `path`.
pub fn wrong(path: &Path, error: &dyn Display) -> Failure {
    Failure::failed(format!("{}: {error}", path.display()))
}
