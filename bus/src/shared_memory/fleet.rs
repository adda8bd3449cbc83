//! The channel's end.

use std::fmt::Display;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use iceoryx2::prelude::{Node, ipc};
use serde::Serialize;

use super::arena::read_answer;
use super::control::Control;
use super::late::LateGroup;
use super::members::{Group, InterruptHandle, Member, Shared};
use super::{BUS, GROUP_MAX};
use crate::codec;
use crate::iceoryx::{self, Island};
use crate::lockstep::{Answers, Batch, Fleet, FleetError, Loss, PROCESS_ENDED};
use crate::message::{Acted, AuvId, Born, Sensed};
use crate::os::{keep_descriptors_from_children, raise_descriptor_limit};
use crate::run_dir::RunDir;
use crate::watch::Watch;
use crate::wire::{NOT_A_MESSAGE, ToAuvRef, read_acted};

/// How long live AUVs may be silent unless [`SharedMemoryFleet::set_stall_limit`] says otherwise.
const STALL_LIMIT: Duration = Duration::from_secs(300);

/// How long the channel sleeps before it looks by itself; it is woken for everything that it must know.
pub(super) const LOOK_AGAIN: Duration = Duration::from_millis(20);

/// The same in a window in which an AUV died, perhaps just when it was to wake the channel.
const LOOK_AGAIN_AFTER_LOSS: Duration = Duration::from_millis(1);

/// Splits the AUVs of processes into wake-up groups of at most [`GROUP_MAX`] (more in a process of more), in the order of the
/// processes: sort them by the phase of their ticks first, so that few groups are due in a short window.
pub fn wake_groups(processes: &[Vec<AuvId>]) -> Vec<Vec<AuvId>> {
    let mut groups: Vec<Vec<AuvId>> = Vec::new();
    for process in processes {
        match groups.last_mut() {
            Some(group) if group.len() + process.len() <= GROUP_MAX => group.extend(process),
            _ => groups.push(process.clone()),
        }
    }
    groups
}

/// The channel's end of the `iceoryx2` transport.
pub struct SharedMemoryFleet {
    // The watching thread first: it refers to all the rest.
    watch: Watch,
    pub(super) groups: Vec<Group>,
    pub(super) members: Vec<Member>,
    pub(super) shared: Arc<Shared>,
    window: u32,
    stall_limit: Duration,
    pub(super) waited: Duration,
    /// Groups that are at work past a deadline.
    pub(super) late: Vec<LateGroup>,
    _node: Node<ipc::Service>,
}

impl SharedMemoryFleet {
    /// Makes the control block and the services of `run`, for the AUVs in `groups` (see [`wake_groups`]). Do this before
    /// their processes start.
    pub fn create(run: &RunDir, groups: &[Vec<AuvId>]) -> Result<Self, FleetError> {
        Self::try_create(run, groups).map_err(|cause| FleetError::Setup { bus: BUS, cause })
    }

