//! The processes of a run: started here, ended here, whatever happens.

use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, Write};
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::path::PathBuf;
use std::process::{Child, ChildStdin, ChildStdout, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use shoal_bus::message::AuvId;
use shoal_bus::run_dir::RunDir;
use shoal_bus::zenoh::RUNTIME_ENV;

use crate::agent_process;
use crate::cli::Bus;
use crate::failure::{Failure, While};
use crate::launch::{FromChannel, Order, ToChannel};
use crate::seat::Seat;

/// How long processes that were told to end may take.
pub const FAREWELL: Duration = Duration::from_secs(10);
/// The same when somebody is waiting for the prompt.
pub const HASTY_FAREWELL: Duration = Duration::from_secs(2);
/// How a process ended that did not do so in time.
const KILLED_AT_THE_END: &str = "killed because it did not end when told to";

/// How soon a process that is known to have ended can be reaped.
const REAPING: Duration = Duration::from_millis(500);

/// This program's own file.
fn executable() -> Result<PathBuf, Failure> {
    std::env::current_exe().while_doing("find this program's own file")
}

/// A command that a Ctrl-C in the terminal does not reach: the launcher passes it on.
fn command(exe: &PathBuf) -> Command {
    let mut command = Command::new(exe);
    command.process_group(0);
    command
}

/// The process of the water and the pipes to it.
pub struct ChannelProcess {
    child: Child,
    input: Arc<Mutex<ChildStdin>>,
    output: BufReader<ChildStdout>,
}

impl ChannelProcess {
    /// Starts it and passes on interrupts to it.
    pub fn start(run: &RunDir, order: &Order, interrupted: &Arc<AtomicBool>) -> Result<Self, Failure> {
        let mut child = command(&executable()?)
            .arg("channel")
            .arg("--run")
            .arg(run.path())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .while_doing("start the channel's process")?;
        let (Some(input), Some(output)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(Failure::failed("the channel's process has no pipes"));
        };
        let input = Arc::new(Mutex::new(input));
        let order = serde_json::to_string(&ToChannelRef::Run(order)).while_doing("describe the run")?;
        write_line(&input, &order);
        pass_on(Arc::clone(interrupted), Arc::clone(&input)).while_doing("start a thread")?;
        Ok(Self { child, input, output: BufReader::new(output) })
    }

    /// Its next word.
    pub fn next(&mut self) -> Result<FromChannel, Failure> {
        let mut line = String::new();
        let read = self.output.read_line(&mut line).while_doing("hear from the channel's process")?;
        if read == 0 {
            let ending = self.child.wait().map_or_else(|error| error.to_string(), describe);
            return Err(Failure::failed(format!(
                "the channel's process ended in the middle of the run: {ending}"
            )));
        }
        serde_json::from_str(&line).while_doing("understand the channel's process")
    }

    /// Tells it the processes of the seats.
    pub fn tell_processes(&self, pids: &[u32]) {
        say(&self.input, &ToChannel::Processes(pids.to_vec()));
    }

    /// Waits for its end, which it has announced.
    pub fn wait(&mut self) {
        end_by(&mut self.child, Instant::now() + FAREWELL);
    }
}

impl Drop for ChannelProcess {
    fn drop(&mut self) {
        end_by(&mut self.child, Instant::now());
    }
}

/// [`ToChannel::Run`] without a copy.
#[derive(serde::Serialize)]
#[serde(rename_all = "snake_case")]
enum ToChannelRef<'a> {
    Run(&'a Order),
}

/// Tells the channel to stop once the flag is set.
fn pass_on(interrupted: Arc<AtomicBool>, input: Arc<Mutex<ChildStdin>>) -> std::io::Result<()> {
    let watch = move || {
        while !interrupted.load(Ordering::Acquire) {
            std::thread::sleep(Duration::from_millis(20));
        }
        say(&input, &ToChannel::Stop);
    };
    std::thread::Builder::new().name("interrupts".to_owned()).spawn(watch).map(drop)
}

fn say(input: &Mutex<ChildStdin>, word: &ToChannel) {
    if let Ok(line) = serde_json::to_string(word) {
        write_line(input, &line);
    }
}

/// A channel that is gone is noticed by the end of its output.
fn write_line(input: &Mutex<ChildStdin>, line: &str) {
    let mut input = input.lock().unwrap_or_else(PoisonError::into_inner);
    let _gone = writeln!(input, "{line}").and_then(|()| input.flush());
}

/// The AUVs' processes.
#[derive(Default)]
pub struct Swarm {
    children: Vec<(Seat, Child)>,
    run: Option<RunDir>,
}

impl Swarm {
    /// Starts a process for each seat.
    pub fn start(&mut self, run: &RunDir, order: &Order, seats: Vec<Seat>) -> Result<(), Failure> {
        self.start_all(run, order.bus, Some(order), seats)
    }

    /// The same for AUVs of Shoal's own in shared memory, of which this machine knows no more.
    pub fn start_in_memory(&mut self, run: &RunDir, seats: Vec<Seat>) -> Result<(), Failure> {
        self.start_all(run, Bus::Iceoryx2, None, seats)
    }

    fn start_all(
        &mut self,
        run: &RunDir,
        bus: Bus,
        order: Option<&Order>,
        seats: Vec<Seat>,
    ) -> Result<(), Failure> {
        let exe = executable()?;
        let log = common_log(run);
        let launcher = std::process::id().to_string();
        let log_file = open_log(&log).while_doing("open a log for the AUVs")?;
        let count = seats.len();
        for seat in seats {
            let mut command = command(&exe);
            if let (Some(of_user), Some(order)) = (&seat.command, order) {
                agent_process::describe(&mut command, of_user, run, order, seat.auvs.start);
                let log = open_log(&own_log(run, &seat)).while_doing("open a log for an AUV")?;
                let stdout = log.try_clone().while_doing("open a log for an AUV")?;
                self.children.push(seat.spawn(&mut command, stdout.into(), log, count)?);
                continue;
            }
            let auvs = format!("{}..{}", seat.auvs.start, seat.auvs.end);
            command.arg("auv").arg("--run").arg(run.path()).args(["--auvs", &auvs]);
            command.args(["--bus", bus.name(), "--launcher", &launcher]);
            if let Some(endpoint) = order.and_then(|order| order.endpoint.as_ref()) {
                command.args(["--endpoint", endpoint]);
            }
            if bus == Bus::Zenoh {
                command.env(RUNTIME_ENV.0, RUNTIME_ENV.1);
            }
            let stderr = log_file.try_clone().while_doing("share the AUVs' log")?;
            self.children.push(seat.spawn(&mut command, Stdio::null(), stderr, count)?);
        }
        self.run = Some(run.clone());
        Ok(())
    }

    /// Process ids in the order of the seats.
    pub fn pids(&self) -> Vec<u32> {
        self.children.iter().map(|(_, child)| child.id()).collect()
    }

    /// Which process is which AUV.
    pub fn processes(&self) -> Vec<(AuvId, u32)> {
        let of_seat =
            |(seat, child): &(Seat, Child)| seat.ids().into_iter().zip(std::iter::repeat(child.id()));
        self.children.iter().flat_map(of_seat).collect()
    }

    /// How the process of an AUV ended, which is known to have ended.
    pub fn ending_of(&mut self, auv: AuvId) -> Option<Ending> {
        let log = self.log();
        let (seat, child) = self.children.iter_mut().find(|(seat, _)| seat.auvs.contains(&auv.0))?;
        let deadline = Instant::now() + REAPING;
        loop {
            match child.try_wait() {
                Ok(Some(status)) => return Some(ending(self.run.as_ref(), seat, Some(status), &log)),
                Ok(None) if Instant::now() < deadline => std::thread::sleep(Duration::from_millis(2)),
                _ => return None,
            }
        }
    }

    /// What Shoal's own AUVs wrote.
    fn log(&self) -> String {
        read(self.run.as_ref().map(common_log))
    }

    /// Waits for all to end, which they have been told to, and says how each did: by its status, or in its own last words.
    pub fn wait(&mut self, patience: Duration) -> Vec<Ending> {
        let deadline = Instant::now() + patience;
        let statuses: Vec<_> =
            self.children.iter_mut().map(|(seat, child)| (&*seat, end_by(child, deadline))).collect();
        let run = self.run.as_ref();
        let log = read(run.map(common_log));
        statuses.into_iter().map(|(seat, status)| ending(run, seat, status, &log)).collect()
    }
}

/// How the process of a seat ended, which has no status if it was killed at the end; `log` is what Shoal's own AUVs wrote.
fn ending(run: Option<&RunDir>, seat: &Seat, status: Option<ExitStatus>, log: &str) -> Ending {
    let was_killed = status.is_none();
    let status = status.map_or_else(|| KILLED_AT_THE_END.to_owned(), describe);
    let own = match seat.command {
        Some(_) => read(run.map(|run| own_log(run, seat))),
        None => String::new(),
    };
    let start = format!("{}: ", seat.name());
    let words = match seat.command {
        Some(_) => own.lines().rev().map(str::trim).find(|line| !line.is_empty()),
        None => log.lines().rev().find_map(|line| line.strip_prefix(&start)),
    };
    let reason = words.map_or_else(|| status.clone(), |words| format!("{status}: {words}"));
    Ending { seat: seat.clone(), reason, was_killed, wrote: last_lines(&own) }
}

/// A log, as far as there is one.
fn read(path: Option<PathBuf>) -> String {
    let bytes = path.and_then(|log| std::fs::read(log).ok()).unwrap_or_default();
    String::from_utf8_lossy(&bytes).into_owned()
}

/// How the process of a seat ended.
pub struct Ending {
    /// Whose.
    pub seat: Seat,
    /// How, as a clause.
    pub reason: String,
    /// Whether it did not end when it was told to.
    pub was_killed: bool,
    /// The last that a program of the user's wrote.
    pub wrote: String,
}

impl Drop for Swarm {
    fn drop(&mut self) {
        for (_, child) in &mut self.children {
            // One that has ended already needs no killing.
            let _ended = child.kill();
        }
        for (_, child) in &mut self.children {
            let _reaped = child.wait();
        }
    }
}

impl Seat {
    /// Starts its process.
    fn spawn(
        self,
        command: &mut Command,
        stdout: Stdio,
        stderr: File,
        count: usize,
    ) -> Result<(Self, Child), Failure> {
        let child = command.stdin(Stdio::null()).stdout(stdout).stderr(stderr).spawn();
        let child = child.map_err(|error| too_many(&self, count, &error))?;
        Ok((self, child))
    }
}

/// What Shoal's own AUVs write.
fn common_log(run: &RunDir) -> PathBuf {
    run.path().join("auvs.log")
}

/// What a program of the user's writes.
fn own_log(run: &RunDir, seat: &Seat) -> PathBuf {
    run.path().join(format!("auv-{}.log", seat.auvs.start))
}

/// The end of a text, as much of it as one screen shows.
fn last_lines(text: &str) -> String {
    const LINES: usize = 30;
    let lines: Vec<&str> = text.lines().collect();
    lines[lines.len().saturating_sub(LINES)..].join("\n")
}

fn open_log(path: &PathBuf) -> std::io::Result<File> {
    OpenOptions::new().create(true).append(true).open(path)
}

fn too_many(seat: &Seat, count: usize, error: &std::io::Error) -> Failure {
    Failure::failed(format!(
        "the process of {} (one of {count}) could not be started: {error}; if this is a limit, raise `ulimit -u` and \
         `ulimit -n`, run fewer with --auvs, or let them share with --auvs-per-process",
        seat.name()
    ))
}

/// Waits for a child until `deadline`, then kills it. Its status, unless it had to be killed.
fn end_by(child: &mut Child, deadline: Instant) -> Option<ExitStatus> {
    loop {
        match child.try_wait() {
            Ok(Some(status)) => return Some(status),
            Ok(None) if Instant::now() < deadline => std::thread::sleep(Duration::from_millis(2)),
            _ => break,
        }
    }
    let _ended = child.kill();
    let _reaped = child.wait();
    None
}

fn describe(status: ExitStatus) -> String {
    match (status.code(), status.signal()) {
        (Some(code), _) => format!("exited with code {code}"),
        (None, Some(signal)) => format!("killed by signal {signal}"),
        (None, None) => "ended".to_owned(),
    }
}
