//! The state tube of an AUV, online: forward from measurement to measurement, in its own time.
//!
//! `dt/ds in [1/(1+d), 1/(1-d)]` and `dp/ds in (R(heading, pitch) [v] + [current] + [n]) dt/ds` carry the enclosure on;
//! fixes, depths and pings contract it where they are measured (seed 001, section 5.3). Every measurement happens at a known local
//! time, so no clock is ever inverted. What is told late contracts the state that was, and odometry carries it on.

use shoal_bus::message::{Born, Culprit, Emptied, Estimator as Orders, Event, Sense, Sensed, TubeSettings};
use shoal_bus::ping::Ping;
use shoal_bus::time::LocalTime;
use shoal_interval::Interval;

use crate::bounds::{interval, interval_box};
use crate::estimator::{Estimate, Estimator, Prediction};
use crate::motion::Stretch;
use crate::odometry::{Leg, Odometry, Way};
use crate::rings::{Ring, Rings};
use crate::state::{Contradiction, Sound, State};
use crate::together;
use crate::travel::{Travel, local_s, seconds};

/// Encloses the state by a tube.
pub struct TubeEstimator {
    travel: Travel,
    /// What is known of sound by now.
    sound: Sound,
    /// What was told of it at birth.
    told_sound: Sound,
    sound_speed_is_constant: bool,
    timestamp_s: f64,
    stamp_s: f64,
    /// What can have happened between a moment and an event of the same stamp.
    at_once: Way,
    /// At the last tick.
    state: State,
    odometry: Odometry,
    rings: Rings,
    stopping_ratio: f64,
}

/// What one event leaves of a state and of what may be the speed of sound, and the ring of a ping.
struct Informed {
    state: State,
    sound: Sound,
    ring: Option<Ring>,
}

impl TubeEstimator {
    /// The tube that begins with what the AUV was told at birth.
    pub fn new(born: &Born) -> Self {
        let settings = match born.orders.estimator {
            Orders::Tube(settings) => settings,
            Orders::Ekf(_) | Orders::DeadReckoning => TubeSettings::forward(0),
        };
        let horizon_ns = settings.horizon_ns;
        let state = State {
            offset_s: interval(born.clock.offset_s),
            position_m: interval_box(&born.prior_position_m),
        };
        let told_sound = Sound {
            speed_m_s: interval(born.modem.sound_speed_m_s),
            hearing_range_m: born.modem.hearing_range_m,
        };
        let travel = Travel::new(born);
        let timestamp_s = born.modem.timestamp_s;
        let stamp_s = born.clock.stamp_ns as f64 * 1e-9;
        Self {
            at_once: Way::within(travel.motion(), apart_s(0.0, timestamp_s, stamp_s)),
            travel,
            sound: told_sound,
            told_sound,
            sound_speed_is_constant: born.modem.sound_speed_is_constant,
            timestamp_s,
            stamp_s,
            state,
            odometry: Odometry::new(horizon_ns),
            rings: Rings::new(settings.rings.into(), seconds(horizon_ns)),
            stopping_ratio: settings.stopping_ratio,
        }
    }

    /// The leg that ended at the last tick, once there was one.
    pub(crate) fn last_leg(&self) -> Option<&Leg> {
        self.odometry.last()
    }

    /// What is known of the velocity from the last tick until `length_s` local seconds later.
    pub(crate) fn stretch_ahead(&self, length_s: f64) -> Stretch {
        self.travel.stretch_ahead(length_s)
    }

    /// Encloses the effective speed of sound in m/s: what was told at birth, contracted by pings where it is one unknown number.
    pub fn sound_speed_m_s(&self) -> Interval {
        self.sound.speed_m_s
    }

    /// Bytes of heap that are in use for what is remembered; the horizon and the number of rings bound them.
    pub fn memory_bytes(&self) -> usize {
        self.odometry.memory_bytes() + self.rings.memory_bytes()
    }

    /// Exact local time of something stamped `stamp`, in seconds.
    fn local_s(&self, stamp: LocalTime) -> Interval {
        local_s(stamp, self.stamp_s)
    }

    /// The state after one event that is stamped `lag_s` local seconds before it; `way` leads there from the last tick.
    ///
    /// What belongs to the time before the last tick, as the beginning of a long packet does, contracts the state that was.
    /// What is older than the horizon is ignored.
    fn informed(
        &self,
        state: &State,
        way: &Way,
        event: &Event,
        lag_s: f64,
    ) -> Result<Informed, Contradiction> {
        // A stamp may precede the tick by its own error, which is nothing to go back for.
        if lag_s <= self.timestamp_s {
            return self.contracted(state, event, lag_s);
        }
        let Some((then, since)) = self.odometry.recall(event.stamp, self.travel.motion()) else {
            return Ok(Informed { state: *state, sound: self.sound, ring: None });
        };
        let since = since.then(way);
        let mut informed = self.contracted(&then.intersection(&since.back(state)), event, 0.0)?;
        let known = state.intersection(&since.ahead(&informed.state));
        if let Some(ring) = &mut informed.ring {
            ring.carry(&since);
        }
        // Everything in `then` leads into `state`, so nothing is left only where they touch, for want of digits.
        Ok(Informed { state: if known.is_empty() { *state } else { known }, ..informed })
    }

