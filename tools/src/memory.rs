//! What processes take of the machine's memory, as the kernel tells.

use std::fs;

/// Reading the proportional set size of a process costs the kernel a walk over its pages: a sample will do.
const SAMPLE: usize = 15;

/// Median proportional set size per AUV of a sample of these processes, given with how many AUVs they carry, in KiB; 0 when none
/// can be read.
pub fn median_pss_kib(processes: &[(u32, usize)]) -> u64 {
    let stride = processes.len().div_ceil(SAMPLE).max(1);
    let mut sizes: Vec<u64> = processes
        .iter()
        .step_by(stride)
        .filter_map(|(pid, auvs)| {
            Some(field_kib(&format!("/proc/{pid}/smaps_rollup"), "Pss:")?.div_ceil(*auvs as u64))
        })
        .collect();
    sizes.sort_unstable();
    sizes.get(sizes.len() / 2).copied().unwrap_or(0)
}

/// Resident set of this process, in KiB; 0 when it cannot be read.
pub fn own_rss_kib() -> u64 {
    field_kib("/proc/self/status", "VmRSS:").unwrap_or(0)
}

fn field_kib(path: &str, field: &str) -> Option<u64> {
    let text = fs::read_to_string(path).ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix(field))?;
    line.split_whitespace().next()?.parse().ok()
}
