//! The end in a process of AUVs.

use std::fmt::Display;
use std::sync::atomic::Ordering;
use std::time::Duration;

use super::BUS;
use super::arena::{Arena, ORPHANED, Place};
use super::long::{self, Way};
use crate::codec;
use crate::lockstep::{Batch, FromAuv, Link, LinkError, ToAuv, ToProcess};
use crate::message::{Acted, AuvId};
use crate::os::{Process, Slept};
use crate::run_dir::RunDir;

/// How long a guard sleeps before it looks whether the channel is alive.
const CHANNEL_CHECK: Duration = Duration::from_secs(2);

/// The end of the `iceoryx2` transport in a process of AUVs.
pub struct SharedMemoryLink {
    run: RunDir,
    arena: Arena,
    place: Place,
    channel: Process,
    members: Vec<Member>,
    /// Who is looked at next, and the bell when the first was.
    next: usize,
    bell: u32,
    /// The message at hand.
    bytes: Vec<u8>,
}

struct Member {
    auv: AuvId,
    slot: usize,
    /// Number and window of the last message.
    sequence: u32,
    window: u32,
    has_batch: bool,
}

impl SharedMemoryLink {
    /// Joins the run of `run` for these AUVs, which are those of one process, and reports in.
    pub fn join(run: &RunDir, auvs: &[AuvId]) -> Result<Self, LinkError> {
        Self::try_join(run, auvs).map_err(|cause| LinkError::Setup { bus: BUS, cause })
    }

    fn try_join(run: &RunDir, auvs: &[AuvId]) -> Result<Self, String> {
        let arena = Arena::open(run).map_err(|error| format!("arena: {error}"))?;
        let found = auvs.iter().map(|auv| arena.find(*auv)).collect::<Option<Vec<_>>>();
        let found = found.ok_or("the run has no such AUVs")?;
        let &(_, place) = found.first().ok_or("a process needs an AUV")?;
        if found.iter().any(|(_, other)| *other != place) {
            return Err("its AUVs are not those of one process".to_owned());
        }
        let channel =
            Process::open(arena.channel_pid()).map_err(|error| format!("channel process: {error}"))?;
        let channel = channel.ok_or("the channel's process has ended")?;
        let mut members = Vec::with_capacity(auvs.len());
        for (&auv, (slot, _)) in auvs.iter().zip(found) {
            let shared = arena.slot(slot);
            let sequence = shared.down.sequence.load(Ordering::Acquire);
            shared.dismissed.store(0, Ordering::Relaxed);
            shared.up.sequence.store(sequence, Ordering::Relaxed);
            // The channel sends nothing before it sees this.
            shared.pid.store(std::process::id(), Ordering::Release);
            members.push(Member { auv, slot, sequence, window: 0, has_batch: false });
        }
        arena.ring_channel().map_err(|error| format!("reporting in: {error}"))?;
        Ok(Self { run: run.clone(), arena, place, channel, members, next: 0, bell: 0, bytes: Vec::new() })
    }

    /// Takes what is new in the slot of one of the AUVs.
    fn take(&mut self, index: usize) -> Result<Option<ToProcess>, LinkError> {
        let Some(member) = self.members.get_mut(index) else { return Ok(None) };
        let slot = self.arena.slot(member.slot);
        if slot.dismissed.load(Ordering::Relaxed) != 0 {
            return Err(failed(format_args!("the channel gave AUV {} up", member.auv)));
        }
        let found = slot.down.sequence.load(Ordering::Acquire);
        if found == member.sequence {
            return Ok(None);
        }
        if found != member.sequence.wrapping_add(1) {
            let Member { auv, sequence: last, .. } = member;
            return Err(failed(format_args!("message {found} to AUV {auv} came after message {last}")));
        }
        (member.sequence, member.window) = (found, slot.window.load(Ordering::Relaxed));
        let received = long::receive(slot.down, &self.run, Way::Down, member.auv, &mut self.bytes);
        received.ok_or_else(|| failed(format_args!("message {found} to AUV {} is damaged", member.auv)))?;
        Ok(Some(match codec::decode(&self.bytes)? {
            ToAuv::Born(born) => {
                self.bytes.clear();
                self.send(index)?;
                ToProcess::Born(born)
            }
            ToAuv::Sensed(items) => {
                member.has_batch = true;
                ToProcess::Sensed(Batch { auv: member.auv, items })
            }
            ToAuv::End => ToProcess::End,
        }))
    }

    /// Sends the message at hand for one of the AUVs, which deals with the last one that it received.
    fn send(&self, index: usize) -> Result<(), LinkError> {
        let Some(member) = self.members.get(index) else { return Ok(()) };
        let up = self.arena.slot(member.slot).up;
        long::send(up, &self.run, Way::Up, member.auv, member.sequence, &self.bytes).map_err(failed)?;
        self.arena.answered(self.place.group, member.window).map_err(failed)
    }
}

impl Link for SharedMemoryLink {
    fn receive(&mut self) -> Result<ToProcess, LinkError> {
        loop {
            if self.next == 0 {
                self.bell = self.arena.group_bell(self.place.group);
            }
            while self.next < self.members.len() {
                self.next += 1;
                if let Some(message) = self.take(self.next - 1)? {
                    return Ok(message);
                }
            }
            self.next = 0;
            match self.arena.ended().load(Ordering::Acquire) {
                0 => {}
                ORPHANED => return Err(failed("the channel's process has ended")),
                _ => return Ok(ToProcess::End),
            }
            let slept = self.arena.sleep(self.place, self.bell, CHANNEL_CHECK).map_err(failed)?;
            if slept == Slept::Out && self.channel.has_ended().map_err(failed)? {
                self.arena.orphan(self.place.group).map_err(failed)?;
            }
        }
    }

    fn answer(&mut self, acted: Batch<Acted>) -> Result<(), LinkError> {
        let of_auv = |member: &Member| member.auv == acted.auv;
        // Usually the one who received last.
        let last = self.next.wrapping_sub(1);
        let index = match self.members.get(last) {
            Some(member) if of_auv(member) => Some(last),
            _ => self.members.iter().position(of_auv),
        };
        let awaiting = index.and_then(|index| Some((index, self.members.get_mut(index)?)));
        let Some((index, member)) = awaiting.filter(|(_, member)| member.has_batch) else {
            return Err(failed("an answer without a batch"));
        };
        member.has_batch = false;
        self.bytes.clear();
        codec::encode_into(&FromAuv::Acted(acted.items), &mut self.bytes)?;
        self.send(index)
    }
}

#[cfg(test)]
impl SharedMemoryLink {
    /// Answers the batch of the first AUV with this, whatever it is.
    pub(super) fn answer_with(&mut self, message: &[u8], length: u32, sequence_ahead: u32) {
        let slot = self.arena.slot(self.members[0].slot);
        slot.up.write(message);
        slot.up.length.store(length, Ordering::Relaxed);
        let sequence = self.members[0].sequence.wrapping_add(sequence_ahead);
        slot.up.sequence.store(sequence, Ordering::Release);
        self.arena.answered(self.place.group, self.members[0].window).unwrap();
    }
}

fn failed(cause: impl Display) -> LinkError {
    LinkError::Failed { bus: BUS, cause: cause.to_string() }
}
