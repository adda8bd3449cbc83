//! A run's own folder in shared memory: two runs never meet, and what one leaves behind goes in one sweep.

use std::fs;
use std::io::{self, Read, Write};
use std::os::unix::fs::{DirBuilderExt, OpenOptionsExt};
use std::path::{Path, PathBuf};

use crate::message::AuvId;

/// Where POSIX shared memory lives on Linux.
const SHARED_MEMORY: &str = "/dev/shm";

const FOLDER_PREFIX: &str = "shoal-";
const DESCRIPTION: &str = "run.json";
const OWNER: &str = "owner";

/// One run's folder, `/dev/shm/shoal-<id>/` (in the temporary folder where there is no `/dev/shm`), mode 0700.
///
/// It is not removed on drop, since several processes hold one: the run's launcher calls [`remove`](Self::remove).
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct RunDir {
    path: PathBuf,
    id: String,
}

impl RunDir {
    /// Makes a folder with a random id for a run that this process owns, and describes it in its `run.json`.
    pub fn create(description: &serde_json::Value) -> io::Result<Self> {
        let base = base();
        loop {
            let id = random_id()?;
            let path = base.join(format!("{FOLDER_PREFIX}{id}"));
            match fs::DirBuilder::new().mode(0o700).create(&path) {
                Ok(()) => {
                    let run = Self { path, id };
                    let filled = run.fill(description);
                    if filled.is_err() {
                        fs::remove_dir_all(&run.path)?;
                    }
                    return filled.map(|()| run);
                }
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
    }

    fn fill(&self, description: &serde_json::Value) -> io::Result<()> {
        self.write_atomically(OWNER, Owner::this().to_string().as_bytes())?;
        self.describe(description)
    }

    /// The run whose folder is `path`.
    pub fn open(path: &Path) -> io::Result<Self> {
        let name =
            path.file_name().and_then(|name| name.to_str()).and_then(|name| name.strip_prefix(FOLDER_PREFIX));
        match name {
            Some(id) if is_id(id) && path.is_dir() => Ok(Self { path: path.to_owned(), id: id.to_owned() }),
            _ => Err(io::Error::new(
                io::ErrorKind::NotFound,
                format!("{} is no folder of a run", path.display()),
            )),
        }
    }

    /// The live runs of this user, sorted by id.
    pub fn list() -> Vec<Self> {
        let mut runs = found();
        runs.retain(Self::is_live);
        runs
    }

    /// Removes what runs of this user left whose owner has ended without cleaning up. Returns how many.
    pub fn sweep() -> usize {
        found()
            .iter()
            .filter(|run| run.owner().is_ok_and(|owner| !owner.is_alive()) && run.remove().is_ok())
            .count()
    }

    /// The id: eight hexadecimal digits.
    pub fn id(&self) -> &str {
        &self.id
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What the name of every shared-memory object of this run starts with.
    pub fn prefix(&self) -> String {
        format!("shoal_{}_", self.id)
    }

    /// The arena of the shared-memory transport.
    pub fn arena(&self) -> PathBuf {
        self.path.join("arena")
    }

    /// A message to (or from, when it goes `up`) this AUV that is too long for the arena.
    pub fn long_message(&self, up: bool, auv: AuvId) -> PathBuf {
        self.path.join(format!("{}-{auv}", if up { "up" } else { "down" }))
    }

    /// The socket of the zenoh transport.
    pub fn zenoh_socket(&self) -> PathBuf {
        self.path.join("zenoh.sock")
    }

    /// What `run.json` says.
    pub fn description(&self) -> io::Result<serde_json::Value> {
        Ok(serde_json::from_slice(&fs::read(self.path.join(DESCRIPTION))?)?)
    }

    /// Replaces `run.json`; a reader sees the old or the new one, never a part.
    pub fn describe(&self, description: &serde_json::Value) -> io::Result<()> {
        self.write_atomically(DESCRIPTION, description.to_string().as_bytes())
    }

    /// Whether the process that created it is alive.
    pub fn is_live(&self) -> bool {
        self.owner().is_ok_and(|owner| owner.is_alive())
    }

    /// Removes the folder and every shared-memory object of this run. Call it when its processes have ended.
    pub fn remove(&self) -> io::Result<()> {
        let prefix = self.prefix();
        let mut outcome = Ok(());
        for entry in fs::read_dir(SHARED_MEMORY).into_iter().flatten().flatten() {
            if entry.file_name().to_str().is_some_and(|name| name.starts_with(&prefix)) {
                outcome = outcome.and(gone(fs::remove_file(entry.path())));
            }
        }
        outcome.and(gone(fs::remove_dir_all(&self.path)))
    }

    fn owner(&self) -> io::Result<Owner> {
        let text = fs::read_to_string(self.path.join(OWNER))?;
        Owner::parse(&text)
            .ok_or_else(|| io::Error::new(io::ErrorKind::InvalidData, "the owner's file is damaged"))
    }

    /// Writes the file `name` in the folder; a reader sees all of it or none.
    pub(crate) fn write_atomically(&self, name: &str, bytes: &[u8]) -> io::Result<()> {
        let draft = self.path.join(format!(".{name}.{}", std::process::id()));
        let mut file =
            fs::OpenOptions::new().write(true).create(true).truncate(true).mode(0o600).open(&draft)?;
        file.write_all(bytes)?;
        fs::rename(draft, self.path.join(name))
    }
}

/// A process, and when it started: process numbers are used again.
#[derive(PartialEq, Eq)]
struct Owner {
    pid: u32,
    started: u64,
}

impl Owner {
    fn this() -> Self {
        let pid = std::process::id();
        Self { pid, started: started(pid).unwrap_or(0) }
    }

    fn parse(text: &str) -> Option<Self> {
        let (pid, started) = text.split_once(' ')?;
        Some(Self { pid: pid.parse().ok()?, started: started.parse().ok()? })
    }

    fn is_alive(&self) -> bool {
        started(self.pid) == Some(self.started)
    }
}

impl std::fmt::Display for Owner {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {}", self.pid, self.started)
    }
}

/// When the process started, in clock ticks since boot (field 22 of proc(5)'s `stat`); `None` for one that has ended.
fn started(pid: u32) -> Option<u64> {
    let stat = fs::read_to_string(format!("/proc/{pid}/stat")).ok()?;
    // The second field is the name in parentheses, which may hold anything.
    let mut fields = stat.rsplit_once(") ")?.1.split(' ');
    let state = fields.next()?;
    if matches!(state, "Z" | "X") {
        return None;
    }
    fields.nth(18)?.parse().ok()
}

fn base() -> PathBuf {
    let shared = Path::new(SHARED_MEMORY);
    if shared.is_dir() { shared.to_owned() } else { std::env::temp_dir() }
}

fn found() -> Vec<RunDir> {
    let entries = fs::read_dir(base()).into_iter().flatten().flatten();
    let mut runs: Vec<RunDir> = entries.filter_map(|entry| RunDir::open(&entry.path()).ok()).collect();
    runs.sort();
    runs
}

fn is_id(text: &str) -> bool {
    text.len() == 8 && text.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f'))
}

fn random_id() -> io::Result<String> {
    let mut bytes = [0; 4];
    fs::File::open("/dev/urandom")?.read_exact(&mut bytes)?;
    Ok(format!("{:08x}", u32::from_le_bytes(bytes)))
}

/// That something is gone already is what a removal wants.
fn gone(removed: io::Result<()>) -> io::Result<()> {
    match removed {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_apart_listed_and_removed() {
        let description = serde_json::json!({"scenario": "swarm-300"});
        let first = RunDir::create(&description).unwrap();
        let second = RunDir::create(&description).unwrap();
        assert_ne!(first.id(), second.id());
        assert_eq!(first.description().unwrap(), description);
        assert_eq!(RunDir::open(first.path()).unwrap(), first);
        let listed = RunDir::list();
        assert!(listed.contains(&first) && listed.contains(&second));

        let object = Path::new(SHARED_MEMORY).join(format!("{}object", first.prefix()));
        fs::write(&object, "x").unwrap();
        first.remove().unwrap();
        assert!(!object.exists() && !first.path().exists() && second.path().exists());

        second.write_atomically(OWNER, b"1 0").unwrap();
        assert!(!second.is_live());
        RunDir::sweep();
        assert!(!second.path().exists());
        first.remove().unwrap();
    }

    #[test]
    fn other_folders_are_no_runs() {
        assert!(RunDir::open(Path::new("/dev/shm/shoal-xyz")).is_err());
        assert!(RunDir::open(Path::new("/")).is_err());
    }
}
