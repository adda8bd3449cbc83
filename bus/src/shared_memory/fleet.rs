//! The channel's end.

use std::fmt::Display;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use super::BUS;
use super::arena::{Arena, ENDED, GROUP_MAX, Place};
use super::long::{self, Way};
use super::members::{InterruptHandle, Member, Shared};
use crate::codec;
use crate::lockstep::{Answers, Batch, Fleet, FleetError, Loss, PROCESS_ENDED};
use crate::message::{AuvId, Born, Sensed};
use crate::os::raise_descriptor_limit;
use crate::run_dir::RunDir;
use crate::watch::Watch;
use crate::wire::{NOT_A_MESSAGE, ToAuvRef, read_acted};

/// How long live AUVs may be silent unless [`SharedMemoryFleet::set_stall_limit`] says otherwise.
const STALL_LIMIT: Duration = Duration::from_secs(300);

/// How long the channel sleeps before it looks by itself; it is woken for everything that it must know.
const LOOK_AGAIN: Duration = Duration::from_millis(20);

/// The same in a window in which an AUV died, perhaps just when it was to wake the channel.
const LOOK_AGAIN_AFTER_LOSS: Duration = Duration::from_millis(1);

/// The channel's end of the `iceoryx2` transport.
pub struct SharedMemoryFleet {
    // The watching thread first: it refers to all the rest.
    watch: Watch,
    pub(super) members: Vec<Member>,
    /// Of each group those that are due in this window, as (member, index of its message).
    due: Vec<Vec<(usize, usize)>>,
    pub(super) shared: Arc<Shared>,
    run: RunDir,
    /// The message at hand.
    bytes: Vec<u8>,
    stall_limit: Duration,
    pub(super) waited: Duration,
    /// Who is at work past a deadline, as (member, ticks).
    pub(super) late: Vec<(usize, usize)>,
}

impl SharedMemoryFleet {
    /// Makes the arena of `run`, for these processes and the AUVs that each carries. Do this before they start. Processes that are
    /// next to each other are woken together: sort them by the phase of their AUVs' ticks.
    pub fn create(run: &RunDir, processes: &[Vec<AuvId>]) -> Result<Self, FleetError> {
        Self::try_create(run, processes).map_err(|cause| FleetError::Setup { bus: BUS, cause })
    }

