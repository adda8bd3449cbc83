//! Sound on its way: wavefronts that leave where the emitter was and arrive where the receiver is by then.
//!
//! A ping emitted at a by i reaches j at the b that solves `|p_j(b) - p_i(a)| = c (b - a)`: the position of the emitter at
//! emission, of the receiver at reception (seed 001, equations 5.2 ii and 5.4). The left side changes more slowly than the right
//! as long as bodies are slower than sound, so there is one solution, and where it lies can be bracketed at the emission.

use std::collections::VecDeque;

use shoal_bus::message::AuvId;
use shoal_bus::ping::Frame;
use shoal_bus::time::{LocalTime, SimTime};
use shoal_bus::traffic::Fate;

use crate::bearing::Incidence;
use crate::body::{Body, Segment, Vec3};

/// Bound of the error of an arrival's true time, in seconds: the solver's tolerance and the whole nanosecond it is rounded to.
pub const ARRIVAL_TOLERANCE_S: f64 = 5e-9;

/// One ping as it leaves.
#[derive(Debug)]
pub struct Wavefront {
    /// Who emitted it.
    pub from: AuvId,
    /// The emitter's group, which has its make of modem.
    pub group: u16,
    /// How many pings the emitter had emitted before.
    pub sequence: u32,
    /// True time of emission.
    pub emitted: SimTime,
    /// Length of the packet at the emitter, in nanoseconds of true time.
    pub packet_ns: i64,
    /// True position of emission, in metres.
    pub origin_m: Vec3,
    /// True velocity over ground at the emission, in m/s.
    pub velocity_m_s: Vec3,
    /// What it carries.
    pub frame: Frame,
    /// Width of the position box that it carries, in metres.
    pub box_width_m: f64,
    /// Heard up to this range at level `ideal`, in metres.
    pub range_m: f64,
    /// Whether what it carries does not hold the truth.
    pub is_false: bool,
}

/// All wavefronts that someone may still have to do with, numbered in the order in which they left.
#[derive(Debug, Default)]
pub struct Wavefronts {
    first: u64,
    under_way: VecDeque<Wavefront>,
}

impl Wavefronts {
    /// The number of the next one to leave.
    pub fn next(&self) -> u64 {
        self.first + self.under_way.len() as u64
    }

    /// One more leaves.
    pub fn leaves(&mut self, wavefront: Wavefront) {
        self.under_way.push_back(wavefront);
    }

    /// The wavefront of this number, which is not forgotten.
    pub fn get(&self, number: u64) -> &Wavefront {
        // Whoever waits for a wavefront keeps it from being forgotten.
        &self.under_way[(number - self.first) as usize]
    }

    /// Forgets all with lower numbers than this, for which nobody waits any more.
    pub fn forget_before(&mut self, number: u64) {
        let forgotten = number.clamp(self.first, self.next()) - self.first;
        self.under_way.drain(..forgotten as usize);
        self.first += forgotten;
    }
}

/// What one receiver makes of one wavefront.
#[derive(Debug)]
pub struct Told {
    /// True time at which it is settled: at level `sea`, the packet's end.
    pub at: SimTime,
    /// Number of the wavefront.
    pub wavefront: u64,
    /// Heard or lost.
    pub fate: Fate,
    /// What the receiver's clock read when the packet began, if that was not at `at`.
    pub stamp: Option<LocalTime>,
    /// How it came in, if it was heard and if that matters to the receiver.
    pub incidence: Option<Incidence>,
}

/// A wavefront on its way to one receiver.
#[derive(Clone, Copy, Debug)]
pub struct Flight {
    /// Number of the wavefront.
    pub wavefront: u64,
    /// It does not arrive before this.
    pub earliest: SimTime,
    /// Whether the receiver was surely in range at the emission; if not, it has to look.
    pub is_sure: bool,
}

/// An arrival.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrival {
    /// True time, rounded up to a whole nanosecond.
    pub at: SimTime,
    /// Distance between emission and reception, in metres.
    pub range_m: f64,
    /// Travel time in seconds.
    pub travel_s: f64,
}

impl Wavefront {
    /// When it may reach, at the soonest, a receiver in range that is now (at the emission) no nearer than `distance_m` and moves at
    /// most at `speed_m_s`.
    pub fn earliest_at(&self, distance_m: f64, speed_m_s: f64, sound_speed_m_s: f64) -> SimTime {
        let travel_s = distance_m / (sound_speed_m_s + speed_m_s);
        (self.emitted + (travel_s * 1e9) as i64 + -1).max(self.emitted)
    }

