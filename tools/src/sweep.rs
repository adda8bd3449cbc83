//! `shoal sweep`: runs a scenario for many seeds and values of its keys, a run on each core, and prints one table.
//!
//! | file | idea |
//! |---|---|
//! | `axes.rs` | seeds and values to go over |
//! | `crew.rs` | runs side by side |
//! | `journal.rs` | runs on disk, so that a sweep goes on where it was stopped |
//! | `figures.rs` | the numbers of a run, and what they come to over seeds |
//! | `table.rs` | the table |

mod axes;
mod crew;
mod figures;
mod journal;
mod table;

use std::collections::BTreeMap;
use std::io::Write;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde::{Deserialize, Serialize};
use shoal_auv::Auv;
use shoal_bus::local::Local;
use shoal_bus::lockstep::Fleet;
use shoal_bus::summary::Summary;
use shoal_channel::channel::Channel;
use shoal_scenario::{Scenario, load};

pub use axes::{Axis, Seeds};

use crate::agent_process::needs_no_processes;
use crate::cli::{Changes, Pace, SweepArgs};
use crate::drive::{Ending, Plan, drive};
use crate::exit::Exit;
use crate::failure::{Failure, While};
use crate::run::interrupts;
use crate::scenario_order::{scenario, with_settings};
use crate::set::Setting;
use axes::combinations;
use crew::side_by_side;
use figures::Figures;
use journal::{Entry, Header, Journal};

/// One combination of values, and what came of it.
struct Row {
    settings: Vec<Setting>,
    outcome: Outcome,
}

/// What came of a combination.
enum Outcome {
    /// Each seed with what came of it.
    Ran(Vec<(u64, RunOutcome)>),
    /// It is no scenario: the reason in one line.
    Refused(String),
}

/// What came of one run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RunOutcome {
    /// What it amounts to.
    Ran(Box<Summary>),
    /// Why it did not get to its end.
    Failed(String),
}

impl RunOutcome {
    fn summary(&self) -> Option<&Summary> {
        match self {
            Self::Ran(summary) => Some(summary),
            Self::Failed(_) => None,
        }
    }

    /// What went wrong in it, in one line.
    fn trouble(&self) -> Option<String> {
        let summary = match self {
            Self::Ran(summary) => summary,
            Self::Failed(reason) => return Some(format!("failed: {reason}")),
        };
        if let Some(first) = summary.containment.first.first() {
            let (violations, name, time_s) = (summary.containment.violations, &first.name, first.time_s);
            let (enclosure, coordinate) = (&first.enclosure, &first.coordinate);
            return Some(format!(
                "violations: {violations}, at first the {enclosure} of {name} in {coordinate} at {time_s} s"
            ));
        }
        let lost = summary.agents.lost.first()?;
        let (count, name, reason) = (summary.agents.lost.len(), &lost.name, &lost.reason);
        Some(format!("AUVs lost: {count}, at first {name} at {} s: {reason}", lost.time_s))
    }
}

/// A combination of values that is a scenario, or why it is none.
struct Combination {
    settings: Vec<Setting>,
    scenario: Result<Scenario, Failure>,
}

/// One run to carry out.
struct Task<'a> {
    settings: &'a [Setting],
    scenario: Scenario,
}

impl Task<'_> {
    fn key(&self) -> (Vec<(String, String)>, u64) {
        let set = self.settings.iter().map(|setting| (setting.key().to_owned(), setting.toml()));
        (set.collect(), self.scenario.seed)
    }
}

