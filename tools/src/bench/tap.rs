//! `shoal bench tap`: what a tap costs the run that it looks at.

use std::io::Write as _;
use std::process::{Command, Output, Stdio};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use clap::Args;
use serde_json::json;
use shoal_bus::run_dir::RunDir;
use shoal_bus::summary::Summary;

use crate::exit::Exit;
use crate::failure::{Failure, While};

/// How long a run may take to show that it is there.
const PATIENCE: Duration = Duration::from_secs(60);

#[derive(Debug, Args)]
pub struct TapBenchArgs {
    /// What to run
    #[arg(long, default_value = "swarm-300")]
    pub scenario: String,
    /// Simulated seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 30.0)]
    pub duration_s: f64,
    /// How often to run it without and with a tap, in turns
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..))]
    pub pairs: u32,
    /// What the tap does, as behind `shoal tap`
    #[arg(long, value_name = "ARGUMENTS", default_value = "")]
    pub tap: String,
    /// One JSON line
    #[arg(long)]
    pub json: bool,
}

/// What a tap said when it ended.
struct TapEnd {
    lines: u64,
    words: String,
}

/// Runs the scenario without and with a tap at full speed, in turns, and prints how the rates compare.
///
/// # Errors
/// When a run fails, or a tap changes a digest.
pub fn tap(args: &TapBenchArgs) -> Result<Exit, Failure> {
    let (mut ratios, mut rates, mut digest) = (Vec::new(), Vec::new(), None);
    let mut last = TapEnd { lines: 0, words: String::new() };
    for pair in 0..args.pairs {
        // Whoever comes second finds a warmer machine: they take turns in that as well.
        let mut of = [None, None];
        for tapped in if pair % 2 == 0 { [false, true] } else { [true, false] } {
            let (summary, end) = one(args, tapped)?;
            let known = digest.get_or_insert_with(|| summary.digest.clone());
            if *known != summary.digest {
                return Err(Failure::failed(format!(
                    "the digest is {} now, and was {known}",
                    summary.digest
                )));
            }
            if let Some(slot) = of.get_mut(usize::from(tapped)) {
                *slot = summary.real_time_factor;
            }
            last = end.unwrap_or(last);
        }
        if let [Some(without), Some(with)] = of {
            ratios.push(with / without);
            rates.push(without);
        }
    }
    let (Some(ratio), Some(rate)) = (median(&mut ratios), median(&mut rates)) else {
        return Err(Failure::failed("no run told its rate"));
    };
    let least = ratios.first().copied().unwrap_or(ratio);
    let text = if args.json {
        let name = format!("tap/{}", args.scenario);
        let line = json!({ "format": "shoal.bench/1", "name": name, "value": rate * ratio, "unit": "x real time",
            "beside": { "name": format!("{name}/without"), "ratio": ratio }, "least_ratio": least, "pairs": ratios.len(),
            "digest": digest, "lines": last.lines, "said": last.words.trim() });
        format!("{line}\n")
    } else {
        format!(
            "{rate:.2} x real time without a tap; with one {:.3} of that (median of {} pairs, least {least:.3})\n\
            the digest is the same, {}\nthe last tap printed {} lines. {}\n",
            ratio,
            ratios.len(),
            digest.unwrap_or_default(),
            last.lines,
            last.words.trim(),
        )
    };
    // Whoever closed our output does not want the figures.
    let _closed = std::io::stdout().lock().write_all(text.as_bytes());
    Ok(Exit::Good)
}

fn median(values: &mut [f64]) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

fn one(args: &TapBenchArgs, tapped: bool) -> Result<(Summary, Option<TapEnd>), Failure> {
    let exe = std::env::current_exe().while_doing("find this program's own file")?;
    let duration = args.duration_s.to_string();
    let run = Command::new(&exe)
        .args(["run", &args.scenario, "--json", "--quiet", "--duration-s", &duration])
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .spawn()
        .while_doing("start a run")?;
    let tap = if tapped { Some(attach(&exe, args, run.id())) } else { None }.transpose();
    let output = run.wait_with_output().while_doing("wait for a run")?;
    let end = match tap? {
        // A thread that reads does not panic.
        Some(reader) => Some(reader.join().unwrap_or_else(|_| Err(std::io::ErrorKind::Other.into()))),
        None => None,
    };
    let end = end.transpose().while_doing("wait for a tap")?;
    if !output.status.success() {
        return Err(Failure::failed(format!("the run did not end well: {}", output.status)));
    }
    let summary = serde_json::from_slice(&output.stdout).while_doing("understand the summary of a run")?;
    let end = end.map(|output| TapEnd {
        lines: output.stdout.iter().filter(|byte| **byte == b'\n').count() as u64,
        words: String::from_utf8_lossy(&output.stderr).into_owned(),
    });
    Ok((summary, end))
}

/// A tap on the run of `launcher`, from its beginning on, and who reads what it prints.
fn attach(
    exe: &std::path::Path,
    args: &TapBenchArgs,
    launcher: u32,
) -> Result<JoinHandle<std::io::Result<Output>>, Failure> {
    let since = Instant::now();
    let is_of = |run: &RunDir| run.description().is_ok_and(|said| said["launcher"] == launcher);
    let run = loop {
        if let Some(run) = RunDir::list().into_iter().find(is_of) {
            break run;
        }
        if since.elapsed() > PATIENCE {
            return Err(Failure::failed("the run does not begin"));
        }
        std::thread::sleep(Duration::from_millis(5));
    };
    let tap = Command::new(exe)
        .arg("tap")
        .args(args.tap.split_whitespace())
        .args(["--run", run.id(), "--wait", "60"])
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .while_doing("start a tap")?;
    Ok(std::thread::spawn(move || tap.wait_with_output()))
}
