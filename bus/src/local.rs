//! The `local` transport: no processes, the minds in one program. The reference that every other transport must equal.

use crate::lockstep::{Answers, Batch, Fleet, FleetError, Loss, Mind};
use crate::message::{Born, Sensed};

/// All minds of a run in this program.
pub struct Local<M, F> {
    be_born: F,
    minds: Vec<Option<M>>,
}

impl<M: Mind, F: Fn(&Born) -> M> Local<M, F> {
    /// A fleet whose minds are made by `be_born`.
    pub fn new(be_born: F) -> Self {
        Self { be_born, minds: Vec::new() }
    }
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
        meanwhile();
        let mut answers = Answers::default();
        for batch in sensed {
            let Some(mind) = self.minds.get_mut(batch.auv.0 as usize).and_then(Option::as_mut) else {
                return Err(FleetError::Failed {
                    bus: "local",
                    cause: format!("AUV {} was never born", batch.auv),
                });
            };
            let items = batch.items.iter().map(|sensed| mind.step(sensed)).collect();
            answers.acted.push(Batch { auv: batch.auv, items });
        }
        Ok(answers)
    }

    fn end(&mut self) {}
}
