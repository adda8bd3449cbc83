//! `shoal`: simulates a swarm of autonomous underwater vehicles, a process each, that know where they are.
//!
//! This executable is also every process of a run: `shoal run` starts `shoal channel` and one `shoal auv` per vehicle.

mod agent_process;
mod auv_process;
mod bench;
mod channel_process;
mod cli;
mod conduct;
mod cpu;
mod drive;
mod exit;
mod failure;
mod figure;
mod filter;
mod free_run;
mod host;
mod hosts_fleet;
mod janitor;
mod launch;
mod limits;
mod localize;
mod manual;
mod memory;
mod observers;
mod plot;
mod processes;
mod processor;
mod progress;
mod record;
mod replay;
mod report;
mod run;
mod scenario_order;
mod scenarios;
mod seat;
mod set;
mod stopwatch;
mod summary_text;
mod sweep;
mod table;
mod tap;
mod terminal;
mod timings_text;
mod view;

use std::process::ExitCode;

use clap::Parser;
use cli::{BenchCommand, Cli, Command};
use exit::Exit;
use failure::{Failure, While};
use shoal_bus::run_dir::RunDir;

fn main() -> ExitCode {
    match processor::check().and_then(|()| command(&Cli::parse().command)) {
        Ok(exit) => exit.into(),
        Err(failure) => {
            eprintln!("{}", failure.message.trim_end());
            failure.exit.into()
        }
    }
}

fn command(command: &Command) -> Result<Exit, Failure> {
    match command {
        Command::Run(args) => run::run(args),
        Command::Host(args) => host::host(args),
        Command::Localize(args) => localize::localize(args),
        Command::Plot(args) => plot::plot(args),
        Command::Report(args) => report::report(args),
        Command::Sweep(args) => sweep::sweep(args),
        Command::Tap(args) => tap::run(args),
        Command::View(args) => view::view(args),
        Command::Scenarios { name, json } => scenarios::list(name.as_deref(), *json),
        Command::Check { scenarios } => scenarios::check(scenarios),
        Command::Record { command } => record::run(command),
        Command::Replay(args) => replay::run(args),
        Command::Schema => manual::schema(),
        Command::Completions(args) => manual::completions(args),
        Command::Man(args) => manual::man(args),
        Command::Bench { command: BenchCommand::Scale(args) } => bench::scale(args),
        Command::Bench { command: BenchCommand::Tap(args) } => bench::tap(args),
        Command::Agent(args) => agent_process::run(args),
        Command::Auv(args) => auv_process::run(args),
        Command::Janitor { run } => {
            RunDir::open(run).while_doing("open the run's folder").and_then(|run| janitor::run(&run))
        }
        Command::Channel { run } => {
            RunDir::open(run).while_doing("open the run's folder").and_then(|run| channel_process::run(&run))
        }
    }
}
