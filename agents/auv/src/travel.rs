//! How the body travels from tick to tick, as log, attitude and Doppler velocity log tell it: no measurement of positions enters.

use shoal_bus::message::{Born, Culprit, Emptied, Measured, Sense, Sensed};
use shoal_bus::time::LocalTime;
use shoal_interval::{Interval, IntervalBox};

use crate::bounds::measured;
use crate::current::{self, Current};
use crate::estimator::Prediction;
use crate::motion::{Motion, Stretch};
use crate::state::State;

/// Velocity through the water and current at the last tick, and what bounds them in between.
#[derive(Clone, Debug)]
pub struct Travel {
    motion: Motion,
    now: LocalTime,
    velocity_m_s: IntervalBox<3>,
    current: Current,
}

impl Travel {
    /// At birth: any velocity that the body can have, and the current as told.
    pub fn new(born: &Born) -> Self {
        let motion = Motion::new(&born.body, &born.clock);
        let velocity_m_s = motion.any_velocity();
        Self { motion, now: born.birth, velocity_m_s, current: Current::new(&born.body) }
    }

    /// The motion that is possible at all.
    pub fn motion(&self) -> &Motion {
        &self.motion
    }

    /// Local time of the last tick.
    pub fn now(&self) -> LocalTime {
        self.now
    }

    /// Goes on to the tick of `sensed`: the stretch of local time since the last one. What contradicts itself goes into `emptied`, unless
    /// something has already.
    pub fn advance(&mut self, sensed: &Sensed, emptied: &mut Option<Emptied>) -> Stretch {
        let after_m_s = self.look_at_log(sensed, emptied);
        let current = self.look_at_ground(sensed, emptied);
        let length_s = seconds(sensed.stamp - self.now);
        let stretch = Stretch {
            before_m_s: self.velocity_m_s,
            after_m_s,
            current_m_s: self.current_between(&current, length_s),
            length_s,
        };
        self.now = sensed.stamp;
        self.velocity_m_s = after_m_s;
        self.current = current;
        stretch
    }

    /// Forgets what was seen of the current, which may have been another one elsewhere.
    pub fn forget_current(&mut self) {
        self.current = self.current.forgotten();
    }

    /// What is known of the velocity from the last tick until `length_s` local seconds later.
    pub fn stretch_ahead(&self, length_s: f64) -> Stretch {
        let current_m_s = self.current.within(self.motion.true_s(length_s));
        Stretch { before_m_s: self.velocity_m_s, after_m_s: IntervalBox::ENTIRE, current_m_s, length_s }
    }

    /// What can be at `at`, not before the last tick, when the state was `state` at the last tick. `at_s` is the exact local time of the
    /// moment, in seconds.
    pub fn predict(&self, state: &State, at: LocalTime, at_s: Interval) -> Prediction {
        let length_s = seconds(at - self.now).max(0.0);
        let stretch = self.stretch_ahead(length_s);
        let state = state.moved(&self.motion.over(&stretch, 0.0, length_s));
        let through_water_m_s = self.motion.velocity_after(&self.velocity_m_s, length_s);
        Prediction {
            time_s: state.true_time_s(at_s),
            position_m: state.position_m,
            velocity_m_s: self.motion.over_ground(&through_water_m_s, &stretch.current_m_s),
            current_m_s: stretch.current_m_s,
            gaussian: None,
        }
    }

    /// The velocity at the tick: what the log says, what was possible, or (contradictory) the log alone.
    fn look_at_log(&self, sensed: &Sensed, emptied: &mut Option<Emptied>) -> IntervalBox<3> {
        let possible = self.motion.velocity_after(&self.velocity_m_s, seconds(sensed.stamp - self.now));
        let mut logs = sensed.events.iter().filter_map(|event| match event.sense {
            Sense::Inertial { heading_rad, pitch_rad, speed_m_s } => {
                Some((event.stamp, velocity(heading_rad, pitch_rad, speed_m_s)))
            }
            _ => None,
        });
        let Some((stamp, logged)) = logs.next_back() else { return possible };
        let since = self.motion.velocity_after(&logged, seconds(sensed.stamp - stamp));
        let both = possible.intersection(&since);
        if !both.is_empty() {
            return both;
        }
        emptied.get_or_insert(Emptied { stamp, by: Culprit::Inertial });
        since.intersection(&self.motion.any_velocity())
    }

    /// What is known of the current at the tick, contracted by each Doppler velocity log that came with an attitude. Contradictory,
    /// it is what the AUV was told.
    fn look_at_ground(&self, sensed: &Sensed, emptied: &mut Option<Emptied>) -> Current {
        let mut current = self.current;
        let mut since = self.now;
        for event in &sensed.events {
            let stamp = event.stamp;
            let Sense::Dvl { velocity_m_s } = &event.sense else { continue };
            let Some(drift_m_s) = drift_at(stamp, velocity_m_s, sensed) else { continue };
            if stamp < since || stamp > sensed.stamp {
                continue;
            }
            let before = current.later(self.motion.true_s(seconds(stamp - since)));
            current = before.contracted(&drift_m_s).unwrap_or_else(|| {
                emptied.get_or_insert(Emptied { stamp, by: Culprit::Dvl });
                before.forgotten()
            });
            since = stamp;
        }
        current.later(self.motion.true_s(seconds(sensed.stamp - since)))
    }

    /// The current met since the last tick, `length_s` local seconds ago, if it is `after` now.
    fn current_between(&self, after: &Current, length_s: f64) -> IntervalBox<3> {
        let elapsed_s = self.motion.true_s(length_s);
        let both = self.current.within(elapsed_s).intersection(&after.within(elapsed_s));
        // A contradiction has made `after` forget what was known before.
        if both.is_empty() { after.within(elapsed_s) } else { both }
    }
}

/// Current plus disturbance at `stamp`, in m/s, if log and attitude were read then too.
fn drift_at(stamp: LocalTime, over_ground_m_s: &[Measured; 3], sensed: &Sensed) -> Option<IntervalBox<3>> {
    sensed.events.iter().filter(|event| event.stamp == stamp).find_map(|event| match event.sense {
        Sense::Inertial { heading_rad, pitch_rad, speed_m_s } => {
            Some(current::drift(heading_rad, pitch_rad, speed_m_s, over_ground_m_s))
        }
        _ => None,
    })
}

/// `R(heading, pitch) (speed, 0, 0)`, in m/s.
pub(crate) fn velocity(heading_rad: Measured, pitch_rad: Measured, speed_m_s: Measured) -> IntervalBox<3> {
    let (sin_heading, cos_heading) = measured(heading_rad).sin_cos();
    let (sin_pitch, cos_pitch) = measured(pitch_rad).sin_cos();
    let speed = measured(speed_m_s);
    IntervalBox::from([speed * cos_pitch * cos_heading, speed * cos_pitch * sin_heading, speed * sin_pitch])
}

/// Exact local time of something stamped `stamp`, in seconds, when a stamp is off by at most `stamp_s` seconds.
pub fn local_s(stamp: LocalTime, stamp_s: f64) -> Interval {
    // Seconds as a double are off by at most half an ulp; one whole ulp is added.
    let seconds = stamp.as_s();
    Interval::centred(seconds, stamp_s + seconds.abs() * f64::EPSILON)
}

/// Seconds of a difference of stamps; exact below 104 days, where nanoseconds are whole doubles, but for the last bit.
pub fn seconds(ns: i64) -> f64 {
    ns as f64 * 1e-9
}
