//! An AUV's end.

use std::fmt::Display;
use std::sync::atomic::Ordering;
use std::time::Duration;

use super::arena::{Arena, write_answer};
use super::control::Control;
use super::{BUS, down_service, up_service};
use crate::codec;
use crate::iceoryx::{self, BytesPublisher, BytesSubscriber, Island, Length};
use crate::lockstep::{FromAuv, Link, LinkError, ToAuv};
use crate::message::{Acted, AuvId};
use crate::os::{Process, raise_descriptor_limit, sleep_on};
use crate::run_dir::RunDir;

/// How long an AUV sleeps before it looks whether the channel is alive.
const CHANNEL_CHECK: Duration = Duration::from_secs(1);

/// No answer to one window is longer: thousands of ticks.
const ANSWER_LIMIT_BYTES: usize = 4 << 20;

/// One AUV's end of the `iceoryx2` transport.
pub struct SharedMemoryLink {
    auv: AuvId,
    slot: usize,
    group: usize,
    // Ports before the control block and everything else: they are dropped in this order.
    down: BytesSubscriber,
    up: BytesPublisher,
    control: Control,
    channel: Process,
    /// Sequence number and window of the last sample.
    sequence: u32,
    window: u32,
    /// Whether a sample of this AUV's own was received: only then is the sequence known for certain.
    is_in_step: bool,
    has_batch: bool,
}

impl SharedMemoryLink {
    /// Joins the run of `run` as `auv`, and reports in.
    pub fn join(run: &RunDir, auv: AuvId) -> Result<Self, LinkError> {
        Self::try_join(run, auv).map_err(|cause| LinkError::Setup { auv, bus: BUS, cause })
    }

    fn try_join(run: &RunDir, auv: AuvId) -> Result<Self, String> {
        raise_descriptor_limit().map_err(|error| format!("descriptor limit: {error}"))?;
        let control = Control::open(run).map_err(|error| format!("control block: {error}"))?;
        let (slot, group) = control.find(auv).ok_or("the run has no such AUV")?;
        let channel =
            Process::open(control.channel_pid()).map_err(|error| format!("channel process: {error}"))?;
        let channel = channel.ok_or("the channel's process has ended")?;
        let node = iceoryx::node(run, Island::Agents)?;
        let down = iceoryx::subscriber(&iceoryx::open(&node, &down_service(group))?)?;
        let up = iceoryx::publisher(
            &iceoryx::open(&node, &up_service(group))?,
            Length::Limit(ANSWER_LIMIT_BYTES),
        )?;
        let sequence = control.group_bell(group).load(Ordering::Acquire);
        control.slot(slot).dismissed.store(0, Ordering::Relaxed);
        control.slot(slot).acknowledged.store(sequence, Ordering::Relaxed);
        control.slot(slot).pid.store(std::process::id(), Ordering::Release);
        control.ring_channel().map_err(|error| format!("reporting in: {error}"))?;
        Ok(Self {
            auv,
            slot,
            group,
            down,
            up,
            control,
            channel,
            sequence,
            window: 0,
            is_in_step: false,
            has_batch: false,
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
            if self.control.slot(self.slot).dismissed.load(Ordering::Acquire) != 0 {
                return Err(failed("the channel gave this AUV up"));
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

    /// Takes the sample that the bell announced. `None`: nothing in it is for this AUV.
    fn take(&mut self) -> Result<Option<ToAuv>, LinkError> {
        let Some(sample) = self.down.receive().map_err(failed)? else {
            if self.is_in_step {
                return Err(failed(format_args!("sample {} is missing", self.sequence.wrapping_add(1))));
            }
            // Published before this AUV had joined.
            self.sequence = self.control.group_bell(self.group).load(Ordering::Acquire);
            return Ok(None);
        };
        let arena = Arena::read(sample.payload(), self.auv).ok_or_else(|| failed("a sample is damaged"))?;
        if self.is_in_step && arena.sequence != self.sequence.wrapping_add(1) {
            let (found, last) = (arena.sequence, self.sequence);
            return Err(failed(format_args!("sample {found} came after sample {last}")));
        }
        (self.sequence, self.window) = (arena.sequence, arena.window);
        let Some(message) = arena.message else { return Ok(None) };
        self.is_in_step = true;
        Ok(Some(codec::decode(message)?))
    }

    fn acknowledge(&self) -> Result<(), LinkError> {
        self.control.acknowledge(self.slot, self.group, self.sequence, self.window).map_err(failed)
    }
}

impl Link for SharedMemoryLink {
    fn receive(&mut self) -> Result<ToAuv, LinkError> {
        while self.await_bell()? {
            match self.take()? {
                // The batch is acknowledged by its answer.
                Some(ToAuv::Sensed(batch)) => {
                    self.has_batch = true;
                    return Ok(ToAuv::Sensed(batch));
                }
                Some(message) => {
                    self.acknowledge()?;
                    return Ok(message);
                }
                None if self.is_in_step => self.acknowledge()?,
                None => {}
            }
        }
        Ok(ToAuv::End)
    }

    fn answer(&mut self, acted: Vec<Acted>) -> Result<(), LinkError> {
        if !std::mem::take(&mut self.has_batch) {
            return Err(failed("an answer without a batch"));
        }
        let message = codec::encode(&FromAuv::Acted(acted))?;
        let reached =
            iceoryx::send(&self.up, &write_answer(self.auv, self.sequence, &message)).map_err(failed)?;
        if reached != 1 {
            return Err(failed(format_args!("an answer reached {reached} channels")));
        }
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
        self.acknowledge().unwrap();
    }
}

fn failed(cause: impl Display) -> LinkError {
    LinkError::Failed { bus: BUS, cause: cause.to_string() }
}
