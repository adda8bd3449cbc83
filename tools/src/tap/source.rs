//! Where messages come from: a live run or a record, through one door.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant, SystemTime};

use shoal_bus::os::give_way;
use shoal_bus::record::{Row, Topic};
use shoal_bus::run_dir::RunDir;
use shoal_bus::summary::Summary;
use shoal_bus::tap::{Cast, Counts, TapItem, TapSubscriber};
use shoal_bus::time::SimTime;

use super::args::OriginArgs;
use super::file::{FileSource, Next};
use super::live;
use crate::failure::{Failure, While};
use crate::run::interrupts;

/// How long one look at a live run lasts: how soon it notices Ctrl-C.
const LOOK: Duration = Duration::from_millis(100);

/// A live run or a record.
pub struct Source {
    from: From,
    interrupted: Arc<AtomicBool>,
    /// Messages between these times are wanted.
    begin: SimTime,
    end: Option<SimTime>,
    duration_ns: Option<i64>,
    timeout: Option<Duration>,
    /// When there was last a message that the user wants to know of.
    last_taken: Instant,
    summary: Option<Box<Summary>>,
}

enum From {
    Live(Box<TapSubscriber>),
    File(FileSource),
}

/// What comes next.
pub enum Heard {
    /// Messages, perhaps none.
    Window(Window),
    /// Nothing within a look at a live run.
    Nothing,
    /// The run, the file or the time asked for is over, or the user has enough.
    End,
}

/// Messages that happened together.
pub struct Window {
    /// All before this has been told.
    pub to: SimTime,
    /// Sorted by time.
    pub rows: Vec<Row>,
    /// How many each topic has had, in a live run.
    pub counts: Option<Counts>,
    /// When it was published by a live run.
    pub published: Option<SystemTime>,
}

impl Source {
    /// Attaches to the run, or opens the record, for the messages of `topics`.
    pub fn open(args: &OriginArgs, topics: &[Topic]) -> Result<Self, Failure> {
        let interrupted = interrupts().while_doing("listen to signals")?;
        let ns = |seconds: f64| (seconds * 1e9).round() as i64;
        let from = match &args.read {
            Some(path) => From::File(FileSource::open(path, topics)?),
            None => {
                // The run has the first word where processors are scarce. A system that refuses is no reason not to look.
                let _refused = give_way();
                From::Live(Box::new(live::attach(args, topics)?))
            }
        };
        Ok(Self {
            from,
            interrupted,
            begin: SimTime::from_ns(args.from.map_or(i64::MIN, ns)),
            end: args.to.map(|to| SimTime::from_ns(ns(to))),
            duration_ns: args.duration.map(ns),
            timeout: args.timeout.map(Duration::from_secs_f64),
            last_taken: Instant::now(),
            summary: None,
        })
    }

    /// The next messages; of a live run, waits a moment for them.
    ///
    /// # Errors
    /// When the run or the record cannot be read, or `--timeout` is over.
    pub fn next(&mut self) -> Result<Heard, Failure> {
        if self.interrupted.load(Ordering::Acquire) {
            return Ok(Heard::End);
        }
        let mut window = match self.receive()? {
            Heard::Window(window) => window,
            Heard::Nothing => return self.patience().map(|()| Heard::Nothing),
            Heard::End => return Ok(Heard::End),
        };
        if let (Some(duration_ns), true) = (self.duration_ns, window.to >= self.begin) {
            // It counts from the first thing that it could show.
            let began = window.rows.iter().map(Row::at).find(|at| *at >= self.begin).unwrap_or(window.to);
            let end = began.max(self.begin) + duration_ns;
            self.end = Some(self.end.map_or(end, |before| before.min(end)));
            self.duration_ns = None;
        }
        let (begin, end) = (self.begin, self.end);
        window.rows.retain(|row| row.at() >= begin && end.is_none_or(|end| row.at() <= end));
        self.patience()?;
        let is_past = window.rows.is_empty() && end.is_some_and(|end| window.to > end);
        Ok(if is_past { Heard::End } else { Heard::Window(window) })
    }

    fn receive(&mut self) -> Result<Heard, Failure> {
        match &mut self.from {
            From::Live(tap) => match tap.next(LOOK).while_doing("listen to the run")? {
                Some(TapItem::Window(window)) => Ok(Heard::Window(Window {
                    to: window.to,
                    rows: window.rows,
                    counts: Some(window.counts),
                    published: Some(window.published),
                })),
                Some(TapItem::End { summary, .. }) => {
                    self.summary = summary;
                    Ok(Heard::End)
                }
                None if !tap.run().is_live() => Ok(Heard::End),
                None => Ok(Heard::Nothing),
            },
            From::File(file) => match file.next()? {
                Next::Rows(to, mut rows) => {
                    if let Some(Row::Summary(summary)) = rows.last() {
                        self.summary = Some(summary.clone());
                    }
                    rows.retain(|row| !matches!(row, Row::Born(_)));
                    Ok(Heard::Window(Window { to, rows, counts: None, published: None }))
                }
                Next::End => Ok(Heard::End),
            },
        }
    }

    /// Tells that there was something for the user: `--timeout` begins anew.
    pub fn taken(&mut self) {
        self.last_taken = Instant::now();
    }

    fn patience(&self) -> Result<(), Failure> {
        match self.timeout {
            Some(timeout) if self.last_taken.elapsed() >= timeout => {
                Err(Failure::failed(format!("no message came within --timeout {} s", timeout.as_secs_f64())))
            }
            _ => Ok(()),
        }
    }

    /// Whether the user has enough.
    pub fn is_stopped(&self) -> bool {
        self.interrupted.load(Ordering::Acquire)
    }

    /// Who takes part: of a live run known with the first window.
    pub fn cast(&self) -> Option<&Cast> {
        match &self.from {
            From::Live(tap) => tap.cast(),
            From::File(file) => file.cast.as_ref(),
        }
    }

    /// Waits until it is known who takes part.
    pub fn await_cast(&mut self) -> Result<Option<Cast>, Failure> {
        while self.cast().is_none() {
            match self.next()? {
                Heard::End => break,
                Heard::Window(_) | Heard::Nothing => {}
            }
        }
        Ok(self.cast().cloned())
    }

    /// The live run.
    pub fn run(&self) -> Option<&RunDir> {
        match &self.from {
            From::Live(tap) => Some(tap.run()),
            From::File(_) => None,
        }
    }

    /// Whether everything is told since the run's beginning.
    pub fn is_from_beginning(&self) -> bool {
        let is_asked_for = self.begin <= SimTime::ZERO && self.end.is_none() && self.duration_ns.is_none();
        is_asked_for
            && match &self.from {
                From::Live(tap) => tap.since().is_some_and(|(_, counts)| counts == Counts::default()),
                From::File(file) => !file.is_cut,
            }
    }

    /// The run's outcome, once it was told.
    pub fn summary(&self) -> Option<&Summary> {
        self.summary.as_deref()
    }

    /// What is missing from what was told, as sentences.
    pub fn gaps(&self) -> Vec<String> {
        match &self.from {
            From::Live(tap) => tap
                .missed_of()
                .filter(|(_, missed)| *missed > 0)
                .map(|(topic, missed)| {
                    format!("this tap was too slow and missed {missed} messages of {}", topic.name())
                })
                .collect(),
            From::File(file) if file.is_cut => {
                vec![format!("the record ends before the run does, at {:.1} s", file.read_to.as_s())]
            }
            From::File(_) => Vec::new(),
        }
    }
}
