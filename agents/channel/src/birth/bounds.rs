//! What is certain about body and modem, as an AUV is told.

use shoal_bus::message::{BodyBounds, Bounds, BoundsBox, Measures, ModemBounds, Relative};
use shoal_scenario::model::{self, Environment, Group, Level, Scenario, SoundSpeed};

use crate::body::{Body, Vec3};
use crate::budget::nominal_reach_m;
use crate::current::{field_change, field_hull_m_s};
use crate::sensors::rounding;
use crate::sound::ARRIVAL_TOLERANCE_S;
use crate::water::Water;

/// Bounds of the body's motion in this water.
pub fn body(scenario: &Scenario, group: &Group) -> BodyBounds {
    let environment = &scenario.environment;
    // Each knot rounds a position as large as the area.
    let extent_m = environment.area_m.iter().flatten().fold(0.0_f64, |extent, side| extent.max(side.abs()));
    let knots_per_s = 1e9 / scenario.knot_ns as f64;
    let integrator_m_s = rounding(2.0 * extent_m * (1.0 + knots_per_s));
    let speed_m_s = group.kind.speed_max_m_s + rounding(group.kind.speed_max_m_s);
    let current_m_s = current(environment);
    let disturbance_m_s = group.kind.disturbance_m_s.map(|bound_m_s| {
        let bound_m_s = bound_m_s + integrator_m_s;
        let bound_m_s = bound_m_s + rounding(bound_m_s);
        Bounds::new(-bound_m_s, bound_m_s)
    });
    // Inside its knot the current is that of the knot: within a time it changes by what the place makes of it within that time
    // and one knot more.
    let [x, y, z] = std::array::from_fn(|axis| fastest_m_s(&current_m_s[axis], &disturbance_m_s[axis]));
    let (horizontal_m_s, vertical_m_s) = (speed_m_s + Vec3::new(x, y, 0.0).norm(), speed_m_s + z);
    let current_change_m_s2 = field_change(&environment.current_field, horizontal_m_s, vertical_m_s)
        .map(|change_m_s2| change_m_s2 * (1.0 + 1e-9));
    let current_step_m_s = current_change_m_s2.map(|change_m_s2| {
        if change_m_s2 > 0.0 { change_m_s2 / knots_per_s + rounding(x + y + z) } else { 0.0 }
    });
    BodyBounds {
        speed_m_s,
        acceleration_m_s2: Body::acceleration_bound_m_s2(&group.kind),
        current_m_s,
        current_change_m_s2,
        current_step_m_s,
        disturbance_m_s,
    }
}

/// How neighbours are followed; all of them keep the bounds of the fastest and nimblest.
pub fn relative(scenario: &Scenario, of: &model::Relative) -> Relative {
    let all = scenario.groups.iter().map(|group| body(scenario, group));
    let hull = |one: &BoundsBox, other: &BoundsBox| {
        std::array::from_fn(|axis| {
            let (one, other) = (one[axis], other[axis]);
            Bounds::new(one.lower.min(other.lower), one.upper.max(other.upper))
        })
    };
    let greater = |one: [f64; 3], other: [f64; 3]| std::array::from_fn(|axis| one[axis].max(other[axis]));
    let nobody = BodyBounds {
        speed_m_s: 0.0,
        acceleration_m_s2: 0.0,
        current_m_s: current(&scenario.environment),
        current_change_m_s2: [0.0; 3],
        current_step_m_s: [0.0; 3],
        disturbance_m_s: [Bounds::default(); 3],
    };
    let fellows = all.fold(nobody, |one, other| BodyBounds {
        speed_m_s: one.speed_m_s.max(other.speed_m_s),
        acceleration_m_s2: one.acceleration_m_s2.max(other.acceleration_m_s2),
        current_m_s: hull(&one.current_m_s, &other.current_m_s),
        current_change_m_s2: greater(one.current_change_m_s2, other.current_change_m_s2),
        current_step_m_s: greater(one.current_step_m_s, other.current_step_m_s),
        disturbance_m_s: hull(&one.disturbance_m_s, &other.disturbance_m_s),
    });
    let measures = match of.measures {
        model::Measures::RangeAndBearing => Measures::RangeAndBearing,
        model::Measures::Bearing => Measures::Bearing,
        model::Measures::Range => Measures::Range,
    };
    Relative { measures, exchanged: of.exchanged, remembered: of.remembered, fellows }
}

/// The current wherever a body is taken, inside the area or not, in m/s.
fn current(environment: &Environment) -> BoundsBox {
    let field_m_s = field_hull_m_s(&environment.current_field);
    std::array::from_fn(|axis| {
        let (value, error) = (environment.current_m_s[axis], environment.current_error_m_s[axis]);
        let Bounds { lower, upper } = field_m_s[axis];
        let error = error + rounding(value.abs() + error + lower.abs().max(upper.abs()));
        Bounds::new(value - error + lower, value + error + upper)
    })
}

/// The greatest speed of two velocities together, in m/s.
fn fastest_m_s(one: &Bounds, other: &Bounds) -> f64 {
    (one.upper + other.upper).max(-one.lower - other.lower)
}

/// How far others hear it, in metres: at level `sea` on average, and as far as noise lets them.
fn range_m(scenario: &Scenario, group: &Group) -> f64 {
    match (&scenario.environment.level, &group.modem.physical) {
        (Level::Sea(sea), Some(physical)) => nominal_reach_m(sea, physical),
        _ => group.modem.range_m,
    }
}

/// Whether sound has one speed everywhere, and the scenario keeps it from the AUVs.
fn has_one_unknown_speed(environment: &Environment) -> bool {
    let is_one = match &environment.level {
        Level::Ideal => true,
        Level::Sea(sea) => sea.sound_speed == SoundSpeed::Uniform,
    };
    is_one && environment.sound_speed_error_m_s > 0.0
}

/// Bounds of the modem and of sound in this water.
pub fn modem(scenario: &Scenario, group: &Group, water: &Water) -> ModemBounds {
    let hearing_range_m = match scenario.environment.level {
        Level::Ideal => {
            let farthest_m =
                scenario.groups.iter().fold(0.0_f64, |farthest, group| farthest.max(group.modem.range_m));
            farthest_m + rounding(farthest_m)
        }
        // A lucky packet comes from far away.
        Level::Sea(_) => f64::INFINITY,
    };
    ModemBounds {
        range_m: range_m(scenario, group),
        hearing_range_m,
        sound_speed_m_s: water.told_sound_speed_m_s,
        sound_speed_is_constant: has_one_unknown_speed(&scenario.environment),
        timestamp_s: group.modem.timestamp_error_s + ARRIVAL_TOLERANCE_S,
        frame_bytes: group.modem.frame_bytes,
    }
}

#[cfg(test)]
mod tests;
