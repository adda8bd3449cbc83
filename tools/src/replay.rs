//! `shoal replay`: what today's minds make of what was recorded.
//!
//! | file | idea |
//! |---|---|
//! | `tape.rs` | what a record holds for it, batch by batch |
//! | `stage.rs` | the live AUVs: processes on the shared-memory bus, or minds in this program |
//! | `estimator.rs` | another estimator |
//! | `judge.rs` | recorded and replayed answers compared |
//! | `outcome.rs` | what came of it, as text and JSON |
//! | `pace.rs` | how fast, and when to wait for a key |

mod estimator;
mod judge;
mod outcome;
mod pace;
mod stage;
mod tape;

use std::io::Write;
use std::num::NonZeroU32;
use std::path::PathBuf;
use std::sync::atomic::Ordering;

use clap::{Args, ValueEnum};
use shoal_bus::lockstep::{Batch, Loss};
use shoal_bus::message::AuvId;
use shoal_bus::record::rows::ReportRow;
use shoal_bus::time::SimTime;

use crate::cli::{Pace, parse_pace};
use crate::exit::Exit;
use crate::failure::{Failure, While};
use crate::record::batches::Batches;
use crate::record::select::parse_time;
use crate::record::source::Record;
use crate::run::interrupts;
use judge::Judge;
use outcome::Outcome;
use pace::{Pacer, Word};
use stage::Stage;
use tape::{Tape, Telling};

/// What to replay, and how.
#[derive(Debug, Args)]
pub struct ReplayArgs {
    /// The record, as `shoal run --record` leaves it
    pub record: PathBuf,
    /// Another estimator for all: `tube`, `ekf`, `dead-reckoning`, or a table as in a scenario, such as `{ name = "tube", rings = 0 }`
    #[arg(long, value_name = "KIND")]
    pub estimator: Option<String>,
    /// Only these AUVs, by number or name; can be given many times
    #[arg(long = "auv", value_name = "N")]
    pub auvs: Vec<String>,
    /// What carries the messages
    #[arg(long, value_enum, default_value_t = Carrier::Iceoryx2)]
    pub bus: Carrier,
    /// Put so many AUVs into each process
    #[arg(long, value_name = "K", default_value = "1")]
    pub auvs_per_process: NonZeroU32,
    /// Compare from this simulated second on; AUVs are told everything from their birth on all the same, as their minds remember
    #[arg(long, value_name = "SECONDS", value_parser = parse_time)]
    pub from: Option<SimTime>,
    /// End at this simulated second
    #[arg(long, value_name = "SECONDS", value_parser = parse_time)]
    pub to: Option<SimTime>,
    /// `max`, or simulated seconds per second of wall clock, from --from on
    #[arg(long, default_value = "max", value_parser = parse_pace)]
    pub rate: Pace,
    /// Wait at --from until Enter is pressed; Enter stops and goes on from then on, `q` ends
    #[arg(long)]
    pub pause: bool,
    /// Wait again after so many simulated seconds: Enter goes on by as much, `c` without stopping, `q` ends
    #[arg(long, value_name = "SECONDS", value_parser = parse_step)]
    pub step: Option<f64>,
    /// Print what came of it as one JSON line
    #[arg(long)]
    pub json: bool,
    /// Do not tell where answers begin to differ while they do
    #[arg(long, short)]
    pub quiet: bool,
}

/// What carries the messages of a replay.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Carrier {
    /// No processes: the minds in this program
    Local,
    /// A process for each AUV, shared memory between them and this one
    Iceoryx2,
}

/// Replays, and prints what came of it.
pub fn run(args: &ReplayArgs) -> Result<Exit, Failure> {
    if args.from.zip(args.to).is_some_and(|(from, to)| to <= from) {
        return Err(Failure::usage("--to must be later than --from"));
    }
    let estimator = args.estimator.as_deref().map(estimator::named).transpose()?;
    let interrupted = interrupts().while_doing("watch for Ctrl-C")?;
    let mut tape = Tape::open(Batches::new(Record::open(&args.record)?), &args.auvs)?;
    let mut born = tape.born()?;
    if let Some(estimator) = estimator {
        born.iter_mut().for_each(|born| born.orders.estimator = estimator);
    }
    let mut judge = Judge::new(&born, tape.names(), args.from, args.quiet);
    let mut stage = Stage::open(args, &tape.description(), &born, &interrupted)?;
    let mut pacer = Pacer::new(args.rate, args.from, args.pause, args.step);
    let mut losses: Vec<Loss> = Vec::new();
    let mut is_interrupted = false;
    while let Some(telling) = tape.next(args.to)? {
        match pacer.until(telling.at, &interrupted, &judge) {
            Word::GoOn => {}
            Word::End => {
                is_interrupted = true;
                break;
            }
        }
        let Some(answers) = stage.tell(&telling.sensed)? else {
            is_interrupted = true;
            break;
        };
        for loss in answers.losses {
            eprintln!("warning: AUV {} is lost: {}", loss.auv, loss.reason);
            tape.forget(loss.auv);
            losses.push(loss);
        }
        judge.take(&telling, replayed(&telling, &answers.acted));
    }
    is_interrupted |= interrupted.load(Ordering::Acquire);
    stage.close();
    let reading = tape.end();
    let outcome = Outcome::new(args, &tape, judge, &losses);
    let text = if args.json {
        serde_json::to_string(&outcome).while_doing("print the outcome")? + "\n"
    } else {
        outcome.text()
    };
    // Whoever closed our output does not want the outcome; the exit code still tells.
    let _closed = std::io::stdout().lock().write_all(text.as_bytes());
    Ok(if outcome.broke_promises() {
        Exit::Violated
    } else if outcome.diverged() {
        Exit::Failed
    } else if is_interrupted || !losses.is_empty() {
        Exit::Loss
    } else {
        reading
    })
}

/// The answers as rows, by AUV, in the order of their ticks.
fn replayed(telling: &Telling, acted: &[Batch<shoal_bus::message::Acted>]) -> Vec<(AuvId, Vec<ReportRow>)> {
    let rows = |batch: &Batch<shoal_bus::message::Acted>| {
        let times = telling.times(batch.auv);
        let each = batch.items.iter().zip(times);
        let rows = each.map(|(acted, (at, local))| ReportRow::new(*at, batch.auv, Some(*local), acted));
        (batch.auv, rows.collect())
    };
    acted.iter().map(rows).collect()
}

fn parse_step(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok().filter(|seconds| (1e-3..=1e9).contains(seconds));
    seconds.ok_or_else(|| "give simulated seconds, such as `0.5`".to_owned())
}
