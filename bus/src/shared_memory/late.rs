//! Windows that wait for nobody: who is late gets its next message when it has answered the last.

use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use super::fleet::{SharedMemoryFleet, failed};
use crate::lockstep::{Answers, Batch, FleetError};
use crate::message::Sensed;
use crate::wire::ToAuvRef;

/// How long the channel sleeps before it looks by itself: those who are late do not wake it.
const LOOK_AGAIN: Duration = Duration::from_millis(1);

impl SharedMemoryFleet {
    /// [`exchange_until`](crate::lockstep::Fleet::exchange_until).
    pub(super) fn exchange_freely(
        &mut self,
        sensed: &mut Vec<Batch<Sensed>>,
        deadline: Instant,
        meanwhile: &mut dyn FnMut(),
    ) -> Result<Answers, FleetError> {
        let mut answers = Answers::default();
        self.gather_late(&mut answers);
        let (mut ready, mut unsent) = (Vec::new(), Vec::new());
        for batch in std::mem::take(sensed) {
            let index = self.index(batch.auv)?;
            match self.late.binary_search_by_key(&index, |(late, _)| *late) {
                _ if !self.members[index].is_alive => {}
                Ok(_) => unsent.push(batch),
                Err(_) => ready.push((index, batch)),
            }
        }
        *sensed = unsent;
        let messages: Vec<(usize, ToAuvRef)> =
            ready.iter().map(|(index, batch)| (*index, ToAuvRef::Sensed(&batch.items))).collect();
        self.send(&messages)?;
        self.late.extend(ready.iter().map(|(index, batch)| (*index, batch.items.len())));
        self.late.sort_unstable();

        meanwhile();
        let since = Instant::now();
        loop {
            let bell = self.shared.arena.channel_bell();
            if self.shared.is_interrupted.load(Ordering::Acquire) {
                return Err(FleetError::Interrupted);
            }
            self.gather_late(&mut answers);
            let left = deadline.saturating_duration_since(Instant::now());
            if self.late.is_empty() || left.is_zero() {
                break;
            }
            self.shared.arena.await_channel_bell(bell, left.min(LOOK_AGAIN)).map_err(failed)?;
        }
        self.waited = since.elapsed();
        answers.sort();
        Ok(answers)
    }

    /// Takes the answers of those that are done, and takes in the ends of others.
    fn gather_late(&mut self, answers: &mut Answers) {
        let mut late = std::mem::take(&mut self.late);
        late.retain(|&(index, ticks)| {
            let has_answered = self.has_answered(index);
            if has_answered {
                self.read(index, ticks, answers);
            }
            !has_answered
        });
        self.bury(&mut answers.losses);
        late.retain(|&(index, _)| self.members[index].is_alive);
        self.late = late;
    }
}
