//! The `local` transport: no processes, the minds in one program. The reference that every other transport must equal.

use std::time::{Duration, Instant};

use crate::lockstep::{Answers, Batch, Fleet, FleetError, Loss, Mind};
use crate::message::{Acted, Born, Sensed};

/// So many minds at least are worth waking another core for.
#[cfg(feature = "parallel")]
const WORTH_A_CORE: usize = 8;

/// All minds of a run in this program.
pub struct Local<M, F> {
    be_born: F,
    minds: Vec<Option<M>>,
    step: fn(&mut [Turn<'_, M>], &mut dyn FnMut()),
    waited: Duration,
}

/// One mind's share of a window.
struct Turn<'a, M> {
    mind: &'a mut M,
    batch: &'a Batch<Sensed>,
    acted: Vec<Acted>,
}

impl<M: Mind> Turn<'_, M> {
    fn take(&mut self) {
        self.acted = self.batch.items.iter().map(|sensed| self.mind.step(sensed)).collect();
    }
}

impl<M: Mind, F: Fn(&Born) -> M> Local<M, F> {
    /// A fleet whose minds are made by `be_born` and think one after the other, in this thread.
    pub fn new(be_born: F) -> Self {
        Self { be_born, minds: Vec::new(), step: one_by_one, waited: Duration::ZERO }
    }

    /// The same on all cores. A mind knows nothing of the others and answers have their order, so nothing else changes.
    #[cfg(feature = "parallel")]
    pub fn on_all_cores(be_born: F) -> Self
    where
        M: Send,
    {
        Self { be_born, minds: Vec::new(), step: side_by_side, waited: Duration::ZERO }
    }
}

fn one_by_one<M: Mind>(turns: &mut [Turn<'_, M>], meanwhile: &mut dyn FnMut()) {
    meanwhile();
    turns.iter_mut().for_each(Turn::take);
}

#[cfg(feature = "parallel")]
fn side_by_side<M: Mind + Send>(turns: &mut [Turn<'_, M>], meanwhile: &mut dyn FnMut()) {
    use rayon::prelude::*;

    if turns.len() < 2 * WORTH_A_CORE {
        return one_by_one(turns, meanwhile);
    }
    rayon::in_place_scope(|scope| {
        scope.spawn(|_| turns.par_iter_mut().with_min_len(WORTH_A_CORE).for_each(Turn::take));
        meanwhile();
    });
}

impl<M: Mind, F: Fn(&Born) -> M> Fleet for Local<M, F> {
    fn born(&mut self, born: &[Born]) -> Result<Vec<Loss>, FleetError> {
        for born in born {
            let index = born.auv.0 as usize;
            if self.minds.len() <= index {
                self.minds.resize_with(index + 1, || None);
            }
            self.minds[index] = Some((self.be_born)(born));
        }
        Ok(Vec::new())
    }

    fn exchange(
        &mut self,
        sensed: &[Batch<Sensed>],
        meanwhile: &mut dyn FnMut(),
    ) -> Result<Answers, FleetError> {
        let mut turns = Vec::with_capacity(sensed.len());
        // Both are in the order of the AUVs.
        let mut minds = self.minds.iter_mut().enumerate();
        for batch in sensed {
            let mind = minds.find(|(index, _)| *index == batch.auv.0 as usize);
            let Some((_, Some(mind))) = mind else {
                return Err(FleetError::Failed {
                    bus: "local",
                    cause: format!("AUV {} was never born, or its batch is out of order", batch.auv),
                });
            };
            turns.push(Turn { mind, batch, acted: Vec::new() });
        }
        let mut since = Instant::now();
        (self.step)(&mut turns, &mut || {
            meanwhile();
            since = Instant::now();
        });
        self.waited = since.elapsed();
        let acted = turns.into_iter().map(|turn| Batch { auv: turn.batch.auv, items: turn.acted }).collect();
        Ok(Answers { acted, losses: Vec::new() })
    }

    fn waited(&self) -> Duration {
        self.waited
    }

    /// Minds in this program are waited for: they are late when the wall clock says so.
    fn exchange_until(
        &mut self,
        sensed: &mut Vec<Batch<Sensed>>,
        _: Instant,
        meanwhile: &mut dyn FnMut(),
    ) -> Result<Answers, FleetError> {
        let answers = self.exchange(sensed, meanwhile)?;
        sensed.clear();
        Ok(answers)
    }

    fn end(&mut self) {}
}
