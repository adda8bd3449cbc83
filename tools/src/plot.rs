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
//!
//! Each is a [`Plot`]: it takes the rows of the record one by one and ends as a figure. What it keeps does not grow with the
//! record, but for `tubes`, which keeps what is known of its AUV at every tick.

mod depths;
mod estimators;
mod fate;
mod flock;
mod losses;
mod ranges;
mod rays;
mod reach;
mod sinr;
mod thinned;
mod tubes;
mod water;
mod way;

use std::fs::File;
use std::io::Write;
use std::path::Path;

use clap::ValueEnum;
use shoal_bus::record::{Ending, RecordHeader, Row, Topic, read_rows};

use crate::cli::PlotArgs;
use crate::exit::Exit;
use crate::failure::Failure;
use crate::figure::Figure;

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
    /// Clock and x of one AUV without pings, online and offline, with the truth inside; for what `localize --offline` writes
    Tubes,
}

/// A figure in the making.
trait Plot {
    /// The topics whose rows it takes.
    fn topics(&self) -> &'static [Topic];

    /// Takes a row, in the order of the record.
    fn take(&mut self, row: &Row);

    /// The figure of all that was taken; its subtitle is the caller's. When there is nothing to show, a sentence that says why.
    fn figure(self: Box<Self>, header: &RecordHeader) -> Result<Figure, String>;
}

/// Draws a figure of a record. A record that was cut is drawn as far as it goes.
pub fn plot(args: &PlotArgs) -> Result<Exit, Failure> {
    let flags = [
        ("--depth-m", args.depth_m.is_some(), Kind::Rays, "rays"),
        ("--range-m", args.range_m.is_some(), Kind::Rays, "rays"),
        ("--auv", args.auv.is_some(), Kind::Tubes, "tubes"),
    ];
    if let Some((flag, _, _, name)) =
        flags.iter().find(|(_, is_given, kind, _)| *is_given && args.kind != *kind)
    {
        return Err(Failure::usage(format!("{flag} is for `{name}`: leave it out")));
    }
    let path = args.record.display();
    let wrong = |error: &dyn std::fmt::Display| Failure::failed(format!("{path}: {error}"));
    let file = File::open(&args.record).map_err(|error| wrong(&error))?;
    let (svg, ending) = draw(file, plot_of(args)).map_err(|error| wrong(&error))?;
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

fn plot_of(args: &PlotArgs) -> Box<dyn Plot> {
    match args.kind {
        Kind::Losses => Box::<losses::Losses>::default(),
        Kind::Ranges => Box::<ranges::Ranges>::default(),
        Kind::Reach => Box::<reach::Reach>::default(),
        Kind::Rays => Box::new(rays::Rays::new(args.depth_m, args.range_m)),
        Kind::Sinr => Box::<sinr::Sinr>::default(),
        Kind::Estimators => Box::<estimators::Estimators>::default(),
        Kind::Flock => Box::<flock::Flock>::default(),
        Kind::Tubes => Box::new(tubes::Tubes::new(args.auv.unwrap_or(0))),
    }
}

/// The text of the figure, and how the record ends.
fn draw(
    record: impl std::io::Read + std::io::Seek,
    mut plot: Box<dyn Plot>,
) -> Result<(String, Ending), String> {
    let mut header = None;
    let topics = plot.topics();
    let mut take = |row: Row| match row {
        Row::Header(found) => header = Some(found),
        row => plot.take(&row),
    };
    let ending = read_rows(record, topics, &mut take).map_err(|error| error.to_string())?;
    let header = header.ok_or("the record was cut before anything happened")?;
    let mut figure = plot.figure(&header)?;
    let auvs = header.auvs.len();
    let plural = if auvs == 1 { "" } else { "s" };
    figure.subtitle = format!("{}, seed {}, {auvs} AUV{plural}", header.scenario_name, header.seed);
    Ok((figure.to_svg(), ending))
}

fn write(out: &Path, svg: &str) -> Result<(), Failure> {
    std::fs::write(out, svg)
        .map_err(|error| Failure::failed(format!("{}: the figure cannot be written: {error}", out.display())))
}

#[cfg(test)]
mod tests;
