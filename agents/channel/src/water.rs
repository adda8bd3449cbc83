//! What the scenario states of the water within bounds and the truth settles once for the whole run.

use nalgebra::Vector3;
use shoal_bus::message::AuvId;
use shoal_scenario::model::Scenario;

use crate::current::Current;
use crate::draw::{Draws, Purpose};

/// The id of draws that concern no vehicle.
const WATER: AuvId = AuvId(u32::MAX);

/// The true water of a run.
#[derive(Clone, Debug)]
pub struct Water {
    /// True speed of sound in m/s, where no profile says more.
    pub sound_speed_m_s: f64,
    /// True current.
    pub current: Current,
}

impl Water {
    /// The water of a run.
    pub fn new(scenario: &Scenario) -> Self {
        let mut draws = Draws::new(scenario.seed, Purpose::Water, WATER, scenario.noise);
        let environment = &scenario.environment;
        let sound_speed_m_s = environment.sound_speed_m_s + draws.error(environment.sound_speed_error_m_s);
        let uniform_m_s = Vector3::from_fn(|axis, _| {
            environment.current_m_s[axis] + draws.error(environment.current_error_m_s[axis])
        });
        let current = Current::new(uniform_m_s, environment.current_field.clone());
        Self { sound_speed_m_s, current }
    }
}
