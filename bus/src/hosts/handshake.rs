//! How a host joins: JSON, so that other versions can at least say what they are.

use serde::{Deserialize, Serialize};

use crate::codec::FORMAT;

/// Version of this program, which both ends must have.
pub const PROGRAM: &str = env!("CARGO_PKG_VERSION");

/// What crosses while a host joins; `format` says which.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "format")]
pub(super) enum Handshake {
    /// From a host: may I join?
    #[serde(rename = "shoal.join/1")]
    Join(Join),
    /// From the launcher: prove that you know the token, and tell me your time.
    #[serde(rename = "shoal.challenge/1")]
    Challenge(Challenge),
    /// From a host: here they are.
    #[serde(rename = "shoal.proof/1")]
    Proof(Proof),
    /// From the launcher: you are in.
    #[serde(rename = "shoal.welcome/1")]
    Welcome(Welcome),
    /// From the launcher: you are not.
    #[serde(rename = "shoal.refusal/1")]
    Refusal {
        /// Why, as a sentence without its full stop.
        reason: String,
    },
}

/// A host asks to join.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Join {
    /// Drawn by the host for this session: 16 hexadecimal digits, part of the keys on which it is spoken to.
    pub(super) host: String,
    /// What people call it.
    pub(super) name: String,
    /// Version of the program.
    pub(super) program: String,
    /// Version of the messages.
    pub(super) messages: u16,
    /// How many AUVs it can carry.
    pub(super) slots: u32,
    /// Drawn by the host; part of both proofs.
    pub(super) nonce: String,
    /// The only scenario that it will run, by its hash.
    pub(super) scenario: Option<String>,
    /// Its process, for a launcher on the same machine.
    pub(super) process: Option<ProcessName>,
}

/// A process, and the machine on which its number means anything.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct ProcessName {
    /// The boot of the machine and the namespace of processes.
    pub(super) machine: String,
    /// Its number.
    pub(super) pid: u32,
}

/// The launcher asks who it is.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Challenge {
    /// Drawn by the launcher; part of both proofs.
    pub(super) nonce: String,
    /// Whether it asks for a token.
    pub(super) token: bool,
    /// Its wall clock at sending, in nanoseconds since 1970.
    pub(super) clock_ns: i64,
}

/// The host answers the challenge.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Proof {
    /// Who.
    pub(super) host: String,
    /// That it knows the token, if it has one.
    pub(super) proof: Option<String>,
    /// `clock_ns` of the challenge.
    pub(super) challenged_ns: i64,
    /// The host's wall clock, in nanoseconds since 1970.
    pub(super) clock_ns: i64,
}

/// The launcher takes the host in.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Welcome {
    /// Drawn by the launcher: part of the keys on which messages of this run travel.
    pub(super) run: String,
    /// Name of the scenario.
    pub(super) name: String,
    /// Hash of its text.
    pub(super) scenario: String,
    /// That the launcher knows the token, if it has one.
    pub(super) proof: Option<String>,
    /// Who is silent for longer than so many seconds is given up, by both ends.
    pub(super) limit_s: f64,
    /// Host's wall clock minus the launcher's, in seconds: half the round trip wrong at most.
    pub(super) clock_ahead_s: f64,
    /// Half the round trip, in seconds.
    pub(super) clock_error_s: f64,
    /// Whether the run has begun, so that it waits for one that is lost.
    pub(super) spare: bool,
}

impl Handshake {
    pub(super) fn write(&self) -> Vec<u8> {
        // Maps with text keys and finite numbers always have a JSON text.
        serde_json::to_vec(self).unwrap_or_default()
    }

    /// Reads one. What cannot be read may still say who sent it.
    pub(super) fn read(bytes: &[u8]) -> Result<Self, Stranger> {
        serde_json::from_slice(bytes).map_err(|_| {
            let value: serde_json::Value = serde_json::from_slice(bytes).unwrap_or_default();
            let text = |name: &str| value.get(name).and_then(|text| text.as_str()).map(str::to_owned);
            Stranger { host: text("host"), format: text("format"), program: text("program") }
        })
    }
}

/// Who sent a handshake of another version.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Stranger {
    pub(super) host: Option<String>,
    pub(super) format: Option<String>,
    pub(super) program: Option<String>,
}

impl Stranger {
    /// Why it is refused.
    pub(super) fn reason(&self) -> String {
        let known = |text: &Option<String>| text.clone().unwrap_or_else(|| "?".to_owned());
        format!(
            "it speaks `{}` (shoal {}), and this is shoal {PROGRAM}: use the same build on all hosts",
            known(&self.format),
            known(&self.program)
        )
    }
}

/// Why a program of this version is refused, if it is.
pub(super) fn other_version(program: &str, messages: u16) -> Option<String> {
    (program != PROGRAM || messages != FORMAT).then(|| {
        format!(
            "it is shoal {program} with messages of format {messages}, the launcher is shoal {PROGRAM} with format {FORMAT}: \
             use the same build on all hosts"
        )
    })
}

/// Nanoseconds since 1970 by the wall clock.
pub(super) fn wall_clock_ns() -> i64 {
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
    now.map_or(0, |now| i64::try_from(now.as_nanos()).unwrap_or(i64::MAX))
}

/// This process, as one on the same machine would find it.
pub(super) fn this_process() -> Option<ProcessName> {
    Some(ProcessName { machine: this_machine()?, pid: std::process::id() })
}

/// The boot of this machine, and the namespace in which this process has its number.
pub(super) fn this_machine() -> Option<String> {
    let boot = std::fs::read_to_string("/proc/sys/kernel/random/boot_id").ok()?;
    let namespace = std::fs::read_link("/proc/self/ns/pid").ok()?;
    Some(format!("{} {}", boot.trim(), namespace.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn handshakes_come_back_and_say_what_they_are() {
        let refusal = Handshake::Refusal { reason: "no".into() };
        let bytes = refusal.write();
        assert_eq!(bytes, br#"{"format":"shoal.refusal/1","reason":"no"}"#);
        assert_eq!(Handshake::read(&bytes), Ok(refusal));
        let later = br#"{"format":"shoal.join/2","host":"ab","program":"9.9.9","colour":3}"#;
        let stranger = Handshake::read(later).unwrap_err();
        assert_eq!(stranger.host.as_deref(), Some("ab"));
        assert!(stranger.reason().starts_with("it speaks `shoal.join/2` (shoal 9.9.9), and this is shoal"));
        assert!(Handshake::read(b"\xff").unwrap_err().reason().starts_with("it speaks `?`"));
        assert_eq!(other_version(PROGRAM, FORMAT), None);
        assert!(other_version("0.0.1", FORMAT).unwrap().contains("use the same build"));
        assert!(this_process().is_some());
    }
}