    fn try_create(run: &RunDir, groups: &[Vec<AuvId>]) -> Result<Self, String> {
        raise_descriptor_limit().map_err(|error| format!("descriptor limit: {error}"))?;
        let mut placed: Vec<(AuvId, usize)> = Vec::new();
        for (group, auvs) in groups.iter().enumerate() {
            placed.extend(auvs.iter().map(|auv| (*auv, group)));
        }
        placed.sort_unstable();
        if let Some(twice) = placed.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            return Err(format!("AUV {} is in two wake-up groups", twice[0].0));
        }
        let node = iceoryx::node(run, Island::Agents)?;
        let made = groups.iter().enumerate().map(|(index, auvs)| Group::create(&node, index, auvs.len()));
        let groups = made.collect::<Result<Vec<Group>, String>>()?;
        let control =
            Control::create(run, &placed, groups.len()).map_err(|error| format!("control block: {error}"))?;
        let shared = Arc::new(Shared {
            control,
            has_ended: placed.iter().map(|_| AtomicBool::new(false)).collect(),
            is_interrupted: AtomicBool::new(false),
        });
        let seen_by_watch = Arc::clone(&shared);
        let watch =
            Watch::new(move |auv| seen_by_watch.end(auv)).map_err(|error| format!("watch: {error}"))?;
        keep_descriptors_from_children().map_err(|error| format!("descriptors: {error}"))?;
        let member = |&(auv, group): &(AuvId, usize)| Member { auv, group, pid: None, is_alive: false };
        Ok(Self {
            watch,
            groups,
            members: placed.iter().map(member).collect(),
            shared,
            window: 0,
            stall_limit: STALL_LIMIT,
            waited: Duration::ZERO,
            late: Vec::new(),
            _node: node,
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
        let found = self.members.binary_search_by_key(&auv, |member| member.auv);
        found.map_err(|_| failed(format_args!("AUV {auv} is in no wake-up group")))
    }

    /// Takes in the ends that were noticed since the last window.
    pub(super) fn bury(&mut self, losses: &mut Vec<Loss>) {
        for (member, has_ended) in self.members.iter_mut().zip(&self.shared.has_ended) {
            if member.is_alive && has_ended.load(Ordering::Acquire) {
                member.lose(PROCESS_ENDED, losses);
            }
        }
    }

    /// Drops from `waiting` those that are done, and those whose process has ended before they were: whether there was any.
    pub(super) fn settle(
        &mut self,
        waiting: &mut Vec<usize>,
        losses: &mut Vec<Loss>,
        is_done: &impl Fn(&Self, usize) -> bool,
    ) -> bool {
        let before = losses.len();
        waiting.retain(|&index| {
            // In this order: what an ended process had done by its end is final.
            let has_ended = self.shared.has_ended[index].load(Ordering::Acquire);
            if is_done(self, index) {
                return false;
            }
            if has_ended {
                self.members[index].lose(PROCESS_ENDED, losses);
            }
            !has_ended
        });
        losses.len() > before
    }

    /// Settles until none is left, and sleeps in between.
    fn wait(
        &mut self,
        mut waiting: Vec<usize>,
        losses: &mut Vec<Loss>,
        is_done: impl Fn(&Self, usize) -> bool,
    ) -> Result<(), FleetError> {
        let mut since = Instant::now();
        let mut look_again = LOOK_AGAIN;
        loop {
            let bell = self.shared.control.channel_bell();
            if self.shared.is_interrupted.load(Ordering::Acquire) {
                return Err(FleetError::Interrupted);
            }
            let before = waiting.len();
            if self.settle(&mut waiting, losses, &is_done) {
                look_again = LOOK_AGAIN_AFTER_LOSS;
            }
            if waiting.is_empty() {
                return Ok(());
            }
            if waiting.len() < before {
                since = Instant::now();
            } else if since.elapsed() > self.stall_limit {
                let waiting = waiting.iter().map(|&index| self.members[index].auv).collect();
                return Err(FleetError::Stalled { waiting, limit_s: self.stall_limit.as_secs() });
            }
            let limit = look_again.min(self.stall_limit);
            self.shared.control.await_channel_bell(bell, limit).map_err(failed)?;
        }
    }

    /// Sends `messages` (of live members, sorted by member) group by group, so that the first group is at work while the next
    /// one's are encoded. Returns for each group the live members that have yet to deal with its sample.
    pub(super) fn send<T: Serialize>(
        &mut self,
        messages: &[(usize, T)],
    ) -> Result<Vec<Vec<usize>>, FleetError> {
        self.window = self.window.wrapping_add(1);
        let mut of_group: Vec<Vec<usize>> = vec![Vec::new(); self.groups.len()];
        for (at, (member, _)) in messages.iter().enumerate() {
            of_group[self.members[*member].group].push(at);
        }
        let mut waiting: Vec<Vec<usize>> = vec![Vec::new(); self.groups.len()];
        for (index, member) in self.members.iter().enumerate() {
            if member.is_alive && !of_group[member.group].is_empty() {
                waiting[member.group].push(index);
            }
        }
        for (index, due) in of_group.iter().enumerate().filter(|(_, due)| !due.is_empty()) {
            let group = &mut self.groups[index];
            for (member, message) in due.iter().map(|&at| &messages[at]) {
                let message = codec::encode(message).map_err(failed)?;
                group.arena.push(self.members[*member].auv, &message);
            }
            group.sequence = group.sequence.wrapping_add(1);
            let sample = group.arena.finish(group.sequence, self.window);
            let sample = sample.ok_or_else(|| failed("one window holds more than 4 GiB for one group"))?;
            self.shared.control.begin_window(index, self.window, waiting[index].len());
            iceoryx::send(&group.down, sample).map_err(failed)?;
            self.shared.control.ring_group(index, group.sequence).map_err(failed)?;
        }
        Ok(waiting)
    }

    /// Waits until these members have dealt with their group's sample.
    fn await_group(&mut self, waiting: Vec<usize>, losses: &mut Vec<Loss>) -> Result<(), FleetError> {
        let since = Instant::now();
        let waited = self.wait(waiting, losses, Self::has_acknowledged);
        self.waited += since.elapsed();
        waited
    }

    /// Whether a member has dealt with its group's last sample.
    pub(super) fn has_acknowledged(&self, index: usize) -> bool {
        let acknowledged = self.shared.control.slot(index).acknowledged.load(Ordering::Acquire);
        acknowledged == self.groups[self.members[index].group].sequence
    }

    /// Takes the answers of one group out of its service. `due` is (member, ticks), sorted.
    pub(super) fn gather(
        &mut self,
        group: usize,
        due: &[(usize, usize)],
        answers: &mut Answers,
    ) -> Result<(), FleetError> {
        let Group { up, sequence: expected, .. } = &self.groups[group];
        let mut gathered: Vec<Option<Result<Vec<Acted>, String>>> = due.iter().map(|_| None).collect();
        let mut has_garbage = false;
        while let Some(sample) = up.receive().map_err(failed)? {
            let mut left = sample.payload();
            while !left.is_empty() {
                let Some((auv, sequence, message)) = read_answer(&mut left) else {
                    has_garbage = true;
                    break;
                };
                match due.binary_search_by_key(&auv, |&(member, _)| self.members[member].auv) {
                    Ok(at) if self.members[due[at].0].is_alive => {
                        gathered[at] = Some(match sequence == *expected {
                            true => read_acted(message, due[at].1),
                            false => Err(format!("it answered sample {sequence} instead of {expected}")),
                        });
                    }
                    Ok(_) => {}
                    Err(_) => has_garbage = true,
                }
            }
        }
        for (&(index, _), acted) in due.iter().zip(gathered) {
            let member = &mut self.members[index];
            if !member.is_alive {
                continue;
            }
            let reason = match acted {
                Some(Ok(items)) => {
                    answers.acted.push(Batch { auv: member.auv, items });
                    continue;
                }
                Some(Err(reason)) => reason,
                None if has_garbage => NOT_A_MESSAGE.to_owned(),
                None => return Err(failed(format_args!("the answer of AUV {} was lost", member.auv))),
            };
            self.shared.control.slot(index).dismissed.store(1, Ordering::Release);
            member.lose(&reason, &mut answers.losses);
        }
        Ok(())
    }

    pub(super) fn clear(&mut self) {
        self.groups.iter_mut().for_each(|group| group.arena.clear());
    }
}

impl Fleet for SharedMemoryFleet {
    fn born(&mut self, born: &[Born]) -> Result<Vec<Loss>, FleetError> {
        let mut losses = Vec::new();
        self.clear();
        let newborn = born.iter().map(|born| self.index(born.auv)).collect::<Result<Vec<usize>, _>>()?;
        for &index in &newborn {
            self.members[index].is_alive = true;
        }
        self.wait(newborn.clone(), &mut losses, |fleet, index| {
            let pid = fleet.shared.control.slot(index).pid.load(Ordering::Acquire);
            fleet.members[index].pid.map_or(pid != 0, |attached| attached == pid)
        })?;
        for group in &self.groups {
            // What those who were here before them left behind.
            while group.up.receive().map_err(failed)?.is_some() {}
        }
        let messages: Vec<(usize, ToAuvRef)> = newborn
            .iter()
            .zip(born)
            .filter(|(index, _)| self.members[**index].is_alive)
            .map(|(&index, born)| (index, ToAuvRef::Born(born)))
            .collect();
        for waiting in self.send(&messages)? {
            self.await_group(waiting, &mut losses)?;
        }
        losses.sort_by_key(|loss| loss.auv);
        Ok(losses)
    }

