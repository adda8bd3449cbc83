//! `shoal janitor`: removes what a host that was killed could not remove itself.

use std::io::Read;
use std::os::unix::process::CommandExt;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use shoal_bus::run_dir::RunDir;

use crate::exit::Exit;
use crate::failure::{Failure, While};

/// A janitor at work for this process.
pub struct Janitor(Child);

impl Janitor {
    /// Starts one for `run`. It is idle until this process ends, however that comes about.
    pub fn start(run: &RunDir) -> Result<Self, Failure> {
        let exe = std::env::current_exe().while_doing("find this program's own file")?;
        let mut command = Command::new(exe);
        command.arg("janitor").arg("--run").arg(run.path()).process_group(0);
        command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::null());
        Ok(Self(command.spawn().while_doing("start a janitor")?))
    }
}

impl Drop for Janitor {
    fn drop(&mut self) {
        drop(self.0.stdin.take());
        let _ended = self.0.wait();
    }
}

/// Waits for the end of the standard input, which is that of the process that holds its other end, and removes `run`.
pub fn run(run: &RunDir) -> Result<Exit, Failure> {
    let mut nothing = [0];
    // Nothing is ever written; an error is an end as well.
    let _end = std::io::stdin().lock().read(&mut nothing);
    for attempt in 0..2 {
        if attempt > 0 {
            // AUVs die with their host, but one that was just starting may have made something since.
            std::thread::sleep(Duration::from_millis(200));
        }
        run.remove().while_doing("remove what is left of a run")?;
    }
    Ok(Exit::Good)
}
