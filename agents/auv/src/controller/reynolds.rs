//! Separation, cohesion, alignment (Reynolds 1987) on the neighbours heard, as in seed 001, section 6.3: positions are the
//! middles of boxes predicted from the last pings, and boxes must not touch.

use nalgebra::Vector3;
use shoal_bus::message::{BoundsBox, Fleetmates, Sensed};

use super::{Belief, Controller, Steering};
use crate::neighbours::{Neighbours, trusted};

/// Weights and distances of the three rules.
pub struct Rules {
    /// Cruise speed in m/s.
    pub speed_m_s: f64,
    /// Weight of separation.
    pub separation: f64,
    /// Weight of cohesion.
    pub cohesion: f64,
    /// Weight of alignment.
    pub alignment: f64,
    /// Added to the separation distance, in metres.
    pub margin_m: f64,
    /// A neighbour silent for so many local nanoseconds is forgotten.
    pub forget_ns: i64,
    /// Whom to follow.
    pub trusts: Vec<Fleetmates>,
}

/// Flocks with trusted neighbours, keeps clear of all, stays inside the area.
pub struct Reynolds {
    rules: Rules,
    area_m: BoundsBox,
    neighbours: Neighbours,
}

impl Reynolds {
    /// Flocking by these rules inside `area_m`.
    pub fn new(rules: Rules, area_m: BoundsBox) -> Self {
        Self { rules, area_m, neighbours: Neighbours::default() }
    }

    /// Points back inside where the box, with room to turn, sticks out of the area; unit length at most per axis.
    fn inwards(&self, belief: &Belief) -> Vector3<f64> {
        // Room for the box, and for ten seconds of cruise.
        let room_m = 0.5 * belief.box_width_m + 10.0 * self.rules.speed_m_s;
        Vector3::from_fn(|axis, _| {
            let side = &self.area_m[axis];
            let room_m = room_m.min(0.25 * side.width());
            let below = (side.lower + room_m - belief.position_m[axis]) / room_m;
            let above = (belief.position_m[axis] - (side.upper - room_m)) / room_m;
            below.clamp(0.0, 1.0) - above.clamp(0.0, 1.0)
        })
    }
}

impl Controller for Reynolds {
    fn steer(&mut self, sensed: &Sensed, belief: &Belief) -> Steering {
        self.neighbours.listen(sensed, self.rules.forget_ns);
        let rules = &self.rules;
        let mut apart = Vector3::zeros();
        let mut centre_m = Vector3::zeros();
        let mut heading = Vector3::zeros();
        let mut followed = 0u32;
        let mut pressed = false;
        for neighbour in self.neighbours.at(belief.time_s) {
            let from_it_m = belief.position_m - neighbour.position_m;
            let distance_m = from_it_m.norm();
            // Equation (6.5): half of both widths; closer than that, boxes may overlap.
            let separation_m = 0.5 * (belief.box_width_m + neighbour.box_width_m) + rules.margin_m;
            if distance_m < 2.0 * separation_m {
                // Seed 001, section 6.3.2: the nearer, the stronger, as 1/d.
                apart +=
                    from_it_m.try_normalize(1e-9).unwrap_or_default() * (separation_m / distance_m.max(0.1));
                pressed |= distance_m < separation_m;
            }
            if trusted(&rules.trusts, neighbour.auv) {
                centre_m += neighbour.position_m;
                heading += neighbour.velocity_m_s;
                followed += 1;
            }
        }
        let unit = |of: Vector3<f64>| of.try_normalize(1e-9).unwrap_or_default();
        let mut wish = unit(belief.velocity_m_s) + unit(apart) * rules.separation;
        // Too close, keeping clear comes before company.
        if followed > 0 && !pressed {
            wish += unit(heading) * rules.alignment;
            wish += unit(centre_m / f64::from(followed) - belief.position_m) * rules.cohesion;
        }
        let inwards = self.inwards(belief);
        wish += inwards * (1.0 + rules.separation + rules.cohesion + rules.alignment);
        let neighbours = self.neighbours.count().min(usize::from(u16::MAX)) as u16;
        Steering { velocity_m_s: unit(wish) * rules.speed_m_s, neighbours }
    }
}