    fn exchange(
        &mut self,
        sensed: &[Batch<Sensed>],
        meanwhile: &mut dyn FnMut(),
    ) -> Result<Answers, FleetError> {
        let mut answers = Answers::default();
        self.clear();
        self.bury(&mut answers.losses);
        let mut due: Vec<Vec<(usize, usize)>> = vec![Vec::new(); self.groups.len()];
        let mut messages = Vec::with_capacity(sensed.len());
        for batch in sensed {
            let index = self.index(batch.auv)?;
            if self.members[index].is_alive {
                messages.push((index, ToAuvRef::Sensed(&batch.items)));
                due[self.members[index].group].push((index, batch.items.len()));
            }
        }
        let waiting = self.send(&messages)?;
        meanwhile();
        self.waited = Duration::ZERO;
        // In the order of sending: while one group's answers are read, the next groups are at work.
        for (group, (waiting, due)) in waiting.into_iter().zip(due).enumerate() {
            self.await_group(waiting, &mut answers.losses)?;
            self.gather(group, &due, &mut answers)?;
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
        self.shared.control.ended().store(1, Ordering::Release);
        for (index, group) in self.groups.iter().enumerate() {
            // The bell must change, or one who is about to sleep on it would not notice. Sleepers also look by themselves.
            let _woken = self.shared.control.ring_group(index, group.sequence.wrapping_add(1));
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
    use super::super::arena::write_answer;
    use super::*;
    use crate::lockstep::{FromAuv, Link};

    /// What a window brings whose only AUV sends these samples.
    fn window(samples: Vec<Vec<u8>>) -> Result<Answers, FleetError> {
        let run = RunDir::create(&serde_json::Value::Null).unwrap();
        let mut fleet = SharedMemoryFleet::create(&run, &[vec![AuvId(4)]]).unwrap();
        let joins = run.clone();
        let auv = std::thread::spawn(move || {
            let mut link = SharedMemoryLink::join(&joins, &[AuvId(4)]).unwrap();
            link.receive().unwrap();
            link.answer_with(&samples);
            link.receive().is_ok_and(|message| message == crate::lockstep::ToProcess::End)
        });
        fleet.wait(vec![0], &mut Vec::new(), |fleet, index| {
            fleet.shared.control.slot(index).pid.load(Ordering::Acquire) != 0
        })?;
        fleet.members[0].is_alive = true;
        let answers = fleet.exchange(&[Batch { auv: AuvId(4), items: Vec::new() }], &mut || {});
        drop(fleet);
        auv.join().unwrap();
        run.remove().unwrap();
        answers
    }

    #[test]
    fn strange_samples_lose_their_sender_and_missing_ones_are_noticed() {
        let fine = codec::encode(&FromAuv::Acted(Vec::new())).unwrap();
        let answer = |auv, sequence, message: &[u8]| {
            let mut sample = Vec::new();
            write_answer(&mut sample, AuvId(auv), sequence, message);
            vec![sample]
        };
        let acted = vec![Batch { auv: AuvId(4), items: Vec::new() }];
        assert_eq!(window(answer(4, 1, &fine)).unwrap(), Answers { acted, losses: Vec::new() });
        let losses = vec![Loss { auv: AuvId(4), reason: NOT_A_MESSAGE.into() }];
        for strange in [answer(4, 1, b"garbage"), answer(4, 1, b""), answer(9, 1, &fine), vec![vec![0; 3]]] {
            assert_eq!(window(strange).unwrap(), Answers { acted: Vec::new(), losses: losses.clone() });
        }
        assert!(
            window(Vec::new()).is_err_and(|error| error.to_string().contains("the answer of AUV 4 was lost"))
        );
        let losses = window(answer(4, 7, &fine)).unwrap().losses;
        assert!(losses[0].reason.contains("answered sample 7 instead of 1"));
    }

    #[test]
    fn an_auv_in_two_groups_is_refused() {
        let run = RunDir::create(&serde_json::Value::Null).unwrap();
        let made = SharedMemoryFleet::create(&run, &[vec![AuvId(1), AuvId(2)], vec![AuvId(1)]]);
        run.remove().unwrap();
        assert!(made.is_err_and(|error| error.to_string().contains("AUV 1 is in two")));
    }

    #[test]
    fn groups_are_small_and_keep_the_order() {
        let auvs: Vec<AuvId> = (0..70).rev().map(AuvId).collect();
        for size in [1, 3, 32] {
            let processes: Vec<Vec<AuvId>> = auvs.chunks(size).map(<[AuvId]>::to_vec).collect();
            let groups = wake_groups(&processes);
            assert!(groups.iter().all(|group| group.len() <= GROUP_MAX));
            assert_eq!(groups.concat(), auvs);
            assert!(processes.iter().all(|process| {
                groups
                    .iter()
                    .any(|group| group.contains(&process[0]) == group.contains(process.last().unwrap()))
            }));
        }
        assert_eq!(wake_groups(std::slice::from_ref(&auvs)), [auvs.clone()]);
    }
}
