//! What the channel keeps of each wake-up group and of each AUV.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use iceoryx2::prelude::{Node, ipc};

use super::arena::ArenaWriter;
use super::control::Control;
use super::{down_service, up_service};
use crate::iceoryx::{self, BytesPublisher, BytesSubscriber, Length, Limits};
use crate::lockstep::Loss;
use crate::message::AuvId;

/// First guess for the length of one AUV's message down; memory grows by itself.
const EXPECTED_MESSAGE_BYTES: usize = 512;

/// Samples that a buffer holds: in step there is never more than one. Every connection pays for this.
const BUFFER: usize = 1;

/// What the watching thread and interrupt handles see.
pub(super) struct Shared {
    pub(super) control: Control,
    /// By member.
    pub(super) has_ended: Vec<AtomicBool>,
    pub(super) is_interrupted: AtomicBool,
}

pub(super) struct Group {
    pub(super) down: BytesPublisher,
    pub(super) up: BytesSubscriber,
    pub(super) sequence: u32,
    pub(super) arena: ArenaWriter,
}

pub(super) struct Member {
    pub(super) auv: AuvId,
    pub(super) group: usize,
    /// Of the process that was attached.
    pub(super) pid: Option<u32>,
    pub(super) is_alive: bool,
}

/// Makes a waiting [`SharedMemoryFleet`](super::SharedMemoryFleet) give up, from any thread.
#[derive(Clone)]
pub struct InterruptHandle(pub(super) Arc<Shared>);

impl InterruptHandle {
    /// Whatever the fleet is waiting for, or does next, ends in
    /// [`FleetError::Interrupted`](crate::lockstep::FleetError::Interrupted).
    pub fn interrupt(&self) {
        self.0.is_interrupted.store(true, Ordering::Release);
        // The channel looks by itself soon if it cannot be woken.
        let _woken = self.0.control.ring_channel();
    }
}

impl Shared {
    /// Notes that the process of `auv` has ended.
    pub(super) fn end(&self, auv: AuvId) {
        let has_ended = self.control.find(auv).and_then(|(index, _)| self.has_ended.get(index));
        if let Some(has_ended) = has_ended {
            has_ended.store(true, Ordering::Release);
            // The channel looks by itself soon if it cannot be woken.
            let _woken = self.control.ring_channel();
        }
    }
}

impl Group {
    /// Makes the services of the group `index`.
    pub(super) fn create(node: &Node<ipc::Service>, index: usize, members: usize) -> Result<Self, String> {
        // Ports of the dead are never cleared away within a run, so those that are restarted need some of their own.
        let auvs = members + members / 4 + 4;
        let limits =
            |publishers, subscribers| Limits { publishers, subscribers, buffer: BUFFER, overflow: false };
        let down = iceoryx::create(node, &down_service(index), limits(1, auvs))?;
        let up = iceoryx::create(node, &up_service(index), limits(auvs, 1))?;
        Ok(Self {
            down: iceoryx::publisher(&down, Length::Expected(members.max(1) * EXPECTED_MESSAGE_BYTES))?,
            up: iceoryx::subscriber(&up)?,
            sequence: 0,
            arena: ArenaWriter::default(),
        })
    }
}

impl Member {
    pub(super) fn lose(&mut self, reason: &str, losses: &mut Vec<Loss>) {
        self.is_alive = false;
        losses.push(Loss { auv: self.auv, reason: reason.to_owned() });
    }
}
