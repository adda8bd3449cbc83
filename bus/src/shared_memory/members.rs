//! What the channel keeps of each AUV, and what other threads see of it.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::arena::{Arena, Place};
use crate::lockstep::Loss;
use crate::message::AuvId;

/// What the watching thread and interrupt handles see.
pub(super) struct Shared {
    pub(super) arena: Arena,
    /// By member.
    pub(super) has_ended: Vec<AtomicBool>,
    pub(super) is_interrupted: AtomicBool,
}

pub(super) struct Member {
    pub(super) auv: AuvId,
    pub(super) place: Place,
    /// Of the last message to it.
    pub(super) sequence: u32,
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
        let _woken = self.0.arena.ring_channel();
    }
}

impl Shared {
    /// Notes that the process of `auv` has ended.
    pub(super) fn end(&self, auv: AuvId) {
        let has_ended = self.arena.find(auv).and_then(|(index, _)| self.has_ended.get(index));
        if let Some(has_ended) = has_ended {
            has_ended.store(true, Ordering::Release);
            // The channel looks by itself soon if it cannot be woken.
            let _woken = self.arena.ring_channel();
        }
    }
}

impl Member {
    pub(super) fn lose(&mut self, reason: &str, losses: &mut Vec<Loss>) {
        self.is_alive = false;
        losses.push(Loss { auv: self.auv, reason: reason.to_owned() });
    }
}
