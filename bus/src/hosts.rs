//! Runs on several machines: one zenoh session per host, shared memory inside it, one message per host and window each way.
//!
//! The launcher's end is a [`HostsFleet`]; it listens. On every machine one [`Host`] connects to it, offers *slots*, is given
//! that many AUVs or fewer, starts their processes, and passes messages on. AUVs never see the network.
//!
//! # The protocol
//!
//! All that follows are payloads of zenoh publications. Numbers are little-endian; `host` and `run` are hexadecimal digits.
//!
//! ## Joining: JSON
//!
//! A host publishes on `shoal/hosts/join`, the launcher answers on `shoal/hosts/reply/{host}`. A host that hears nothing for
//! half a second asks again; asking twice does no harm. Each payload is one object, whose `format` says what it is:
//!
//! | `format` | from | other fields |
//! |---|---|---|
//! | `shoal.join/1` | host | `host`: 16 digits that it draws; `name`, for people; `program`: version of shoal; `messages`: version of the codec ([`codec::FORMAT`](crate::codec::FORMAT)); `slots`; `nonce`: 32 digits; `scenario`: the only one that it will run, as `blake3:` and the hash of its text, or null; `process`: `machine` and `pid`, by which a launcher on the same machine notices its end at once, or null |
//! | `shoal.challenge/1` | launcher | `nonce`: 32 digits; `token`: whether one is asked for; `clock_ns`: its wall clock |
//! | `shoal.proof/1` | host | `host`; `proof`, or null; `challenged_ns`: `clock_ns` of the challenge; `clock_ns`: its own |
//! | `shoal.welcome/1` | launcher | `run`: 16 digits; `name` and `scenario`: what is run, and the hash of its text; `proof`, or null; `limit_s`: who is silent for longer is given up; `clock_ahead_s`, `clock_error_s`: the host's clock minus the launcher's, and how far that may be wrong; `spare`: whether it joined after the beginning |
//! | `shoal.refusal/1` | launcher | `reason` |
//!
//! Proofs are BLAKE3, keyed by the token (`derive_key`), of who proves (`host` or `launcher`), the host's nonce and the launcher's, each behind
//! its length in eight bytes: both ends show that they know the token, and it never crosses the network. It keeps out who should not join;
//! it hides nothing and protects no later message: for networks that are not trusted there is TLS, in the configuration of zenoh.
//!
//! ## Frames
//!
//! From then on the launcher publishes on `shoal/hosts/{run}/{host}/down` and the host on `shoal/hosts/{run}/{host}/up`, one
//! frame per payload: a kind (one byte), a number (`u64`), and the rest.
//!
//! | kind | number | rest | means |
//! |---|---|---|---|
//! | 0 message | grows by one per direction, from 1 | a tag (one byte) and a body | see below |
//! | 1 beat | of the last message sent, 0 for none | - | I am here; sent twice a second |
//! | 2 again | of a message | - | send it again: your beat says that I have missed it |
//! | 3 dismissal | 0 | a reason, UTF-8 | you are no host of this run any more; empty: your goodbye was heard |
//!
//! A message whose number is not greater than the last one heard is ignored. Each end keeps its last message, to send it again. So what a
//! link loses costs half a second, and what it repeats costs nothing; the run waits in lockstep.
//!
//! ## Messages
//!
//! | tag | to a host | body |
//! |---|---|---|
//! | 0 | assignment | length (`u32`) and bytes of an encoded [`Assignment`]; then a list of encoded [`ToAuv::Born`](crate::lockstep::ToAuv::Born) |
//! | 1 | window | a list of encoded [`ToAuv::Sensed`](crate::lockstep::ToAuv::Sensed), one for each AUV that is due |
//! | 2 | end | why, UTF-8; empty when the run is complete |
//!
//! | tag | from a host | body |
//! |---|---|---|
//! | 0 | born | how many processes it started (`u32`); losses |
//! | 1 | answers | a list of encoded [`FromAuv::Acted`](crate::lockstep::FromAuv::Acted); losses |
//! | 2 | goodbye | why, UTF-8 |
//!
//! A list is a count (`u32`), then for each entry the AUV (`u32`), a length (`u32`) and so many bytes. Losses are a list whose bytes are
//! reasons in UTF-8. A host without AUVs that are due gets no message in that window.
//!
//! # Failure
//!
//! A host is gone when it says goodbye, when it was silent for longer than the limit, or, on the launcher's own machine, when its process
//! has ended. All its AUVs are lost then. When another host with as many slots is free, or joins later, they become
//! [vacancies](crate::lockstep::Fleet::vacancies): the channel gives each a new birth. A host that does not hear the launcher for the limit ends by itself.

mod fleet;
mod frame;
mod gate;
mod handshake;
mod heart;
mod host;
mod member;
mod network;
mod parcels;
mod relay;
mod roster;
mod token;

