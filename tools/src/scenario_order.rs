//! From names, files and flags to a scenario.

use std::num::NonZeroU32;
use std::path::{Path, PathBuf};

use shoal_scenario::{Overrides, Scenario, library, load, parse};

use crate::cli::{Bus, Changes, Pace, RunArgs};
use crate::failure::{Failure, While};
use crate::launch::{HostsOrder, Order};
use crate::set::Setting;

impl Order {
    /// Reads the scenario that the command line names.
    pub fn read(args: &RunArgs) -> Result<Self, Failure> {
        if args.endpoint.is_some() && args.bus != Bus::Zenoh {
            return Err(Failure::usage("--endpoint is for zenoh: add `--bus zenoh`, or leave it out"));
        }
        if args.auvs_per_process.is_some() && args.bus == Bus::Local {
            return Err(Failure::usage(
                "--auvs-per-process is for AUVs in processes: add `--bus iceoryx2` or `--bus zenoh`, or leave it out",
            ));
        }
        let folder = folder_of(&args.scenario).while_doing("find the scenario's folder")?;
        let (source_name, text) = load(&args.scenario).map_err(Failure::usage)?;
        let (source_name, text) = with_settings(&source_name, &text, &args.set)?;
        Ok(Self {
            source_name,
            folder,
            text,
            seed: args.seed,
            changes: args.changes.clone(),
            bus: args.bus,
            auvs_per_process: args.auvs_per_process.unwrap_or(NonZeroU32::MIN),
            endpoint: args.endpoint.clone(),
            hosts: HostsOrder::read(args)?,
            pace: pace(args)?,
            free_run: args.free_run,
            timings: args.timings,
            record: args.record.clone(),
        })
    }

    /// What carries the messages, as summaries say it.
    pub fn bus_name(&self) -> &'static str {
        if self.hosts.is_some() { "hosts" } else { self.bus.name() }
    }

    /// The scenario, validated, with the command line's changes.
    pub fn scenario(&self) -> Result<Scenario, Failure> {
        scenario(&self.source_name, &self.text, self.seed, &self.changes)
    }
}

fn pace(args: &RunArgs) -> Result<Pace, Failure> {
    match (args.pace, args.free_run) {
        (Some(Pace::Max), true) => {
            Err(Failure::usage("--free-run follows the wall clock: give --pace a number, or leave it out"))
        }
        (None, true) => Ok(Pace::Factor(1.0)),
        (pace, _) => Ok(pace.unwrap_or(Pace::Max)),
    }
}

/// The folder of a scenario file; for a scenario of the library, the present one.
fn folder_of(name_or_path: &str) -> std::io::Result<PathBuf> {
    let path = Path::new(name_or_path);
    if path.exists() && !library().iter().any(|entry| entry.name == name_or_path) {
        return Ok(path.canonicalize()?.parent().map_or_else(PathBuf::new, Path::to_owned));
    }
    std::env::current_dir()
}

/// The name and the text of a scenario after `--set`: errors will point into this text.
pub fn with_settings(
    source_name: &str,
    text: &str,
    settings: &[Setting],
) -> Result<(String, String), Failure> {
    let changed = Setting::apply(source_name, text, settings)?;
    let name =
        if settings.is_empty() { source_name.to_owned() } else { format!("{source_name} changed by --set") };
    Ok((name, changed))
}

/// The scenario of this text, validated, with the changes that have a flag of their own.
pub fn scenario(
    source_name: &str,
    text: &str,
    seed: Option<u64>,
    changes: &Changes,
) -> Result<Scenario, Failure> {
    let scenario = parse(source_name, text)
        .map_err(|errors| Failure::rendered(errors.render(crate::terminal::stderr_has_colour())))?;
    let noise = match &changes.noise {
        Some(name) => Some(name.parse().map_err(|error| Failure::usage(format!("--noise {name}: {error}")))?),
        None => None,
    };
    let overrides = Overrides {
        seed,
        auvs: changes.auvs,
        duration_s: changes.duration_s,
        window_ms: changes.window_ms,
        noise,
    };
    overrides.apply(scenario).map_err(Failure::usage)
}
