//! The command line of `shoal tap`.

use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum};

/// Watch a live run on this host, or read a record the same way.
#[derive(Debug, Args)]
pub struct TapArgs {
    #[command(subcommand)]
    pub verb: Option<Verb>,
    #[command(flatten)]
    pub origin: OriginArgs,
    #[command(flatten)]
    pub choice: ChoiceArgs,
    #[command(flatten)]
    pub form: FormArgs,
}

#[derive(Clone, Debug, Subcommand)]
pub enum Verb {
    /// The topics, with how many messages they had and have a second
    #[command(after_help = "Example:\n  shoal tap list")]
    List,
    /// What the messages of a topic hold, field by field, and how many there were
    #[command(after_help = "Example:\n  shoal tap info /pings")]
    Info(TopicArg),
    /// Print the messages of a topic
    #[command(after_help = "Example:\n  shoal tap echo /pings --count 10")]
    Echo(TopicArg),
    /// How often messages of a topic come
    #[command(after_help = "Example:\n  shoal tap hz /pings")]
    Hz(TopicArg),
    /// How many bytes a second the messages of a topic are, as the JSON of a record
    #[command(after_help = "Example:\n  shoal tap bw /reports")]
    Bw(TopicArg),
    /// How long messages of a topic take from the water to this tap, and how long after they happened they are told
    #[command(after_help = "Example:\n  shoal tap delay /pings")]
    Delay(TopicArg),
    /// A table of the AUVs that keeps itself up to date: what they know of themselves, and what they hear
    #[command(after_help = "Example:\n  shoal tap top --sort box")]
    Top(TopArgs),
}

#[derive(Clone, Debug, Args)]
pub struct TopicArg {
    /// Such as `/pings`; `shoal tap list` lists them
    #[arg(value_name = "TOPIC")]
    pub topic: String,
}

#[derive(Clone, Debug, Args)]
pub struct TopArgs {
    /// By what to sort first
    #[arg(long, value_enum, default_value_t = Sort::Auv)]
    pub sort: Sort,
}

/// By what AUVs are sorted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Sort {
    /// Their ids
    Auv,
    /// The width of their position box, widest first
    Box,
    /// The width of their clock interval, widest first
    Clock,
    /// Fewest neighbours first
    Neighbours,
    /// Fewest pings heard first
    Heard,
    /// Most pings lost first
    Lost,
}

/// Where messages come from, and for how long.
#[derive(Debug, Args)]
pub struct OriginArgs {
    /// Which run, when several are live: its id, or the name of its scenario
    #[arg(long, global = true, value_name = "RUN")]
    pub run: Option<String>,
    /// Read a record instead of a live run
    #[arg(long, short, global = true, value_name = "FILE", conflicts_with = "run")]
    pub read: Option<PathBuf>,
    /// Wait so many seconds for a run to begin
    #[arg(long, global = true, value_name = "SECONDS", default_value_t = 0.0, allow_negative_numbers = true)]
    pub wait: f64,
    /// From this simulated second on
    #[arg(long, global = true, value_name = "SECONDS", value_parser = seconds)]
    pub from: Option<f64>,
    /// Up to this simulated second
    #[arg(long, global = true, value_name = "SECONDS", value_parser = seconds)]
    pub to: Option<f64>,
    /// End after so many simulated seconds
    #[arg(long, global = true, value_name = "SECONDS", value_parser = seconds)]
    pub duration: Option<f64>,
    /// Fail when no message comes for so many seconds of wall clock
    #[arg(long, global = true, value_name = "SECONDS", value_parser = seconds)]
    pub timeout: Option<f64>,
}

/// Which messages.
#[derive(Debug, Args)]
pub struct ChoiceArgs {
    /// Pings with this fate only; several with commas
    #[arg(long, global = true, value_enum, value_delimiter = ',')]
    pub kind: Vec<Kind>,
    /// Lost pings only, or those lost for these reasons, such as `--lost=noise,collision`
    #[arg(long, global = true, value_name = "REASON", num_args = 0.., require_equals = true, value_delimiter = ',')]
    pub lost: Option<Vec<String>>,
    /// Messages that satisfy this only, such as 'range_m > 400 and not reason == noise'
    #[arg(long, global = true, value_name = "EXPR")]
    pub filter: Option<String>,
    /// One message, then end: the same as `--count 1`
    #[arg(long, global = true, conflicts_with = "count")]
    pub once: bool,
    /// End after so many messages, or so many lines of figures
    #[arg(long, short, global = true, value_name = "N")]
    pub count: Option<u64>,
}

/// How they are told.
#[derive(Debug, Args)]
pub struct FormArgs {
    /// Print these fields only, such as `range_m` or `reception.sinr_db`; several with commas
    #[arg(long, global = true, value_name = "PATH", value_delimiter = ',')]
    pub field: Vec<String>,
    /// One JSON line each
    #[arg(long, global = true, conflicts_with = "csv")]
    pub json: bool,
    /// Comma-separated values with a line of titles
    #[arg(long, global = true)]
    pub csv: bool,
    /// Write a record instead of printing: of all topics, or of what was chosen
    #[arg(long, short, global = true, value_name = "FILE", conflicts_with_all = ["json", "csv", "field"])]
    pub write: Option<PathBuf>,
}

/// What became of a ping.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Kind {
    /// It left a modem
    Emitted,
    /// It was decoded
    Heard,
    /// It was not, or never left
    Lost,
}

impl ChoiceArgs {
    /// How many messages to show at most.
    pub fn limit(&self) -> u64 {
        if self.once { 1 } else { self.count.unwrap_or(u64::MAX) }
    }
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if (0.0..=9e9).contains(&seconds) => Ok(seconds),
        _ => Err("give a number of seconds, 0 or more".to_owned()),
    }
}
