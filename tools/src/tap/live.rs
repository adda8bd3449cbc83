//! Finds the live run that is meant.

use std::time::{Duration, Instant};

use shoal_bus::record::Topic;
use shoal_bus::run_dir::RunDir;
use shoal_bus::tap::{TapError, TapSubscriber};

use super::args::OriginArgs;
use crate::exit::Exit;
use crate::failure::Failure;
use crate::filter::similar;

/// Finds the run and attaches, waiting as long as `--wait` says.
pub fn attach(args: &OriginArgs, topics: &[Topic]) -> Result<TapSubscriber, Failure> {
    let patience = Duration::try_from_secs_f64(args.wait).ok();
    let deadline = patience.and_then(|patience| Instant::now().checked_add(patience));
    let wrong = || Failure::usage(format!("--wait {}: give a number of seconds, 0 or more", args.wait));
    let deadline = deadline.ok_or_else(wrong)?;
    loop {
        let attempt = chosen(args.run.as_deref()).and_then(|run| {
            TapSubscriber::attach(&run, topics).map_err(|error| match error {
                TapError::NotLive(_) => Failure::usage(format!("{error}; give a record with -r FILE")),
                _ => Failure::failed(format!(
                    "run {} cannot be tapped: it is just starting or ending, or has too many taps; give --wait SECONDS",
                    run.id()
                )),
            })
        });
        match attempt {
            Err(failure) if Instant::now() >= deadline || failure.exit == Exit::Usage => return Err(failure),
            Err(_) => std::thread::sleep(Duration::from_millis(20)),
            Ok(tap) => return Ok(tap),
        }
    }
}

/// The run that `--run` names, or the only one.
pub fn chosen(wanted: Option<&str>) -> Result<RunDir, Failure> {
    let mut live: Vec<RunDir> = RunDir::list();
    let listed = list(&live);
    if let Some(wanted) = wanted {
        if let Some(run) = live.iter().find(|run| run.id() == wanted) {
            return Ok(run.clone());
        }
        let scenarios: Vec<String> = live.iter().map(scenario).collect();
        let is_wanted = |(_, name): &(&RunDir, &String)| name.as_str() == wanted;
        let mut named: Vec<&RunDir> =
            live.iter().zip(&scenarios).filter(is_wanted).map(|(run, _)| run).collect();
        return match (named.pop(), named.is_empty()) {
            (Some(run), true) => Ok(run.clone()),
            (Some(_), false) => Err(Failure::usage(format!(
                "several live runs are of `{wanted}`, choose one by its id with --run ID: {listed}"
            ))),
            (None, _) => {
                let names = live.iter().map(RunDir::id).chain(scenarios.iter().map(String::as_str));
                let meant =
                    similar(wanted, names).map_or(String::new(), |name| format!("; did you mean `{name}`?"));
                Err(Failure::failed(format!(
                    "no live run has the id `{wanted}`, nor a scenario of that name; live on this host: {listed}{meant}"
                )))
            }
        };
    }
    match live.len() {
        0 => Err(Failure::failed(
            "no run is live on this host; start one with `shoal run`, give --wait SECONDS, or a record",
        )),
        1 => Ok(live.swap_remove(0)),
        _ => Err(Failure::usage(format!("several runs are live, choose one with --run RUN: {listed}"))),
    }
}

fn scenario(run: &RunDir) -> String {
    let description = run.description().unwrap_or_default();
    description["scenario"].as_str().unwrap_or("?").to_owned()
}

fn list(runs: &[RunDir]) -> String {
    let name = |run: &RunDir| format!("{} ({})", run.id(), scenario(run));
    if runs.is_empty() { "none".to_owned() } else { runs.iter().map(name).collect::<Vec<_>>().join(", ") }
}
