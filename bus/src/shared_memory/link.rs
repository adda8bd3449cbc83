//! The end in a process of AUVs.

use std::fmt::Display;
use std::sync::atomic::Ordering;
use std::time::Duration;

use super::arena::{Arena, write_answer};
use super::control::Control;
use super::{BUS, down_service, up_service};
use crate::codec;
use crate::iceoryx::{self, BytesPublisher, BytesSubscriber, Island, Length};
use crate::lockstep::{Batch, FromAuv, Link, LinkError, ToAuv, ToProcess};
use crate::message::{Acted, AuvId};
use crate::os::{Process, raise_descriptor_limit, sleep_on};
use crate::run_dir::RunDir;

/// How long an AUV sleeps before it looks whether the channel is alive.
const CHANNEL_CHECK: Duration = Duration::from_secs(1);

/// The answers of a process to one window are no longer: thousands of ticks.
const ANSWER_LIMIT_BYTES: usize = 4 << 20;

/// The same for each further AUV of the process.
const FURTHER_LIMIT_BYTES: usize = 64 << 10;

/// The end of the `iceoryx2` transport in a process of AUVs.
pub struct SharedMemoryLink {
    members: Vec<Member>,
    group: usize,
    // Ports before the control block and everything else: they are dropped in this order.
    down: BytesSubscriber,
    up: BytesPublisher,
    control: Control,
    channel: Process,
    /// Sequence number and window of the last sample.
    sequence: u32,
    window: u32,
    /// Whether a sample with a message was received: only then is the sequence known for certain.
    is_in_step: bool,
    /// What the last sample held, last first.
    inbox: Vec<ToProcess>,
    /// How many of its batches have no answer yet, and the other answers.
    unanswered: usize,
    outbox: Vec<u8>,
}

struct Member {
    auv: AuvId,
    slot: usize,
    has_batch: bool,
}

impl SharedMemoryLink {
    /// Joins the run of `run` for these AUVs, which are of one wake-up group, and reports in.
    pub fn join(run: &RunDir, auvs: &[AuvId]) -> Result<Self, LinkError> {
        Self::try_join(run, auvs).map_err(|cause| LinkError::Setup { bus: BUS, cause })
    }

    fn try_join(run: &RunDir, auvs: &[AuvId]) -> Result<Self, String> {
        raise_descriptor_limit().map_err(|error| format!("descriptor limit: {error}"))?;
        let control = Control::open(run).map_err(|error| format!("control block: {error}"))?;
        let found = auvs.iter().map(|auv| control.find(*auv)).collect::<Option<Vec<_>>>();
        let found = found.ok_or("the run has no such AUVs")?;
        let &(_, group) = found.first().ok_or("a process needs an AUV")?;
        if found.iter().any(|(_, other)| *other != group) {
            return Err("its AUVs are not of one wake-up group".to_owned());
        }
        let channel =
            Process::open(control.channel_pid()).map_err(|error| format!("channel process: {error}"))?;
        let channel = channel.ok_or("the channel's process has ended")?;
        let node = iceoryx::node(run, Island::Agents)?;
        let down = iceoryx::subscriber(&iceoryx::open(&node, &down_service(group))?)?;
        let limit = ANSWER_LIMIT_BYTES + (auvs.len() - 1) * FURTHER_LIMIT_BYTES;
        let up = iceoryx::publisher(&iceoryx::open(&node, &up_service(group))?, Length::Limit(limit))?;
        let sequence = control.group_bell(group).load(Ordering::Acquire);
        for &(slot, _) in &found {
            control.slot(slot).dismissed.store(0, Ordering::Relaxed);
            control.slot(slot).acknowledged.store(sequence, Ordering::Relaxed);
            control.slot(slot).pid.store(std::process::id(), Ordering::Release);
        }
        control.ring_channel().map_err(|error| format!("reporting in: {error}"))?;
        let member = |(&auv, (slot, _))| Member { auv, slot, has_batch: false };
        Ok(Self {
            members: auvs.iter().zip(found).map(member).collect(),
            group,
            down,
            up,
            control,
            channel,
            sequence,
            window: 0,
            is_in_step: false,
            inbox: Vec::new(),
            unanswered: 0,
            outbox: Vec::new(),
        })
    }