    fn try_create(run: &RunDir, processes: &[Vec<AuvId>]) -> Result<Self, String> {
        raise_descriptor_limit().map_err(|error| format!("descriptor limit: {error}"))?;
        let mut placed: Vec<(AuvId, Place)> = Vec::new();
        for (index, auvs) in processes.iter().enumerate() {
            let place = Place { group: index / GROUP_MAX, bit: 1 << (index % GROUP_MAX) };
            placed.extend(auvs.iter().map(|auv| (*auv, place)));
        }
        placed.sort_unstable_by_key(|(auv, _)| *auv);
        if let Some(twice) = placed.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            return Err(format!("AUV {} is in two processes", twice[0].0));
        }
        let groups = processes.len().div_ceil(GROUP_MAX);
        let arena = Arena::create(run, &placed, groups).map_err(|error| format!("arena: {error}"))?;
        let shared = Arc::new(Shared {
            arena,
            has_ended: placed.iter().map(|_| AtomicBool::new(false)).collect(),
            is_interrupted: AtomicBool::new(false),
        });
        let seen_by_watch = Arc::clone(&shared);
        let watch =
            Watch::new(move |auv| seen_by_watch.end(auv)).map_err(|error| format!("watch: {error}"))?;
        let member = |&(auv, place)| Member { auv, place, sequence: 0, pid: None, is_alive: false };
        Ok(Self {
            watch,
            members: placed.iter().map(member).collect(),
            due: vec![Vec::new(); groups],
            shared,
            run: run.clone(),
            bytes: Vec::new(),
            stall_limit: STALL_LIMIT,
            waited: Duration::ZERO,
            late: Vec::new(),
        })
    }

    /// Says which process is which AUV, so that its end is noticed; again for one that was restarted.
    pub fn attach_processes(&mut self, processes: &[(AuvId, u32)]) -> Result<(), FleetError> {
        for (auv, pid) in processes {
            let index = self.index(*auv)?;
            self.members[index].pid = Some(*pid);
            self.shared.has_ended[index].store(false, Ordering::Release);
        }
        self.watch.attach(processes).map_err(failed)
    }

    /// How long live AUVs may be silent before [`FleetError::Stalled`]; 300 s at first.
    pub fn set_stall_limit(&mut self, limit: Duration) {
        self.stall_limit = limit;
    }

    /// A handle that makes this fleet give up.
    pub fn interrupt_handle(&self) -> InterruptHandle {
        InterruptHandle(Arc::clone(&self.shared))
    }

    pub(super) fn index(&self, auv: AuvId) -> Result<usize, FleetError> {
        // Where it is when all ids from 0 on are there.
        if self.members.get(auv.0 as usize).is_some_and(|member| member.auv == auv) {
            return Ok(auv.0 as usize);
        }
        let found = self.members.binary_search_by_key(&auv, |member| member.auv);
        found.map_err(|_| failed(format_args!("AUV {auv} is in no process of this run")))
    }

    /// Takes in the ends that were noticed since the last window.
    pub(super) fn bury(&mut self, losses: &mut Vec<Loss>) {
        for (member, has_ended) in self.members.iter_mut().zip(&self.shared.has_ended) {
            if member.is_alive && has_ended.load(Ordering::Acquire) {
                member.lose(PROCESS_ENDED, losses);
            }
        }
    }

    /// Waits until each of these members is done, or has been lost because its process ended before it was.
    fn wait(
        &mut self,
        members: impl Iterator<Item = usize> + Clone,
        losses: &mut Vec<Loss>,
        is_done: impl Fn(&Self, usize) -> bool,
    ) -> Result<(), FleetError> {
        let mut waiting = members.peekable();
        let mut since = None;
        let mut look_again = LOOK_AGAIN;
        loop {
            let bell = self.shared.arena.channel_bell();
            if self.shared.is_interrupted.load(Ordering::Acquire) {
                return Err(FleetError::Interrupted);
            }
            while let Some(&index) = waiting.peek() {
                // In this order: what an ended process had done by its end is final.
                let has_ended = self.shared.has_ended[index].load(Ordering::Acquire);
                if !is_done(self, index) {
                    if !has_ended {
                        break;
                    }
                    self.members[index].lose(PROCESS_ENDED, losses);
                }
                if has_ended {
                    look_again = LOOK_AGAIN_AFTER_LOSS;
                }
                since = None;
                waiting.next();
            }
            if waiting.peek().is_none() {
                return Ok(());
            }
            if since.get_or_insert_with(Instant::now).elapsed() > self.stall_limit {
                let waiting = waiting.filter(|&index| !is_done(self, index));
                let waiting = waiting.map(|index| self.members[index].auv).collect();
                return Err(FleetError::Stalled { waiting, limit_s: self.stall_limit.as_secs() });
            }
            let limit = look_again.min(self.stall_limit);
            self.shared.arena.await_channel_bell(bell, limit).map_err(failed)?;
        }
    }

    /// Sends one message to each of these members, group by group: the first group is at work while the next one's are written.
    /// Leaves in `due` who has yet to deal with it.
    pub(super) fn send(&mut self, messages: &[(usize, ToAuvRef<'_>)]) -> Result<(), FleetError> {
        self.due.iter_mut().for_each(Vec::clear);
        for (at, (index, _)) in messages.iter().enumerate() {
            self.due[self.members[*index].place.group].push((*index, at));
        }
        let arena = &self.shared.arena;
        for (group, due) in self.due.iter().enumerate().filter(|(_, due)| !due.is_empty()) {
            let window = arena.begin_window(group, due.len());
            let mut bits = 0;
            for &(index, at) in due {
                let member = &mut self.members[index];
                member.sequence = member.sequence.wrapping_add(1);
                bits |= member.place.bit;
                self.bytes.clear();
                codec::encode_into(&messages[at].1, &mut self.bytes).map_err(failed)?;
                let slot = arena.slot(index);
                slot.window.store(window, Ordering::Relaxed);
                long::send(slot.down, &self.run, Way::Down, member.auv, member.sequence, &self.bytes)
                    .map_err(failed)?;
            }
            arena.ring_group(group, bits).map_err(failed)?;
        }
        Ok(())
    }

    /// Waits until all members of a group that are due have dealt with their message.
    fn await_group(&mut self, group: usize, losses: &mut Vec<Loss>) -> Result<(), FleetError> {
        let since = Instant::now();
        let due = std::mem::take(&mut self.due[group]);
        let waited = self.wait(due.iter().map(|(index, _)| *index), losses, Self::has_answered);
        self.due[group] = due;
        self.waited += since.elapsed();
        waited
    }

    /// Whether a member has dealt with the last message to it.
    pub(super) fn has_answered(&self, index: usize) -> bool {
        // Whatever is not the number before is an answer; whether it is the right one is seen when it is read.
        let before = self.members[index].sequence.wrapping_sub(1);
        self.shared.arena.slot(index).up.sequence.load(Ordering::Acquire) != before
    }

    /// Reads the answer of a member to a batch of so many ticks.
    pub(super) fn read(&mut self, index: usize, ticks: usize, answers: &mut Answers) {
        let member = &mut self.members[index];
        if !member.is_alive {
            return;
        }
        let slot = self.shared.arena.slot(index);
        let found = slot.up.sequence.load(Ordering::Acquire);
        let acted = if found == member.sequence {
            long::receive(slot.up, &self.run, Way::Up, member.auv, &mut self.bytes)
                .ok_or_else(|| NOT_A_MESSAGE.to_owned())
                .and_then(|()| read_acted(&self.bytes, ticks))
        } else {
            Err(format!("answered message {found} instead of {}", member.sequence))
        };
        match acted {
            Ok(items) => answers.acted.push(Batch { auv: member.auv, items }),
            Err(reason) => {
                slot.dismissed.store(1, Ordering::Release);
                // Who is deaf to this hears of the run's end.
                let _woken = self.shared.arena.ring_group(member.place.group, member.place.bit);
                member.lose(&reason, &mut answers.losses);
            }
        }
    }
}

impl Fleet for SharedMemoryFleet {
    fn born(&mut self, born: &[Born]) -> Result<Vec<Loss>, FleetError> {
        let mut losses = Vec::new();
        let newborn = born.iter().map(|born| self.index(born.auv)).collect::<Result<Vec<usize>, _>>()?;
        for &index in &newborn {
            self.members[index].is_alive = true;
        }
        self.wait(newborn.iter().copied(), &mut losses, |fleet, index| {
            let pid = fleet.shared.arena.slot(index).pid.load(Ordering::Acquire);
            fleet.members[index].pid.map_or(pid != 0, |attached| attached == pid)
        })?;
        let alive = newborn.iter().zip(born).filter(|(index, _)| self.members[**index].is_alive);
        let messages: Vec<_> = alive.map(|(&index, born)| (index, ToAuvRef::Born(born))).collect();
        self.send(&messages)?;
        for group in 0..self.due.len() {
            self.await_group(group, &mut losses)?;
        }
        losses.sort_by_key(|loss| loss.auv);
        Ok(losses)
    }

    fn exchange(
        &mut self,
        sensed: &[Batch<Sensed>],
        meanwhile: &mut dyn FnMut(),
    ) -> Result<Answers, FleetError> {
        let mut answers = Answers { acted: Vec::with_capacity(sensed.len()), losses: Vec::new() };
        self.bury(&mut answers.losses);
        let mut messages = Vec::with_capacity(sensed.len());
        for batch in sensed {
            let index = self.index(batch.auv)?;
            if self.members[index].is_alive {
                messages.push((index, ToAuvRef::Sensed(&batch.items)));
            }
        }
        self.send(&messages)?;
        meanwhile();
        self.waited = Duration::ZERO;
        // In the order of sending: while one group's answers are read, the next groups are at work.
        for group in 0..self.due.len() {
            self.await_group(group, &mut answers.losses)?;
            for at in 0..self.due[group].len() {
                let (index, message) = self.due[group][at];
                self.read(index, messages[message].1.ticks(), &mut answers);
            }
        }
        answers.sort();
        Ok(answers)
    }

    fn waited(&self) -> Duration {
        self.waited
    }

    fn exchange_until(
        &mut self,
        sensed: &mut Vec<Batch<Sensed>>,
        deadline: Instant,
        meanwhile: &mut dyn FnMut(),
    ) -> Result<Answers, FleetError> {
        self.exchange_freely(sensed, deadline, meanwhile)
    }

    fn end(&mut self) {
        self.shared.arena.ended().store(ENDED, Ordering::Release);
        for group in 0..self.due.len() {
            // A futex call on a word that is mapped does not fail; the launcher ends who sleeps nevertheless.
            let _woken = self.shared.arena.ring_group(group, u32::MAX);
        }
    }
}

impl Drop for SharedMemoryFleet {
    fn drop(&mut self) {
        self.end();
    }
}

pub(super) fn failed(cause: impl Display) -> FleetError {
    FleetError::Failed { bus: BUS, cause: cause.to_string() }
}

#[cfg(test)]
mod tests {
    use super::super::SharedMemoryLink;
    use super::*;
    use crate::codec::MESSAGE_LIMIT_BYTES;
    use crate::lockstep::{FromAuv, Link, ToProcess};

    /// What a window brings whose only AUV answers with this, by its own account `length` bytes of a message so many numbers ahead.
    fn window(message: &[u8], length: usize, sequence_ahead: u32) -> Answers {
        let run = RunDir::create(&serde_json::Value::Null).unwrap();
        let mut fleet = SharedMemoryFleet::create(&run, &[vec![AuvId(4)]]).unwrap();
        let (joins, message) = (run.clone(), message.to_vec());
        let auv = std::thread::spawn(move || {
            let mut link = SharedMemoryLink::join(&joins, &[AuvId(4)]).unwrap();
            link.receive().unwrap();
            link.answer_with(&message, length as u32, sequence_ahead);
            link.receive().is_ok_and(|message| message == ToProcess::End)
        });
        fleet
            .wait([0].into_iter(), &mut Vec::new(), |fleet, index| {
                fleet.shared.arena.slot(index).pid.load(Ordering::Acquire) != 0
            })
            .unwrap();
        fleet.members[0].is_alive = true;
        let answers = fleet.exchange(&[Batch { auv: AuvId(4), items: Vec::new() }], &mut || {}).unwrap();
        drop(fleet);
        auv.join().unwrap();
        run.remove().unwrap();
        answers
    }

    #[test]
    fn strange_answers_lose_their_sender() {
        let fine = codec::encode(&FromAuv::Acted(Vec::new())).unwrap();
        let acted = vec![Batch { auv: AuvId(4), items: Vec::new() }];
        assert_eq!(window(&fine, fine.len(), 0), Answers { acted, losses: Vec::new() });
        let lost = |answers: Answers| {
            assert!(answers.acted.is_empty());
            let [Loss { auv: AuvId(4), reason }] = &answers.losses[..] else { panic!("{answers:?}") };
            reason.clone()
        };
        for length in [0, 1, 7, fine.len() - 1, fine.len() + 1, 9_000, MESSAGE_LIMIT_BYTES, u32::MAX as usize]
        {
            assert_eq!(lost(window(&fine, length, 0)), NOT_A_MESSAGE, "{length}");
        }
        assert_eq!(lost(window(b"garbage", 7, 0)), NOT_A_MESSAGE);
        assert_eq!(lost(window(&fine, fine.len(), 6)), "answered message 7 instead of 1");
    }

    #[test]
    fn an_auv_in_two_processes_is_refused() {
        let run = RunDir::create(&serde_json::Value::Null).unwrap();
        let made = SharedMemoryFleet::create(&run, &[vec![AuvId(1), AuvId(2)], vec![AuvId(1)]]);
        run.remove().unwrap();
        assert!(made.is_err_and(|error| error.to_string().contains("AUV 1 is in two")));
    }
}
