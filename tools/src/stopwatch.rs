//! Notes where the time of a run goes, window by window.

use std::time::{Duration, Instant};

use shoal_bus::summary::{Phase, PhaseLine, Stretch, Timings};
use shoal_bus::time::SimTime;

/// So many stretches at most tell how the time went over the run.
const STRETCHES: usize = 20;

/// A stopwatch for the windows of a run. One that is off never looks at the clock.
pub struct Stopwatch(Option<Laps>);

struct Laps {
    since: Instant,
    window_ns: [u64; 6],
    windows: Vec<(SimTime, [u64; 6])>,
}

impl Stopwatch {
    /// One that does nothing.
    pub fn off() -> Self {
        Self(None)
    }

    /// One that runs.
    pub fn on() -> Self {
        Self(Some(Laps { since: Instant::now(), window_ns: [0; 6], windows: Vec::new() }))
    }

    /// A window begins.
    pub fn begin(&mut self) {
        if let Some(laps) = &mut self.0 {
            (laps.since, laps.window_ns) = (Instant::now(), [0; 6]);
        }
    }

    /// The time since the last lap, or the window's beginning, went into `phase`.
    pub fn lap(&mut self, phase: Phase) {
        if let Some(laps) = &mut self.0 {
            let now = Instant::now();
            laps.window_ns[phase as usize] += nanoseconds(now - laps.since);
            laps.since = now;
        }
    }

    /// The time since the last lap went into gathering, but for what `waited` says.
    pub fn lap_gathered(&mut self, waited: Duration) {
        self.lap(Phase::Gather);
        if let Some(laps) = &mut self.0 {
            let gathered_ns = &mut laps.window_ns[Phase::Gather as usize];
            let waited_ns = nanoseconds(waited).min(*gathered_ns);
            *gathered_ns -= waited_ns;
            laps.window_ns[Phase::Agents as usize] += waited_ns;
        }
    }

    /// The window that ends at true time `to` is over.
    pub fn end(&mut self, to: SimTime) {
        if let Some(laps) = &mut self.0 {
            laps.windows.push((to, laps.window_ns));
        }
    }

    /// What it noted; `None` when it is off.
    pub fn timings(&self) -> Option<Timings> {
        let windows = &self.0.as_ref()?.windows;
        let total_ns: u64 = windows.iter().flat_map(|(_, phases)| phases).sum();
        let stretch = windows.len().div_ceil(STRETCHES).max(1);
        Some(Timings {
            windows: windows.len() as u64,
            total_ms: ms(total_ns),
            phases: Phase::ALL.map(|phase| line(phase, windows, total_ns)).to_vec(),
            over_time: windows.chunks(stretch).map(mean).collect(),
            cpu: None,
        })
    }
}

fn line(phase: Phase, windows: &[(SimTime, [u64; 6])], total_ns: u64) -> PhaseLine {
    let mut of_phase: Vec<u64> = windows.iter().map(|(_, phases)| phases[phase as usize]).collect();
    of_phase.sort_unstable();
    let nth_of_100 = |n: usize| ms(of_phase.get(of_phase.len() * n / 100).copied().unwrap_or(0));
    let sum: u64 = of_phase.iter().sum();
    PhaseLine {
        phase,
        median_ms: nth_of_100(50),
        p95_ms: nth_of_100(95),
        max_ms: ms(of_phase.last().copied().unwrap_or(0)),
        share: sum as f64 / total_ns.max(1) as f64,
    }
}

/// The mean over some windows, of which there is one at least.
fn mean(windows: &[(SimTime, [u64; 6])]) -> Stretch {
    let sum_ms = |phase: Phase| ms(windows.iter().map(|(_, phases)| phases[phase as usize]).sum());
    Stretch {
        from_s: windows.first().map_or(0.0, |(to, _)| to.as_s()),
        mean_ms: Phase::ALL.map(|phase| sum_ms(phase) / windows.len().max(1) as f64),
    }
}

fn nanoseconds(duration: Duration) -> u64 {
    u64::try_from(duration.as_nanos()).unwrap_or(u64::MAX)
}

fn ms(ns: u64) -> f64 {
    ns as f64 * 1e-6
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phases_are_summed_up_over_windows_and_over_time() {
        let mut watch = Stopwatch::on();
        let laps = watch.0.as_mut().unwrap();
        for window in 1..=100_u64 {
            let phases = [window * 1_000_000, 0, 0, 3_000_000, 0, 0];
            laps.windows.push((SimTime::from_ns(window as i64 * 10_000_000), phases));
        }
        let timings = watch.timings().unwrap();
        assert_eq!((timings.windows, timings.total_ms), (100, 5350.0));
        let channel = &timings.phases[0];
        assert_eq!((channel.median_ms, channel.p95_ms, channel.max_ms), (51.0, 96.0, 100.0));
        assert!((timings.phases.iter().map(|line| line.share).sum::<f64>() - 1.0).abs() < 1e-12);
        assert_eq!(timings.over_time.len(), 20);
        let last = &timings.over_time[19];
        assert_eq!((last.from_s, last.mean_ms[0], last.mean_ms[3]), (0.96, 98.0, 3.0));
    }

    #[test]
    fn what_the_fleet_waited_is_the_agents_share() {
        let mut watch = Stopwatch::on();
        watch.begin();
        std::thread::sleep(Duration::from_millis(5));
        watch.lap_gathered(Duration::from_millis(3));
        watch.end(SimTime::ZERO);
        let timings = watch.timings().unwrap();
        let of = |phase: Phase| timings.phases[phase as usize].max_ms;
        assert_eq!(of(Phase::Agents), 3.0);
        assert!(of(Phase::Gather) >= 2.0);
        // More than there was cannot have been waited.
        watch.begin();
        watch.lap_gathered(Duration::from_secs(9));
        watch.end(SimTime::ZERO);
        assert!(watch.timings().unwrap().phases[Phase::Agents as usize].max_ms < 9000.0);
    }

    #[test]
    fn one_that_is_off_knows_nothing() {
        let mut watch = Stopwatch::off();
        watch.begin();
        watch.lap(Phase::Wake);
        watch.end(SimTime::ZERO);
        assert_eq!(watch.timings(), None);
    }
}