/// Runs every combination with every seed and prints the table.
pub fn sweep(args: &SweepArgs) -> Result<Exit, Failure> {
    axes::check(&args.axes, args.seeds.is_some())?;
    let (source_name, text) = load(&args.scenario).map_err(Failure::usage)?;
    let interrupted = interrupts().while_doing("watch for Ctrl-C")?;
    let combinations = read(&source_name, &text, &args.axes, &args.changes);
    let tasks = tasks(&combinations, args.seeds.as_ref());

    let mut known = BTreeMap::new();
    let mut journal = None;
    if let Some(path) = runs_path(args) {
        let (opened, entries) = Journal::open(&path, &Header::new(&args.scenario, &text, &args.changes))?;
        known.extend(entries.into_iter().map(|entry| ((entry.set, entry.seed), entry.outcome)));
        journal = Some(opened);
    }
    let mut outcomes: Vec<Option<RunOutcome>> = tasks.iter().map(|task| known.remove(&task.key())).collect();
    let missing: Vec<usize> = (0..tasks.len()).filter(|&index| outcomes[index].is_none()).collect();
    let bar = bar(tasks.len(), tasks.len() - missing.len(), args.quiet);
    let jobs = args.jobs.map_or_else(cores, |jobs| jobs as usize);
    let carry_out =
        |&index: &usize| attempt(&tasks[index].scenario, &|scenario| carry_out(scenario, &interrupted));
    side_by_side(&missing, jobs, carry_out, |nth, outcome: Option<RunOutcome>| {
        let Some(outcome) = outcome else { return Ok(()) };
        let task = &tasks[missing[nth]];
        bar.set_message(format!("{} seed {}", describe(task.settings), task.scenario.seed));
        bar.inc(1);
        if let Some(journal) = &mut journal {
            let (set, seed) = task.key();
            journal.append(&Entry { set, seed, outcome: outcome.clone() })?;
        }
        outcomes[missing[nth]] = Some(outcome);
        Ok(())
    })?;
    bar.finish_and_clear();
    let is_interrupted = outcomes.iter().any(Option::is_none);
    report(args, &rows(combinations, &args.seeds, outcomes), is_interrupted)
}

/// Where runs are kept: where the user says, or beside the table.
fn runs_path(args: &SweepArgs) -> Option<PathBuf> {
    args.runs.clone().or_else(|| Some(args.csv.as_ref()?.with_extension("runs.jsonl")))
}

fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// All combinations as scenarios.
fn read(source_name: &str, text: &str, axes: &[Axis], changes: &Changes) -> Vec<Combination> {
    let of = |settings: Vec<Setting>| {
        let scenario = with_settings(source_name, text, &settings)
            .and_then(|(name, text)| scenario(&name, &text, None, changes))
            .and_then(without_commands);
        Combination { settings, scenario }
    };
    combinations(axes).into_iter().map(of).collect()
}

/// The scenario, unless some of its AUVs are programs of their own, which have no place here.
fn without_commands(scenario: Scenario) -> Result<Scenario, Failure> {
    match scenario.groups.iter().find(|group| group.command.is_some()) {
        None => Ok(scenario),
        Some(group) => Err(Failure::usage(format!(
            "the AUVs of group `{}` are programs of their own, and a sweep has no processes: remove its `command`, or use `shoal run`",
            group.name
        ))),
    }
}

/// Every combination that is a scenario with every seed, in the order of the table.
fn tasks<'a>(combinations: &'a [Combination], seeds: Option<&Seeds>) -> Vec<Task<'a>> {
    let mut tasks = Vec::new();
    for Combination { settings, scenario } in combinations {
        let Ok(scenario) = scenario else { continue };
        let seeds = seeds.map_or_else(|| vec![scenario.seed], |seeds| seeds.0.clone());
        tasks.extend(
            seeds.into_iter().map(|seed| Task { settings, scenario: Scenario { seed, ..scenario.clone() } }),
        );
    }
    tasks
}

/// The table's rows: of combinations whose runs are all there.
fn rows(
    combinations: Vec<Combination>,
    seeds: &Option<Seeds>,
    outcomes: Vec<Option<RunOutcome>>,
) -> Vec<Row> {
    let mut outcomes = outcomes.into_iter();
    let mut rows = Vec::new();
    for Combination { settings, scenario } in combinations {
        let outcome = match scenario {
            Ok(scenario) => {
                let seeds = seeds.as_ref().map_or_else(|| vec![scenario.seed], |seeds| seeds.0.clone());
                let ran: Option<Vec<_>> =
                    seeds.into_iter().zip(outcomes.by_ref()).map(|(seed, of)| Some((seed, of?))).collect();
                let Some(ran) = ran else { continue };
                Outcome::Ran(ran)
            }
            Err(failure) => {
                eprintln!("{}{}", described(&settings), failure.message.trim_end());
                Outcome::Refused(first_line(&failure))
            }
        };
        rows.push(Row { settings, outcome });
    }
    rows
}

