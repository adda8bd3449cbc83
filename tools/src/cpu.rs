//! What processes take of the machine's processors, as the kernel tells.

use std::fs;

use shoal_bus::summary::Cpu;

/// What processes had taken when this was made.
pub struct CpuMeter {
    own: Taken,
    /// (process, what it had taken).
    others: Vec<(u32, Taken)>,
}

/// What one process has taken.
#[derive(Clone, Copy, Debug, Default)]
struct Taken {
    run_ns: u64,
    switches: u64,
}

impl CpuMeter {
    /// Begins to measure this process and `others`.
    pub fn start(others: &[u32]) -> Option<Self> {
        let of = |&pid: &u32| Some((pid, taken(&pid.to_string())?));
        Some(Self { own: own()?, others: others.iter().filter_map(of).collect() })
    }

    /// What was taken since, by those who are still there.
    pub fn stop(&self) -> Option<CpuTaken> {
        let own = own()?.since(self.own);
        let of = |(pid, before): &(u32, Taken)| Some(taken(&pid.to_string())?.since(*before));
        let all = self.others.iter().filter_map(of).fold(own, Taken::and);
        Some(CpuTaken { own, all })
    }
}

/// What was taken while a [`CpuMeter`] ran.
pub struct CpuTaken {
    own: Taken,
    all: Taken,
}

impl CpuTaken {
    /// In proportion to what was done: so many control ticks of so many AUVs in so many simulated seconds.
    pub fn per(&self, auvs: u32, sim_s: f64, wakes: u64) -> Cpu {
        let auv_s = (f64::from(auvs) * sim_s).max(1e-9);
        let us_per_auv_s = |taken: Taken| taken.run_ns as f64 * 1e-3 / auv_s;
        Cpu {
            us_per_auv_s: us_per_auv_s(self.all),
            channel_us_per_auv_s: us_per_auv_s(self.own),
            switches_per_wake: self.all.switches as f64 / (wakes as f64).max(1.0),
        }
    }
}

impl Taken {
    fn and(self, other: Self) -> Self {
        Self { run_ns: self.run_ns + other.run_ns, switches: self.switches + other.switches }
    }

    fn since(self, before: Self) -> Self {
        Self {
            run_ns: self.run_ns.saturating_sub(before.run_ns),
            switches: self.switches.saturating_sub(before.switches),
        }
    }
}

/// What this process has taken until now: the kernel adds up a running thread's time when it gives way.
fn own() -> Option<Taken> {
    std::thread::yield_now();
    taken("self")
}

/// Sums up the threads of a process; `None` when the kernel does not tell, or there is no such process.
fn taken(process: &str) -> Option<Taken> {
    let mut sum = Taken::default();
    for thread in fs::read_dir(format!("/proc/{process}/task")).ok()?.flatten() {
        // Nanoseconds on a processor, user and system: `stat` only counts hundredths of seconds. A thread may just have ended.
        let Ok(schedule) = fs::read_to_string(thread.path().join("schedstat")) else { continue };
        sum.run_ns += schedule.split_whitespace().next()?.parse::<u64>().ok()?;
        let status = fs::read_to_string(thread.path().join("status")).unwrap_or_default();
        let switches = status.lines().filter(|line| line.contains("ctxt_switches:"));
        sum.switches +=
            switches.filter_map(|line| line.split_whitespace().nth(1)?.parse::<u64>().ok()).sum::<u64>();
    }
    Some(sum)
}

#[cfg(test)]
mod tests {
    use std::hint::black_box;
    use std::process::Command;

    use super::*;

    #[test]
    fn own_work_and_that_of_others_is_told_apart() {
        let mut child = Command::new("sleep").arg("60").spawn().unwrap();
        let meter = CpuMeter::start(&[child.id(), u32::MAX]).unwrap();
        let before = taken("self").unwrap().run_ns;
        let mut sum = 0_u64;
        while taken("self").unwrap().run_ns < before + 20_000_000 {
            (0..100_000_u64).for_each(|number| sum = black_box(sum ^ number));
        }
        let cpu = meter.stop().unwrap().per(2, 10.0, 4);
        child.kill().unwrap();
        child.wait().unwrap();
        // 20 ms over twenty seconds of AUVs.
        assert!(cpu.channel_us_per_auv_s >= 1000.0, "{cpu:?}");
        assert!(cpu.us_per_auv_s >= cpu.channel_us_per_auv_s, "{cpu:?}");
        assert!(cpu.us_per_auv_s < cpu.channel_us_per_auv_s + 500.0, "{cpu:?}");
    }

    #[test]
    fn what_is_gone_is_not_there() {
        assert!(taken("4294967295").is_none());
    }
}
