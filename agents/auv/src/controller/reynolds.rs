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

#[cfg(test)]
mod tests {
    use shoal_bus::message::{AuvId, Bounds, Event, Sense};
    use shoal_bus::ping::Ping;
    use shoal_bus::time::LocalTime;

    use super::*;

    /// The velocity wished for at the middle of a wide sea, by one who goes east, after hearing these neighbours:
    /// (id, east in m, north in m, width of the box in m, velocity north in m/s).
    fn steered(neighbours: &[(u32, f64, f64, f64, f64)], at_m: Vector3<f64>) -> Vector3<f64> {
        let rules = Rules {
            speed_m_s: 1.5,
            separation: 1.0,
            cohesion: 1.0,
            alignment: 1.0,
            margin_m: 5.0,
            forget_ns: 1_000,
            trusts: vec![Fleetmates { first: AuvId(0), count: 10 }],
        };
        let event = |&(sender, east_m, north_m, width_m, north_m_s): &(u32, f64, f64, f64, f64)| {
            let side = |middle: f64, width: f64| Bounds::new(middle - 0.5 * width, middle + 0.5 * width);
            let frame = Ping {
                sender: AuvId(sender),
                sequence: 0,
                emission_s: Bounds::new(10.0, 10.0),
                position_m: [side(east_m, width_m), side(north_m, width_m), side(-500.0, width_m)],
                velocity_m_s: [side(0.0, 0.0), side(north_m_s, 0.0), side(0.0, 0.0)],
            };
            Event { stamp: LocalTime::ZERO, sense: Sense::Heard { frame: frame.encode().unwrap() } }
        };
        let events = neighbours.iter().map(event).collect();
        let sensed = Sensed { tick: 0, stamp: LocalTime::ZERO, events };
        let belief = Belief {
            time_s: 10.0,
            position_m: at_m,
            box_width_m: 10.0,
            velocity_m_s: Vector3::new(1.5, 0.0, 0.0),
            lead_s: 0.1,
        };
        let area_m = [Bounds::new(0.0, 1_000.0), Bounds::new(0.0, 1_000.0), Bounds::new(-1_000.0, 0.0)];
        let velocity_m_s = Reynolds::new(rules, area_m).steer(&sensed, &belief).velocity_m_s;
        assert!((velocity_m_s.norm() - 1.5).abs() < 1e-9);
        velocity_m_s
    }

    const MIDDLE: Vector3<f64> = Vector3::new(500.0, 500.0, -500.0);

    #[test]
    fn alone_it_goes_on() {
        assert!((steered(&[], MIDDLE) - Vector3::new(1.5, 0.0, 0.0)).norm() < 1e-9);
    }

    #[test]
    fn it_approaches_and_aligns_with_those_it_trusts() {
        assert!(steered(&[(1, 500.0, 700.0, 1.0, 0.0)], MIDDLE).y > 0.5);
        assert!(steered(&[(1, 700.0, 500.0, 1.0, -1.0)], MIDDLE).y < -0.3);
        // A stranger far away is nobody's business.
        assert!(steered(&[(99, 500.0, 700.0, 1.0, 5.0)], MIDDLE).y.abs() < 1e-9);
    }

    #[test]
    fn it_keeps_clear_of_everyone_the_more_the_less_is_known() {
        // 14 m north: with boxes of 10 m and 1 m the distance is (10 + 1) / 2 + 5 = 10.5 m, kept; with 10 m and 20 m it is 20 m.
        for stranger in [1, 99] {
            assert!(steered(&[(stranger, 500.0, 514.0, 20.0, 0.0)], MIDDLE).y < -0.5);
        }
    }

    #[test]
    fn it_turns_back_at_the_border() {
        assert!(steered(&[], Vector3::new(999.0, 500.0, -500.0)).x < 0.0);
        assert!(steered(&[], Vector3::new(500.0, 500.0, -0.5)).z < 0.0);
    }
}
