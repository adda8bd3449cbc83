//! Drives a run in real time, with deadlines: simulated time follows the wall clock, and nobody waits for an AUV that is late.

mod backlog;

use std::time::{Duration, Instant};

use shoal_bus::lockstep::{Fleet, FleetError};
use shoal_bus::summary::Phase;
use shoal_bus::time::SimTime;
use shoal_channel::channel::Channel;
use shoal_scenario::{Scenario, window_limit_ns};

use backlog::Backlog;

use crate::drive::{Ending, Observer, revive, tell};
use crate::failure::Failure;
use crate::stopwatch::Stopwatch;

/// How long a sleep may keep an interrupt waiting.
const LOOK_AGAIN: Duration = Duration::from_millis(50);

/// How to drive freely.
#[derive(Clone, Copy, Debug)]
pub struct FreePlan {
    /// Nanoseconds of true time per window.
    pub window_ns: i64,
    /// Simulated seconds per second of wall clock.
    pub pace: f64,
    /// Whether the end of any AUV ends the run.
    pub abort_on_crash: bool,
}

impl FreePlan {
    /// The window for a free run, in nanoseconds: the one asked for, or else a quarter of the shortest reaction time and no longer than the
    /// scenario's. What an AUV is told at a window's end has waited in it, and what it answers waits for the end of another: the
    /// rest of the reaction time is left to think.
    pub fn window_ns(scenario: &Scenario, asked_for: bool) -> Result<i64, Failure> {
        let limits =
            scenario.groups.iter().map(|group| window_limit_ns(group.reaction_ns, group.clock.drift_bound));
        let limit_ns = limits.min().unwrap_or(i64::MAX);
        if !asked_for {
            return Ok(scenario.window_ns.min(limit_ns / 4).max(1));
        }
        if scenario.window_ns <= limit_ns / 2 {
            return Ok(scenario.window_ns);
        }
        Err(Failure::usage(format!(
            "--window-ms is too long for --free-run: nobody could answer within the reaction time; at most {} ms",
            limit_ns / 2_000_000
        )))
    }
}

/// Runs from the channel's present to its end. Says besides how far the simulation was behind the wall clock at worst.
pub fn drive_freely(
    channel: &mut Channel,
    fleet: &mut dyn Fleet,
    plan: &FreePlan,
    observers: &mut [&mut dyn Observer],
    interrupted: &dyn Fn() -> bool,
    watch: &mut Stopwatch,
) -> Result<(Ending, Duration), Failure> {
    let mut lag_max = Duration::ZERO;
    let ending = windows(channel, fleet, plan, observers, interrupted, watch, &mut lag_max);
    tell(channel, observers)?;
    Ok((ending?, lag_max))
}

fn windows(
    channel: &mut Channel,
    fleet: &mut dyn Fleet,
    plan: &FreePlan,
    observers: &mut [&mut dyn Observer],
    interrupted: &dyn Fn() -> bool,
    watch: &mut Stopwatch,
    lag_max: &mut Duration,
) -> Result<Ending, Failure> {
    let clock = WallClock { began: Instant::now(), pace: plan.pace };
    let mut backlog = Backlog::default();
    while channel.now() < channel.end() {
        let to = (channel.now() + plan.window_ns).min(channel.end());
        if !clock.wait_for(to, interrupted) {
            return Ok(Ending::Interrupted);
        }
        *lag_max = (*lag_max).max(clock.due(to).elapsed());
        watch.begin();
        let sensed = channel.advance(to).map_err(Failure::failed)?;
        backlog.add(sensed.clone());
        watch.lap(Phase::Channel);
        let mut told = Ok(());
        // Until the next window is due.
        let deadline = clock.due(to + plan.window_ns);
        let answers = fleet.exchange_until(backlog.ready(), deadline, &mut || {
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
        answers.losses.iter().for_each(|loss| backlog.forget(loss.auv));
        channel.accept_late(sensed, answers, clock.now());
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

/// The clock that simulated time follows: one that only goes forward, whatever is done to the time of day.
struct WallClock {
    began: Instant,
    pace: f64,
}

impl WallClock {
    /// When `t` is due.
    fn due(&self, t: SimTime) -> Instant {
        // The latest that a clock can say stands for a pace too slow to be told.
        let after = Duration::try_from_secs_f64(t.as_s() / self.pace).unwrap_or(Duration::MAX);
        self.began.checked_add(after).unwrap_or_else(|| self.began + Duration::from_secs(1 << 32))
    }

    /// The true time that is due now.
    fn now(&self) -> SimTime {
        SimTime::from_ns((self.began.elapsed().as_secs_f64() * self.pace * 1e9) as i64)
    }

    /// Sleeps until `t` is due; `false` if interrupted.
    fn wait_for(&self, t: SimTime, interrupted: &dyn Fn() -> bool) -> bool {
        let due = self.due(t);
        loop {
            if interrupted() {
                return false;
            }
            let early = due.saturating_duration_since(Instant::now());
            if early.is_zero() {
                return true;
            }
            std::thread::sleep(early.min(LOOK_AGAIN));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_leave_time_to_answer() {
        let (name, text) = shoal_scenario::load("swarm-300").unwrap();
        let scenario = shoal_scenario::parse(&name, &text).unwrap();
        // Reactions take 0.2 s, a little less on clocks that are fast.
        let window_ns = FreePlan::window_ns(&scenario, false).unwrap();
        assert!((49_000_000..50_000_000).contains(&window_ns), "{window_ns}");
        let refused = FreePlan::window_ns(&scenario, true).unwrap_err();
        assert!(refused.message.contains("at most 99 ms"), "{}", refused.message);
        let shorter = Scenario { window_ns: 20_000_000, ..scenario };
        assert_eq!(FreePlan::window_ns(&shorter, true).unwrap(), 20_000_000);
        assert_eq!(FreePlan::window_ns(&shorter, false).unwrap(), 20_000_000);
    }

    #[test]
    fn simulated_time_follows_the_clock_at_its_pace() {
        let clock = WallClock { began: Instant::now(), pace: 4.0 };
        assert_eq!(clock.due(SimTime::from_ns(2_000_000_000)) - clock.began, Duration::from_millis(500));
        assert!(clock.wait_for(SimTime::from_ns(20_000_000), &|| false));
        assert!(clock.now() >= SimTime::from_ns(20_000_000));
        assert!(!clock.wait_for(SimTime::from_ns(i64::MAX), &|| true));
    }
}
