//! A message as a line for people.

use std::fmt::{self, Display, Formatter};

use shoal_bus::record::Row;
use shoal_bus::record::rows::{FlockRow, LogRow, PingRow, Real, ReceptionRow, ReportRow, TruthRow};
use shoal_bus::time::SimTime;

/// A ping as a line: `    12.304 s     7 ->   12  heard    412.3 m  274.9 ms  SINR 14 dB  box 3.1 m`.
pub struct PingLine<'r>(pub &'r PingRow);

impl Display for PingLine<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.0 {
            PingRow::Emitted { t_ns, from, sequence, bytes, box_width_m, beyond_range, .. } => {
                begin(f, *t_ns)?;
                write!(
                    f,
                    "{from:>4} ->  all  emitted  #{sequence}  {bytes} B  box {} m",
                    tenths(box_width_m)
                )?;
                if *beyond_range > 0 { write!(f, "  {beyond_range} beyond range") } else { Ok(()) }
            }
            PingRow::Heard { t_ns, from, to, range_m, travel_s, box_width_m, reception, outlier, .. } => {
                begin(f, *t_ns)?;
                write!(
                    f,
                    "{from:>4} -> {to:>4}  heard    {} m  {:.1} ms",
                    tenths(range_m),
                    travel_s.0 * 1e3
                )?;
                received(f, reception.as_ref())?;
                write!(f, "  box {} m{}", tenths(box_width_m), if *outlier { "  outlier" } else { "" })
            }
            PingRow::Lost { t_ns, from, to, reason, range_m, reception, colliding, .. } => {
                begin(f, *t_ns)?;
                match to {
                    Some(to) => write!(f, "{from:>4} -> {to:>4}  lost     {} m", tenths(range_m))?,
                    None => write!(f, "{from:>4} ->  all  lost   ")?,
                }
                write!(f, "  {}", reason.name())?;
                received(f, reception.as_ref())?;
                for (index, other) in colliding.iter().enumerate() {
                    write!(f, "{}{other}", if index == 0 { "  with " } else { ", " })?;
                }
                Ok(())
            }
        }
    }
}

/// SINR, and the way if it was not the direct one.
fn received(f: &mut Formatter<'_>, reception: Option<&ReceptionRow>) -> fmt::Result {
    let Some(ReceptionRow { path, sinr_db, .. }) = reception else { return Ok(()) };
    write!(f, "  SINR {:.0} dB", sinr_db.0)?;
    if path == "direct" { Ok(()) } else { write!(f, "  off {path}") }
}

fn begin(f: &mut Formatter<'_>, at: SimTime) -> fmt::Result {
    write!(f, "{:10.3} s  ", at.as_s())
}

fn tenths(of: &Real) -> impl Display {
    let number = of.0;
    fmt::from_fn(move |f| write!(f, "{number:.1}"))
}

/// A message of any topic as a line; as JSON where there is nothing better.
pub struct Line<'r>(pub &'r Row);

impl Display for Line<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.0 {
            Row::Ping(ping) => PingLine(ping).fmt(f),
            Row::Truth(row) => truth(f, row),
            Row::Report(row) => report(f, row),
            Row::Log(row) => log(f, row),
            Row::Flock(row) => flock(f, row),
            row => {
                begin(f, row.at())?;
                f.write_str(&serde_json::to_string(row).map_err(|_| fmt::Error)?)
            }
        }
    }
}

fn truth(f: &mut Formatter<'_>, row: &TruthRow) -> fmt::Result {
    let TruthRow { auv, tick, t_ns, local_ns, position_m, heading_rad, .. } = row;
    begin(f, *t_ns)?;
    let [x, y, z] = position_m.map(|Real(metres)| metres);
    let ahead_ms = (local_ns.ns() - t_ns.ns()) as f64 * 1e-6;
    write!(f, "{auv:>4}  tick {tick}  at {x:.1} {y:.1} {z:.1} m")?;
    write!(f, "  heading {:.3} rad  clock {ahead_ms:+.3} ms", heading_rad.0)
}

fn report(f: &mut Formatter<'_>, row: &ReportRow) -> fmt::Result {
    let ReportRow { auv, tick, t_ns, neighbours, contractions, rejected, components, .. } = row;
    begin(f, *t_ns)?;
    write!(
        f,
        "{auv:>4}  tick {tick}  box {:.1} m  clock {:.2} ms",
        box_width_m(row),
        clock_width_s(row) * 1e3
    )?;
    write!(f, "  {neighbours} neighbours  {contractions} contractions")?;
    if *components > 1 {
        write!(f, "  {components} components")?;
    }
    if *rejected > 0 {
        write!(f, "  {rejected} rejected")?;
    }
    match &row.emptied {
        Some(emptied) => write!(f, "  emptied by {}", emptied.by),
        None => Ok(()),
    }
}

fn log(f: &mut Formatter<'_>, row: &LogRow) -> fmt::Result {
    begin(f, row.timestamp.sim_time())?;
    let level = if row.level >= 4 { "error" } else { "warning" };
    write!(f, "{level}  {}: {}", row.name, row.message)
}

fn flock(f: &mut Formatter<'_>, row: &FlockRow) -> fmt::Result {
    begin(f, row.t_ns)?;
    let flock = &row.flock;
    write!(f, "polarization {:.2}  connectivity {:.2}", flock.polarization, flock.connectivity)?;
    if let Some(separation_m) = flock.min_separation_m {
        write!(f, "  separation {separation_m:.1} m")?;
    }
    write!(f, "  {} collisions", flock.collisions)
}

/// Width of the position box in metres: of its widest side.
pub fn box_width_m(row: &ReportRow) -> f64 {
    row.position_m.iter().map(|[lower, upper]| upper.0 - lower.0).fold(0.0, f64::max)
}

/// Width of the clock interval in seconds.
pub fn clock_width_s(row: &ReportRow) -> f64 {
    let [lower, upper] = &row.clock_offset_s;
    upper.0 - lower.0
}
