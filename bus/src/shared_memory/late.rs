//! Windows that wait for nobody: a group that is late takes its next sample when it is done with the last.

use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use super::fleet::{LOOK_AGAIN, SharedMemoryFleet, failed};
use crate::lockstep::{Answers, Batch, FleetError};
use crate::message::Sensed;
use crate::wire::ToAuvRef;

/// A group that has taken a sample and is not done with it.
pub(super) struct LateGroup {
    group: usize,
    /// Members that have not dealt with the sample yet.
    waiting: Vec<usize>,
    /// (member, ticks) that it was about, sorted.
    due: Vec<(usize, usize)>,
}

impl SharedMemoryFleet {
    /// [`exchange_until`](crate::lockstep::Fleet::exchange_until). Who shares a wake-up group is late together: make a group for
    /// each process.
    pub(super) fn exchange_freely(
        &mut self,
        sensed: &mut Vec<Batch<Sensed>>,
        deadline: Instant,
        meanwhile: &mut dyn FnMut(),
    ) -> Result<Answers, FleetError> {
        let mut answers = Answers::default();
        self.clear();
        self.bury(&mut answers.losses);
        self.gather_late(&mut answers)?;

        let ready = self.take_ready(sensed)?;
        let mut due: Vec<Vec<(usize, usize)>> = vec![Vec::new(); self.groups.len()];
        for (index, batch) in &ready {
            due[self.members[*index].group].push((*index, batch.items.len()));
        }
        let messages: Vec<(usize, ToAuvRef)> =
            ready.iter().map(|(index, batch)| (*index, ToAuvRef::Sensed(&batch.items))).collect();
        let waiting = self.send(&messages)?;
        for (group, (waiting, due)) in
            waiting.into_iter().zip(due).enumerate().filter(|(_, (_, due))| !due.is_empty())
        {
            self.late.push(LateGroup { group, waiting, due });
        }

        meanwhile();
        let since = Instant::now();
        self.waited = Duration::ZERO;
        loop {
            let bell = self.shared.control.channel_bell();
            if self.shared.is_interrupted.load(Ordering::Acquire) {
                return Err(FleetError::Interrupted);
            }
            self.gather_late(&mut answers)?;
            let left = deadline.saturating_duration_since(Instant::now());
            if self.late.is_empty() || left.is_zero() {
                break;
            }
            self.shared.control.await_channel_bell(bell, left.min(LOOK_AGAIN)).map_err(failed)?;
        }
        self.waited = since.elapsed();
        answers.sort();
        Ok(answers)
    }

    /// Takes the batches of live members whose groups are done with the sample before, and drops those of the dead.
    fn take_ready(&self, sensed: &mut Vec<Batch<Sensed>>) -> Result<Vec<(usize, Batch<Sensed>)>, FleetError> {
        let mut ready = Vec::with_capacity(sensed.len());
        for batch in std::mem::take(sensed) {
            let index = self.index(batch.auv)?;
            let member = &self.members[index];
            if !member.is_alive {
                continue;
            }
            if self.late.iter().any(|late| late.group == member.group) {
                sensed.push(batch);
            } else {
                ready.push((index, batch));
            }
        }
        Ok(ready)
    }

    /// Takes the answers of the groups that are done.
    fn gather_late(&mut self, answers: &mut Answers) -> Result<(), FleetError> {
        for mut late in std::mem::take(&mut self.late) {
            self.settle(&mut late.waiting, &mut answers.losses, &Self::has_acknowledged);
            if late.waiting.is_empty() {
                self.gather(late.group, &late.due, answers)?;
            } else {
                self.late.push(late);
            }
        }
        Ok(())
    }
}
