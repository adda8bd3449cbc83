//! `shoal plot`: figures of what a record holds, as SVG.
//!
//! | file | figure |
//! |---|---|
//! | `losses.rs` | what became of the pings, over time |
//! | `ranges.rs` | what travel times say of ranges |
//! | `reach.rs` | where pings are heard, over range and depth |
//! | `rays.rs` | which way sound goes in the run's water |
//! | `sinr.rs` | how far a packet stands out of the noise, over range |
//! | `estimators.rs` | how good the estimates of each group are, over time |
//! | `flock.rs` | how the swarm moves and holds together, over time |
//! | `tubes.rs` | what is known of one AUV: without pings, online, offline |
//! | `widths.rs` | how wide enclosures are, over time |
//! | `map.rs` | where everyone is and believes to be, at one moment |
//! | `paving.rs` | where the last pings let one AUV be, at one moment |
//! | `links.rs` | who hears whom, at one moment and over time |
//!
//! Each is a [`Plot`]: it takes the rows of the record one by one and ends as a figure. What it keeps does not grow with the
//! record, but for what is kept of one AUV at every tick (`tubes`, `widths`), and for numbers of each second (`links`).

mod depths;
mod estimators;
mod fate;
mod flock;
mod groups;
mod links;
mod losses;
mod map;
mod paving;
mod ranges;
mod rays;
mod reach;
mod sinr;
mod thinned;
mod tubes;
mod water;
mod way;
mod widths;

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use shoal_bus::record::{Ending, RecordHeader, Row, Topic, read_rows};

use crate::exit::Exit;
use crate::failure::Failure;
use crate::figure::Figure;

pub use fate::Fate;
use groups::told;

#[derive(Debug, Args)]
pub struct PlotArgs {
    /// The record, as `shoal run --record` leaves it
    pub record: PathBuf,
    /// What to draw
    #[arg(value_enum)]
    pub kind: Kind,
    /// File to write; standard output unless given
    #[arg(long, short, value_name = "FILE.svg")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub of: Of,
}

/// What of the run to draw.
#[derive(Clone, Copy, Debug, Default, Args)]
pub struct Of {
    /// For `tubes`, `widths` and `paving`: of which AUV, counted from 0
    #[arg(long, value_name = "N")]
    pub auv: Option<u32>,
    /// For `map`, `links` and `paving`: at which true time in seconds; at the end of the record unless given
    #[arg(long, value_name = "SECONDS", value_parser = parse_moment)]
    pub at_s: Option<f64>,
    /// For `rays`: depth of the source in metres; that of the first ping unless given
    #[arg(long, value_name = "METRES")]
    pub depth_m: Option<f64>,
    /// For `rays`: how far to follow them, in metres; as far as pings went unless given
    #[arg(long, value_name = "METRES")]
    pub range_m: Option<f64>,
}

fn parse_moment(text: &str) -> Result<f64, String> {
    let at_s = text.parse().ok().filter(|at_s| (0.0..=1e9).contains(at_s));
    at_s.ok_or_else(|| "give seconds of true time, such as `12.5`".to_owned())
}

/// A moment in nanoseconds of true time; later than any record unless given.
fn moment_ns(at_s: Option<f64>) -> i64 {
    at_s.map_or(i64::MAX, |at_s| (at_s * 1e9).round() as i64)
}

/// What to draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Kind {
    /// What became of the pings, over time: heard, or lost and why
    Losses,
    /// What travel times say of ranges, against the truth: outliers stand out
    Ranges,
    /// Where pings are heard and lost, over range and depth of the receiver: shadow zones
    Reach,
    /// Speed of sound over depth, and the rays of a source
    Rays,
    /// Signal over noise and interference, over range
    Sinr,
    /// How often the truth is inside what each group believes, NEES of Kalman filters, error and width, over time
    Estimators,
    /// Least separation, polarization, algebraic connectivity and connected components of the swarm, over time
    Flock,
    /// Position and clock of one AUV over time, with the truth inside; online, and for what `localize --offline` writes also without
    /// pings and offline
    Tubes,
    /// How wide position boxes and clock intervals are, over time: the swarm's quantiles, and one AUV with --auv
    Widths,
    /// Where the AUVs are and believe to be, at one moment, and the pings under way
    Map,
    /// Who hears whom, at one moment and over time
    Links,
    /// Where the last pings that one AUV heard let it be, at one moment: rings, and the sub-paving of what lies in all of them
    Paving,
}

/// A figure in the making.
pub trait Plot {
    /// The topics whose rows it takes.
    fn topics(&self) -> &'static [Topic];

    /// Takes a row, in the order of the record.
    fn take(&mut self, row: &Row);

    /// The figure of all that was taken; its subtitle is the caller's. When there is nothing to show, a sentence that says why.
    fn figure(self: Box<Self>, header: &RecordHeader) -> Result<Figure, String>;
}