    /// Sleeps until the group's bell is another than that of the last sample. `false`: the run is over.
    fn await_bell(&self) -> Result<bool, LinkError> {
        loop {
            let bell = self.control.group_bell(self.group);
            let rung = bell.load(Ordering::Acquire) != self.sequence;
            if self.control.ended().load(Ordering::Acquire) != 0 {
                return Ok(false);
            }
            let is_dismissed =
                |member: &&Member| self.control.slot(member.slot).dismissed.load(Ordering::Acquire) != 0;
            if let Some(member) = self.members.iter().find(is_dismissed) {
                return Err(failed(format_args!("the channel gave AUV {} up", member.auv)));
            }
            if rung {
                return Ok(true);
            }
            sleep_on(bell, self.sequence, CHANNEL_CHECK).map_err(failed)?;
            if bell.load(Ordering::Acquire) == self.sequence && self.channel.has_ended().map_err(failed)? {
                return Err(failed("the channel's process has ended"));
            }
        }
    }

    /// Takes the sample that the bell announced, and acknowledges it unless it waits for answers.
    fn take(&mut self) -> Result<(), LinkError> {
        let Some(sample) = self.down.receive().map_err(failed)? else {
            if self.is_in_step {
                return Err(failed(format_args!("sample {} is missing", self.sequence.wrapping_add(1))));
            }
            // Published before this process had joined.
            self.sequence = self.control.group_bell(self.group).load(Ordering::Acquire);
            return Ok(());
        };
        for member in self.members.iter_mut().rev() {
            let auv = member.auv;
            let arena = Arena::read(sample.payload(), auv).ok_or_else(|| failed("a sample is damaged"))?;
            if self.is_in_step && arena.sequence != self.sequence.wrapping_add(1) {
                let (found, last) = (arena.sequence, self.sequence);
                return Err(failed(format_args!("sample {found} came after sample {last}")));
            }
            let Some(message) = arena.message else { continue };
            self.inbox.push(match codec::decode(message)? {
                ToAuv::Born(born) => ToProcess::Born(born),
                ToAuv::Sensed(items) => {
                    member.has_batch = true;
                    self.unanswered += 1;
                    ToProcess::Sensed(Batch { auv, items })
                }
                ToAuv::End => ToProcess::End,
            });
        }
        let arena = Arena::read(sample.payload(), AuvId(0)).ok_or_else(|| failed("a sample is damaged"))?;
        (self.sequence, self.window) = (arena.sequence, arena.window);
        drop(sample);
        self.is_in_step |= !self.inbox.is_empty();
        if self.is_in_step && self.unanswered == 0 {
            self.acknowledge()?;
        }
        Ok(())
    }

    fn acknowledge(&self) -> Result<(), LinkError> {
        for member in &self.members {
            self.control.acknowledge(member.slot, self.group, self.sequence, self.window).map_err(failed)?;
        }
        Ok(())
    }
}

impl Link for SharedMemoryLink {
    fn receive(&mut self) -> Result<ToProcess, LinkError> {
        loop {
            if let Some(message) = self.inbox.pop() {
                return Ok(message);
            }
            if !self.await_bell()? {
                return Ok(ToProcess::End);
            }
            self.take()?;
        }
    }

    fn answer(&mut self, acted: Batch<Acted>) -> Result<(), LinkError> {
        let member = self.members.iter_mut().find(|member| member.auv == acted.auv);
        if !member.is_some_and(|member| std::mem::take(&mut member.has_batch)) {
            return Err(failed("an answer without a batch"));
        }
        let message = codec::encode(&FromAuv::Acted(acted.items))?;
        write_answer(&mut self.outbox, acted.auv, self.sequence, &message);
        self.unanswered -= 1;
        if self.unanswered > 0 {
            return Ok(());
        }
        let reached = iceoryx::send(&self.up, &self.outbox).map_err(failed)?;
        if reached != 1 {
            return Err(failed(format_args!("an answer reached {reached} channels")));
        }
        self.outbox.clear();
        self.acknowledge()
    }
}

#[cfg(test)]
impl SharedMemoryLink {
    /// Acknowledges the batch after sending these samples instead of an answer.
    pub(super) fn answer_with(&mut self, samples: &[Vec<u8>]) {
        for sample in samples {
            iceoryx::send(&self.up, sample).unwrap();
        }
        self.unanswered = 0;
        self.acknowledge().unwrap();
    }
}

fn failed(cause: impl Display) -> LinkError {
    LinkError::Failed { bus: BUS, cause: cause.to_string() }
}
