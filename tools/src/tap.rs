//! `shoal tap`: watches the pings of a live run.

use std::io::{self, Write};
use std::time::{Duration, Instant};

use serde_json::json;
use shoal_bus::record::rows::{PingRow, ReceptionRow};
use shoal_bus::record::{Row, Topic};
use shoal_bus::run_dir::RunDir;
use shoal_bus::tap::{TapError, TapItem, TapSubscriber};

use crate::cli::TapArgs;
use crate::exit::Exit;
use crate::failure::{Failure, While};

/// Prints every event of the tapped run until it ends, or `--count` are printed.
pub fn run(args: &TapArgs) -> Result<Exit, Failure> {
    let mut tap = attached(args)?;
    let mut out = io::BufWriter::new(io::stdout().lock());
    let mut left = args.count.unwrap_or(u64::MAX);
    while left > 0 {
        let Some(item) = tap.next(Duration::from_millis(200)).while_doing("listen to the run")? else {
            if out.flush().is_err() || !tap.run_is_live() {
                break;
            }
            continue;
        };
        let TapItem::Window(window) = item else { break };
        for row in window.rows.iter().take(left.try_into().unwrap_or(usize::MAX)) {
            let Row::Ping(ping) = row else { continue };
            let line = if args.json { json_line(ping) } else { text_line(ping) };
            if writeln!(out, "{line}").is_err() {
                // Whoever read us has gone: so do we.
                return Ok(Exit::Good);
            }
            left -= 1;
        }
        // What has happened is seen at once, however little it is.
        if out.flush().is_err() {
            return Ok(Exit::Good);
        }
    }
    let _closed = out.flush();
    match tap.missed() {
        0 => Ok(Exit::Good),
        missed => {
            eprintln!("warning: this tap was too slow and missed {missed} events");
            Ok(Exit::Loss)
        }
    }
}

/// A tap on one run, and the run.
struct Attached {
    run: RunDir,
    tap: TapSubscriber,
}

impl Attached {
    fn next(&mut self, timeout: Duration) -> Result<Option<TapItem>, TapError> {
        self.tap.next(timeout)
    }

    fn missed(&self) -> u64 {
        self.tap.missed()
    }

    fn run_is_live(&self) -> bool {
        self.run.is_live()
    }
}

/// Finds the run and attaches, waiting as long as `--wait` says.
fn attached(args: &TapArgs) -> Result<Attached, Failure> {
    let patience = Duration::try_from_secs_f64(args.wait).ok();
    let deadline = patience.and_then(|patience| Instant::now().checked_add(patience));
    let wrong = || Failure::usage(format!("--wait {}: give a number of seconds, 0 or more", args.wait));
    let deadline = deadline.ok_or_else(wrong)?;
    loop {
        let attempt = chosen(args).and_then(|run| match TapSubscriber::attach(&run, &[Topic::Pings]) {
            Ok(tap) => Ok(Attached { run, tap }),
            Err(_) => Err(Failure::failed(format!(
                "run {} is just starting or ending and cannot be tapped; give --wait SECONDS",
                run.id()
            ))),
        });
        match attempt {
            Err(failure) if Instant::now() >= deadline || failure.exit == Exit::Usage => return Err(failure),
            Err(_) => std::thread::sleep(Duration::from_millis(20)),
            Ok(attached) => return Ok(attached),
        }
    }
}

/// The run that `--run` names, or the only one.
fn chosen(args: &TapArgs) -> Result<RunDir, Failure> {
    let mut live: Vec<RunDir> = RunDir::list();
    if let Some(id) = &args.run {
        let names = list(&live);
        return live.into_iter().find(|run| run.id() == id).ok_or_else(|| {
            Failure::failed(format!("no live run has the id `{id}`; live on this host: {names}"))
        });
    }
    match live.len() {
        0 => Err(Failure::failed(
            "no run is live on this host; start one with `shoal run`, or give --wait SECONDS",
        )),
        1 => Ok(live.swap_remove(0)),
        _ => Err(Failure::usage(format!("several runs are live, choose one with --run ID: {}", list(&live)))),
    }
}

fn list(runs: &[RunDir]) -> String {
    let name = |run: &RunDir| {
        let description = run.description().unwrap_or_default();
        let scenario = description["scenario"].as_str().unwrap_or("?").to_owned();
        format!("{} ({scenario})", run.id())
    };
    if runs.is_empty() { "none".to_owned() } else { runs.iter().map(name).collect::<Vec<_>>().join(", ") }
}

fn text_line(ping: &PingRow) -> String {
    match ping {
        PingRow::Emitted { t_ns, from, sequence, bytes, box_width_m, beyond_range, .. } => format!(
            "{:10.3} s  {from:>4} ->  all  emitted  #{sequence}  {bytes} B  box {:.1} m  {beyond_range} beyond range",
            t_ns.as_s(),
            box_width_m.0
        ),
        PingRow::Heard { t_ns, from, to, range_m, travel_s, box_width_m, reception, outlier, .. } => format!(
            "{:10.3} s  {from:>4} -> {to:>4}  heard  {:.1} m  {:.1} ms{}  box {:.1} m{}",
            t_ns.as_s(),
            range_m.0,
            travel_s.0 * 1e3,
            reception.as_ref().map_or(String::new(), |reception| format!("  {}", reception_text(reception))),
            box_width_m.0,
            if *outlier { "  outlier" } else { "" },
        ),
        PingRow::Lost { t_ns, from, to, reason, range_m, reception, colliding, .. } => {
            let to = to.map_or("-".to_owned(), |to| to.to_string());
            let reception = reception
                .as_ref()
                .map_or(String::new(), |reception| format!("  {}", reception_text(reception)));
            let with = match colliding.as_slice() {
                [] => String::new(),
                others => {
                    let names: Vec<String> = others.iter().map(ToString::to_string).collect();
                    format!("  with {}", names.join(", "))
                }
            };
            format!(
                "{:10.3} s  {from:>4} -> {to:>4}  lost   {:.1} m  {}{reception}{with}",
                t_ns.as_s(),
                range_m.0,
                reason.name()
            )
        }
    }
}

/// Received level, SINR and path.
fn reception_text(reception: &ReceptionRow) -> String {
    let ReceptionRow { path, level_db, sinr_db, .. } = reception;
    format!("{:.0} dB  SINR {:.0} dB  {path}", level_db.0, sinr_db.0)
}

fn json_line(ping: &PingRow) -> String {
    let mut line = json!(ping);
    line["format"] = "shoal.ping/1".into();
    line.to_string()
}
