//! Drives a run: window by window between the water and a fleet of AUVs, with observers looking on.

use std::time::{Duration, Instant};

use shoal_bus::chronicle::Entry;
use shoal_bus::lockstep::{Fleet, FleetError, Loss};
use shoal_bus::summary::Phase;
use shoal_bus::time::SimTime;
use shoal_channel::channel::Channel;

use crate::cli::Pace;
use crate::failure::Failure;
use crate::stopwatch::Stopwatch;

/// Someone who looks on without changing anything.
pub trait Observer {
    /// All that happened before `to` and was not yet told, in order.
    fn window(&mut self, to: SimTime, entries: &[Entry]);

    /// Whether it wants to be told how the swarm holds together, from now on.
    fn watches_flock(&self) -> bool {
        false
    }
}

/// How to drive.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// Nanoseconds of true time per window.
    pub window_ns: i64,
    /// How fast.
    pub pace: Pace,
    /// Whether the end of any AUV ends the run.
    pub abort_on_crash: bool,
}

/// How the drive ended, short of failing.
#[derive(Debug, PartialEq)]
pub enum Ending {
    /// The scenario's end was reached.
    Complete,
    /// The user asked to stop.
    Interrupted,
    /// An AUV ended and the scenario says that the run ends with it.
    Aborted(Loss),
}

/// Runs from the channel's present to its end. `interrupted` is asked once a window.
pub fn drive(
    channel: &mut Channel,
    fleet: &mut dyn Fleet,
    plan: &Plan,
    observers: &mut [&mut dyn Observer],
    interrupted: &dyn Fn() -> bool,
) -> Result<Ending, Failure> {
    drive_watched(channel, fleet, plan, observers, interrupted, &mut Stopwatch::off())
}

/// As [`drive`], with a stopwatch at hand.
pub fn drive_watched(
    channel: &mut Channel,
    fleet: &mut dyn Fleet,
    plan: &Plan,
    observers: &mut [&mut dyn Observer],
    interrupted: &dyn Fn() -> bool,
    watch: &mut Stopwatch,
) -> Result<Ending, Failure> {
    let ending = windows(channel, fleet, plan, observers, interrupted, watch);
    // The last window is still to be told, however it ended.
    tell(channel, observers)?;
    ending
}

fn windows(
    channel: &mut Channel,
    fleet: &mut dyn Fleet,
    plan: &Plan,
    observers: &mut [&mut dyn Observer],
    interrupted: &dyn Fn() -> bool,
    watch: &mut Stopwatch,
) -> Result<Ending, Failure> {
    let began = Instant::now();
    while channel.now() < channel.end() {
        if interrupted() {
            return Ok(Ending::Interrupted);
        }
        let to = (channel.now() + plan.window_ns).min(channel.end());
        keep_pace(plan.pace, began, to, interrupted);
        if observers.iter().any(|observer| observer.watches_flock()) {
            channel.watch_flock();
        }
        watch.begin();
        let sensed = channel.advance(to).map_err(Failure::failed)?;
        watch.lap(Phase::Channel);
        let mut told = Ok(());
        let answers = fleet.exchange(&sensed, &mut || {
            watch.lap(Phase::Wake);
            told = tell(channel, observers);
            watch.lap(Phase::Record);
        });
        watch.lap_gathered(fleet.waited());
        told?;
        let answers = match answers {
            Ok(answers) => answers,
            Err(FleetError::Interrupted) => return Ok(Ending::Interrupted),
            Err(error) => return Err(Failure::failed(error)),
        };
        let loss = answers.losses.first().cloned();
        channel.accept(sensed, answers);
        watch.lap(Phase::Accept);
        watch.end(to);
        if let Some(loss) = loss.filter(|_| plan.abort_on_crash) {
            return Ok(Ending::Aborted(loss));
        }
        if !revive(channel, fleet)? {
            return Ok(Ending::Interrupted);
        }
    }
    Ok(Ending::Complete)
}

/// Gives those a new life whom the fleet can carry again. `false`: interrupted.
pub fn revive(channel: &mut Channel, fleet: &mut dyn Fleet) -> Result<bool, Failure> {
    let vacancies = fleet.vacancies();
    if vacancies.is_empty() {
        return Ok(true);
    }
    let born = channel.revive(&vacancies);
    match fleet.born(&born) {
        Ok(losses) => channel.stillborn(losses),
        Err(FleetError::Interrupted) => return Ok(false),
        Err(error) => return Err(Failure::failed(error)),
    }
    Ok(true)
}

/// Tells the observers what happened in the window last accepted.
pub fn tell(channel: &mut Channel, observers: &mut [&mut dyn Observer]) -> Result<(), Failure> {
    let to = channel.accepted();
    let entries = channel.chronicle().map_err(Failure::failed)?;
    for observer in observers.iter_mut() {
        observer.window(to, entries);
    }
    Ok(())
}

/// Waits until the wall clock has come as far as the end of the window, or until interrupted.
fn keep_pace(pace: Pace, began: Instant, to: SimTime, interrupted: &dyn Fn() -> bool) {
    const LOOK_AGAIN: Duration = Duration::from_millis(50);
    let Pace::Factor(factor) = pace else { return };
    // A pace too slow to be told in seconds is one that waits for ever.
    let due = Duration::try_from_secs_f64(to.as_s() / factor).unwrap_or(Duration::MAX);
    while let Some(early) = due.checked_sub(began.elapsed()).filter(|early| !early.is_zero()) {
        if interrupted() {
            return;
        }
        std::thread::sleep(early.min(LOOK_AGAIN));
    }
}
