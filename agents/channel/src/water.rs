//! What the scenario states of the water within bounds and the truth settles once for the whole run.

use nalgebra::Vector3;
use shoal_bus::message::{AuvId, Bounds};
use shoal_scenario::model::{
    Environment, Level, NamedProfile, Scenario, Sea, SoundSpeed, SoundSpeedFormula as FormulaName,
};

use crate::acoustics::profile::{Node, Profile, ProfileError};
use crate::acoustics::ray::WaterColumn;
use crate::acoustics::sound_speed::SoundSpeedFormula;
use crate::current::Current;
use crate::draw::{Draws, Purpose};
use crate::sensors::rounding;

/// The id of draws that concern no vehicle.
const WATER: AuvId = AuvId(u32::MAX);

/// The true water of a run, and what AUVs are told of its sound.
#[derive(Clone, Debug)]
pub struct Water {
    /// True speed of sound in m/s at level `ideal`, or where no profile says more.
    pub sound_speed_m_s: f64,
    /// True speed of sound over depth, between surface and bottom; at level `sea` only.
    pub column: Option<WaterColumn>,
    /// True current.
    pub current: Current,
    /// What AUVs are told: distance over travel time lies in it, in m/s. At level `sea` that is so for every path that is no
    /// slower than the straight line, such as a direct one that no boundary blocks; an echo may fall below.
    pub told_sound_speed_m_s: Bounds,
}

impl Water {
    /// The water of a run.
    ///
    /// # Errors
    /// [`ProfileError`] for depths and speeds that are no profile: none that was read from a scenario file.
    ///
    /// ```
    /// use shoal_channel::water::Water;
    ///
    /// let (source_name, text) = shoal_scenario::load("two-circles")?;
    /// let water = Water::new(&shoal_scenario::parse(&source_name, &text)?)?;
    /// assert!(water.told_sound_speed_m_s.contains(water.sound_speed_m_s));
    /// // That scenario is one of level `ideal`.
    /// assert!(water.column.is_none());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(scenario: &Scenario) -> Result<Self, ProfileError> {
        let mut draws = Draws::new(scenario.seed, Purpose::Water, WATER, scenario.noise);
        let environment = &scenario.environment;
        let error_m_s = draws.error(environment.sound_speed_error_m_s);
        let uniform_m_s = Vector3::from_fn(|axis, _| {
            environment.current_m_s[axis] + draws.error(environment.current_error_m_s[axis])
        });
        let (column, (slowest_m_s, fastest_m_s)) = match &environment.level {
            Level::Ideal => (None, (environment.sound_speed_m_s, environment.sound_speed_m_s)),
            Level::Sea(sea) => {
                let stated = stated_profile(environment, sea)?;
                let truth = stated.shifted_m_s(error_m_s)?;
                let bounds_m_s = stated.speed_bounds_m_s(0.0, sea.bottom_depth_m);
                (Some(WaterColumn::new(truth, sea.bottom_depth_m)), bounds_m_s)
            }
        };
        let told_error_m_s = environment.sound_speed_error_m_s + rounding(fastest_m_s);
        Ok(Self {
            sound_speed_m_s: environment.sound_speed_m_s + error_m_s,
            column,
            current: Current::new(uniform_m_s, environment.current_field.clone()),
            told_sound_speed_m_s: Bounds::new(slowest_m_s - told_error_m_s, fastest_m_s + told_error_m_s),
        })
    }
}

/// The speed of sound over depth as the scenario has it, constant above the surface and below the bottom.
///
/// Temperatures and salinities make a speed at each depth where they are given; in between the speed is linear.
///
/// # Errors
/// [`ProfileError`] for depths and speeds that are no profile.
pub fn stated_profile(environment: &Environment, sea: &Sea) -> Result<Profile, ProfileError> {
    let bottom_m = sea.bottom_depth_m;
    let nodes: Vec<Node> = match &sea.sound_speed {
        SoundSpeed::Uniform => return Profile::uniform(environment.sound_speed_m_s),
        SoundSpeed::Named(name) => {
            return Ok(match name {
                NamedProfile::MixedLayer => Profile::mixed_layer(bottom_m),
                NamedProfile::SummerThermocline => Profile::summer_thermocline(bottom_m),
                NamedProfile::Arctic => Profile::arctic(bottom_m),
                NamedProfile::Munk => Profile::munk(bottom_m),
            });
        }
        SoundSpeed::Speeds { depths_m, speeds_m_s } => depths_m
            .iter()
            .zip(speeds_m_s)
            .map(|(&depth_m, &speed_m_s)| Node { depth_m, speed_m_s })
            .collect(),
        SoundSpeed::Water { depths_m, temperatures_c, salinities_psu, formula } => {
            let formula = match formula {
                FormulaName::Mackenzie => SoundSpeedFormula::Mackenzie,
                FormulaName::Medwin => SoundSpeedFormula::Medwin,
                FormulaName::ChenMillero => SoundSpeedFormula::ChenMillero,
                FormulaName::DelGrosso => SoundSpeedFormula::DelGrosso,
            };
            let water = temperatures_c.iter().zip(salinities_psu);
            let node = |(&depth_m, (&temperature_c, &salinity_psu))| Node {
                depth_m,
                speed_m_s: formula.speed_m_s(temperature_c, salinity_psu, depth_m),
            };
            depths_m.iter().zip(water).map(node).collect()
        }
    };
    between_surface_and_bottom(&Profile::new(&nodes)?, bottom_m)
}

/// The same profile without what lies above the surface or below the bottom, so that no body that strays there meets a
/// speed that is not in the column.
fn between_surface_and_bottom(profile: &Profile, bottom_m: f64) -> Result<Profile, ProfileError> {
    let end = |depth_m| Node { depth_m, speed_m_s: profile.speed_m_s(depth_m) };
    if bottom_m < 0.002 {
        return Profile::new(&[end(0.0)]);
    }
    // Nodes may not be as close as a millimetre to each other.
    let inside = |node: &&Node| 0.002 < node.depth_m && node.depth_m < bottom_m - 0.002;
    let inner = profile.nodes().iter().filter(inside).copied();
    let nodes: Vec<Node> = std::iter::once(end(0.0)).chain(inner).chain([end(bottom_m)]).collect();
    Profile::new(&nodes)
}

#[cfg(test)]
pub(crate) mod tests;
