//! What the launcher and the channel's process say to each other: JSON lines over pipes.

use std::num::NonZeroU32;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};
use shoal_bus::summary::Summary;

use crate::cli::{Bus, Changes, Pace};

/// From the launcher to the channel, on its standard input. The input's end means that the launcher is gone.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ToChannel {
    /// What to run; comes first.
    Run(Box<Order>),
    /// Process ids of the AUVs' seats, in their order.
    Processes(Vec<u32>),
    /// Stop and sum up.
    Stop,
}

/// What to run.
#[derive(Debug, Serialize, Deserialize)]
pub struct Order {
    /// What errors call the scenario.
    pub source_name: String,
    /// Where relative paths in it lead from.
    pub folder: PathBuf,
    /// The scenario's text.
    pub text: String,
    /// `--seed`.
    pub seed: Option<u64>,
    /// `--auvs` and the like.
    pub changes: Changes,
    /// Transport.
    pub bus: Bus,
    /// How many AUVs a process carries.
    pub auvs_per_process: NonZeroU32,
    /// zenoh endpoint.
    pub endpoint: Option<String>,
    /// Where AUVs are carried, if not on this machine.
    pub hosts: Option<HostsOrder>,
    /// Pace.
    pub pace: Pace,
    /// Whether nobody waits for AUVs that are late.
    pub free_run: bool,
    /// Whether to note where the time goes.
    pub timings: bool,
    /// Where to record.
    pub record: Option<PathBuf>,
}

/// Which hosts carry the AUVs of a run.
#[derive(Debug, Serialize, Deserialize)]
pub struct HostsOrder {
    /// Where to listen for them.
    pub listen: String,
    /// How many the run begins with.
    pub count: usize,
    /// Configuration of zenoh.
    pub zenoh_config: Option<PathBuf>,
    /// What they must know.
    pub token: Option<String>,
    /// Seconds of silence after which one is lost.
    pub limit_s: f64,
}

/// From the channel to the launcher, on its standard output.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FromChannel {
    /// The bus is up: start the AUVs.
    Ready,
    /// All AUVs have reported in; the first window begins.
    Started,
    /// So many simulated seconds are done.
    Progress(f64),
    /// Something that the user should know.
    Note(String),
    /// Something that happened to a host.
    News(String),
    /// The run is over.
    Done(Box<Done>),
    /// It failed.
    Failed {
        /// The whole sentence.
        message: String,
    },
}

/// The end of a run.
#[derive(Debug, Serialize, Deserialize)]
pub struct Done {
    /// What it amounts to; the launcher adds what only it knows.
    pub summary: Summary,
    /// Whether the user stopped it before the scenario's end.
    pub interrupted: bool,
    /// Whether its record is incomplete.
    pub record_incomplete: bool,
    /// Why it was aborted, if it was.
    pub aborted: Option<String>,
}
