//! What the launcher keeps of each host.

use std::collections::BTreeMap;
use std::sync::Arc;

use zenoh::Session;

use super::frame::Line;
use super::handshake::{Join, Welcome};
use super::heart::{Pulse, send};
use super::parcels::{Reader, from_host};
use crate::lockstep::{Batch, Loss};
use crate::message::{Acted, AuvId};
use crate::wire::{NOT_A_MESSAGE, read_acted};

/// One host as the launcher sees it.
pub(super) struct Member {
    pub(super) join: Join,
    /// As people call it, if two have one name.
    pub(super) name: String,
    pub(super) welcome: Welcome,
    pub(super) pulse: Arc<Pulse>,
    pub(super) line: Line,
    pub(super) state: State,
    pub(super) awaits: Awaits,
    /// Its living AUVs, and of how many ticks each owes the answers.
    pub(super) auvs: BTreeMap<AuvId, usize>,
}

/// What a host is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum State {
    /// It has joined and carries nobody.
    Idle,
    /// It carries AUVs.
    Carrying,
    /// It is gone.
    Gone,
}

/// What the launcher waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Awaits {
    Nothing,
    Births,
    Answers,
    Goodbye,
}

/// What a message from a host means.
pub(super) enum Brought {
    /// What was awaited, or nothing.
    Taken,
    /// Its AUVs are born, in so many processes.
    Births { processes: u32 },
    /// The host leaves, for this reason.
    Goodbye(String),
}

impl Member {
    /// Sends the next message, whose body `fill` writes after `tag`.
    pub(super) fn say(
        &mut self,
        session: &Session,
        tag: u8,
        fill: impl FnOnce(&mut Vec<u8>),
    ) -> Result<(), String> {
        let frame = self.line.next(tag, fill);
        let sent = send(session, &self.pulse.key, frame);
        self.pulse.sent(self.line.sent());
        sent
    }

    /// Takes in a message that was not heard before. `None`: it is no message of a host, or not the one that is due.
    pub(super) fn take(
        &mut self,
        body: &[u8],
        acted: &mut Vec<Batch<Acted>>,
        losses: &mut Vec<Loss>,
    ) -> Option<Brought> {
        let (tag, body) = body.split_first()?;
        let mut reader = Reader(body);
        match (*tag, self.awaits) {
            (from_host::BORN, Awaits::Births) => {
                let processes = reader.number()?;
                let lost = reader.losses()?;
                reader.ending(())?;
                self.lose(lost, losses);
                self.awaits = Awaits::Nothing;
                return Some(Brought::Births { processes });
            }
            (from_host::ANSWERS, Awaits::Answers) => {
                let answers = reader.list()?;
                let lost = reader.losses()?;
                reader.ending(())?;
                for (auv, message) in answers {
                    self.answered(auv, message, acted, losses);
                }
                self.lose(lost, losses);
                self.awaits = Awaits::Nothing;
                let forgotten: Vec<Loss> =
                    self.auvs.iter().filter(|(_, ticks)| **ticks > 0).map(forgotten).collect();
                self.lose(forgotten, losses);
            }
            (from_host::GOODBYE, _) => {
                return Some(Brought::Goodbye(String::from_utf8_lossy(body).into_owned()));
            }
            // Of a window that an interruption left behind.
            (from_host::BORN | from_host::ANSWERS, Awaits::Goodbye) => {}
            _ => return None,
        }
        Some(Brought::Taken)
    }

    fn answered(
        &mut self,
        auv: AuvId,
        message: &[u8],
        acted: &mut Vec<Batch<Acted>>,
        losses: &mut Vec<Loss>,
    ) {
        let Some(ticks) = self.auvs.get_mut(&auv).map(std::mem::take).filter(|ticks| *ticks > 0) else {
            return self.lose(vec![Loss { auv, reason: NOT_A_MESSAGE.to_owned() }], losses);
        };
        match read_acted(message, ticks) {
            Ok(items) => acted.push(Batch { auv, items }),
            Err(reason) => self.lose(vec![Loss { auv, reason }], losses),
        }
    }

    /// Takes AUVs off its list that were on it.
    fn lose(&mut self, lost: Vec<Loss>, losses: &mut Vec<Loss>) {
        losses.extend(lost.into_iter().filter(|loss| self.auvs.remove(&loss.auv).is_some()));
    }

    /// Takes all AUVs off its list.
    pub(super) fn lose_all(&mut self, reason: &str, losses: &mut Vec<Loss>) -> Vec<AuvId> {
        let auvs: Vec<AuvId> = std::mem::take(&mut self.auvs).into_keys().collect();
        losses.extend(auvs.iter().map(|&auv| Loss { auv, reason: reason.to_owned() }));
        auvs
    }
}

fn forgotten((&auv, _): (&AuvId, &usize)) -> Loss {
    Loss { auv, reason: "its host gave no answer for it".to_owned() }
}