    /// When and where it arrives, if that is before `horizon`, up to which the receiver's motion is settled. It does not arrive
    /// before `earliest`.
    pub fn arrival(
        &self,
        receiver: &Body,
        earliest: SimTime,
        sound_speed_m_s: f64,
        horizon: SimTime,
    ) -> Option<Arrival> {
        for segment in receiver.segments_from(earliest) {
            if segment.start >= horizon {
                return None;
            }
            let whole_s = (segment.end - segment.start) as f64 * 1e-9;
            if self.ahead(segment, whole_s, sound_speed_m_s).by_m > 0.0 {
                // Sound has not caught up by the end of this stretch, nor will it have if the stretch is cut short.
                continue;
            }
            let elapsed_s = self.meet(segment, sound_speed_m_s);
            let at = (segment.start + (elapsed_s * 1e9).ceil() as i64).min(segment.end);
            let range_m = (segment.position_after(elapsed_s) - self.origin_m).norm();
            return (at < horizon).then_some(Arrival { at, range_m, travel_s: range_m / sound_speed_m_s });
        }
        None
    }

    /// How far the receiver is ahead of the wavefront, `elapsed_s` seconds after the start of `segment`. Falls strictly, because
    /// bodies are slower than sound.
    fn ahead(&self, segment: &Segment, elapsed_s: f64, sound_speed_m_s: f64) -> Ahead {
        let sound_s = (segment.start - self.emitted) as f64 * 1e-9 + elapsed_s;
        let ray_m = segment.position_after(elapsed_s) - self.origin_m;
        let range_m = ray_m.norm();
        Ahead { by_m: range_m - sound_speed_m_s * sound_s, ray_m, range_m }
    }

    /// Seconds after the start of `segment` at which sound and receiver meet, which is before its end.
    ///
    /// The search spans the stretch as it was planned: a setpoint that is decided later must not change the last bits.
    fn meet(&self, segment: &Segment, sound_speed_m_s: f64) -> f64 {
        let mut elapsed_s = 0.0;
        let mut ahead = self.ahead(segment, elapsed_s, sound_speed_m_s);
        if ahead.by_m <= 0.0 {
            return 0.0;
        }
        let (mut before_s, mut after_s) = (0.0, segment.planned_length_s());
        // Newton's steps shrink quadratically, by (body speed / sound speed)² or better; one that leaves the bracket is
        // replaced by its middle.
        for _ in 0..100 {
            if ahead.by_m > 0.0 {
                before_s = elapsed_s
            } else {
                after_s = elapsed_s
            }
            let velocity_m_s = segment.ground_velocity_m_s + segment.acceleration_m_s2 * elapsed_s;
            let opening_m_s =
                if ahead.range_m > 0.0 { (ahead.ray_m / ahead.range_m).dot(&velocity_m_s) } else { 0.0 };
            let newton_s = elapsed_s + ahead.by_m / (sound_speed_m_s - opening_m_s);
            let next_s =
                if (before_s..=after_s).contains(&newton_s) { newton_s } else { 0.5 * (before_s + after_s) };
            let step_s = next_s - elapsed_s;
            elapsed_s = next_s;
            if step_s.abs() < 1e-12 {
                break;
            }
            ahead = self.ahead(segment, elapsed_s, sound_speed_m_s);
        }
        elapsed_s
    }
}

/// A receiver before a wavefront.
struct Ahead {
    /// By how many metres.
    by_m: f64,
    /// From the emission to the receiver, in metres.
    ray_m: Vec3,
    /// Length of that.
    range_m: f64,
}

/// How far from the emission a receiver may be at that moment and still come into range in time, in metres.
pub fn reach_m(range_m: f64, speed_m_s: f64, sound_speed_m_s: f64) -> f64 {
    range_m * (1.0 + speed_m_s / sound_speed_m_s) * (1.0 + 1e-9)
}

#[cfg(test)]
mod tests {
    use shoal_scenario::model::{Kind, Noise};

    use super::*;
    use crate::body::Attitude;

    fn body(seed: u64, position_m: Vec3) -> Body {
        let kind = Kind {
            speed_max_m_s: 12.0,
            acceleration_max_m_s2: 4.0,
            turn_rate_max_rad_s: 1.5,
            pitch_max_rad: 1.0,
            disturbance_m_s: [1.0; 3],
            length_m: 1.0,
        };
        let attitude = Attitude { heading_rad: seed as f64, pitch_rad: 0.1, speed_m_s: 11.0 };
        Body::new(&kind, Vec3::zeros(), 10_000_000, position_m, attitude, (seed, AuvId(0), Noise::Uniform))
    }