    /// The state contracted by one event that is stamped `lag_s` local seconds before it.
    fn contracted(&self, state: &State, event: &Event, lag_s: f64) -> Result<Informed, Contradiction> {
        let stamp_s = self.local_s(event.stamp);
        let state = match &event.sense {
            Sense::Inertial { .. } | Sense::Dvl { .. } | Sense::Bearing { .. } | Sense::Held => *state,
            Sense::Depth { depth_m } => state.with_depth(*depth_m)?,
            Sense::Gnss { position_m, time_s } => {
                state.with_fix(&interval_box(position_m), interval(*time_s), stamp_s)?
            }
            // Bytes that are no ping say nothing.
            Sense::Heard { frame } => match Ping::decode(frame) {
                Ok(ping) => return self.told_by(state, &ping, stamp_s, lag_s),
                Err(_) => *state,
            },
        };
        Ok(Informed { state, sound: self.sound, ring: None })
    }

    /// The state contracted by a ping that is stamped `lag_s` local seconds before it, and the ring that it leaves.
    fn told_by(
        &self,
        state: &State,
        ping: &Ping,
        stamp_s: Interval,
        lag_s: f64,
    ) -> Result<Informed, Contradiction> {
        let arrival_s = stamp_s.inflate(self.timestamp_s);
        let since = if lag_s == 0.0 {
            self.at_once
        } else {
            Way::within(self.travel.motion(), apart_s(lag_s, self.timestamp_s, self.stamp_s))
        };
        let ring = Ring::new(ping, arrival_s, since);
        let (state, sound) = ring.contract_with_sound(state, &self.sound)?;
        Ok(Informed { state, sound, ring: Some(ring) })
    }

    /// The state contracted by all rings together, of which the last `fresh` are new. Contradictory, those are dropped.
    fn contracted_together(&mut self, state: &State, fresh: usize) -> Result<State, Contradiction> {
        let rings = self.rings.present();
        let contracted = together::contract(rings, state, &self.sound, self.stopping_ratio);
        if contracted.is_err() {
            self.rings.drop_newest(fresh);
        }
        contracted
    }
}

/// Local seconds, at most, between a moment and an event that is stamped `lag_s` before it.
fn apart_s(lag_s: f64, timestamp_s: f64, stamp_s: f64) -> f64 {
    lag_s + timestamp_s + 2.0 * stamp_s
}

impl Estimator for TubeEstimator {
    fn update(&mut self, sensed: &Sensed) -> Estimate {
        let mut emptied = None;
        let mut contractions = 0;
        let mut rejected = 0;
        let begun = self.travel.now();
        let stretch = self.travel.advance(sensed, &mut emptied);
        let passage = self.travel.motion().along(&stretch);
        let mut state = self.state;
        let mut since = begun;
        let mut slice: Option<State> = None;
        let mut way = Way::none();
        let mut fresh = 0;

        let mut events = sensed.events.iter().peekable();
        loop {
            // All events up to the next moment are told before the tube moves on to it.
            let next = events.peek().map_or(sensed.stamp, |event| event.stamp.clamp(since, sensed.stamp));
            let moved = passage.over(seconds(since - begun), seconds(next - begun));
            let before = state;
            state = state.moved(&moved);
            way = way.then(&Way::from(&moved));
            self.rings.carry(&Way::from(&moved));
            let mut told = false;
            while let Some(event) = events.next_if(|event| event.stamp <= next) {
                told = true;
                match self.informed(&state, &way, event, seconds(next - event.stamp)) {
                    Ok(informed) => {
                        contractions += u16::from(informed.state.is_tighter_than(&state));
                        state = informed.state;
                        if self.sound_speed_is_constant {
                            self.sound = informed.sound;
                        }
                        let cuts = |ring: &Ring| together::is_cut_by(&state, ring, &self.sound);
                        if let Some(ring) = informed.ring.filter(cuts) {
                            self.rings.push(ring);
                            fresh += 1;
                        }
                    }
                    Err(Contradiction(by)) => {
                        rejected += u16::from(matches!(by, Culprit::Ping(_)));
                        // What contradicts may be what the speed was learned from.
                        self.sound = self.told_sound;
                        emptied.get_or_insert(Emptied { stamp: event.stamp, by });
                    }
                }
            }
            let ends = next == sensed.stamp && (!told || events.peek().is_none());
            if ends && fresh > 0 {
                match self.contracted_together(&state, fresh) {
                    Ok(contracted) => state = contracted,
                    Err(Contradiction(by)) => {
                        rejected += fresh as u16;
                        self.sound = self.told_sound;
                        emptied.get_or_insert(Emptied { stamp: sensed.stamp, by });
                    }
                }
            }
            let swept = before.swept(&moved, &state);
            slice = Some(slice.map_or(swept, |slice| slice.hull(&swept)));
            since = next;
            if ends {
                break;
            }
        }

        let slice = slice.unwrap_or(state);
        self.rings.forget(sensed.stamp.as_s());
        self.odometry.append(Leg { begun, ended: sensed.stamp, state: self.state, stretch, way });
        self.state = state;
        Estimate { state, slice, emptied, contractions, rejected, components: 1, gaussian: None }
    }

    fn predict(&self, at: LocalTime) -> Prediction {
        self.travel.predict(&self.state, at, self.local_s(at))
    }
}

#[cfg(test)]
pub(crate) mod tests;
