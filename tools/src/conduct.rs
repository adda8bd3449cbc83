//! Conducts a run as it was ordered, and measures it.

use std::time::{Duration, Instant};

use shoal_bus::lockstep::Fleet;
use shoal_bus::summary::{FreeRun, Summary};
use shoal_channel::channel::Channel;
use shoal_scenario::{OnCrash, Scenario};

use crate::cli::Pace;
use crate::cpu::{CpuMeter, CpuTaken};
use crate::drive::{Ending, Observer, Plan, drive_watched};
use crate::failure::Failure;
use crate::free_run::{FreePlan, drive_freely};
use crate::launch::Order;
use crate::stopwatch::Stopwatch;

/// How a run went on this machine.
pub struct Conducted {
    /// How it ended.
    pub ending: Ending,
    wall_s: f64,
    watch: Stopwatch,
    cpu: Option<CpuTaken>,
    /// How far a free run was behind the wall clock at worst.
    lag_max: Option<Duration>,
}

/// Runs all windows. `processes` are those of the AUVs on this host.
pub fn conduct(
    order: &Order,
    scenario: &Scenario,
    channel: &mut Channel,
    fleet: &mut dyn Fleet,
    observers: &mut [&mut dyn Observer],
    interrupted: &dyn Fn() -> bool,
    processes: &[u32],
) -> Result<Conducted, Failure> {
    let mut watch = if order.timings { Stopwatch::on() } else { Stopwatch::off() };
    let meter = if order.timings { CpuMeter::start(processes) } else { None };
    let abort_on_crash = scenario.on_crash == OnCrash::Abort;
    let began = Instant::now();
    let (ending, lag_max) = match order.pace {
        Pace::Factor(pace) if order.free_run => {
            let asked_for = order.changes.window_ms.is_some();
            let window_ns = FreePlan::window_ns(scenario, asked_for)?;
            let plan = FreePlan { window_ns, pace, abort_on_crash };
            let (ending, lag_max) = drive_freely(channel, fleet, &plan, observers, interrupted, &mut watch)?;
            (ending, Some(lag_max))
        }
        pace => {
            let plan = Plan { window_ns: scenario.window_ns, pace, abort_on_crash };
            (drive_watched(channel, fleet, &plan, observers, interrupted, &mut watch)?, None)
        }
    };
    let wall_s = began.elapsed().as_secs_f64();
    let cpu = meter.and_then(|meter| meter.stop());
    Ok(Conducted { ending, wall_s, watch, cpu, lag_max })
}

impl Conducted {
    /// A run that was interrupted before its first window.
    pub fn nothing() -> Self {
        let (ending, watch) = (Ending::Interrupted, Stopwatch::off());
        Self { ending, wall_s: 0.0, watch, cpu: None, lag_max: None }
    }

    /// The channel's summary with what the wall clock knows of a free run.
    pub fn complete(&self, simulated: Summary) -> Summary {
        let Some(lag_max) = self.lag_max else { return simulated };
        let lag_max_s = lag_max.as_secs_f64();
        let free_run = FreeRun { lag_max_s, ..simulated.free_run.unwrap_or_default() };
        Summary { free_run: Some(free_run), reproducible: false, ..simulated }
    }

    /// A complete summary with the facts of this machine, but for its memory and processes.
    pub fn with_wall_facts(&self, simulated: Summary) -> Summary {
        let timings = self.watch.timings().map(|mut timings| {
            let per = |cpu: &CpuTaken| cpu.per(simulated.auvs, simulated.sim_s, simulated.wakes);
            timings.cpu = self.cpu.as_ref().map(per);
            timings
        });
        Summary {
            wall_s: Some(self.wall_s),
            real_time_factor: Some(simulated.sim_s / self.wall_s.max(1e-9)),
            timings,
            ..simulated
        }
    }
}
