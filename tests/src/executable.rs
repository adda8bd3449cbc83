//! The real executable: built, started, watched, ended.

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsStr;
use std::fs::File;
use std::io::Read;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Child, ExitStatus, Stdio};
use std::sync::OnceLock;
use std::thread::JoinHandle;

use rustix::process::Signal;
use serde_json::Value;

use crate::process::{Process, await_that, processes_of};
use crate::traces;

/// Path of the executable, built from the present sources by the first call, in the profile and the target folder of the
/// running test.
///
/// # Panics
/// When it does not build.
pub fn shoal() -> &'static Path {
    static PATH: OnceLock<PathBuf> = OnceLock::new();
    PATH.get_or_init(|| {
        let folder = profile_folder();
        let profile = match folder.file_name().and_then(OsStr::to_str) {
            Some("debug") | None => "dev",
            Some(name) => name,
        };
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let mut build = std::process::Command::new(cargo);
        // What cargo tells a test of its own package would make `ring`, and all that needs it, build anew.
        let of_this_package = |name: &OsStr| {
            name.to_str()
                .is_some_and(|name| name.starts_with("CARGO_PKG") || name.starts_with("CARGO_MANIFEST"))
        };
        for (name, _) in std::env::vars_os().filter(|(name, _)| of_this_package(name)) {
            build.env_remove(name);
        }
        let built = build
            .args(["build", "--quiet", "--package", "shoal", "--profile", profile])
            .arg("--target-dir")
            .arg(folder.parent().expect("a profile's folder lies in the target folder"))
            .current_dir(crate::workspace())
            .status()
            .expect("cargo can be started");
        assert!(built.success(), "the executable does not build");
        folder.join("shoal")
    })
}

/// `target/PROFILE`, from the path of the running test, `target/PROFILE/deps/NAME`.
fn profile_folder() -> PathBuf {
    let test = std::env::current_exe().expect("a test knows its own path");
    let folder = test.ancestors().nth(2).expect("a test lies in the folder deps of its profile");
    folder.to_owned()
}

/// `target`, or wherever the build of the running test went.
pub(crate) fn target_folder() -> PathBuf {
    let profile = profile_folder();
    profile.parent().expect("a profile's folder lies in the target folder").to_owned()
}

/// Holds all cores: while one test holds it, others that ask for it wait, in this and in other test processes. For runs with
/// hundreds of processes.
#[must_use]
pub fn alone() -> impl Drop {
    struct Alone(File);
    impl Drop for Alone {
        fn drop(&mut self) {
            // Closing the file would do as well.
            let _unlocked = self.0.unlock();
        }
    }
    let path = profile_folder().join("shoal-tests.lock");
    let file = File::options().create(true).append(true).open(path).expect("a lock file can be made");
    file.lock().expect("a lock file can be locked");
    Alone(file)
}

/// The executable with arguments, yet to be started.
pub struct Command {
    /// What it is preceded by, if it is to run elsewhere.
    entry: Vec<String>,
    arguments: Vec<String>,
}

/// A command that has ended.
#[derive(Debug)]
pub struct Finished {
    /// How.
    pub status: ExitStatus,
    /// What it wrote on its standard output.
    pub stdout: String,
    /// What it wrote on its standard error.
    pub stderr: String,
}

/// A command in progress. Dropped, it and all its children are killed, by their numbers.
pub struct Live {
    child: Child,
    launcher: Process,
    children: Vec<Process>,
    output: Option<(JoinHandle<String>, JoinHandle<String>)>,
    before: BTreeSet<PathBuf>,
    temporary: tempfile::TempDir,
}

impl Command {
    /// `shoal ARGUMENTS`, split at spaces.
    pub fn new(arguments: &str) -> Self {
        Self { entry: Vec::new(), arguments: arguments.split_whitespace().map(str::to_owned).collect() }
    }

    /// On another machine: preceded by [`Networks::entry`](crate::Networks::entry).
    #[must_use]
    pub fn within(mut self, entry: Vec<String>) -> Self {
        self.entry = entry;
        self
    }

    /// With one more argument, which may have spaces.
    #[must_use]
    pub fn with(mut self, argument: impl AsRef<OsStr>) -> Self {
        self.arguments.push(argument.as_ref().to_string_lossy().into_owned());
        self
    }

    /// With more arguments, split at spaces.
    #[must_use]
    pub fn and(mut self, arguments: &str) -> Self {
        self.arguments.extend(arguments.split_whitespace().map(str::to_owned));
        self
    }

    /// Starts it, with a temporary folder of its own.
    pub fn start(&self) -> Live {
        let before = traces::shared_memory();
        let temporary = tempfile::tempdir().expect("a temporary folder can be made");
        let mut words = self.entry.iter().map(OsStr::new).chain([shoal().as_os_str()]);
        let mut child = std::process::Command::new(words.next().unwrap_or_default())
            .args(words)
            .args(&self.arguments)
            .env("TMPDIR", temporary.path())
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the executable can be started");
        let launcher = Process::ended_or_not(child.id()).expect("an unreaped child can be found");
        let output = child.stdout.take().map(read).zip(child.stderr.take().map(read));
        Live { child, launcher, children: Vec::new(), output, before, temporary }
    }

    /// Runs it to its end, and checks that nothing is left of it.
    pub fn finish(&self) -> Finished {
        self.start().finish()
    }

    /// Runs it with `--json` to its end: it must succeed, leave nothing, and print one JSON line.
    pub fn json(self) -> Value {
        self.with("--json").finish().succeeded().json()
    }
}

