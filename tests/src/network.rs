//! Two machines on one: network namespaces with a bad link in between, made by the test itself.

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};

/// Which of the two machines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Where the launcher is.
    Near = 0,
    /// Where the hosts are.
    Far = 1,
}

/// Two network namespaces, and the link between them.
///
/// All that holds them is processes whose standard input is a pipe of this one: however the test ends, they end, and the kernel
/// removes the rest.
pub struct Networks {
    ends: Vec<Child>,
    holders: Vec<Child>,
    _sockets: tempfile::TempDir,
}

const INTERFACE: &str = "shoal0";
const ADDRESSES: [&str; 2] = ["10.77.0.1", "10.77.0.2"];

impl Networks {
    /// Two namespaces on a link that delays packets by so many milliseconds in each direction and loses this fraction of them; else why
    /// there are none here.
    pub fn new(delay_ms: f64, loss: f64) -> Result<Self, String> {
        let sockets = tempfile::tempdir().map_err(|error| error.to_string())?;
        let mut made = Self { ends: Vec::new(), holders: Vec::new(), _sockets: sockets };
        made.hold(&["unshare", "--user", "--map-root-user", "--net"])?;
        let in_first: Vec<String> = made.entry(Side::Near);
        let in_first: Vec<&str> = in_first.iter().map(String::as_str).collect();
        made.hold(&[&in_first[..], &["unshare", "--net"]].concat())?;
        for side in [Side::Near, Side::Far] {
            made.link(side, delay_ms, loss)?;
        }
        for side in [Side::Near, Side::Far] {
            made.ip(side, &["link", "set", "lo", "up"])?;
            made.ip(side, &["addr", "add", &format!("{}/24", ADDRESSES[side as usize]), "dev", INTERFACE])?;
            made.ip(side, &["link", "set", INTERFACE, "up"])?;
        }
        Ok(made)
    }

    /// Its address there.
    pub fn address(&self, side: Side) -> &'static str {
        ADDRESSES[side as usize]
    }

    /// What a command must be preceded by to run there.
    pub fn entry(&self, side: Side) -> Vec<String> {
        let holder = self.holders.get(side as usize).map_or(0, Child::id);
        let words = ["nsenter", "--preserve-credentials", "--user", "--net", "--target"];
        words.into_iter().map(str::to_owned).chain([holder.to_string()]).collect()
    }

    /// Takes the link down, or up again.
    ///
    /// # Panics
    /// When that fails.
    pub fn set_link(&self, is_up: bool) {
        let state = if is_up { "up" } else { "down" };
        self.ip(Side::Near, &["link", "set", INTERFACE, state]).expect("what could be set up can be set");
    }

    /// A namespace, held by a process that reads its standard input.
    fn hold(&mut self, entry: &[&str]) -> Result<(), String> {
        let words = [entry, &["sh", "-c", "echo ready; exec cat"]].concat();
        let child = started(&words)?;
        self.holders.push(child);
        Ok(())
    }

    fn link(&mut self, side: Side, delay_ms: f64, loss: f64) -> Result<(), String> {
        let socket = |side: usize| self._sockets.path().join(format!("{side}.sock")).display().to_string();
        let (here, there) = (socket(side as usize), socket(1 - side as usize));
        let script = crate::workspace().join("tests/tests/network/link.py").display().to_string();
        let (delay, loss, seed) =
            ((delay_ms / 1e3).to_string(), loss.to_string(), (side as usize).to_string());
        let entry = self.entry(side);
        let mut words: Vec<&str> = entry.iter().map(String::as_str).collect();
        words.extend(["python3", &script, INTERFACE, &here, &there, &delay, &loss, &seed]);
        let child = started(&words)?;
        self.ends.push(child);
        Ok(())
    }

    fn ip(&self, side: Side, arguments: &[&str]) -> Result<(), String> {
        let entry = self.entry(side);
        // It is where users that are not root do not look.
        let path = std::env::var("PATH").unwrap_or_default() + ":/usr/sbin:/sbin";
        let output = Command::new(&entry[0])
            .args(&entry[1..])
            .arg("ip")
            .args(arguments)
            .env("PATH", path)
            .output()
            .map_err(|error| format!("{}: {error}", entry[0]))?;
        match output.status.success() {
            true => Ok(()),
            false => {
                Err(format!("ip {}: {}", arguments.join(" "), String::from_utf8_lossy(&output.stderr).trim()))
            }
        }
    }
}

/// A process that says that it is ready.
fn started(words: &[&str]) -> Result<Child, String> {
    let mut child = Command::new(words[0])
        .args(&words[1..])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|error| format!("{}: {error}", words[0]))?;
    let mut line = String::new();
    if let Some(stdout) = child.stdout.take() {
        // What cannot be read is not ready.
        let _read = BufReader::new(stdout).read_line(&mut line);
    }
    if line.trim() == "ready" {
        return Ok(child);
    }
    let _killed = child.kill();
    let said =
        child.wait_with_output().map(|output| String::from_utf8_lossy(&output.stderr).trim().to_owned());
    Err(format!("{}: {}", words.join(" "), said.unwrap_or_default()))
}

impl Drop for Networks {
    fn drop(&mut self) {
        for child in self.ends.iter_mut().chain(&mut self.holders) {
            drop(child.stdin.take());
            let _killed = child.kill();
            let _reaped = child.wait();
        }
    }
}
