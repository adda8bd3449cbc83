//! A record, read as if it were a live run.

use std::fs::File;
use std::path::Path;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};

use shoal_bus::record::{BATCH_NS, Ending, RecordHeader, Row, Topic, read_rows};
use shoal_bus::tap::Cast;
use shoal_bus::time::SimTime;

use crate::failure::{Failure, While};

/// Batches that are read ahead.
const AHEAD: usize = 16;

/// A record that is being read, by a thread of its own: it may be left at any time.
pub struct FileSource {
    batches: Receiver<Found>,
    pub cast: Option<Cast>,
    /// How far it has been read.
    pub read_to: SimTime,
    /// Whether the file ended before the run did.
    pub is_cut: bool,
}

/// What the thread has found.
enum Found {
    Cast(Box<Cast>),
    /// Rows of one batch, sorted by time, and its end.
    Rows(SimTime, Vec<Row>),
    End(Ending),
    Failed(String),
}

/// What comes next from a file.
pub enum Next {
    Rows(SimTime, Vec<Row>),
    End,
}

impl FileSource {
    /// Opens the record at `path` for the rows of `topics`.
    pub fn open(path: &Path, topics: &[Topic]) -> Result<Self, Failure> {
        let file =
            File::open(path).map_err(|error| Failure::failed(format!("{}: {error}", path.display())))?;
        let (sender, batches) = sync_channel(AHEAD);
        let mut topics = topics.to_vec();
        topics.push(Topic::Born);
        let path = path.to_owned();
        std::thread::Builder::new()
            .name("record".to_owned())
            .spawn(move || read(file, &path, &topics, &sender))
            .while_doing("start a thread")?;
        let mut source = Self { batches, cast: None, read_to: SimTime::ZERO, is_cut: false };
        // The beginning of a file comes first; what is no record fails here.
        if let Found::Cast(cast) = source.receive()? {
            source.cast = Some(*cast);
        }
        Ok(source)
    }

    /// The next batch that has rows.
    pub fn next(&mut self) -> Result<Next, Failure> {
        loop {
            match self.receive()? {
                Found::Cast(_) => {}
                Found::Rows(end, rows) => {
                    self.read_to = end;
                    return Ok(Next::Rows(end, rows));
                }
                Found::End(ending) => {
                    self.is_cut = ending != Ending::Complete;
                    return Ok(Next::End);
                }
                Found::Failed(_) => return Ok(Next::End),
            }
        }
    }

    fn receive(&mut self) -> Result<Found, Failure> {
        match self.batches.recv() {
            Ok(Found::Failed(sentence)) => Err(Failure::failed(sentence)),
            Ok(found) => Ok(found),
            Err(_) => Ok(Found::End(Ending::Complete)),
        }
    }
}

fn read(file: File, path: &Path, topics: &[Topic], sender: &SyncSender<Found>) {
    let mut batching = Batching { sender, header: None, born: Vec::new(), end: None, rows: Vec::new() };
    let outcome = read_rows(file, topics, &mut |row| batching.take(row));
    batching.tell_cast();
    batching.flush();
    // Whoever left does not want to know.
    let _left = sender.send(match outcome {
        Ok(ending) => Found::End(ending),
        Err(error) => Found::Failed(format!("{}: {error}", path.display())),
    });
}

/// Gathers rows until a batch is complete, since a record has the topics one behind the other.
struct Batching<'s> {
    sender: &'s SyncSender<Found>,
    header: Option<RecordHeader>,
    born: Vec<shoal_bus::message::Born>,
    end: Option<SimTime>,
    rows: Vec<Row>,
}

impl Batching<'_> {
    fn take(&mut self, row: Row) {
        match row {
            Row::Header(header) => self.header = Some(header),
            Row::Born(born) => self.born.push(*born),
            row => {
                self.tell_cast();
                let end = batch_end(row.at());
                if self.end != Some(end) {
                    self.flush();
                    self.end = Some(end);
                }
                self.rows.push(row);
            }
        }
    }

    fn tell_cast(&mut self) {
        if let Some(header) = self.header.take() {
            let born = std::mem::take(&mut self.born);
            let _left = self.sender.send(Found::Cast(Box::new(Cast { header, born })));
        }
    }

    fn flush(&mut self) {
        if let Some(end) = self.end.take() {
            let mut rows = std::mem::take(&mut self.rows);
            rows.sort_by_key(Row::at);
            let _left = self.sender.send(Found::Rows(end, rows));
        }
    }
}

/// The end of the batch that holds `at`.
fn batch_end(at: SimTime) -> SimTime {
    SimTime::from_ns(at.ns().max(0).saturating_add(BATCH_NS - 1) / BATCH_NS * BATCH_NS)
}
