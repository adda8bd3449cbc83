//! Whether this machine lets so many processes start: asked before the first one does.

use std::fs;

use crate::cli::Bus;
use crate::failure::Failure;

/// Descriptors and processes that a run needs beside those of its seats, with some to spare.
const SPARE: u64 = 64;

/// A bound that the system sets, and what of it is taken.
struct Limit {
    what: &'static str,
    most: u64,
    taken: u64,
    raise: &'static str,
}

/// Refuses what the machine's limits forbid, with a sentence that says how to raise them.
pub fn check(processes: usize, bus: Bus) -> Result<(), Failure> {
    let processes = processes as u64;
    // The channel watches each process by a descriptor, and zenoh has a socket for each.
    let descriptors = if bus == Bus::Zenoh { 2 } else { 1 } * processes;
    let limits = limits();
    let needed = |limit: &Limit| if limit.what == DESCRIPTORS { descriptors } else { processes } + SPARE;
    match limits.iter().find(|limit| limit.taken + needed(limit) > limit.most) {
        None => Ok(()),
        Some(limit) => {
            let Limit { what, most, taken, raise } = limit;
            let needed = needed(limit);
            Err(Failure::usage(format!(
                "this run would need {needed} {what} where {most} are allowed and {taken} taken: {raise}, run fewer with \
                 --auvs, or let AUVs share processes with --auvs-per-process"
            )))
        }
    }
}

const DESCRIPTORS: &str = "open files in one process";

/// All limits that can be read.
fn limits() -> Vec<Limit> {
    let number = |path: &str| fs::read_to_string(path).ok().and_then(|text| text.trim().parse::<u64>().ok());
    let threads = fs::read_to_string("/proc/loadavg").ok().and_then(|text| threads_in(&text)).unwrap_or(0);
    let own = fs::read_to_string("/proc/self/limits").unwrap_or_default();
    let group = fs::read_to_string("/proc/self/cgroup").ok().and_then(|text| {
        let path = text.lines().find_map(|line| line.strip_prefix("0::"))?.to_owned();
        Some(format!("/sys/fs/cgroup{}", path.trim_end_matches('/')))
    });
    let of_group = |name: &str| number(&format!("{}/{name}", group.as_deref()?));
    let limit = |what, most: Option<u64>, taken, raise| Some(Limit { what, most: most?, taken, raise });
    let processes = "processes";
    [
        limit(
            processes,
            number("/proc/sys/kernel/pid_max"),
            threads,
            "raise it with `sysctl kernel.pid_max=4194304`",
        ),
        limit(
            processes,
            number("/proc/sys/kernel/threads-max"),
            threads,
            "raise it with `sysctl kernel.threads-max=N`",
        ),
        limit(
            processes,
            of_group("pids.max"),
            of_group("pids.current").unwrap_or(0),
            "raise `pids.max` of this control group (TasksMax in systemd)",
        ),
        // The soft limit; it does not hold root.
        limit(
            processes,
            column(&own, "Max processes", 0).filter(|_| !is_root()),
            0,
            "raise it with `ulimit -u`",
        ),
        limit(DESCRIPTORS, column(&own, "Max open files", 1), 0, "raise it with `ulimit -Hn`, as root"),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// Soft (0) or hard (1) limit in proc(5)'s `limits`; `None` when there is none.
fn column(limits: &str, name: &str, column: usize) -> Option<u64> {
    let line = limits.lines().find_map(|line| line.strip_prefix(name))?;
    line.split_whitespace().nth(column)?.parse().ok()
}

/// How many threads the machine has, in proc(5)'s `loadavg`.
fn threads_in(loadavg: &str) -> Option<u64> {
    loadavg.split_whitespace().nth(3)?.split_once('/')?.1.parse().ok()
}

fn is_root() -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let uids = status.lines().find_map(|line| line.strip_prefix("Uid:"));
    uids.is_some_and(|uids| uids.split_whitespace().nth(1) == Some("0"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_may_start_and_far_too_many_may_not() {
        assert!(check(3, Bus::Iceoryx2).is_ok());
        let refused = check(1 << 40, Bus::Iceoryx2).unwrap_err();
        assert!(refused.message.contains("raise it with") && refused.message.contains("--auvs-per-process"));
    }

    #[test]
    fn proc_is_understood() {
        let limits = "Limit                     Soft Limit           Hard Limit           Units     \n\
                      Max processes             96178                unlimited            processes \n\
                      Max open files            1024                 20000                files     \n";
        assert_eq!(column(limits, "Max processes", 0), Some(96_178));
        assert_eq!(column(limits, "Max processes", 1), None);
        assert_eq!(column(limits, "Max open files", 1), Some(20_000));
        assert_eq!(threads_in("0.20 0.18 0.12 1/80 11206\n"), Some(80));
        assert!(limits_are_read());
    }

    fn limits_are_read() -> bool {
        super::limits().iter().any(|limit| limit.what == DESCRIPTORS || limit.most > 0)
    }
}
