//! What a run leaves behind in shared memory and temporary folders, where many runs may be going on at once.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use crate::process::Process;

/// Everything in shared memory that belongs to a run that process `launcher` started.
///
/// A run's folder says who owns it; objects beside it carry its id. An object of a run that has no folder any more belongs
/// to nobody else either and is counted, unless it was there `before`.
pub fn traces_of(launcher: u32, before: &BTreeSet<PathBuf>) -> Vec<PathBuf> {
    let belongs = |path: &PathBuf| {
        if before.contains(path) {
            return false;
        }
        let Some(id) = run_id(path) else { return true };
        match owner(&id) {
            Some(owner) => owner == launcher,
            // Its run is beginning or ending right now; or it has lost its folder, and is still there a little later.
            None => {
                std::thread::sleep(std::time::Duration::from_millis(300));
                path.exists() && owner(&id).is_none_or(|owner| owner == launcher)
            }
        }
    };
    shared_memory().into_iter().filter(belongs).collect()
}

/// The id of the run that process `launcher` is carrying out.
pub(crate) fn run_of(launcher: u32) -> Option<String> {
    let ids = shared_memory().into_iter().filter_map(|path| run_id(&path));
    ids.into_iter().find(|id| owner(id) == Some(launcher))
}

/// The ids of all runs that are live on this host.
pub fn live_runs() -> BTreeSet<String> {
    let ids = shared_memory().into_iter().filter_map(|path| run_id(&path));
    ids.filter(|id| owner(id).and_then(Process::of).is_some()).collect()
}

/// The process that a run's folder names as its owner.
fn owner(id: &str) -> Option<u32> {
    let text = fs::read_to_string(Path::new("/dev/shm").join(format!("shoal-{id}")).join("owner")).ok()?;
    text.split(' ').next()?.parse().ok()
}

/// All that has to do with runs in `/dev/shm` now.
pub(crate) fn shared_memory() -> BTreeSet<PathBuf> {
    let entries = fs::read_dir("/dev/shm").into_iter().flatten().flatten();
    entries
        .map(|entry| entry.path())
        .filter(|path| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            ["shoal", "iox", "iceoryx"].iter().any(|start| name.starts_with(start))
        })
        .collect()
}

/// The eight hexadecimal digits of `shoal-ID` and `shoal_ID_...`.
fn run_id(path: &Path) -> Option<String> {
    let name = path.file_name()?.to_str()?;
    let id = name.strip_prefix("shoal-").or_else(|| name.strip_prefix("shoal_"))?.get(..8)?;
    id.bytes().all(|byte| byte.is_ascii_hexdigit()).then(|| id.to_owned())
}
