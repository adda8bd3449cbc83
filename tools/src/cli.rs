//! The command line.

use std::num::NonZeroU32;
use std::ops::Range;
use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use serde::{Deserialize, Serialize};

use crate::bench::{ScaleArgs, TapBenchArgs};
use crate::localize::LocalizeArgs;
use crate::manual::{CompletionsArgs, ManArgs};
use crate::plot::PlotArgs;
use crate::record::RecordCommand;
use crate::replay::ReplayArgs;
use crate::report::ReportArgs;
use crate::set::Setting;
use crate::sweep::{Axis, Seeds};
use crate::tap::TapArgs;
use crate::view::ViewArgs;

/// Simulates a swarm of autonomous underwater vehicles, each a process that knows only its own drifting clock and its own
/// sensors, and proves at every step that none of them loses the truth.
#[derive(Debug, Parser)]
#[command(name = "shoal", version, max_term_width = 110)]
#[command(
    after_help = "Exit codes: 0 good, 1 failed, or what was compared differs, 2 usage or refused scenario, 3 finished with loss (an AUV \
    died, or the run or its data are incomplete), 4 an enclosure did not hold the truth, 5 a record is damaged."
)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Run a scenario: one process per AUV, and one for the water
    #[command(
        after_help = "Examples:\n  shoal run six-circles\n  shoal run swarm-300 --record flock.mcap\n  \
        shoal run my.toml --seed 7 --auvs 50 --bus local --json\n  \
        shoal run swarm-3 --set group.modem.range_m=300"
    )]
    Run(RunArgs),
    /// Carry AUVs of a run whose water is on another machine
    #[command(
        after_help = "On the machine with the water:\n  shoal run swarm-300 --listen tcp/192.168.0.7:7447 --hosts 2\nOn each that \
        carries AUVs:\n  shoal host --connect tcp/192.168.0.7:7447 --slots 150\n\nIt ends with the run. A host that joins a run in \
        progress waits to take the place of one that is lost."
    )]
    Host(HostArgs),
    /// Run a scenario for many seeds and values of its keys, and print one table
    #[command(
        after_help = "KEY names a value of the scenario file with dots, such as `environment.sound_speed_m_s`, or \
        `group.0.count` for the first group and `group.count` for all.\n\nExamples:\n  shoal sweep six-circles --seeds 1..5\n  \
        shoal sweep swarm-300 --auvs 30 --seeds 1..20 --set group.modem.range_m=200,400,800 --csv range.csv\n\n\
        With --csv or --runs a sweep that was stopped, however it was, goes on when the same command is given again."
    )]
    Sweep(SweepArgs),
    /// Watch a live run on this host, or read a record the same way
    #[command(
        args_conflicts_with_subcommands = false,
        after_help = "Without a verb it prints pings. `shoal tap help VERB` tells more about a verb.\n\nExamples:\n  shoal tap --wait 10\n  \
        shoal tap --lost=noise,collision --filter 'range_m < 200'\n  shoal tap --run swarm-300 list\n  \
        shoal tap echo /reports --filter 'auv == 7' --field t_s,neighbours\n  shoal tap hz /pings --once\n  shoal tap top --sort box\n  \
        shoal tap -w part.mcap --duration 10\n  shoal tap -r part.mcap --from 3 --to 4 --csv > pings.csv\n\n\
        Filters: FIELD == VALUE, != < <= > >=, FIELD in (A, B), FIELD ~ TEXT, FIELD alone; and, or, not, ( ). A field is the dotted \
        path of a value in a message's JSON, as `shoal tap info TOPIC` lists them: `reception.sinr_db < 10 and not reason == noise`."
    )]
    Tap(TapArgs),
    /// Show a record or a live run in the browser: positions, links, boxes and wavefronts, and what each AUV knows
    #[command(
        after_help = "Examples:\n  shoal run swarm-1000 --record flock.mcap\n  shoal view flock.mcap\n  \
        shoal view --live --wait 60   (and in another shell: shoal run swarm-300 --pace 1)\n  shoal view flock.mcap --export flock.html   (one file to give away)\n\nThe page is for this machine only: its address has \
        a secret, and a remote shell is told the `ssh -L` line that leads to it. Press ? on the page for its keys."
    )]
    View(ViewArgs),
    /// Find out where AUVs were, after the run: all trajectories of a record together, or one vehicle from files
    #[command(
        after_help = "From a record it writes a copy that has the trajectories too, RECORD.offline.mcap beside it unless told otherwise.\n\n\
        Examples:\n  shoal run six-circles --record circles.mcap\n  shoal localize circles.mcap --offline\n  \
        shoal plot circles.offline.mcap tubes --auv 3 -o tubes.svg\n  shoal localize --dataset goats02 -o track.svg\n  \
        shoal localize --dataset goats02 --estimator ekf --gate 0 --json\n  shoal localize --dataset goats02 --start unknown"
    )]
    Localize(LocalizeArgs),
    /// Draw a figure (SVG) of what a record holds
    #[command(
        after_help = "Examples:\n  shoal run six-circles --record circles.mcap\n  shoal plot circles.mcap losses -o losses.svg\n  \
        shoal plot circles.mcap tubes --auv 3 -o tubes.svg\n  shoal plot circles.mcap map --at-s 12.5 -o map.svg\n  \
        rsvg-convert -z 2 losses.svg -o losses.png   (from librsvg, for a PNG)"
    )]
    Plot(PlotArgs),
    /// Write a page (HTML) that says what a run amounts to, or what two runs differ in
    #[command(after_help = "The page is one file that needs no other and no network.\n\nExamples:\n  \
        shoal run swarm-300 --record flock.mcap\n  shoal report flock.mcap -o flock.html\n  \
        shoal report flock.mcap other.mcap -o both.html\n  shoal report flock.mcap --markdown -o flock.md")]
    Report(ReportArgs),
    /// List the scenarios that come with Shoal, or print one
    #[command(after_help = "Examples:\n  shoal scenarios\n  shoal scenarios six-circles > mine.toml")]
    Scenarios {
        /// Print the text of this one
        name: Option<String>,
        /// One JSON line each
        #[arg(long)]
        json: bool,
    },
    /// Check scenario files without running them
    #[command(after_help = "Example:\n  shoal check mine.toml")]
    Check {
        /// Names from the library, or paths
        #[arg(required = true)]
        scenarios: Vec<String>,
    },
    /// Look into records (MCAP files)
    Record {
        #[command(subcommand)]
        command: RecordCommand,
    },
    /// Feed what AUVs were told in a recorded run to live ones, and show where they behave otherwise
    #[command(
        after_help = "The AUVs of today's code, or with another estimator, are told what those of the record were told, each from its birth on. \
        What they answer is compared with what was answered then. It is an open loop: an AUV that answers otherwise is still told what \
        it was told then, so what is compared is what its mind makes of the same measurements, not where another course would have led.\n\n\
        Exits with 0 when all answers are the same, with 1 when some differ, with 4 when an enclosure that promises to hold the truth \
        lost it where the recorded one held it.\n\nExamples:\n  shoal replay flock.mcap\n  shoal replay flock.mcap --estimator ekf\n  \
        shoal replay flock.mcap --estimator '{name=\"tube\",rings=0}' --json\n  shoal replay flock.mcap --from 10 --step 0.5"
    )]
    Replay(ReplayArgs),
    /// Measure this machine
    Bench {
        #[command(subcommand)]
        command: BenchCommand,
    },
    /// Print the JSON Schema of scenario files, with which editors complete and check them
    #[command(
        after_help = "Example:\n  shoal schema > scenario.schema.json\n\nA scenario file that begins with the line\n  \
        #:schema ./scenario.schema.json\nis completed and checked by every editor that knows taplo (Even Better TOML for VS Code, Helix, \
        Neovim)."
    )]
    Schema,
    /// Print completions for a shell
    #[command(
        after_help = "Examples:\n  shoal completions bash > ~/.local/share/bash-completion/completions/shoal\n  \
        shoal completions zsh > \"${fpath[1]}/_shoal\"\n  shoal completions fish > ~/.config/fish/completions/shoal.fish"
    )]
    Completions(CompletionsArgs),
    /// Print the manual page of a verb, or write all of them
    #[command(
        after_help = "Examples:\n  shoal man plot | man -l -\n  shoal man --out ~/.local/share/man/man1"
    )]
    Man(ManArgs),
    /// A program of the user's that is one AUV; started by `run`
    #[command(hide = true)]
    Agent(AgentArgs),
    /// One AUV, or several; started by `run`
    #[command(hide = true)]
    Auv(AuvArgs),
    /// What cleans up after a host that was killed; started by `host`
    #[command(hide = true)]
    Janitor {
        /// Folder of the run
        #[arg(long)]
        run: PathBuf,
    },
    /// The water; started by `run`
    #[command(hide = true)]
    Channel {
        /// Folder of the run
        #[arg(long)]
        run: PathBuf,
    },
}