fn report(args: &SweepArgs, rows: &[Row], is_interrupted: bool) -> Result<Exit, Failure> {
    if is_interrupted {
        let how = match runs_path(args) {
            Some(path) => format!("the same command goes on from {}", path.display()),
            None => "with --csv or --runs the same command would go on from here".to_owned(),
        };
        eprintln!("warning: interrupted; the table has the combinations that were complete; {how}");
    }
    let keys: Vec<&str> = args.axes.iter().map(Axis::key).collect();
    // A reader that has enough closes the pipe.
    let text = table::text(&args.scenario, &keys, rows);
    let _closed = std::io::stdout().lock().write_all(text.as_bytes());
    if let Some(path) = &args.csv {
        std::fs::write(path, table::csv(&keys, rows))
            .map_err(|error| Failure::failed(format!("{}: cannot be written: {error}", path.display())))?;
    }
    Ok(exit(rows, is_interrupted))
}

/// The gravest of what happened: a violation, then a run that failed, then a refusal of all, then one of some, or the loss of an AUV.
fn exit(rows: &[Row], is_interrupted: bool) -> Exit {
    let ran = || {
        rows.iter().filter_map(|row| if let Outcome::Ran(runs) = &row.outcome { Some(runs) } else { None })
    };
    let runs = || ran().flatten().map(|(_, outcome)| outcome);
    let summaries = || runs().filter_map(RunOutcome::summary);
    let refused = rows.len() - ran().count();
    if summaries().any(|summary| summary.containment.violations > 0) {
        Exit::Violated
    } else if runs().any(|outcome| matches!(outcome, RunOutcome::Failed(_))) {
        Exit::Failed
    } else if refused > 0 && refused == rows.len() {
        Exit::Usage
    } else if refused > 0 || is_interrupted || summaries().any(|summary| !summary.agents.lost.is_empty()) {
        Exit::Loss
    } else {
        Exit::Good
    }
}

/// One run, whatever becomes of it; `None` when the user stopped it.
fn attempt(
    scenario: &Scenario,
    carry_out: &dyn Fn(&Scenario) -> Result<Option<Summary>, Failure>,
) -> Option<RunOutcome> {
    match catch_unwind(AssertUnwindSafe(|| carry_out(scenario))) {
        Ok(Ok(summary)) => summary.map(|summary| RunOutcome::Ran(Box::new(summary))),
        Ok(Err(failure)) => Some(RunOutcome::Failed(first_line(&failure))),
        Err(panic) => {
            let words = panic.downcast_ref::<String>().map(String::as_str);
            let words = words.or(panic.downcast_ref::<&str>().copied()).unwrap_or("without a word");
            Some(RunOutcome::Failed(format!(
                "a bug in shoal, it panicked: {}",
                words.lines().next().unwrap_or("")
            )))
        }
    }
}

/// One run without processes; `None` when the user stopped it.
fn carry_out(scenario: &Scenario, interrupted: &AtomicBool) -> Result<Option<Summary>, Failure> {
    if interrupted.load(Ordering::Acquire) {
        return Ok(None);
    }
    needs_no_processes(scenario, "sweep it with `shoal run` in a loop")?;
    let mut channel = Channel::new(scenario).map_err(Failure::failed)?;
    let mut fleet = Local::new(Auv::new);
    let losses = fleet.born(&channel.born()).map_err(Failure::failed)?;
    channel.stillborn(losses);
    let plan = Plan { window_ns: scenario.window_ns, pace: Pace::Max, abort_on_crash: false };
    let is_interrupted = || interrupted.load(Ordering::Acquire);
    let ending = drive(&mut channel, &mut fleet, &plan, &mut [], &is_interrupted)?;
    Ok((ending == Ending::Complete).then(|| channel.summary()))
}

fn bar(runs: usize, done: usize, hidden: bool) -> ProgressBar {
    let target = if hidden { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
    let bar = ProgressBar::with_draw_target(Some(runs as u64), target).with_position(done as u64);
    if let Ok(style) = ProgressStyle::with_template("{pos} of {len} runs {bar:32} {elapsed_precise} {msg}") {
        bar.set_style(style);
    }
    bar
}

fn first_line(failure: &Failure) -> String {
    let line = failure.message.lines().next().unwrap_or_default();
    line.trim_start_matches("error: ").to_owned()
}

/// `KEY=VALUE KEY=VALUE`.
fn describe(settings: &[Setting]) -> String {
    settings.iter().map(Setting::to_string).collect::<Vec<_>>().join(" ")
}

/// As [`describe`], to stand before an error of that combination.
fn described(settings: &[Setting]) -> String {
    if settings.is_empty() { String::new() } else { format!("with {}: ", describe(settings)) }
}

#[cfg(test)]
mod tests;
