//! Every random draw of a run: reproducible streams keyed by (seed, purpose, vehicle), each read in its own order.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use shoal_bus::message::AuvId;
use shoal_scenario::model::Noise;

/// What a stream of draws is for; streams of different purposes are independent.
#[derive(Clone, Copy, Debug)]
pub enum Purpose {
    /// Start position, prior box, heading.
    Start = 1,
    /// Phases of ticks, pings and fixes.
    Phase = 2,
    /// Constant and wandering part of the clock's drift, offset.
    Clock = 3,
    /// State noise of the body.
    Disturbance = 4,
    /// Heading, pitch and speed.
    Inertial = 5,
    /// Depth.
    Depth = 6,
    /// Satellite fixes.
    Gnss = 7,
    /// Timestamps of arrivals.
    Arrival = 8,
    /// What the scenario knows only within bounds, such as speed of sound and current.
    Water = 9,
    /// Fading, and whether a packet is decoded.
    Reception = 10,
    /// Velocity over ground.
    Dvl = 11,
    /// Directions from which pings arrive.
    Bearing = 12,
    /// Arrivals that were none.
    Outlier = 13,
}

/// One stream of draws.
pub struct Draws {
    source: ChaCha8Rng,
    noise: Noise,
    worst_side: f64,
}

impl Draws {
    /// The stream for `purpose` and `vehicle` of the run with this seed.
    pub fn new(seed: u64, purpose: Purpose, vehicle: AuvId, noise: Noise) -> Self {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        key[8..12].copy_from_slice(&(purpose as u32).to_le_bytes());
        key[12..16].copy_from_slice(&vehicle.0.to_le_bytes());
        let mut draws = Self { source: ChaCha8Rng::from_seed(key), noise, worst_side: 1.0 };
        draws.worst_side = if draws.unit() < 0.5 { -1.0 } else { 1.0 };
        draws
    }

    /// Uniform in `[0, 1)`, whatever the mood.
    pub fn unit(&mut self) -> f64 {
        (self.source.next_u64() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// What another random source may begin with.
    pub fn entropy(&mut self) -> u64 {
        self.source.next_u64()
    }

    /// Uniform in `[least, greatest]`, whatever the mood.
    pub fn between(&mut self, least: f64, greatest: f64) -> f64 {
        (least + (greatest - least) * self.unit()).clamp(least, greatest)
    }

    /// An error in `[-bound, bound]`: uniform, or (adversarial) at a bound, on the same side for some 64 draws on average,
    /// because an error that persists hurts an integral most.
    pub fn error(&mut self, bound: f64) -> f64 {
        let unit = self.unit();
        match self.noise {
            Noise::Uniform => ((2.0 * unit - 1.0) * bound).clamp(-bound, bound),
            Noise::Adversarial => {
                if unit < 1.0 / 64.0 {
                    self.worst_side = -self.worst_side;
                }
                self.worst_side * bound
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_repeat_and_differ() {
        let draw = |seed, purpose, auv| Draws::new(seed, purpose, AuvId(auv), Noise::Uniform).unit();
        assert_eq!(draw(1, Purpose::Clock, 3), draw(1, Purpose::Clock, 3));
        assert_ne!(draw(1, Purpose::Clock, 3), draw(2, Purpose::Clock, 3));
        assert_ne!(draw(1, Purpose::Clock, 3), draw(1, Purpose::Start, 3));
        assert_ne!(draw(1, Purpose::Clock, 3), draw(1, Purpose::Clock, 4));
    }

    #[test]
    fn errors_keep_their_bound_and_adversarial_ones_reach_both_sides() {
        let mut uniform = Draws::new(7, Purpose::Depth, AuvId(0), Noise::Uniform);
        let mut worst = Draws::new(7, Purpose::Depth, AuvId(0), Noise::Adversarial);
        let mut sides = [0; 2];
        for _ in 0..10_000 {
            assert!(uniform.error(0.3).abs() <= 0.3);
            let error = worst.error(0.3);
            assert_eq!(error.abs(), 0.3);
            sides[usize::from(error > 0.0)] += 1;
        }
        assert!(sides.iter().all(|&count| count > 1_000), "{sides:?}");
    }
}
