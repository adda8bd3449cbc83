//! The true current: the same everywhere, plus what the scenario's field adds from place to place.

use shoal_bus::message::{Bounds, BoundsBox};
use shoal_scenario::model::CurrentField;

use crate::body::Vec3;
use crate::sensors::rounding;

/// The current of a run. It depends on the place and never on time.
///
/// ```
/// use nalgebra::Vector3;
/// use shoal_channel::current::Current;
/// use shoal_scenario::model::CurrentField;
///
/// // Half a metre per second eastward at the surface, none from 20 m on; 0.1 m/s northward everywhere.
/// let field = CurrentField::Shear { surface_m_s: [0.5, 0.0, 0.0], deep_m_s: [0.0; 3], depth_m: 20.0 };
/// let current = Current::new(Vector3::new(0.0, 0.1, 0.0), field);
/// assert_eq!(current.at(&Vector3::new(70.0, 3.0, -10.0)), Vector3::new(0.25, 0.1, 0.0));
/// assert_eq!(current.at(&Vector3::new(70.0, 3.0, -99.0)), Vector3::new(0.0, 0.1, 0.0));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Current {
    uniform_m_s: Vec3,
    field: CurrentField,
}

impl Current {
    /// A uniform current in m/s with a field added to it.
    pub fn new(uniform_m_s: Vec3, field: CurrentField) -> Self {
        Self { uniform_m_s, field }
    }

    /// The current at a place, in m/s.
    pub fn at(&self, position_m: &Vec3) -> Vec3 {
        match self.field {
            CurrentField::Uniform => self.uniform_m_s,
            CurrentField::Shear { surface_m_s, deep_m_s, depth_m } => {
                let (surface_m_s, deep_m_s) = (Vec3::from(surface_m_s), Vec3::from(deep_m_s));
                let part = (-position_m.z / depth_m).clamp(0.0, 1.0);
                self.uniform_m_s + surface_m_s + (deep_m_s - surface_m_s) * part
            }
            CurrentField::Vortex { centre_m: [x_m, y_m], core_radius_m, speed_m_s } => {
                // In radii of the core, in which the speed rises as r up to 1 and falls as 1/r from there on.
                let (x, y) = ((position_m.x - x_m) / core_radius_m, (position_m.y - y_m) / core_radius_m);
                let scale_m_s = speed_m_s / (x * x + y * y).max(1.0);
                self.uniform_m_s + Vec3::new(-y * scale_m_s, x * scale_m_s, 0.0)
            }
        }
    }

    /// Bound of its speed anywhere, in m/s.
    pub fn speed_bound_m_s(&self) -> f64 {
        let speed_m_s = match self.field {
            CurrentField::Uniform => return self.uniform_m_s.norm(),
            // In between the current lies on a straight line between the two, and the ends of a line are farthest out.
            CurrentField::Shear { surface_m_s, deep_m_s, .. } => [surface_m_s, deep_m_s]
                .map(|end_m_s| (self.uniform_m_s + Vec3::from(end_m_s)).norm())
                .into_iter()
                .fold(0.0, f64::max),
            CurrentField::Vortex { speed_m_s, .. } => self.uniform_m_s.norm() + speed_m_s.abs(),
        };
        speed_m_s + rounding(speed_m_s)
    }
}

/// A uniform current in m/s.
impl From<Vec3> for Current {
    fn from(uniform_m_s: Vec3) -> Self {
        Self::new(uniform_m_s, CurrentField::Uniform)
    }
}

/// What a field adds, per axis, anywhere: the least box around it, in m/s. [`Current::at`] rounds: it keeps this within
/// [`rounding`].
pub fn field_hull_m_s(field: &CurrentField) -> BoundsBox {
    match *field {
        CurrentField::Uniform => [Bounds::default(); 3],
        CurrentField::Shear { surface_m_s, deep_m_s, .. } => std::array::from_fn(|axis| {
            Bounds::new(surface_m_s[axis].min(deep_m_s[axis]), surface_m_s[axis].max(deep_m_s[axis]))
        }),
        CurrentField::Vortex { speed_m_s, .. } => {
            let side = Bounds::new(-speed_m_s.abs(), speed_m_s.abs());
            [side, side, Bounds::default()]
        }
    }
}

/// How much each component of a field changes, at most, on a way that leads `horizontal` metres to the side and `vertical`
/// metres up or down, in m/s; of speeds in m/s, how fast it changes, in m/s².
pub fn field_change(field: &CurrentField, horizontal: f64, vertical: f64) -> [f64; 3] {
    match *field {
        CurrentField::Uniform => [0.0; 3],
        CurrentField::Shear { surface_m_s, deep_m_s, depth_m } => {
            std::array::from_fn(|axis| (deep_m_s[axis] - surface_m_s[axis]).abs() / depth_m * vertical)
        }
        // Outside of the core the flow has neither vorticity nor divergence, so the gradients of both components are
        // speed core / r² long: most at the rim. Inside they are that long everywhere.
        CurrentField::Vortex { core_radius_m, speed_m_s, .. } => {
            let change = speed_m_s.abs() / core_radius_m * horizontal;
            [change, change, 0.0]
        }
    }
}

#[cfg(test)]
mod tests;
