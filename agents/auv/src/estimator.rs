//! How an AUV finds out where it is, and when.

use shoal_bus::message::{Emptied, Gaussian, Sensed};
use shoal_bus::time::LocalTime;
use shoal_interval::{Interval, IntervalBox};

use crate::state::State;

/// Encloses the own state from what is sensed.
pub trait Estimator: Send {
    /// Takes in one tick. What it finds contradictory it drops, and says so.
    fn update(&mut self, sensed: &Sensed) -> Estimate;

    /// The state at `at`, which is not before the last tick, as far as the bounds of motion tell.
    fn predict(&self, at: LocalTime) -> Prediction;

    /// The part of the state that it bets on, for steering: never what it encloses. None when that is all of it.
    fn likeliest(&self) -> Option<State> {
        None
    }
}

/// What is known at a tick.
#[derive(Clone, Copy, Debug)]
pub struct Estimate {
    /// At the tick.
    pub state: State,
    /// Over all of the time since the tick before.
    pub slice: State,
    /// The measurement that would have left nothing, if there was one.
    pub emptied: Option<Emptied>,
    /// How many measurements made the state smaller.
    pub contractions: u16,
    /// How many pings were taken for outliers, or dropped.
    pub rejected: u16,
    /// In how many separate parts the state may lie.
    pub components: u16,
    /// What a Kalman filter believes.
    pub gaussian: Option<Gaussian>,
}

/// What is known of a moment to come.
#[derive(Clone, Copy, Debug)]
pub struct Prediction {
    /// True time in seconds.
    pub time_s: Interval,
    /// Position in metres.
    pub position_m: IntervalBox<3>,
    /// Velocity over ground in m/s.
    pub velocity_m_s: IntervalBox<3>,
    /// The current in m/s.
    pub current_m_s: IntervalBox<3>,
    /// What a Kalman filter believes: position in metres and true time in seconds. The intervals above promise nothing then.
    pub gaussian: Option<Gaussian>,
}
