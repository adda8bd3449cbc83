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
    #[arg(long, value_name = "ARGUMENTS", default_value = "", allow_hyphen_values = true)]
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

/// What was measured without, or with, a tap.
#[derive(Default)]
struct Measured {
    /// Simulated seconds per second of each run.
    rates: Vec<f64>,
    /// Processor time of the run's own processes for each AUV and simulated second.
    cpu_us: Vec<f64>,
}

/// Runs the scenario without and with a tap at full speed, in turns, and prints how they compare.
///
/// # Errors
/// When a run fails, or a tap changes a digest.
pub fn tap(args: &TapBenchArgs) -> Result<Exit, Failure> {
    let (mut without, mut with) = (Measured::default(), Measured::default());
    let mut digest = None;
    let mut last = TapEnd { lines: 0, words: String::new() };
    for pair in 0..args.pairs {
        // Whoever comes second finds a warmer machine: they take turns in that as well.
        for tapped in if pair % 2 == 0 { [false, true] } else { [true, false] } {
            let (summary, end) = one(args, tapped)?;
            let known = digest.get_or_insert_with(|| summary.digest.clone());
            if *known != summary.digest {
                return Err(Failure::failed(format!(
                    "the digest is {} now, and was {known}",
                    summary.digest
                )));
            }
            let measured = if tapped { &mut with } else { &mut without };
            measured.rates.extend(summary.real_time_factor);
            let cpu = summary.timings.as_ref().and_then(|timings| timings.cpu);
            measured.cpu_us.extend(cpu.map(|cpu| cpu.us_per_auv_s));
            last = end.unwrap_or(last);
        }
    }
    let compared = compare(&mut without, &mut with);
    let Some(Compared { rate, ratio, median_ratio, cpu_ratio }) = compared else {
        return Err(Failure::failed("no run told its rate and processor time"));
    };
    let (pairs, lines, said) = (args.pairs, last.lines, last.words.trim());
    let text = if args.json {
        let name = format!("tap/{}", args.scenario);
        let line = json!({ "format": "shoal.bench/1", "name": name, "value": rate * ratio, "unit": "x real time",
            "beside": { "name": format!("{name}/without"), "ratio": ratio }, "median_ratio": median_ratio,
            "cpu_ratio": cpu_ratio, "pairs": pairs, "digest": digest, "lines": lines, "said": said });
        format!("{line}\n")
    } else {
        format!(
            "{pairs} runs without and with a tap, in turns; the digest is always {}\n\
            rate: {rate:.2} x real time without, {ratio:.3} of that with (fastest runs; medians {median_ratio:.3})\n\
            processor time of the run: {cpu_ratio:.3} of that without (medians)\n\
            the last tap printed {lines} lines. {said}\n",
            digest.unwrap_or_default(),
        )
    };
    // Whoever closed our output does not want the figures.
    let _closed = std::io::stdout().lock().write_all(text.as_bytes());
    Ok(Exit::Good)
}

struct Compared {
    /// The fastest without a tap.
    rate: f64,
    /// The fastest with a tap beside it: what else goes on on a machine only slows.
    ratio: f64,
    median_ratio: f64,
    cpu_ratio: f64,
}

fn compare(without: &mut Measured, with: &mut Measured) -> Option<Compared> {
    let median_ratio = median(&mut with.rates)? / median(&mut without.rates)?;
    let cpu_ratio = median(&mut with.cpu_us)? / median(&mut without.cpu_us)?;
    // Sorted by now.
    let (rate, tapped) = (*without.rates.last()?, *with.rates.last()?);
    Some(Compared { rate, ratio: tapped / rate, median_ratio, cpu_ratio })
}

fn median(values: &mut [f64]) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

fn one(args: &TapBenchArgs, tapped: bool) -> Result<(Summary, Option<TapEnd>), Failure> {
    let exe = std::env::current_exe().while_doing("find this program's own file")?;
    let duration = args.duration_s.to_string();
    let run = Command::new(&exe)
        .args(["run", &args.scenario, "--json", "--quiet", "--timings", "--duration-s", &duration])
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .spawn()
        .while_doing("start a run")?;
    let tap = if tapped { Some(attach(&exe, args, run.id())) } else { None }.transpose();
    let output = run.wait_with_output().while_doing("wait for a run")?;
    // A thread that reads does not panic.
    let end = tap?.map(|reader| reader.join().unwrap_or_else(|_| Err(std::io::ErrorKind::Other.into())));
    let end = end.transpose().while_doing("wait for a tap")?;
    if !output.status.success() {
        return Err(Failure::failed(format!("the run did not end well: {}", output.status)));
    }
    let summary = serde_json::from_slice(&output.stdout).while_doing("understand the summary of a run")?;
    if let Some(tap) = end.as_ref().filter(|tap| tap.status.code() == Some(Exit::Failed as i32)) {
        let words = String::from_utf8_lossy(&tap.stderr);
        return Err(Failure::failed(format!(
            "the tap failed, perhaps because the run was over before it came; give a longer --duration-s: {}",
            words.trim()
        )));
    }
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
        // Long enough for the run to be ready, short when it is over already.
        .args(["--run", run.id(), "--wait", "10"])
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .while_doing("start a tap")?;
    Ok(std::thread::spawn(move || tap.wait_with_output()))
}
