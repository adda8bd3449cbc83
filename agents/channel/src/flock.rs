//! How the swarm moves: distances between bodies, alignment, who could hear whom.

use std::collections::BTreeSet;

use shoal_bus::summary::Flock as Figures;
use shoal_bus::time::SimTime;

use crate::body::Vec3;

/// Separation is looked at this often, in nanoseconds of true time.
pub const SAMPLE_NS: i64 = 100_000_000;

/// Separation over a run.
#[derive(Default)]
pub struct Flock {
    min_separation_m: Option<f64>,
    touching: BTreeSet<(u32, u32)>,
    collisions: u64,
}

impl Flock {
    /// The sampling times after or at `from` and before `to`.
    pub fn samples(from: SimTime, to: SimTime) -> impl Iterator<Item = SimTime> {
        let first = (from.ns() + SAMPLE_NS - 1).div_euclid(SAMPLE_NS);
        (first..).map(|index| SimTime::from_ns(index * SAMPLE_NS)).take_while(move |&at| at < to)
    }

    /// Takes in all positions of one moment; `length_m` are the bodies' lengths.
    pub fn sample(&mut self, positions_m: &[Vec3], length_m: &[f64]) {
        let longest_m = length_m.iter().fold(0.0, |a: f64, &b| a.max(b));
        let mut by_x: Vec<u32> = (0..positions_m.len() as u32).collect();
        by_x.sort_by(|&a, &b| {
            positions_m[a as usize].x.total_cmp(&positions_m[b as usize].x).then(a.cmp(&b))
        });
        let mut touching = BTreeSet::new();
        let mut closest_m = self.min_separation_m.unwrap_or(f64::INFINITY);
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
            self.min_separation_m = Some(closest_m);
        }
        self.collisions += touching.difference(&self.touching).count() as u64;
        self.touching = touching;
    }

    /// The figures of the run, with the alignment and connectivity of its last moment.
    pub fn figures(&self, positions_m: &[Vec3], velocities_m_s: &[Vec3], range_m: &[f64]) -> Figures {
        Figures {
            polarization: polarization(velocities_m_s),
            min_separation_m: self.min_separation_m,
            collisions: self.collisions,
            connectivity: connectivity(positions_m, range_m),
        }
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

/// Fraction of all ordered pairs whose second can hear the first.
fn connectivity(positions_m: &[Vec3], range_m: &[f64]) -> f64 {
    let count = positions_m.len();
    if count < 2 {
        return 0.0;
    }
    let mut linked = 0u64;
    for a in 0..count {
        for b in a + 1..count {
            let distance_m = (positions_m[a] - positions_m[b]).norm();
            linked += u64::from(distance_m <= range_m[a]) + u64::from(distance_m <= range_m[b]);
        }
    }
    linked as f64 / (count * (count - 1)) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn separation_is_the_closest_pair_and_a_touch_counts_once() {
        let mut flock = Flock::default();
        let far = [Vec3::new(0.0, 0.0, 0.0), Vec3::new(5.0, 0.0, 0.0), Vec3::new(0.0, 4.0, 0.0)];
        flock.sample(&far, &[1.0; 3]);
        assert_eq!(flock.min_separation_m, Some(4.0));
        let near = [far[0], Vec3::new(0.5, 0.0, 0.0), far[2]];
        flock.sample(&near, &[1.0; 3]);
        flock.sample(&near, &[1.0; 3]);
        assert_eq!((flock.min_separation_m, flock.collisions), (Some(0.5), 1));
    }

    #[test]
    fn alignment_and_connectivity_of_known_flocks() {
        let north = Vec3::new(0.0, 2.0, 0.0);
        assert_eq!(polarization(&[north, north * 3.0]), 1.0);
        assert_eq!(polarization(&[north, -north]), 0.0);
        let places = [Vec3::zeros(), Vec3::new(10.0, 0.0, 0.0)];
        assert_eq!(connectivity(&places, &[10.0, 5.0]), 0.5);
    }

    #[test]
    fn sampling_times_do_not_depend_on_windows() {
        let at = |from, to| Flock::samples(SimTime::from_ns(from), SimTime::from_ns(to)).collect::<Vec<_>>();
        let whole = at(0, 1_000_000_000);
        let split: Vec<_> = (0..100).flat_map(|i| at(i * 10_000_000, (i + 1) * 10_000_000)).collect();
        assert_eq!(whole, split);
        assert_eq!(whole.len(), 10);
    }
}
