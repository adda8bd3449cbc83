//! Exit codes: one documented type.

use std::process::ExitCode;

/// How `shoal` ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// 0: all good.
    Good = 0,
    /// 1: it failed, or what was compared differs.
    Failed = 1,
    /// 2: it was called wrongly, or with a scenario that is refused.
    Usage = 2,
    /// 3: finished with loss: an AUV died, or the run or its data are incomplete.
    Loss = 3,
    /// 4: an enclosure did not hold the truth.
    Violated = 4,
    /// 5: a record is not what was written.
    Damaged = 5,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit as u8)
    }
}
