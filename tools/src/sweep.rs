//! `shoal sweep`: runs a scenario for many seeds and values of its keys, one after the other in this process, and prints one
//! table.

mod axes;
mod figures;
mod table;

use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use shoal_auv::Auv;
use shoal_bus::local::Local;
use shoal_bus::lockstep::Fleet;
use shoal_bus::summary::Summary;
use shoal_channel::channel::Channel;
use shoal_scenario::{Scenario, load};

pub use axes::{Axis, Seeds};

use crate::agent_process::needs_no_processes;
use crate::cli::{Pace, SweepArgs};
use crate::drive::{Ending, Plan, drive};
use crate::exit::Exit;
use crate::failure::{Failure, While};
use crate::run::interrupts;
use crate::scenario_order::{scenario, with_settings};
use crate::set::Setting;
use axes::combinations;
use figures::Figures;

/// One combination of values, and what came of it.
struct Row {
    settings: Vec<Setting>,
    outcome: Outcome,
}

/// What came of a combination.
enum Outcome {
    /// One summary for each seed.
    Ran(Vec<Summary>),
    /// Refused, or it failed on the way: the exit code that it deserves, and the reason in one line.
    Stopped(Exit, String),
}

/// Runs every combination with every seed and prints the table.
pub fn sweep(args: &SweepArgs) -> Result<Exit, Failure> {
    axes::check(&args.axes, args.seeds.is_some())?;
    let (source_name, text) = load(&args.scenario).map_err(Failure::usage)?;
    let interrupted = interrupts().while_doing("watch for Ctrl-C")?;
    let combinations = combinations(&args.axes);
    let seeds: Vec<Option<u64>> = match &args.seeds {
        Some(seeds) => seeds.0.iter().copied().map(Some).collect(),
        None => vec![None],
    };
    let bar = bar(combinations.len() * seeds.len(), args.quiet);
    let mut rows = Vec::new();
    for settings in combinations {
        if interrupted.load(Ordering::Acquire) {
            break;
        }
        let of_seed = |seed: &Option<u64>| {
            let (name, text) = with_settings(&source_name, &text, &settings)?;
            let scenario = scenario(&name, &text, *seed, &args.changes)?;
            bar.set_message(format!("{} seed {}", describe(&settings), scenario.seed));
            let summary = carry_out(&scenario, &interrupted);
            bar.inc(1);
            summary
        };
        let outcome = match seeds.iter().map(of_seed).collect::<Result<Option<Vec<Summary>>, Failure>>() {
            Ok(Some(summaries)) => Outcome::Ran(summaries),
            Ok(None) => break,
            Err(failure) => {
                bar.suspend(|| eprintln!("{}{}", described(&settings), failure.message.trim_end()));
                let reason = failure.message.lines().next().unwrap_or_default();
                Outcome::Stopped(failure.exit, reason.trim_start_matches("error: ").to_owned())
            }
        };
        rows.push(Row { settings, outcome });
    }
    bar.finish_and_clear();
    report(args, seeds.len(), &rows, interrupted.load(Ordering::Acquire))
}

fn report(args: &SweepArgs, seeds: usize, rows: &[Row], is_interrupted: bool) -> Result<Exit, Failure> {
    if is_interrupted {
        eprintln!("warning: interrupted; the table has the combinations that were complete");
    }
    let keys: Vec<&str> = args.axes.iter().map(Axis::key).collect();
    // A reader that has enough closes the pipe.
    let text = table::text(&args.scenario, seeds, &keys, rows);
    let _closed = std::io::stdout().lock().write_all(text.as_bytes());
    if let Some(path) = &args.csv {
        std::fs::write(path, table::csv(&keys, rows))
            .map_err(|error| Failure::failed(format!("{}: cannot be written: {error}", path.display())))?;
    }
    Ok(exit(rows, is_interrupted))
}

/// The gravest of what happened: a violation, then a run that failed, then a refusal of all, then one of some.
fn exit(rows: &[Row], is_interrupted: bool) -> Exit {
    let violated = |row: &Row| match &row.outcome {
        Outcome::Ran(summaries) => summaries.iter().any(|summary| summary.containment.violations > 0),
        Outcome::Stopped(..) => false,
    };
    let stopped = |row: &&Row| matches!(row.outcome, Outcome::Stopped(..));
    let failed = |row: &Row| matches!(row.outcome, Outcome::Stopped(Exit::Failed, _));
    match rows.iter().filter(stopped).count() {
        _ if rows.iter().any(violated) => Exit::Violated,
        _ if rows.iter().any(failed) => Exit::Failed,
        0 if !is_interrupted => Exit::Good,
        refused if refused > 0 && refused == rows.len() => Exit::Usage,
        _ => Exit::Loss,
    }
}

/// One run without processes; `None` when the user stopped it.
fn carry_out(scenario: &Scenario, interrupted: &AtomicBool) -> Result<Option<Summary>, Failure> {
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

fn bar(runs: usize, hidden: bool) -> ProgressBar {
    let target = if hidden { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
    let bar = ProgressBar::with_draw_target(Some(runs as u64), target);
    if let Ok(style) = ProgressStyle::with_template("{pos} of {len} runs {bar:32} {elapsed_precise} {msg}") {
        bar.set_style(style);
    }
    bar
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