#[derive(Debug, Subcommand)]
pub enum BenchCommand {
    /// What an AUV costs among more and more others at the same density: processor time, start-up, memory
    #[command(
        after_help = "Examples:\n  shoal bench scale\n  shoal bench scale --bus local --auvs 100,1000,10000 --json\n  \
        shoal bench scale --control-period-s 1"
    )]
    Scale(ScaleArgs),
    /// What a tap at full speed costs the run that it looks at; its digest must stay the same
    #[command(
        after_help = "Examples:\n  shoal bench tap\n  shoal bench tap --tap 'echo /reports --json' --pairs 9 --json"
    )]
    Tap(TapBenchArgs),
}

#[derive(Debug, Args)]
pub struct RunArgs {
    /// A name from `shoal scenarios`, or the path of a scenario file
    pub scenario: String,
    /// What carries the messages
    #[arg(long, value_enum, default_value_t = Bus::Iceoryx2)]
    pub bus: Bus,
    /// Put so many AUVs into each process; one unless given. Never changes the result
    #[arg(long, value_name = "K", value_parser = parse_auvs_per_process, allow_negative_numbers = true)]
    pub auvs_per_process: Option<NonZeroU32>,
    /// Seed of every random draw
    #[arg(long, allow_negative_numbers = true)]
    pub seed: Option<u64>,
    /// Change one value of the scenario; can be given many times
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = Setting::parse)]
    pub set: Vec<Setting>,
    #[command(flatten)]
    pub changes: Changes,
    /// `max`, or simulated seconds per second of wall clock: 1 is real time. `max` unless given, 1 with --free-run
    #[arg(long, value_parser = parse_pace, allow_negative_numbers = true)]
    pub pace: Option<Pace>,
    /// Wait for nobody: an AUV that does not answer within its reaction time holds its last command. For hardware in the loop;
    /// such a run cannot be reproduced
    #[arg(long)]
    pub free_run: bool,
    /// Tell where the time went, as a graph, or with --json in the summary
    #[arg(long)]
    pub timings: bool,
    /// Write a record (MCAP) of the run
    #[arg(long, value_name = "FILE")]
    pub record: Option<PathBuf>,
    /// zenoh endpoint to listen on and connect to, such as `tcp/127.0.0.1:7447`; a private socket unless given
    #[arg(long, value_name = "ENDPOINT", value_parser = parse_endpoint)]
    pub endpoint: Option<String>,
    /// Have hosts carry the AUVs, and listen for them here, such as `tcp/192.168.0.7:7447`: see `shoal host`
    #[arg(long, value_name = "ENDPOINT", value_parser = parse_network_endpoint, requires = "hosts", conflicts_with_all = ["bus", "endpoint", "free_run"])]
    pub listen: Option<String>,
    /// How many hosts the run begins with
    #[arg(long, value_name = "M", requires = "listen")]
    pub hosts: Option<NonZeroU32>,
    /// A host that is silent for so many seconds is lost
    #[arg(long, value_name = "SECONDS", default_value_t = 30.0, value_parser = parse_seconds, requires = "listen")]
    pub host_limit: f64,
    #[command(flatten)]
    pub network: NetworkArgs,
    /// Print the summary as one JSON line
    #[arg(long)]
    pub json: bool,
    /// No progress bar
    #[arg(long, short)]
    pub quiet: bool,
}

