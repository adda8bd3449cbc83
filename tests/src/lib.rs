//! What the integration tests share: the real executable and its processes, runs inside the test's own process, and
//! scenarios drawn at random.
//!
//! - [`shoal`] is the executable, built from the present sources; [`Command`] starts it, and [`Live`] is a run in progress
//!   whose processes end with the value, whatever happens.
//! - [`run_local`] carries a scenario out in this process: the reference that real processes must equal.
//! - [`random_scenario`] and [`random_sea_scenario`] write scenario files, each another corner of what a scenario may say;
//!   [`Swarm`] writes those of the nightly suite.

mod chromium;
mod executable;
mod local;
mod network;
pub mod present;
mod process;
mod random_scenario;
mod swarm_scenario;
mod traces;

pub use chromium::Chromium;
pub use executable::{Command, Finished, Live, alone, shoal};
pub use local::{LocalRunError, library_scenario, run_local, run_local_watched};
pub use network::{Networks, Side};
pub use process::{Process, await_that, processes_of};
pub use random_scenario::{Dice, random_scenario, random_sea_scenario};
pub use swarm_scenario::Swarm;
pub use traces::{live_runs, traces_of};

use std::path::PathBuf;

/// The scenario file `NAME.toml` that comes with the tests.
pub fn scenario_file(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/scenarios").join(format!("{name}.toml"))
}

/// The folder of the workspace.
pub fn workspace() -> PathBuf {
    let here = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    here.parent().map(PathBuf::from).unwrap_or(here)
}
