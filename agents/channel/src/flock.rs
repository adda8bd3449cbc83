//! How the swarm moves and holds together: distances between bodies, alignment, who could hear whom.

mod algebraic;
mod links;

use std::collections::BTreeSet;

use shoal_bus::summary::Flock as Figures;
use shoal_bus::time::{NS_PER_S, SimTime};

pub use algebraic::algebraic_connectivity;
pub use links::{Graph, Links};

use crate::body::Vec3;

/// Separation is looked at this often, in nanoseconds of true time.
pub const SAMPLE_NS: i64 = 100_000_000;

/// Separation over a run.
#[derive(Default)]
pub struct Flock {
    min_separation_m: Option<f64>,
    /// Since it was last asked for.
    lately_m: Option<f64>,
    touching: BTreeSet<(u32, u32)>,
    collisions: u64,
}

/// The AUVs that live, at one moment.
#[derive(Clone, Debug, Default)]
pub struct Flying {
    /// Where each is, in metres.
    positions_m: Vec<Vec3>,
    /// How each moves over ground, in m/s.
    velocities_m_s: Vec<Vec3>,
    /// How far the modem of each is heard, in metres.
    range_m: Vec<f64>,
}

impl FromIterator<(Vec3, Vec3, f64)> for Flying {
    /// From position in metres, velocity over ground in m/s, and range of the modem in metres, of each.
    fn from_iter<I: IntoIterator<Item = (Vec3, Vec3, f64)>>(of: I) -> Self {
        let mut flying = Self::default();
        for (position_m, velocity_m_s, range_m) in of {
            flying.positions_m.push(position_m);
            flying.velocities_m_s.push(velocity_m_s);
            flying.range_m.push(range_m);
        }
        flying
    }
}

impl Flock {
    /// The sampling times after or at `from` and before `to`.
    pub fn samples(from: SimTime, to: SimTime) -> impl Iterator<Item = SimTime> {
        let first = (from.ns() + SAMPLE_NS - 1).div_euclid(SAMPLE_NS);
        (first..).map(|index| SimTime::from_ns(index * SAMPLE_NS)).take_while(move |&at| at < to)
    }

    /// Whether a sampling time is a whole second.
    pub fn is_second(at: SimTime) -> bool {
        at.ns() % NS_PER_S == 0
    }

    /// Takes in all positions of one moment; `length_m` are the bodies' lengths.
    pub fn sample(&mut self, positions_m: &[Vec3], length_m: &[f64]) {
        let longest_m = length_m.iter().fold(0.0, |a: f64, &b| a.max(b));
        let mut by_x: Vec<u32> = (0..positions_m.len() as u32).collect();
        by_x.sort_by(|&a, &b| {
            positions_m[a as usize].x.total_cmp(&positions_m[b as usize].x).then(a.cmp(&b))
        });
        let mut touching = BTreeSet::new();
        let mut closest_m = self.lately_m.unwrap_or(f64::INFINITY);
        for (rank, &a) in by_x.iter().enumerate() {
            for &b in &by_x[rank + 1..] {
                let apart = positions_m[b as usize] - positions_m[a as usize];
                if apart.x > closest_m.max(longest_m) {
                    break;
                }
                let distance_m = apart.norm();
                closest_m = closest_m.min(distance_m);
                if distance_m < 0.5 * (length_m[a as usize] + length_m[b as usize]) {
                    touching.insert((a.min(b), a.max(b)));
                }
            }
        }
        if closest_m.is_finite() {
            self.lately_m = Some(closest_m);
            self.min_separation_m = Some(self.min_separation_m.map_or(closest_m, |m| m.min(closest_m)));
        }
        self.collisions += touching.difference(&self.touching).count() as u64;
        self.touching = touching;
    }

    /// The figures of a moment, with the separation of the whole run.
    pub fn figures(&self, flying: &Flying) -> Figures {
        let links = Links::between(&flying.positions_m, &flying.range_m);
        Figures {
            polarization: polarization(&flying.velocities_m_s),
            min_separation_m: self.min_separation_m,
            collisions: self.collisions,
            connectivity: links.fraction(),
            algebraic_connectivity: algebraic_connectivity(&links),
            components: links.components(),
            largest_component: links.largest_component(),
        }
    }

    /// The figures of a moment, with the separation since this was last asked for.
    pub fn figures_lately(&mut self, flying: &Flying) -> Figures {
        let min_separation_m = self.lately_m.take();
        Figures { min_separation_m, ..self.figures(flying) }
    }
}

/// Length of the mean of the unit velocities; bodies at rest have none and do not count.
fn polarization(velocities_m_s: &[Vec3]) -> f64 {
    let directions: Vec<Vec3> =
        velocities_m_s.iter().filter_map(|velocity| velocity.try_normalize(1e-6)).collect();
    if directions.is_empty() {
        return 0.0;
    }
    (directions.iter().sum::<Vec3>() / directions.len() as f64).norm()
}

#[cfg(test)]
mod tests;
