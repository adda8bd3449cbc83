//! Processes as `/proc` shows them. A process is a number and a start time: numbers are used again.

use std::fs;
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process};

/// Longest that anything is waited for before a test is called stuck; no result depends on it.
const PATIENCE: Duration = Duration::from_secs(60);

/// One process.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Process {
    /// Its number.
    pub pid: u32,
    started: u64,
}

impl Process {
    /// The process with this number, if there is one that has not ended.
    pub fn of(pid: u32) -> Option<Self> {
        let [state, ..] = stat(pid)?;
        if matches!(state.as_str(), "Z" | "X") { None } else { Self::ended_or_not(pid) }
    }

    /// The process with this number, even one that has ended and waits to be reaped.
    pub(crate) fn ended_or_not(pid: u32) -> Option<Self> {
        let [.., started] = stat(pid)?;
        Some(Self { pid, started: started.parse().ok()? })
    }

    /// Whether it has not ended yet.
    pub fn is_alive(&self) -> bool {
        Self::of(self.pid) == Some(*self)
    }

    /// Its arguments, its own name first; empty when it has ended.
    pub fn arguments(&self) -> Vec<String> {
        let bytes = fs::read(format!("/proc/{}/cmdline", self.pid)).unwrap_or_default();
        let text = String::from_utf8_lossy(&bytes);
        text.split_terminator('\0').map(str::to_owned).collect()
    }

    /// The value that follows `option` in its arguments.
    pub fn argument(&self, option: &str) -> Option<String> {
        let arguments = self.arguments();
        let place = arguments.iter().position(|argument| argument == option)?;
        arguments.get(place + 1).cloned()
    }

    /// Sends a signal, unless it has ended.
    pub fn signal(&self, signal: Signal) {
        if let Some(pid) = i32::try_from(self.pid).ok().and_then(Pid::from_raw).filter(|_| self.is_alive()) {
            // It may end in this very moment.
            let _ended = kill_process(pid, signal);
        }
    }
}

/// The living children of the process `pid` (of a run's launcher: the channel and the AUVs), by number.
pub fn processes_of(pid: u32) -> Vec<Process> {
    let numbers = fs::read_dir("/proc").into_iter().flatten().flatten();
    let numbers = numbers.filter_map(|entry| entry.file_name().to_str()?.parse::<u32>().ok());
    let parent = pid.to_string();
    let is_child = |&pid: &u32| stat(pid).is_some_and(|[_, of, _]| of == parent);
    let mut children: Vec<Process> = numbers.filter(is_child).filter_map(Process::of).collect();
    children.sort();
    children
}

/// Looks until `condition` holds.
///
/// # Panics
/// When it does not within a minute; `what` says what was expected.
pub fn await_that(what: &str, mut condition: impl FnMut() -> bool) {
    let since = Instant::now();
    while !condition() {
        assert!(since.elapsed() < PATIENCE, "{what}: still not so after {PATIENCE:?}");
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// State, parent and start time of proc(5)'s `stat`.
fn stat(pid: u32) -> Option<[String; 3]> {
    let stat = fs::read_to_string(format!("/proc/{pid}/stat")).ok()?;
    // The second field is the name in parentheses, which may hold anything.
    let fields: Vec<&str> = stat.rsplit_once(") ")?.1.split(' ').collect();
    Some([*fields.first()?, *fields.get(1)?, *fields.get(19)?].map(str::to_owned))
}