/// How hosts reach each other.
#[derive(Debug, Args)]
pub struct NetworkArgs {
    /// Configuration of zenoh between hosts, over the one that `shoal host --print-zenoh-config` prints
    #[arg(long, value_name = "FILE")]
    pub zenoh_config: Option<PathBuf>,
    /// File with a secret that the other end must know as well; `SHOAL_TOKEN` unless given
    #[arg(long, value_name = "FILE")]
    pub token: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub struct HostArgs {
    /// Where `shoal run` listens, such as `tcp/192.168.0.7:7447`
    #[arg(long, value_name = "ENDPOINT", value_parser = parse_network_endpoint, required_unless_present = "print_zenoh_config")]
    pub connect: Option<String>,
    /// How many AUVs this machine can carry
    #[arg(long, value_name = "N", required_unless_present = "print_zenoh_config")]
    pub slots: Option<NonZeroU32>,
    /// What to call this host; the machine's name unless given
    #[arg(long)]
    pub name: Option<String>,
    /// Take part in a run of this scenario only: the texts must be the same
    #[arg(long, value_name = "SCENARIO")]
    pub scenario: Option<String>,
    /// Wait so many seconds for the run to be there
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0, value_parser = parse_seconds)]
    pub wait: f64,
    #[command(flatten)]
    pub network: NetworkArgs,
    /// Print the configuration of zenoh that holds unless `--zenoh-config` says otherwise, and end
    #[arg(long)]
    pub print_zenoh_config: bool,
    /// Do not tell how far the run is
    #[arg(long, short)]
    pub quiet: bool,
}

