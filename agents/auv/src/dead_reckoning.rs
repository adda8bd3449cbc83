//! Dead reckoning: log, attitude and clock alone, from the prior on.
//!
//! A tube like any other, and as guaranteed, but all that says where or when the AUV is goes unheard: fixes, pings, and depth too,
//! which would measure one coordinate of the place. Logs stay, over ground as through water. So its box grows for ever, and
//! its middle is the estimate.

use shoal_bus::message::{Born, Sense, Sensed};
use shoal_bus::time::LocalTime;

use crate::estimator::{Estimate, Estimator, Prediction};
use crate::tube_estimator::TubeEstimator;

/// Encloses the state by what the body did.
pub struct DeadReckoning {
    tube: TubeEstimator,
    /// What it heeds of a tick.
    heeded: Sensed,
}

impl DeadReckoning {
    /// The reckoning that begins with what the AUV was told at birth.
    pub fn new(born: &Born) -> Self {
        let heeded = Sensed { tick: 0, stamp: born.birth, events: Vec::new() };
        Self { tube: TubeEstimator::new(born), heeded }
    }
}

impl Estimator for DeadReckoning {
    fn update(&mut self, sensed: &Sensed) -> Estimate {
        (self.heeded.tick, self.heeded.stamp) = (sensed.tick, sensed.stamp);
        let logs = sensed
            .events
            .iter()
            .filter(|event| matches!(event.sense, Sense::Inertial { .. } | Sense::Dvl { .. }));
        self.heeded.events.clear();
        self.heeded.events.extend(logs.cloned());
        self.tube.update(&self.heeded)
    }

    fn predict(&self, at: LocalTime) -> Prediction {
        self.tube.predict(at)
    }
}

#[cfg(test)]
mod tests;