use serde::{Deserialize, Serialize};
use thiserror::Error;

pub use fleet::{HostsFleet, HostsInterruptHandle};
pub use handshake::PROGRAM;
pub use host::{Crew, Ending, Host, HostStopHandle, Joined, Offer};
pub use network::{DEFAULT_CONFIG, Network, NetworkError};
pub use relay::{Decoding, Relay};
pub use roster::Terms;

use crate::lockstep::FleetError;
use crate::message::AuvId;

const BUS: &str = "hosts";

const JOIN_KEY: &str = "shoal/hosts/join";

fn reply_key(host: &str) -> String {
    format!("shoal/hosts/reply/{host}")
}

fn down_key(run: &str, host: &str) -> String {
    format!("shoal/hosts/{run}/{host}/down")
}

fn up_key(run: &str, host: &str) -> String {
    format!("shoal/hosts/{run}/{host}/up")
}

/// What a host is to carry.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Assignment {
    /// Which AUVs, neighbours in the order due together.
    pub auvs: Vec<AuvId>,
    /// How many of them share a process.
    pub auvs_per_process: u32,
}

/// Why a run on several hosts does not begin.
#[derive(Debug, Error)]
pub enum HostsError {
    /// Hosts cannot reach the launcher.
    #[error(transparent)]
    Network(#[from] NetworkError),
    /// The hosts that joined cannot carry all AUVs.
    #[error(
        "{missing} of {auvs} AUVs have no place on the hosts that joined ({offers} slots): start them with more --slots, or more of \
         them with a greater --hosts"
    )]
    Slots {
        /// How many there are.
        auvs: usize,
        /// How many slots are missing.
        missing: usize,
        /// What each host offers.
        offers: String,
    },
    /// The user asked to stop.
    #[error("interrupted")]
    Interrupted,
}

/// Why a host cannot take part, or no longer.
#[derive(Debug, Error)]
pub enum HostError {
    /// The launcher cannot be reached.
    #[error(transparent)]
    Network(#[from] NetworkError),
    /// Somebody is there, but no launcher.
    #[error(
        "{endpoint} can be reached, but no launcher has answered there for {wait_s} s: start `shoal run ... --listen {endpoint} \
         --hosts M` there"
    )]
    NoAnswer {
        /// Where.
        endpoint: String,
        /// How long was waited.
        wait_s: u64,
    },
    /// The launcher said no.
    #[error("the launcher refuses this host: {reason}")]
    Refused {
        /// Its reason.
        reason: String,
    },
    /// The launcher does not know this host's token.
    #[error(
        "the launcher does not know this host's token, so this host does not join: give both ends the same --token FILE"
    )]
    Launcher,
    /// The launcher runs something else.
    #[error("this host insists on a scenario with hash {only}, and the launcher runs {found}")]
    Scenario {
        /// The only one that it will run.
        only: String,
        /// What the launcher runs.
        found: String,
    },
    /// What arrived is nothing that a launcher says.
    #[error("the launcher sent what is no message, or not the one that was due")]
    NotAMessage,
    /// A message could not be read.
    #[error("a message from the launcher could not be read: {0}")]
    Codec(#[from] crate::codec::CodecError),
    /// Its own AUVs cannot be started or reached.
    #[error(transparent)]
    Fleet(#[from] FleetError),
}

/// What both ends call the text of a scenario: `blake3:` and its hash.
pub fn scenario_hash(text: &str) -> String {
    format!("blake3:{}", blake3::hash(text.as_bytes()).to_hex())
}

/// AUVs for people: runs of consecutive ids as `first-last`.
pub fn ranges(auvs: &[AuvId]) -> String {
    let mut sorted: Vec<u32> = auvs.iter().map(|auv| auv.0).collect();
    sorted.sort_unstable();
    let runs = sorted.chunk_by(|one, next| one + 1 == *next);
    let mut texts: Vec<String> = runs
        .map(|run| match run {
            [one] => one.to_string(),
            [first, .., last] => format!("{first}-{last}"),
            [] => String::new(),
        })
        .collect();
    const SHOWN: usize = 8;
    if texts.len() > SHOWN {
        texts.truncate(SHOWN);
        texts.push(format!("... ({} in all)", auvs.len()));
    }
    texts.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn auvs_are_told_in_ranges() {
        let of = |auvs: &[u32]| ranges(&auvs.iter().copied().map(AuvId).collect::<Vec<_>>());
        assert_eq!(of(&[]), "");
        assert_eq!(of(&[4]), "4");
        assert_eq!(of(&[5, 3, 4, 9, 11, 12]), "3-5, 9, 11-12");
        let many: Vec<u32> = (0..40).map(|id| 2 * id).collect();
        assert_eq!(of(&many), "0, 2, 4, 6, 8, 10, 12, 14, ... (40 in all)");
    }
}
