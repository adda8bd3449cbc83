//! One path of one packet towards a receiver that moves.

use shoal_bus::time::SimTime;
use shoal_bus::traffic::SoundPath;

use crate::acoustics::doppler::doppler_factor;
use crate::acoustics::ray::{Direction, Ray};
use crate::bearing::Incidence;
use crate::body::{Body, Pose, Vec3};
use crate::sound::Wavefront;

use super::SeaWater;

/// The search ends when sound and receiver are less than so many nanoseconds apart. Only direct paths are promised to anyone.
const DIRECT_NS: f64 = 1.0;
const BOUNCED_NS: f64 = 1_000.0;

/// Rounds of the search at most; each brings sound and receiver nearer by two thirds or better, as bodies are at most half as
/// fast as sound.
const ROUNDS: usize = 200;

/// A path on which sound has not yet met the receiver.
///
/// With `tau(t)` the travel time of the path to where the receiver is at t, sound meets it at the b that solves
/// `b - a = tau(b)`. Since tau changes by less than v / c per second, the receiver's greatest speed over the least speed of
/// sound, `b >= t + (tau(t) - (t - a)) / (1 + v / c)` at any t before: each round goes there, never past b. So it never asks
/// for motion that is not settled yet, and passes the same moments however time is cut into windows.
#[derive(Clone, Debug)]
pub struct Crossing {
    pub path: SoundPath,
    pub level_db: f64,
    ray: Ray,
    /// Horizontal distance and depth of the receiver that the ray leads to, in metres.
    led_to_m: [f64; 2],
    /// Sound and receiver do not meet sooner after the emission.
    not_before_ns: f64,
}

/// Sound meets the receiver.
#[derive(Clone, Copy, Debug)]
pub struct Meeting {
    /// When, rounded up to a whole nanosecond.
    pub start: SimTime,
    /// Distance between the places of emission and reception in metres, straight through the water.
    pub range_m: f64,
    /// Bound of the error of that, in metres: what the receiver moves until the nanosecond that `start` names.
    pub range_error_m: f64,
    /// Factor of frequencies.
    pub doppler: f64,
    /// How sound comes in.
    pub incidence: Incidence,
}

impl Crossing {
    /// A path along `ray`, which leads to where the receiver was at the emission.
    pub fn new(path: SoundPath, ray: Ray, led_to_m: [f64; 2], level_db: f64, speed_ratio: f64) -> Self {
        Self { path, level_db, ray, led_to_m, not_before_ns: ray.travel_s * 1e9 / (1.0 + speed_ratio) }
    }

    /// Where sound and receiver meet, if that is before `horizon`, up to which the receiver's motion is settled. `speed_ratio` is its
    /// greatest speed over the least speed of sound.
    pub fn meet(
        &mut self,
        wavefront: &Wavefront,
        receiver: &Body,
        speed_ratio: f64,
        water: &SeaWater,
        horizon: SimTime,
    ) -> Option<Meeting> {
        let near_ns = if self.path == SoundPath::Direct { DIRECT_NS } else { BOUNCED_NS };
        for round in 0..ROUNDS {
            let elapsed_ns = self.not_before_ns.floor();
            let at = wavefront.emitted + elapsed_ns as i64;
            if at >= horizon {
                return None;
            }
            let place_m = receiver.position_at(at);
            let travel_ns = self.travel_s(wavefront, place_m, water) * 1e9;
            let gap_ns = travel_ns - elapsed_ns;
            if gap_ns > near_ns && round + 1 < ROUNDS {
                self.not_before_ns = elapsed_ns + gap_ns / (1.0 + speed_ratio);
                continue;
            }
            let start = wavefront.emitted + travel_ns.max(elapsed_ns).ceil() as i64;
            return Some(Meeting {
                start,
                range_m: (place_m - wavefront.origin_m).norm(),
                range_error_m: speed_ratio * water.slowest_m_s * ((start - at) as f64 * 1e-9),
                doppler: self.doppler(wavefront, place_m, receiver.ground_velocity_at(at), water),
                incidence: self.incidence(wavefront, &receiver.at(at)),
            });
        }
        None
    }

    /// Travel time to `place_m`, along the ray that leads there or, where there is none any more, along the last one, bent a little.
    fn travel_s(&mut self, wavefront: &Wavefront, place_m: Vec3, water: &SeaWater) -> f64 {
        let origin_m = wavefront.origin_m;
        let (range_m, depth_m) = ((place_m - origin_m).xy().norm(), -place_m.z);
        let ray = water.column.ray(self.path, -origin_m.z, depth_m, range_m, Some(&self.ray));
        let [last_range_m, last_depth_m] = std::mem::replace(&mut self.led_to_m, [range_m, depth_m]);
        match ray {
            Some(ray) => self.ray = ray,
            None => {
                // The gradient of the travel time is the ray's slowness, along its direction.
                let upwards_s_m = self.ray.arrival.sin / water.column.profile().speed_m_s(depth_m);
                self.ray.travel_s +=
                    self.ray.slowness_s_m * (range_m - last_range_m) - upwards_s_m * (depth_m - last_depth_m);
            }
        }
        self.ray.travel_s
    }

    /// Back along the ray, which stays in the vertical plane of both ends.
    fn incidence(&self, wavefront: &Wavefront, receiver: &Pose) -> Incidence {
        let back = (wavefront.origin_m - receiver.position_m).xy().try_normalize(0.0).unwrap_or_default();
        let Direction { cos, sin } = self.ray.arrival;
        Incidence {
            towards: Vec3::new(cos * back.x, cos * back.y, -sin),
            heading_rad: receiver.attitude.heading_rad,
        }
    }

    /// Both motions along the ray, at either end.
    fn doppler(&self, wavefront: &Wavefront, place_m: Vec3, velocity_m_s: Vec3, water: &SeaWater) -> f64 {
        let profile = water.column.profile();
        let towards = (place_m - wavefront.origin_m).xy().try_normalize(0.0).unwrap_or_default();
        let along = |cos: f64, sin: f64, velocity: Vec3| cos * towards.dot(&velocity.xy()) + sin * velocity.z;
        let (departure, arrival) = (self.ray.departure, self.ray.arrival);
        let emitter_speed_m_s = profile.speed_m_s(-wavefront.origin_m.z);
        let receiver_speed_m_s = profile.speed_m_s(-place_m.z);
        let emitter_rate_m_s = -along(departure.cos, departure.sin, wavefront.velocity_m_s);
        let receiver_rate_m_s = along(arrival.cos, arrival.sin, velocity_m_s);
        // The formula has one speed of sound: the emitter's rate is told in the receiver's.
        let emitter_rate_m_s = emitter_rate_m_s * (receiver_speed_m_s / emitter_speed_m_s);
        doppler_factor(emitter_rate_m_s, receiver_rate_m_s, receiver_speed_m_s)
    }
}

#[cfg(test)]
mod tests;
