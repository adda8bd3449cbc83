//! `shoal run`: starts the processes of a run, watches over them, and sums up.

use std::io::Write;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use shoal_auv::Auv;
use shoal_bus::local::Local;
use shoal_bus::lockstep::{Fleet, PROCESS_ENDED};
use shoal_bus::run_dir::RunDir;
use shoal_bus::summary::{Memory, Summary};
use shoal_channel::channel::Channel;
use shoal_scenario::Scenario;

use crate::agent_process::{check_commands, needs_no_processes};
use crate::cli::{Bus, RunArgs};
use crate::conduct::conduct;
use crate::drive::{Ending, Observer};
use crate::exit::Exit;
use crate::failure::{Failure, While};
use crate::free_run::FreePlan;
use crate::launch::{Done, FromChannel, Order};
use crate::limits;
use crate::memory;
use crate::observers::{Progress, Recorder, Tapped};
use crate::processes::{ChannelProcess, Ending as ProcessEnding, FAREWELL, HASTY_FAREWELL, Swarm};
use crate::progress::Bar;
use crate::seat::Seat;
use crate::summary_text;
use crate::timings_text;

/// The words of so many of the user's programs are shown.
const LOGS_SHOWN: usize = 8;

/// Runs a scenario and prints what it amounts to.
pub fn run(args: &RunArgs) -> Result<Exit, Failure> {
    let order = Order::read(args)?;
    let scenario = order.scenario()?;
    for warning in scenario.warnings() {
        eprintln!("warning: {warning}");
    }
    if order.free_run {
        FreePlan::window_ns(&scenario, order.changes.window_ms.is_some())?;
    }
    check_commands(&scenario, &order)?;
    if order.bus == Bus::Local {
        needs_no_processes(&scenario, "use `--bus iceoryx2` or `--bus zenoh`")?;
    }
    if order.bus != Bus::Local {
        limits::check(Seat::of_run(&order, &scenario).len(), order.bus)?;
    }
    RunDir::sweep();
    let interrupted = interrupts().while_doing("watch for Ctrl-C")?;
    let run = RunDir::create(&description(&scenario, &order)).while_doing("make a folder for the run")?;
    let _residue = Residue(run.clone());
    let bar = Bar::new(&scenario, args.quiet || args.json);
    let done = match order.bus {
        Bus::Local => in_this_program(&order, &scenario, &run, &interrupted, &bar)?,
        Bus::Iceoryx2 | Bus::Zenoh => in_processes(&order, &scenario, &run, &interrupted, &bar)?,
    };
    bar.finish();
    print_summary(args, &done)?;
    Ok(exit(&done))
}

/// Removes what the run leaves in shared memory, however it ends.
pub struct Residue(pub RunDir);

impl Drop for Residue {
    fn drop(&mut self) {
        if let Err(error) = self.0.remove() {
            eprintln!("warning: what is left of run {} could not be removed: {error}", self.0.id());
        }
    }
}

/// What others on this host may know of the run.
fn description(scenario: &Scenario, order: &Order) -> serde_json::Value {
    serde_json::json!({
        "format": "shoal.run/1",
        "scenario": scenario.name,
        "seed": scenario.seed,
        "auvs": scenario.auv_count(),
        "bus": order.bus_name(),
        "launcher": std::process::id(),
    })
}

/// A flag that Ctrl-C and a polite kill set.
pub fn interrupts() -> std::io::Result<Arc<AtomicBool>> {
    let flag = Arc::new(AtomicBool::new(false));
    for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM, signal_hook::consts::SIGHUP] {
        signal_hook::flag::register(signal, Arc::clone(&flag))?;
    }
    Ok(flag)
}

