//! What a run in real time amounts to besides.

use serde::{Deserialize, Serialize};

/// The deadlines of a run whose AUVs ran freely (`--free-run`): the answer to a tick at local time s is to be in by s + R, the
/// reaction time later.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FreeRun {
    /// Ticks that were not answered in time, of all AUVs.
    pub deadline_misses: u64,
    /// How late the latest answer was, in seconds, or will be at least.
    pub worst_s: f64,
    /// The AUVs that missed any, sorted.
    pub late: Vec<LateAuv>,
    /// How far the simulation was behind the wall clock at worst, in wall seconds: none where the machine keeps up.
    pub lag_max_s: f64,
}

/// One AUV that missed deadlines.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LateAuv {
    /// Index of the AUV.
    pub auv: u32,
    /// Its name.
    pub name: String,
    /// Ticks that it did not answer in time.
    pub misses: u64,
    /// How late its latest answer was, in seconds.
    pub worst_s: f64,
}
