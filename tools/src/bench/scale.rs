//! `shoal bench scale`: what an AUV costs among more and more others at the same density.

use std::fmt::Write as _;
use std::io::Write as _;
use std::process::{Command, Stdio};

use clap::Args;
use serde_json::json;
use shoal_bus::summary::Summary;

use crate::cli::Bus;
use crate::exit::Exit;
use crate::failure::{Failure, While};
use crate::summary_text::grouped;

/// The swarm of this name in the library, of so many AUVs in a cube whose side is so many metres.
const SCENARIO: (&str, f64, f64) = ("swarm-300", 300.0, 1000.0);

/// Costs are told beside those of so many AUVs.
const BESIDE: u32 = 100;

#[derive(Debug, Args)]
pub struct ScaleArgs {
    /// Numbers of AUVs, one run for each
    #[arg(long, value_name = "N,N", value_delimiter = ',', default_value = "10,100,1000,3000,10000")]
    pub auvs: Vec<u32>,
    /// What carries the messages
    #[arg(long, value_enum, default_value_t = Bus::Iceoryx2)]
    pub bus: Bus,
    /// Simulated seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 10.0)]
    pub duration_s: f64,
    /// Seconds between an AUV's wake-ups
    #[arg(long, value_name = "SECONDS", default_value_t = 0.1)]
    pub control_period_s: f64,
    /// AUVs in each process
    #[arg(long, value_name = "K")]
    pub auvs_per_process: Option<u32>,
    /// One JSON line per run
    #[arg(long)]
    pub json: bool,
}

/// One run, measured.
struct Row {
    auvs: u32,
    summary: Summary,
    us_per_auv_s: f64,
}

/// Runs a swarm of the same density at every size, and prints what each costs.
pub fn scale(args: &ScaleArgs) -> Result<Exit, Failure> {
    let mut out = std::io::stdout().lock();
    // Whoever closed our output does not want the table.
    let mut say = |text: &str| drop(out.write_all(text.as_bytes()).and_then(|()| out.flush()));
    if !args.json {
        say(HEADER);
    }
    let mut beside = None;
    for &auvs in &args.auvs {
        let row = measure(args, auvs)?;
        if auvs == BESIDE {
            beside = Some(row.us_per_auv_s);
        }
        let ratio = beside.map(|beside| row.us_per_auv_s / beside);
        say(&if args.json { json_line(args, &row, ratio) } else { text_line(&row, ratio) });
    }
    Ok(Exit::Good)
}

/// The arguments of `shoal` for a run of `auvs` AUVs: the water is as deep as ever, and wide enough for the same density.
fn arguments(args: &ScaleArgs, auvs: u32) -> Vec<String> {
    let (scenario, count, side_m) = SCENARIO;
    let wide_m = side_m * (f64::from(auvs) / count).sqrt();
    let region = format!("[[0, {wide_m}], [0, {wide_m}], [-{side_m}, 0]]");
    let settings = [
        format!("group.count={auvs}"),
        format!("group.control_period_s={}", args.control_period_s),
        format!("environment.area_m={region}"),
        format!("group.start.region_m={region}"),
        format!("duration_s={}", args.duration_s),
    ];
    let mut arguments: Vec<String> =
        ["run", scenario, "--json", "--timings", "--bus", args.bus.name()].map(str::to_owned).to_vec();
    arguments.extend(settings.into_iter().flat_map(|setting| ["--set".to_owned(), setting]));
    if let Some(each) = args.auvs_per_process {
        arguments.extend(["--auvs-per-process".to_owned(), each.to_string()]);
    }
    arguments
}

fn measure(args: &ScaleArgs, auvs: u32) -> Result<Row, Failure> {
    let exe = std::env::current_exe().while_doing("find this program's own file")?;
    let output = Command::new(exe)
        .args(arguments(args, auvs))
        .stdin(Stdio::null())
        .stderr(Stdio::inherit())
        .output()
        .while_doing("start a run")?;
    if !output.status.success() {
        return Err(Failure::failed(format!("the run of {auvs} AUVs did not end well: {}", output.status)));
    }
    let summary: Summary =
        serde_json::from_slice(&output.stdout).while_doing("understand the summary of a run")?;
    let cpu = summary.timings.as_ref().and_then(|timings| timings.cpu);
    let cpu =
        cpu.ok_or_else(|| Failure::failed("the kernel does not tell the processor time of processes"))?;
    Ok(Row { auvs, us_per_auv_s: cpu.us_per_auv_s, summary })
}

const HEADER: &str = "      AUVs  real time  us per AUV-s  beside 100  channel us  switches/wake   start-up  AUV, MiB  channel, MiB\n";

fn text_line(row: &Row, ratio: Option<f64>) -> String {
    let Row { auvs, summary, us_per_auv_s } = row;
    let cpu = summary.timings.as_ref().and_then(|timings| timings.cpu).unwrap_or_default();
    let memory = summary.memory.unwrap_or_default();
    let mut text = String::new();
    // Writing to a string does not fail.
    let _infallible = writeln!(
        text,
        "{:>10}  {:>7.2} x  {us_per_auv_s:>12.1}  {:>10}  {:>10.1}  {:>13.2}  {:>7.2} s  {:>8.2}  {:>12.1}",
        grouped((*auvs).into()),
        summary.real_time_factor.unwrap_or(0.0),
        ratio.map_or("-".to_owned(), |ratio| format!("{ratio:.2}")),
        cpu.channel_us_per_auv_s,
        cpu.switches_per_wake,
        summary.startup_s.unwrap_or(0.0),
        memory.auv_pss_kib_median as f64 / 1024.0,
        memory.channel_rss_kib as f64 / 1024.0,
    );
    text
}

fn json_line(args: &ScaleArgs, row: &Row, ratio: Option<f64>) -> String {
    let Row { auvs, summary, us_per_auv_s } = row;
    let name = |auvs: u32| format!("scale/{}/{auvs}", args.bus.name());
    let line = json!({
        "format": "shoal.bench/1",
        "name": name(*auvs),
        "value": us_per_auv_s,
        "unit": "us/AUV-s",
        "beside": ratio.map(|ratio| json!({"name": name(BESIDE), "ratio": ratio})),
        "control_period_s": args.control_period_s,
        "real_time_factor": summary.real_time_factor,
        "startup_s": summary.startup_s,
        "cpu": summary.timings.as_ref().and_then(|timings| timings.cpu),
        "memory": summary.memory,
        "digest": summary.digest,
    });
    format!("{line}\n")
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;
    use crate::cli::{Cli, Command};
    use crate::launch::Order;

    #[test]
    fn the_density_is_the_same_at_every_size() {
        let args = ScaleArgs {
            auvs: Vec::new(),
            bus: Bus::Local,
            duration_s: 2.5,
            control_period_s: 1.0,
            auvs_per_process: None,
            json: false,
        };
        for auvs in [10, 300, 10_000] {
            let words = ["shoal".to_owned()].into_iter().chain(arguments(&args, auvs));
            let Command::Run(run) = Cli::parse_from(words).command else { panic!("no run") };
            let scenario = Order::read(&run).unwrap().scenario().unwrap();
            assert_eq!((scenario.auv_count(), scenario.duration_ns), (auvs, 2_500_000_000));
            let sides_m = scenario.environment.area_m.map(|[lower, upper]| upper - lower);
            let density = f64::from(auvs) / sides_m.iter().product::<f64>();
            assert!((density / 300e-9 - 1.0).abs() < 1e-12, "{density}");
        }
    }
}