/// A process for the water and one for each seat.
fn in_processes(
    order: &Order,
    scenario: &Scenario,
    run: &RunDir,
    interrupted: &Arc<AtomicBool>,
    bar: &Bar,
) -> Result<Done, Failure> {
    let began = Instant::now();
    let mut channel = ChannelProcess::start(run, order, interrupted)?;
    let mut swarm = Swarm::default();
    let mut startup_s = None;
    loop {
        match channel.next()? {
            FromChannel::Ready => {
                swarm.start(run, order, Seat::of_run(order, scenario))?;
                channel.tell_processes(&swarm.pids());
            }
            FromChannel::Started => {
                startup_s = Some(began.elapsed().as_secs_f64());
                bar.start();
            }
            FromChannel::Progress(sim_s) => bar.advance(sim_s),
            FromChannel::Note(note) => bar.note(&note),
            FromChannel::News(news) => bar.log(&news),
            FromChannel::Failed { message } => {
                // What the user's programs said may be why.
                show_words(&swarm.wait(Duration::ZERO), bar);
                return Err(Failure { exit: Exit::Failed, message });
            }
            FromChannel::Done(mut done) => {
                done.summary.startup_s = startup_s;
                channel.wait();
                let endings = swarm.wait(if done.interrupted { HASTY_FAREWELL } else { FAREWELL });
                for lost in &mut done.summary.agents.lost {
                    let of_its_seat = endings.iter().find(|ending| ending.seat.auvs.contains(&lost.auv));
                    if let Some(ProcessEnding { reason: ending, .. }) = of_its_seat {
                        lost.reason = match lost.reason.as_str() {
                            PROCESS_ENDED => ending.clone(),
                            reason => format!("{reason}; {ending}"),
                        };
                    }
                }
                show_words(&endings, bar);
                for ending in endings.iter().filter(|ending| ending.was_killed) {
                    let lost = &done.summary.agents.lost;
                    if !lost.iter().any(|lost| ending.seat.auvs.contains(&lost.auv)) {
                        let whose = ending.seat.name();
                        bar.note(&format!(
                            "the process of {whose} did not end when it was told to, and was killed"
                        ));
                    }
                }
                return Ok(*done);
            }
        }
    }
}

/// Shows what the user's programs wrote.
fn show_words(endings: &[ProcessEnding], bar: &Bar) {
    for ending in endings.iter().filter(|ending| !ending.wrote.is_empty()).take(LOGS_SHOWN) {
        bar.log(&format!("{} wrote:\n{}", ending.seat.name(), ending.wrote));
    }
}

/// No processes: the reference.
fn in_this_program(
    order: &Order,
    scenario: &Scenario,
    run: &RunDir,
    interrupted: &AtomicBool,
    bar: &Bar,
) -> Result<Done, Failure> {
    let began = Instant::now();
    let mut channel = Channel::new(scenario).map_err(Failure::failed)?;
    let mut recorder = match &order.record {
        Some(path) => {
            channel.watch_flock();
            Some(Recorder::create(path, scenario, &order.text, &channel.born())?)
        }
        None => None,
    };
    let mut fleet = Local::on_all_cores(Auv::new);
    let losses = fleet.born(&channel.born()).map_err(Failure::failed)?;
    channel.stillborn(losses);
    let (mut tapped, trouble) = Tapped::create(run, scenario, &order.text, channel.born());
    trouble.iter().for_each(|trouble| bar.note(trouble));
    let startup_s = began.elapsed().as_secs_f64();
    bar.start();

    let mut progress = Progress::new(|sim_s| bar.advance(sim_s));
    let mut observers: Vec<&mut dyn Observer> = vec![&mut tapped, &mut progress];
    observers.extend(recorder.as_mut().map(|recorder| recorder as &mut dyn Observer));
    let is_interrupted = || interrupted.load(Ordering::Acquire);
    let conducted = conduct(order, scenario, &mut channel, &mut fleet, &mut observers, &is_interrupted, &[])?;

    let simulated = conducted.complete(channel.summary());
    let incomplete_record = recorder.and_then(|recorder| recorder.finish(&simulated));
    incomplete_record.iter().for_each(|trouble| bar.note(trouble));
    tapped.end(&simulated);
    let summary = Summary {
        bus: Some(order.bus.name().to_owned()),
        processes: Some(1),
        startup_s: Some(startup_s),
        memory: Some(Memory { auv_pss_kib_median: 0, channel_rss_kib: memory::own_rss_kib() }),
        ..conducted.with_wall_facts(simulated)
    };
    let interrupted = conducted.ending == Ending::Interrupted;
    Ok(Done { summary, interrupted, record_incomplete: incomplete_record.is_some(), aborted: None })
}

fn print_summary(args: &RunArgs, done: &Done) -> Result<(), Failure> {
    let text = if args.json {
        serde_json::to_string(&done.summary).while_doing("print the summary")? + "\n"
    } else {
        let timings = done.summary.timings.as_ref().map(timings_text::render);
        summary_text::render(&done.summary) + &timings.unwrap_or_default()
    };
    if let Some(aborted) = &done.aborted {
        eprintln!("error: the run was aborted: {aborted}");
    }
    if done.interrupted {
        eprintln!("warning: interrupted before the scenario's end");
    }
    // Whoever closed our output does not want the summary; the exit code still tells.
    let _closed = std::io::stdout().lock().write_all(text.as_bytes());
    Ok(())
}

fn exit(done: &Done) -> Exit {
    if done.summary.containment.violations > 0 {
        Exit::Violated
    } else if done.interrupted || done.record_incomplete || !done.summary.agents.lost.is_empty() {
        Exit::Loss
    } else {
        Exit::Good
    }
}
