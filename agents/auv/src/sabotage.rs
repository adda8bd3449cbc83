//! Minds that break a promise on purpose, so that a test can see the channel's check catch them.

use shoal_bus::message::{Born, Sabotage};
use shoal_interval::{Interval, IntervalBox};

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

/// A box ten metres and its own width east of where it should be.
pub fn elsewhere(position_m: &IntervalBox<3>) -> IntervalBox<3> {
    let away_m = Interval::point(10.0 + position_m.width()).unwrap_or(Interval::ZERO);
    let [x, y, z] = position_m.sides();
    IntervalBox::from([x + away_m, y, z])
}