    fn wavefront(emitted_ns: i64) -> Wavefront {
        Wavefront {
            from: AuvId(1),
            group: 0,
            sequence: 0,
            emitted: SimTime::from_ns(emitted_ns),
            packet_ns: 0,
            velocity_m_s: Vec3::zeros(),
            origin_m: Vec3::new(3.0, -2.0, -1.0),
            frame: Frame::new(&[]).unwrap(),
            box_width_m: 0.0,
            range_m: 1e4,
            is_false: false,
        }
    }

    #[test]
    fn the_moving_receiver_is_met_as_bisection_finds_it() {
        let sound_speed_m_s = 100.0;
        for seed in 0..200u64 {
            let place = Vec3::new(seed as f64, 40.0 - seed as f64 * 0.7, -(seed as f64) * 0.2);
            let mut body = body(seed, place);
            body.steer(SimTime::from_ns(123_456_789), Vec3::new(-9.0, 8.0, 2.0));
            let horizon = SimTime::from_ns(6_000_000_000);
            body.integrate(horizon);
            let wavefront = wavefront(777_777_777);
            let distance_m = (body.at(wavefront.emitted).position_m - wavefront.origin_m).norm();
            let earliest = wavefront.earliest_at(distance_m, 14.0, sound_speed_m_s);
            let arrival = wavefront.arrival(&body, earliest, sound_speed_m_s, horizon).unwrap();

            let ahead_m = |t: SimTime| {
                let distance_m = (body.at(t).position_m - wavefront.origin_m).norm();
                distance_m - sound_speed_m_s * ((t - wavefront.emitted) as f64 * 1e-9)
            };
            let (mut before, mut after) = (wavefront.emitted, horizon);
            while after - before > 1 {
                let middle = before + (after - before) / 2;
                if ahead_m(middle) > 0.0 { before = middle } else { after = middle }
            }
            assert!((arrival.at - after).abs() <= 1, "{} {}", arrival.at, after);
            assert!(arrival.at >= earliest);
        }
    }

    #[test]
    fn the_horizon_hides_an_arrival_but_never_moves_it() {
        let mut settled = body(5, Vec3::new(60.0, 0.0, 0.0));
        settled.integrate(SimTime::from_ns(2_000_000_000));
        let wavefront = wavefront(0);
        let earliest = wavefront.earliest_at(57.1, 14.0, 100.0);
        let whole = wavefront.arrival(&settled, earliest, 100.0, SimTime::from_ns(2_000_000_000)).unwrap();
        let mut growing = body(5, Vec3::new(60.0, 0.0, 0.0));
        let mut seen = None;
        for window in 1..=400 {
            let horizon = SimTime::from_ns(window * 5_000_000);
            growing.integrate(horizon);
            if seen.is_none() {
                seen = wavefront.arrival(&growing, earliest, 100.0, horizon);
            }
            growing.forget_before(horizon);
        }
        assert_eq!(seen, Some(whole));
    }

    #[test]
    fn slow_sound_and_a_tight_turn_are_no_trap() {
        // The parabola of a stretch, taken seconds ahead, would outrun sound: only what happens inside it counts.
        let mut body = body(5, Vec3::new(1_800.0, 0.0, 0.0));
        for step in 0..600 {
            let side = if step % 2 == 0 { 9.0 } else { -9.0 };
            body.steer(SimTime::from_ns(step * 100_000_000), Vec3::new(-side, side, 0.0));
        }
        let horizon = SimTime::from_ns(60_000_000_000);
        body.integrate(horizon);
        let wavefront = wavefront(0);
        let earliest = wavefront.earliest_at(1_797.0, 14.0, 60.0);
        let arrival = wavefront.arrival(&body, earliest, 60.0, horizon).unwrap();
        let distance_m = (body.at(arrival.at).position_m - wavefront.origin_m).norm();
        assert!((distance_m / 60.0 - arrival.at.as_s()).abs() < 2e-9);
    }

    #[test]
    fn zero_range_is_heard_at_once() {
        let mut body = body(2, Vec3::new(3.0, -2.0, -1.0));
        body.integrate(SimTime::from_ns(100_000_000));
        let wavefront = wavefront(0);
        let earliest = wavefront.earliest_at(0.0, 14.0, 100.0);
        let arrival = wavefront.arrival(&body, earliest, 100.0, SimTime::from_ns(50_000_000)).unwrap();
        assert_eq!((arrival.at, arrival.range_m), (SimTime::ZERO, 0.0));
    }
}