/// Changes to a scenario that have a flag of their own.
#[derive(Clone, Debug, Default, PartialEq, Args, Serialize, Deserialize)]
pub struct Changes {
    /// Number of AUVs: scales all groups in proportion
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub auvs: Option<u32>,
    /// Simulated seconds
    #[arg(
        long = "duration-s",
        visible_alias = "duration",
        value_name = "SECONDS",
        allow_negative_numbers = true
    )]
    pub duration_s: Option<f64>,
    /// Lockstep window in milliseconds of true time; never changes the result
    #[arg(
        long = "window-ms",
        visible_alias = "window",
        value_name = "MILLISECONDS",
        allow_negative_numbers = true
    )]
    pub window_ms: Option<f64>,
    /// How errors are drawn inside their bounds: `uniform` or `adversarial`
    #[arg(long)]
    pub noise: Option<String>,
}

#[derive(Debug, Args)]
pub struct SweepArgs {
    /// A name from `shoal scenarios`, or the path of a scenario file
    pub scenario: String,
    /// Seeds of each combination, such as `1..20` (20 is one of them) or `3,5,8`; the scenario's own unless given
    #[arg(long, value_parser = Seeds::parse)]
    pub seeds: Option<Seeds>,
    /// Values of one key of the scenario; given more than once, all combinations are run
    #[arg(long = "set", value_name = "KEY=A,B,C", value_parser = Axis::parse)]
    pub axes: Vec<Axis>,
    #[command(flatten)]
    pub changes: Changes,
    /// Write the table to this file too, as comma-separated values
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Keep every run that ended in this file, so that the same command goes on where it was stopped; beside the table of `--csv`
    /// unless given
    #[arg(long, value_name = "FILE")]
    pub runs: Option<PathBuf>,
    /// Runs at a time; one for each core unless given
    #[arg(long, short, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub jobs: Option<u16>,
    /// No progress bar
    #[arg(long, short)]
    pub quiet: bool,
}

