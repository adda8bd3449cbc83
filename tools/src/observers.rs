//! Who looks on: the record, the tap, the progress.

use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use shoal_bus::chronicle::Entry;
use shoal_bus::message::Born;
use shoal_bus::record::{RecordHeader, RecordWriter, RecordedAuv};
use shoal_bus::run_dir::RunDir;
use shoal_bus::summary::Summary;
use shoal_bus::tap::{Cast, LiveTopic, TapPublisher};
use shoal_bus::time::SimTime;
use shoal_scenario::Scenario;

use crate::drive::Observer;
use crate::failure::Failure;

/// Writes the record. When the disk fails, the run goes on without it and says so at the end.
pub struct Recorder {
    path: PathBuf,
    writer: Option<RecordWriter<BufWriter<File>>>,
    failure: Option<String>,
}

impl Recorder {
    /// Begins the record at `path`.
    pub fn create(path: &Path, scenario: &Scenario, text: &str, born: &[Born]) -> Result<Self, Failure> {
        let wrong = |error: &dyn std::fmt::Display| {
            Failure::failed(format!("{}: {error}; choose another place with --record", path.display()))
        };
        let file =
            File::create(path).map_err(|error| wrong(&format!("the record cannot be created: {error}")))?;
        let mut writer = RecordWriter::create(BufWriter::new(file), &header(scenario, text))
            .map_err(|error| wrong(&error))?;
        writer.born(born).map_err(|error| wrong(&error))?;
        Ok(Self { path: path.to_owned(), writer: Some(writer), failure: None })
    }

    /// Ends the record. The sentence says what is missing from it, if something is.
    pub fn finish(mut self, summary: &Summary) -> Option<String> {
        if let Some(writer) = self.writer.take() {
            let outcome = writer.finish(summary).map(drop);
            self.note(outcome);
        }
        self.failure
    }

    fn note<E: std::fmt::Display>(&mut self, outcome: Result<(), E>) {
        if let Err(error) = outcome {
            let path = self.path.display();
            self.failure = Some(format!("the record {path} is incomplete: {error}"));
            self.writer = None;
        }
    }
}

impl Observer for Recorder {
    fn window(&mut self, to: SimTime, entries: &[Entry]) {
        let Some(writer) = self.writer.as_mut() else { return };
        let outcome = writer.append(entries).and_then(|()| writer.advance(to));
        self.note(outcome);
    }
}

fn header(scenario: &Scenario, text: &str) -> RecordHeader {
    RecordHeader {
        scenario_name: scenario.name.clone(),
        seed: scenario.seed,
        scenario_text: text.to_owned(),
        auvs: recorded_auvs(scenario),
    }
}

fn recorded_auvs(scenario: &Scenario) -> Vec<RecordedAuv> {
    let of_group = |(index, group): (usize, &shoal_scenario::Group)| {
        let (group_name, length_m) = (group.name.clone(), group.kind.length_m);
        (0..group.count)
            .map(move |k| RecordedAuv {
                name: format!("{group_name}-{k}"),
                group: index as u16,
                group_name: group_name.clone(),
                length_m,
            })
            .collect::<Vec<_>>()
    };
    scenario.groups.iter().enumerate().flat_map(of_group).collect()
}

/// Publishes the run for whoever taps.
pub struct Tapped {
    publisher: Option<TapPublisher>,
}

impl Tapped {
    /// Opens the run for taps. A run whose tap cannot be opened goes on without; the sentence says why.
    pub fn create(run: &RunDir, scenario: &Scenario, text: &str, born: Vec<Born>) -> (Self, Option<String>) {
        match TapPublisher::create(run, Cast { header: header(scenario, text), born }) {
            Ok(publisher) => (Self { publisher: Some(publisher) }, None),
            Err(error) => (Self { publisher: None }, Some(format!("this run cannot be tapped: {error}"))),
        }
    }

    /// Tells the taps that the run is over, and how it went.
    pub fn end(self, summary: &Summary) {
        if let Some(publisher) = self.publisher {
            // A tap that is gone does not matter to the run.
            let _gone = publisher.end(Some(summary));
        }
    }
}

impl Observer for Tapped {
    fn window(&mut self, to: SimTime, entries: &[Entry]) {
        let Some(publisher) = self.publisher.as_mut() else { return };
        if publisher.publish(to, entries).is_err() {
            self.publisher = None;
        }
    }

    fn watches_flock(&self) -> bool {
        self.publisher.as_ref().is_some_and(|publisher| publisher.is_heard(LiveTopic::Flock))
    }
}

/// Says now and then how far the run is.
pub struct Progress<F> {
    say: F,
    said: Instant,
}

impl<F: FnMut(f64)> Progress<F> {
    /// Calls `say` with simulated seconds, at most ten times a second.
    pub fn new(say: F) -> Self {
        Self { say, said: Instant::now() }
    }
}

impl<F: FnMut(f64)> Observer for Progress<F> {
    fn window(&mut self, to: SimTime, _: &[Entry]) {
        if self.said.elapsed() >= Duration::from_millis(100) {
            self.said = Instant::now();
            (self.say)(to.as_s());
        }
    }
}
