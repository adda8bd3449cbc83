//! The runs of a sweep on disk, so that a sweep that was stopped goes on: a line for what they have in common, then one for each run
//! that ended, each on the disk before the next is written.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::RunOutcome;
use crate::cli::Changes;
use crate::failure::Failure;

/// Format tag of the first line.
const FORMAT: &str = "shoal.sweep/1";

/// What all runs of a journal have in common: the first line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    format: String,
    /// Name of the scenario, as it was asked for.
    scenario: String,
    /// Hash of its text.
    text: String,
    /// Changes with a flag of their own.
    changes: Changes,
    /// Which program made the runs.
    program: String,
}

impl Header {
    /// Of the runs that this program makes of a scenario.
    pub fn new(scenario: &str, text: &str, changes: &Changes) -> Self {
        let hash = |bytes: &[u8]| format!("blake3:{}", blake3::hash(bytes).to_hex());
        // Two builds of one version may differ in what they do.
        let own =
            std::env::current_exe().and_then(std::fs::read).map_or_else(|_| String::new(), |own| hash(&own));
        Self {
            format: FORMAT.to_owned(),
            scenario: scenario.to_owned(),
            text: hash(text.as_bytes()),
            // Windows never change a result.
            changes: Changes { window_ms: None, ..changes.clone() },
            program: format!("{} {own}", env!("CARGO_PKG_VERSION")),
        }
    }

    /// Why runs of `found` cannot stand beside runs of this.
    fn difference(&self, found: &Self) -> Option<&'static str> {
        let differences = [
            (self.format != found.format, "was written by another version of shoal"),
            (
                self.text != found.text,
                "has runs of another scenario, or of this one as it was before it was edited",
            ),
            (self.changes != found.changes, "has runs with another --auvs, --duration or --noise"),
            (self.program != found.program, "has runs of another build of shoal"),
        ];
        differences.into_iter().find(|(differs, _)| *differs).map(|(_, what)| what)
    }
}

/// One run that ended: a line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// Keys with their values, as TOML.
    pub set: Vec<(String, String)>,
    /// Seed of every random draw.
    pub seed: u64,
    /// What came of it.
    pub outcome: RunOutcome,
}

/// A file of runs.
pub struct Journal {
    path: PathBuf,
    file: File,
}

impl Journal {
    /// Opens the file at `path`, or makes it, and reads the runs in it. A last line that was not written to its end is removed.
    ///
    /// # Errors
    /// When the file cannot be read or written, another sweep has it open, it is something else, a line of it is damaged, or its runs
    /// are of another scenario, with other changes, or of another program.
    pub fn open(path: &Path, header: &Header) -> Result<(Self, Vec<Entry>), Failure> {
        let refuse = |why: &str| {
            Failure::usage(format!(
                "{} {why}: delete it to begin anew, or name another file with --runs",
                path.display()
            ))
        };
        let broken = |error: std::io::Error| {
            Failure::failed(format!("the runs cannot be kept in {}: {error}", path.display()))
        };
        let file = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path);
        let mut file = file.map_err(broken)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                let path = path.display();
                return Err(Failure::usage(format!(
                    "another sweep is at work on {path}: wait for it, or name another file with --runs"
                )));
            }
            // A file system without locks.
            Err(TryLockError::Error(_)) => {}
        }
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(broken)?;
        let whole = bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |at| at + 1);
        let mut lines = bytes[..whole].split_inclusive(|&byte| byte == b'\n');
        let first = line(header)?;
        let mut journal = Self { path: path.to_owned(), file };
        let Some(found) = lines.next() else {
            // Nothing, or a piece of what would be written now: all else is somebody's file.
            if !first.starts_with(&bytes) {
                return Err(refuse("holds no runs of a sweep"));
            }
            journal.cut(0).and_then(|()| journal.write(&first)).map_err(broken)?;
            return Ok((journal, Vec::new()));
        };
        let found: Header = serde_json::from_slice(found).map_err(|_| refuse("holds no runs of a sweep"))?;
        if let Some(what) = header.difference(&found) {
            return Err(refuse(what));
        }
        let entries = lines.enumerate().map(|(index, line)| {
            serde_json::from_slice(line).map_err(|_| refuse(&format!("is damaged in line {}", index + 2)))
        });
        let entries = entries.collect::<Result<_, _>>()?;
        journal.cut(whole as u64).map_err(broken)?;
        Ok((journal, entries))
    }

    /// Adds a run; it is on the disk when this returns.
    ///
    /// # Errors
    /// When the disk does not take it.
    pub fn append(&mut self, entry: &Entry) -> Result<(), Failure> {
        let line = line(entry)?;
        self.write(&line).map_err(|error| {
            Failure::failed(format!("a run cannot be kept in {}: {error}", self.path.display()))
        })
    }

    fn cut(&mut self, length: u64) -> std::io::Result<()> {
        self.file.set_len(length)?;
        self.file.seek(SeekFrom::Start(length)).map(drop)
    }

    fn write(&mut self, line: &[u8]) -> std::io::Result<()> {
        self.file.write_all(line)?;
        self.file.sync_data()
    }
}

