//! Minds that break a promise on purpose, so that a test can see the channel's check catch them.

use shoal_bus::message::{Born, Sabotage};
use shoal_interval::{Interval, IntervalBox};

use crate::estimator::Prediction;

/// The tick at which [`Sabotage::EmptySet`] strikes.
pub const EMPTYING_TICK: u64 = 10;

/// What the estimator is told: what the AUV was, or the same with half the clock's drift.
pub fn believed(born: &Born) -> Born {
    let mut believed = born.clone();
    if born.orders.sabotage == Some(Sabotage::HalvedClock) {
        believed.clock.drift *= 0.5;
    }
    believed
}

/// Moves a prediction ten metres and the width of its box east of where it should be.
pub fn lie(prediction: &mut Prediction) {
    let away_m = 10.0 + prediction.position_m.width();
    let [x, y, z] = prediction.position_m.sides();
    prediction.position_m = IntervalBox::from([x + Interval::point(away_m).unwrap_or(Interval::ZERO), y, z]);
    if let Some(gaussian) = &mut prediction.gaussian {
        gaussian.mean[0] += away_m;
    }
}