#[derive(Debug, Args)]
pub struct AgentArgs {
    /// Process that started it, with which it ends
    #[arg(long)]
    pub launcher: u32,
    /// Program and arguments
    #[arg(last = true, required = true)]
    pub command: Vec<String>,
}

#[derive(Debug, Args)]
pub struct AuvArgs {
    /// Folder of the run
    #[arg(long)]
    pub run: PathBuf,
    /// Ids of those that this process carries
    #[arg(long, value_name = "FIRST..END", value_parser = parse_auvs)]
    pub auvs: Range<u32>,
    /// What carries the messages
    #[arg(long, value_enum)]
    pub bus: Bus,
    /// zenoh endpoint of the channel
    #[arg(long)]
    pub endpoint: Option<String>,
    /// Process that started it, with which it ends
    #[arg(long)]
    pub launcher: u32,
}

/// What carries the messages of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Bus {
    /// No processes: all in one program
    Local,
    /// Shared memory on this host
    Iceoryx2,
    /// zenoh, one session per AUV
    Zenoh,
}

impl Bus {
    /// As on the command line and in summaries.
    pub fn name(self) -> &'static str {
        match self {
            Self::Local => "local",
            Self::Iceoryx2 => "iceoryx2",
            Self::Zenoh => "zenoh",
        }
    }
}

/// How fast simulated time goes by.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Pace {
    /// As fast as it can.
    Max,
    /// So many simulated seconds per second of wall clock, at most.
    Factor(f64),
}

pub fn parse_pace(text: &str) -> Result<Pace, String> {
    match text {
        "max" => Ok(Pace::Max),
        _ => {
            match text.parse::<f64>() {
                Ok(factor) if (1e-6..=1e9).contains(&factor) => Ok(Pace::Factor(factor)),
                _ => Err("give `max`, or a number from 0.000001 to 1000000000, such as `1` for real time"
                    .to_owned()),
            }
        }
    }
}

fn parse_auvs_per_process(text: &str) -> Result<NonZeroU32, String> {
    text.parse().map_err(|_| "give a whole number from 1 on, such as `32`".to_owned())
}

fn parse_auvs(text: &str) -> Result<Range<u32>, String> {
    let range = text.split_once("..").and_then(|(first, end)| Some(first.parse().ok()?..end.parse().ok()?));
    range.filter(|range| !range.is_empty()).ok_or_else(|| "give `FIRST..END`, such as `0..32`".to_owned())
}

fn parse_seconds(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok().filter(|seconds| (1.0..=1e6).contains(seconds));
    seconds.ok_or_else(|| "give seconds from 1 to 1000000".to_owned())
}

fn parse_network_endpoint(text: &str) -> Result<String, String> {
    match text.split_once('/') {
        Some(("quic", _)) if !cfg!(feature = "quic") => {
            Err("this build has no QUIC: give `tcp/` or `tls/`, or build it with `--features quic`".to_owned())
        }
        Some(("tcp" | "tls" | "quic", address)) if has_port(address) => Ok(text.to_owned()),
        Some(("unixsock-stream", path)) if !path.is_empty() => Ok(text.to_owned()),
        _ => Err("give `tcp/ADDRESS:PORT`, or `tls/ADDRESS:PORT` with a configuration of zenoh that names certificates, such as \
                  `tcp/192.168.0.7:7447`"
            .to_owned()),
    }
}

fn has_port(address: &str) -> bool {
    // What follows a `?` or `#` is zenoh's.
    let address = address.split(['?', '#']).next().unwrap_or(address);
    let port = address.rsplit_once(':').filter(|(name, _)| !name.is_empty());
    port.is_some_and(|(_, port)| port.parse::<u16>().is_ok_and(|port| port > 0))
}

fn parse_endpoint(text: &str) -> Result<String, String> {
    match text.split_once('/') {
        Some(("tcp" | "unixsock-stream", address)) if !address.is_empty() => Ok(text.to_owned()),
        _ => {
            Err("give `tcp/ADDRESS:PORT` or `unixsock-stream/PATH`, such as `tcp/127.0.0.1:7447`".to_owned())
        }
    }
}
