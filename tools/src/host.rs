//! `shoal host`: carries AUVs of a run whose water is on another machine.

use std::fs;
use std::io::Read;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use shoal_bus::hosts::{
    Assignment, Crew, DEFAULT_CONFIG, Decoding, Ending, Host, HostError, HostStopHandle, Joined, Network,
    Offer, Relay, ranges, scenario_hash,
};
use shoal_bus::lockstep::{FleetError, Loss, PROCESS_ENDED};
use shoal_bus::run_dir::RunDir;
use shoal_bus::shared_memory::SharedMemoryFleet;

use crate::cli::{Bus, HostArgs};
use crate::exit::Exit;
use crate::failure::{Failure, While};
use crate::janitor::Janitor;
use crate::processes::{HASTY_FAREWELL, Swarm};
use crate::run::interrupts;
use crate::seat::Seat;

/// How often a host says how far it is.
const PROGRESS: Duration = Duration::from_secs(10);

/// Joins a run, carries what it is given, and ends with the run.
pub fn host(args: &HostArgs) -> Result<Exit, Failure> {
    if args.print_zenoh_config {
        print!("{DEFAULT_CONFIG}");
        return Ok(Exit::Good);
    }
    let (Some(endpoint), Some(slots)) = (&args.connect, args.slots) else {
        return Err(Failure::usage("give `--connect tcp/ADDRESS:PORT` and `--slots N`"));
    };
    RunDir::sweep();
    let network = Network::new(args.network.zenoh_config.as_deref()).map_err(Failure::usage)?;
    let name = args.name.clone().unwrap_or_else(hostname);
    let offer = Offer {
        endpoint: endpoint.clone(),
        name: name.clone(),
        slots: slots.get(),
        token: token(args.network.token.as_deref())?,
        scenario: args.scenario.as_deref().map(insisted).transpose()?,
        wait: Duration::from_secs_f64(args.wait),
    };
    eprintln!("{name}: asking {endpoint} for a run, with {slots} slots");
    let host = Host::join(&offer, &network).map_err(Failure::failed)?;
    tell_joined(&name, host.joined());
    let interrupted = interrupts().while_doing("watch for Ctrl-C")?;
    let over = Arc::new(AtomicBool::new(false));
    let watching = pass_on(&interrupted, &over, host.stop_handle()).while_doing("start a thread")?;
    let mut crew = Carried { name: &name, scenario: host.joined().scenario.clone(), ..Carried::new(args) };
    let ending = host.serve(&mut crew);
    over.store(true, Ordering::Release);
    // It looks twenty times a second.
    let _ended = watching.join();
    finish(&name, &crew, ending)
}

fn tell_joined(name: &str, joined: &Joined) {
    let Joined { scenario, hash, clock_ahead_s, clock_error_s, is_spare } = joined;
    let role = if *is_spare { ", as a spare: it waits to take the place of a host that is lost" } else { "" };
    eprintln!("{name}: joined a run of {scenario} ({hash}){role}");
    eprintln!(
        "{name}: its clock is {clock_ahead_s:+.6} s from the launcher's, give or take {clock_error_s:.6} s"
    );
}

/// Says how it ended; the exit code is that of a run that lost what this host carried, if it did.
fn finish(name: &str, crew: &Carried, ending: Result<Ending, HostError>) -> Result<Exit, Failure> {
    let carried = if crew.carries_any() { "; its AUVs are lost" } else { "" };
    let (exit, said) = match ending.map_err(Failure::failed)? {
        Ending::Over => (Exit::Good, "the run is over".to_owned()),
        Ending::Failed(reason) => (Exit::Failed, format!("the run has failed: {reason}")),
        Ending::Dismissed(reason) => {
            (Exit::Loss, format!("the launcher has given this host up: {reason}{carried}"))
        }
        Ending::LauncherGone(limit) => (
            Exit::Loss,
            format!("the launcher was silent for {} s and is gone{carried}", limit.as_secs_f64()),
        ),
        Ending::Stopped => (Exit::Loss, format!("interrupted{carried}")),
    };
    eprintln!("{name}: ended after {}: {said}", crew.progress.told());
    Ok(exit)
}

/// Stops the host once the flag is set.
fn pass_on(
    interrupted: &Arc<AtomicBool>,
    over: &Arc<AtomicBool>,
    handle: HostStopHandle,
) -> std::io::Result<std::thread::JoinHandle<()>> {
    let (interrupted, over) = (Arc::clone(interrupted), Arc::clone(over));
    let watch = move || {
        while !over.load(Ordering::Acquire) {
            if interrupted.load(Ordering::Acquire) {
                return handle.stop();
            }
            std::thread::sleep(Duration::from_millis(50));
        }
    };
    std::thread::Builder::new().name("interrupts".to_owned()).spawn(watch)
}

/// What this host carries.
struct Carried<'a> {
    name: &'a str,
    scenario: String,
    // In this order: the AUVs end before their folder goes, and the janitor has nothing left to do.
    swarm: Swarm,
    run: Option<Residue>,
    janitor: Option<Janitor>,
    progress: Progress,
    quiet: bool,
}

