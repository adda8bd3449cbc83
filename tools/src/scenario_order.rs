//! From names, files and flags to a scenario.

use shoal_scenario::{Overrides, Scenario, load, parse};

use crate::cli::{Bus, RunArgs};
use crate::failure::Failure;
use crate::launch::Order;

impl Order {
    /// Reads the scenario that the command line names.
    pub fn read(args: &RunArgs) -> Result<Self, Failure> {
        if args.endpoint.is_some() && args.bus != Bus::Zenoh {
            return Err(Failure::usage("--endpoint is for zenoh: add `--bus zenoh`, or leave it out"));
        }
        let (source_name, text) = load(&args.scenario).map_err(Failure::usage)?;
        Ok(Self {
            source_name,
            text,
            seed: args.seed,
            auvs: args.auvs,
            duration_s: args.duration_s,
            window_ms: args.window_ms,
            noise: args.noise.clone(),
            bus: args.bus,
            endpoint: args.endpoint.clone(),
            pace: args.pace,
            record: args.record.clone(),
        })
    }

    /// The scenario, validated, with the command line's changes.
    pub fn scenario(&self) -> Result<Scenario, Failure> {
        let scenario = parse(&self.source_name, &self.text)
            .map_err(|errors| Failure::rendered(errors.render(crate::terminal::stderr_has_colour())))?;
        let noise = match &self.noise {
            Some(name) => {
                Some(name.parse().map_err(|error| Failure::usage(format!("--noise {name}: {error}")))?)
            }
            None => None,
        };
        let overrides = Overrides {
            seed: self.seed,
            auvs: self.auvs,
            duration_s: self.duration_s,
            window_ms: self.window_ms,
            noise,
        };
        overrides.apply(scenario).map_err(Failure::usage)
    }
}