/// Draws a figure of a record. A record that was cut is drawn as far as it goes.
pub fn plot(args: &PlotArgs) -> Result<Exit, Failure> {
    let flags: [(&str, bool, &[Kind], &str); 4] = [
        ("--depth-m", args.of.depth_m.is_some(), &[Kind::Rays], "`rays`"),
        ("--range-m", args.of.range_m.is_some(), &[Kind::Rays], "`rays`"),
        (
            "--auv",
            args.of.auv.is_some(),
            &[Kind::Tubes, Kind::Widths, Kind::Paving],
            "`tubes`, `widths` and `paving`",
        ),
        (
            "--at-s",
            args.of.at_s.is_some(),
            &[Kind::Map, Kind::Links, Kind::Paving],
            "`map`, `links` and `paving`",
        ),
    ];
    if let Some((flag, _, _, names)) =
        flags.iter().find(|(_, is_given, kinds, _)| *is_given && !kinds.contains(&args.kind))
    {
        return Err(Failure::usage(format!("{flag} is for {names}: leave it out")));
    }
    let path = args.record.display();
    let wrong = |error: &dyn std::fmt::Display| Failure::failed(format!("{path}: {error}"));
    let file = File::open(&args.record).map_err(|error| wrong(&error))?;
    let (svg, ending) = draw_one(file, plot_of(args.kind, &args.of)).map_err(|error| wrong(&error))?;
    match &args.out {
        Some(out) => write(out, &svg)?,
        // A reader that has enough closes the pipe.
        None => {
            let _closed = std::io::stdout().lock().write_all(svg.as_bytes());
        }
    }
    if let Ending::Truncated { .. } = ending {
        eprintln!("warning: {path} ends before the run does: the figure shows what is there");
        return Ok(Exit::Loss);
    }
    Ok(Exit::Good)
}

/// The figure of a kind, yet to be fed.
pub fn plot_of(kind: Kind, of: &Of) -> Box<dyn Plot> {
    match kind {
        Kind::Losses => Box::<losses::Losses>::default(),
        Kind::Ranges => Box::<ranges::Ranges>::default(),
        Kind::Reach => Box::<reach::Reach>::default(),
        Kind::Rays => Box::new(rays::Rays::new(of.depth_m, of.range_m)),
        Kind::Sinr => Box::<sinr::Sinr>::default(),
        Kind::Estimators => Box::<estimators::Estimators>::default(),
        Kind::Flock => Box::<flock::Flock>::default(),
        Kind::Tubes => Box::new(tubes::Tubes::new(of.auv.unwrap_or(0))),
        Kind::Widths => Box::new(widths::Widths::new(of.auv)),
        Kind::Map => Box::new(map::Map::new(of.at_s)),
        Kind::Links => Box::new(links::Links::new(of.at_s)),
        Kind::Paving => Box::new(paving::Paving::new(of.auv.unwrap_or(0), of.at_s)),
    }
}

/// What a record tells once it is read: its header, a figure of each plot or why there is none, and how it ends.
pub struct Drawn {
    /// What stands at the beginning.
    pub header: RecordHeader,
    /// As many as there were plots, in their order.
    pub figures: Vec<Result<Figure, String>>,
    /// How the record ends.
    pub ending: Ending,
}

/// Feeds all plots in one pass, and `also` with every row of theirs and of `topics`.
pub fn draw(
    record: impl std::io::Read + std::io::Seek,
    mut plots: Vec<Box<dyn Plot>>,
    topics: &[Topic],
    also: &mut dyn FnMut(&Row),
) -> Result<Drawn, String> {
    let mut header = None;
    let wanted =
        |topic: &Topic| topics.contains(topic) || plots.iter().any(|plot| plot.topics().contains(topic));
    let topics: Vec<Topic> = Topic::ALL.into_iter().filter(wanted).collect();
    let mut take = |row: Row| match row {
        Row::Header(found) => header = Some(found),
        row => {
            also(&row);
            plots.iter_mut().for_each(|plot| plot.take(&row));
        }
    };
    let ending = read_rows(record, &topics, &mut take).map_err(|error| error.to_string())?;
    let header = header.ok_or("the record was cut before anything happened")?;
    let subtitle = run_of(&header);
    let figure = |plot: Box<dyn Plot>| {
        plot.figure(&header).map(|figure| Figure { subtitle: subtitle.clone(), ..figure })
    };
    let figures = plots.into_iter().map(figure).collect();
    Ok(Drawn { header, figures, ending })
}

/// The text of one figure, and how the record ends.
fn draw_one(
    record: impl std::io::Read + std::io::Seek,
    plot: Box<dyn Plot>,
) -> Result<(String, Ending), String> {
    let drawn = draw(record, vec![plot], &[], &mut |_| {})?;
    let figure = drawn.figures.into_iter().next().unwrap_or_else(|| Err("nothing to draw".to_owned()))?;
    Ok((figure.to_svg(), drawn.ending))
}

/// Which run it is, in a few words.
pub fn run_of(header: &RecordHeader) -> String {
    let auvs = header.auvs.len();
    let plural = if auvs == 1 { "" } else { "s" };
    format!("{}, seed {}, {auvs} AUV{plural}", header.scenario_name, header.seed)
}

fn write(out: &Path, svg: &str) -> Result<(), Failure> {
    std::fs::write(out, svg)
        .map_err(|error| Failure::failed(format!("{}: the figure cannot be written: {error}", out.display())))
}

#[cfg(test)]
mod tests;