/// Removes what a run leaves in shared memory, however it ends.
struct Residue(RunDir);

impl Drop for Residue {
    fn drop(&mut self) {
        if let Err(error) = self.0.remove() {
            eprintln!("warning: what is left of run {} could not be removed: {error}", self.0.id());
        }
    }
}

#[derive(Default)]
struct Progress {
    windows: u64,
    batches: u64,
    said: Option<Instant>,
}

impl Progress {
    fn told(&self) -> String {
        format!("{} windows with {} batches", self.windows, self.batches)
    }
}

impl Carried<'_> {
    fn new(args: &HostArgs) -> Self {
        Self {
            name: "",
            scenario: String::new(),
            swarm: Swarm::default(),
            run: None,
            janitor: None,
            progress: Progress::default(),
            quiet: args.quiet,
        }
    }

    fn carries_any(&self) -> bool {
        self.run.is_some()
    }

    fn try_start(&mut self, assignment: &Assignment) -> Result<Box<dyn Relay>, Failure> {
        let seats = Seat::of(&assignment.auvs, assignment.auvs_per_process);
        eprintln!("{}: carries AUVs {} in {} processes", self.name, ranges(&assignment.auvs), seats.len());
        let description = serde_json::json!({
            "format": "shoal.run/1",
            "scenario": self.scenario,
            "auvs": assignment.auvs.len(),
            "bus": Bus::Iceoryx2.name(),
            "launcher": std::process::id(),
        });
        let run = RunDir::create(&description).while_doing("make a folder for the run")?;
        self.janitor = Some(Janitor::start(&run)?);
        let run = &self.run.insert(Residue(run)).0;
        let processes = Seat::in_wake_order(&seats, &assignment.auvs);
        let mut fleet = SharedMemoryFleet::create(run, &processes).map_err(Failure::failed)?;
        self.swarm.start_in_memory(run, seats)?;
        fleet.attach_processes(&self.swarm.processes()).map_err(Failure::failed)?;
        let interrupt = fleet.interrupt_handle();
        Ok(Box::new(Decoding::new(fleet, move || interrupt.interrupt())))
    }
}

impl Crew for Carried<'_> {
    fn start(&mut self, assignment: &Assignment) -> Result<Box<dyn Relay>, FleetError> {
        self.try_start(assignment).map_err(|failure| FleetError::Setup {
            bus: Bus::Iceoryx2.name(),
            cause: failure.message.trim_start_matches("error: ").to_owned(),
        })
    }

    fn processes(&self) -> u32 {
        self.swarm.pids().len() as u32
    }

    fn explain(&mut self, loss: &mut Loss) {
        if let Some(ending) = self.swarm.ending_of(loss.auv).filter(|_| loss.reason == PROCESS_ENDED) {
            loss.reason = ending.reason;
        }
        eprintln!("{}: AUV {} is lost: {}", self.name, loss.auv, loss.reason);
    }

    fn progress(&mut self, windows: u64, batches: usize) {
        self.progress.windows = windows;
        self.progress.batches += batches as u64;
        let said = self.progress.said.get_or_insert_with(Instant::now);
        if !self.quiet && said.elapsed() >= PROGRESS {
            *said = Instant::now();
            eprintln!("{}: {}", self.name, self.progress.told());
        }
    }

    fn disband(&mut self) {
        for ending in self.swarm.wait(HASTY_FAREWELL).iter().filter(|ending| ending.was_killed) {
            let whose = ending.seat.name();
            eprintln!("warning: the process of {whose} did not end when it was told to, and was killed");
        }
    }
}

/// The token in a file, or in the environment where no file is given.
pub fn token(file: Option<&Path>) -> Result<Option<String>, Failure> {
    let Some(path) = file else {
        return Ok(std::env::var(TOKEN_ENV).ok().filter(|token| !token.is_empty()));
    };
    let wrong = |cause: &dyn std::fmt::Display| {
        Failure::usage(format!("--token {}: {cause}; put one line with the secret into it", path.display()))
    };
    let mut text = String::new();
    fs::File::open(path)
        .and_then(|mut file| file.read_to_string(&mut text))
        .map_err(|error| wrong(&error))?;
    match text.trim() {
        "" => Err(wrong(&"the file is empty")),
        token => Ok(Some(token.to_owned())),
    }
}

/// What holds the token where no file is given.
pub const TOKEN_ENV: &str = "SHOAL_TOKEN";

/// The hash of the scenario that the command line insists on.
fn insisted(scenario: &str) -> Result<String, Failure> {
    let (_, text) = shoal_scenario::load(scenario).map_err(Failure::usage)?;
    Ok(scenario_hash(&text))
}

fn hostname() -> String {
    let name = fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default();
    if name.trim().is_empty() { "host".to_owned() } else { name.trim().to_owned() }
}