impl Finished {
    /// The exit code; absent when a signal ended it.
    pub fn code(&self) -> Option<i32> {
        self.status.code()
    }

    /// Itself, if it exited with 0.
    #[track_caller]
    pub fn succeeded(self) -> Self {
        self.exited(0)
    }

    /// Itself, if it exited with `code`.
    #[track_caller]
    pub fn exited(self, code: i32) -> Self {
        assert_eq!(
            self.code(),
            Some(code),
            "signal {:?}\n{}{}",
            self.status.signal(),
            self.stdout,
            self.stderr
        );
        self
    }

    /// Its only line of standard output, which is JSON.
    #[track_caller]
    pub fn json(&self) -> Value {
        let lines = self.json_lines();
        assert_eq!(lines.len(), 1, "one line was expected:\n{}{}", self.stdout, self.stderr);
        lines[0].clone()
    }

    /// The lines of its standard output, each JSON.
    #[track_caller]
    pub fn json_lines(&self) -> Vec<Value> {
        let parse = |line: &str| serde_json::from_str(line).unwrap_or_else(|error| panic!("{error}: {line}"));
        self.stdout.lines().map(parse).collect()
    }
}

impl Live {
    /// The process that was started: of a run, the launcher.
    pub fn launcher(&self) -> Process {
        self.launcher
    }

    /// Its living children.
    pub fn children(&mut self) -> Vec<Process> {
        let now = processes_of(self.launcher.pid);
        self.children.extend(&now);
        self.children.sort();
        self.children.dedup();
        now
    }

    /// The process of the water, once it is there.
    pub fn channel(&mut self) -> Option<Process> {
        self.children()
            .into_iter()
            .find(|child| child.arguments().get(1).is_some_and(|word| word == "channel"))
    }

    /// The processes of the AUVs that are there, by the AUVs' ids: several share one with `--auvs-per-process`.
    pub fn auvs(&mut self) -> BTreeMap<u32, Process> {
        let carried = |child: &Process| {
            // A program of the user's is told one.
            if let Some(auv) = child.argument("--auv").and_then(|auv| auv.parse::<u32>().ok()) {
                return Some(auv..auv + 1);
            }
            let auvs = child.argument("--auvs")?;
            let (first, end) = auvs.split_once("..")?;
            Some(first.parse::<u32>().ok()?..end.parse().ok()?)
        };
        let each = |child: Process| carried(&child).unwrap_or(0..0).map(move |auv| (auv, child));
        self.children().into_iter().flat_map(each).collect()
    }

    /// The id of its run, once it is there.
    pub fn run_id(&self) -> Option<String> {
        traces::run_of(self.launcher.pid)
    }

    /// Waits until the run is under way with `auvs` AUVs, which ping: a tap has heard one event. Returns its id.
    pub fn await_pings(&mut self, auvs: usize) -> String {
        await_that("all AUVs have a process", || self.auvs().len() == auvs || !self.launcher.is_alive());
        await_that("the run has an id", || self.run_id().is_some() || !self.launcher.is_alive());
        let id = self.run_id().expect("a run in progress has an id");
        let heard = Command::new("tap --json --count 1 --wait 60 --run").with(&id).finish();
        assert_eq!(heard.succeeded().stdout.lines().count(), 1);
        id
    }

    /// Sends a signal to the process that was started.
    pub fn signal(&self, signal: Signal) {
        self.launcher.signal(signal);
    }

    /// Waits for its end, and checks that nothing is left of it: no process, no shared memory, no temporary file.
    pub fn finish(mut self) -> Finished {
        let mut status = None;
        await_that("the command ends", || {
            status = self.child.try_wait().expect("a child can be waited for");
            status.is_some()
        });
        let status = status.expect("it was waited for");
        let children = self.children.clone();
        await_that("its children are gone", || children.iter().all(|child| !child.is_alive()));
        let (stdout, stderr) = self.output.take().expect("its output is taken once");
        let [stdout, stderr] = [stdout, stderr].map(|text| text.join().expect("reading does not panic"));
        let pid = self.launcher.pid;
        if status.signal().is_some() {
            // It could not clean up itself: others do, in their time.
            await_that("what is left is removed", || traces::traces_of(pid, &self.before).is_empty());
        }
        let left = traces::traces_of(pid, &self.before);
        assert!(left.is_empty(), "left in shared memory: {left:?}");
        let left: Vec<_> = std::fs::read_dir(self.temporary.path())
            .expect("the temporary folder is there")
            .flatten()
            .map(|entry| entry.path())
            .collect();
        assert!(left.is_empty(), "left in the temporary folder: {left:?}");
        Finished { status, stdout, stderr }
    }
}

impl Drop for Live {
    fn drop(&mut self) {
        self.children();
        if self.launcher.is_alive() {
            // A moment to clean up; then by force.
            self.launcher.signal(Signal::TERM);
            for _ in 0..500 {
                if !matches!(self.child.try_wait(), Ok(None)) {
                    break;
                }
                std::thread::sleep(std::time::Duration::from_millis(10));
            }
        }
        let _ended = self.child.kill();
        let _reaped = self.child.wait();
        self.children.iter().for_each(|child| child.signal(Signal::KILL));
    }
}

fn read(mut from: impl Read + Send + 'static) -> JoinHandle<String> {
    std::thread::spawn(move || {
        let mut bytes = Vec::new();
        // What was read before an error is all there is.
        let _length = from.read_to_end(&mut bytes);
        String::from_utf8_lossy(&bytes).into_owned()
    })
}