fn line(of: &impl Serialize) -> Result<Vec<u8>, Failure> {
    let mut line = serde_json::to_vec(of).map_err(Failure::failed)?;
    line.push(b'\n');
    Ok(line)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exit::Exit;

    fn header() -> Header {
        Header::new(
            "a",
            "name = \"a\"",
            &Changes { auvs: Some(3), window_ms: Some(9.0), ..Changes::default() },
        )
    }

    fn entry(seed: u64) -> Entry {
        let set = vec![("group.modem.range_m".to_owned(), "0.1".to_owned())];
        Entry { set, seed, outcome: RunOutcome::Failed(format!("reason {seed}")) }
    }

    #[test]
    fn a_file_cut_anywhere_gives_all_runs_before_the_cut_and_goes_on() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("runs");
        let header = header();
        let (mut journal, none) = Journal::open(&path, &header).unwrap();
        assert!(none.is_empty());
        (1..=3).for_each(|seed| journal.append(&entry(seed)).unwrap());
        drop(journal);
        let bytes = std::fs::read(&path).unwrap();
        let ends: Vec<usize> = (0..bytes.len()).filter(|&at| bytes[at] == b'\n').map(|at| at + 1).collect();
        assert_eq!(ends.len(), 4);
        for length in 0..=bytes.len() {
            std::fs::write(&path, &bytes[..length]).unwrap();
            let (mut journal, found) = Journal::open(&path, &header).unwrap();
            let kept = ends.iter().filter(|&&end| end <= length).count().saturating_sub(1);
            assert!(found.into_iter().eq((1..=kept as u64).map(entry)), "cut at {length}");
            (kept as u64 + 1..=3).for_each(|seed| journal.append(&entry(seed)).unwrap());
            drop(journal);
            assert!(std::fs::read(&path).unwrap() == bytes, "cut at {length}");
        }
    }

    #[test]
    fn what_does_not_belong_here_is_refused_and_left_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("runs");
        let refused = |header: &Header| {
            let before = std::fs::read(&path).unwrap();
            let Err(failure) = Journal::open(&path, header) else { panic!("it was taken") };
            assert_eq!(failure.exit, Exit::Usage);
            assert!(std::fs::read(&path).unwrap() == before);
            failure.message
        };
        drop(Journal::open(&path, &header()).unwrap());
        let other = Header::new("a", "name = \"a\" # edited", &header().changes);
        assert!(refused(&other).contains("another scenario"));
        let other = Header { changes: Changes::default(), ..header() };
        assert!(refused(&other).contains("--auvs"));
        let other = Header { program: "0.0.1".into(), ..header() };
        assert!(refused(&other).contains("another build"));
        let open = Journal::open(&path, &header()).unwrap();
        assert!(refused(&header()).contains("another sweep is at work"));
        drop(open);
        let mut bytes = std::fs::read(&path).unwrap();
        bytes.extend(b"{\"set\":\n{}\n");
        std::fs::write(&path, &bytes).unwrap();
        assert!(refused(&header()).contains("damaged in line 2"));
        for foreign in ["a table", "a table\nof numbers\n"] {
            std::fs::write(&path, foreign).unwrap();
            assert!(refused(&header()).contains("holds no runs"));
        }
    }
}
