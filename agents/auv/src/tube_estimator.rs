//! The state tube of an AUV, online: forward from measurement to measurement, in its own time.
//!
//! `dt/ds in [1/(1+d), 1/(1-d)]` and `dp/ds in (R(heading, pitch) [v] + [current] + [n]) dt/ds` carry the enclosure on;
//! fixes, depths and pings contract it where they are measured (seed 001, section 5.3). Every measurement happens at a known local
//! time, so no clock is ever inverted. What is told late contracts the state that was, and odometry carries it on.

use shoal_bus::message::{Born, Culprit, Emptied, Estimator as Orders, Event, Sense, Sensed};
use shoal_bus::ping::Ping;
use shoal_bus::time::LocalTime;
use shoal_interval::Interval;

use crate::bounds::{interval, interval_box};
use crate::estimator::{Estimate, Estimator, Prediction};
use crate::history::History;
use crate::odometry::{Leg, Odometry, Way};
use crate::state::{Contradiction, Moment, Sound, State};
use crate::travel::{Travel, seconds};

/// Encloses the state by a tube.
pub struct TubeEstimator {
    travel: Travel,
    sound: Sound,
    timestamp_s: f64,
    stamp_s: f64,
    history: History,
    odometry: Odometry,
}

impl TubeEstimator {
    /// The tube that begins with what the AUV was told at birth.
    pub fn new(born: &Born) -> Self {
        let horizon_ns = match born.orders.estimator {
            Orders::Tube(settings) => settings.horizon_ns,
            Orders::Ekf(_) | Orders::DeadReckoning => 0,
        };
        let state = State {
            offset_s: interval(born.clock.offset_s),
            position_m: interval_box(&born.prior_position_m),
        };
        Self {
            travel: Travel::new(born),
            sound: Sound {
                speed_m_s: interval(born.modem.sound_speed_m_s),
                hearing_range_m: born.modem.hearing_range_m,
            },
            timestamp_s: born.modem.timestamp_s,
            stamp_s: born.clock.stamp_ns as f64 * 1e-9,
            history: History::new(born.birth, &state, horizon_ns),
            odometry: Odometry::new(horizon_ns),
        }
    }

    /// Exact local time of something stamped `stamp`, in seconds.
    fn local_s(&self, stamp: LocalTime) -> Interval {
        // Seconds as a double are off by at most half an ulp; one whole ulp is added.
        let seconds = stamp.as_s();
        Interval::centred(seconds, self.stamp_s + seconds.abs() * f64::EPSILON)
    }

    /// The state after one event that is stamped `lag_s` local seconds before it; `way` leads there from the last tick.
    ///
    /// What belongs to the time before the last tick, as the beginning of a long packet does, contracts the state that was.
    /// What is older than the horizon is ignored.
    fn informed(&self, state: &State, way: &Way, event: &Event, lag_s: f64) -> Result<State, Contradiction> {
        // A stamp may precede the tick by its own error, which is nothing to go back for.
        if lag_s <= self.timestamp_s {
            return self.contracted(state, event, lag_s);
        }
        let Some((then, since)) = self.odometry.recall(event.stamp, self.travel.motion()) else {
            return Ok(*state);
        };
        let since = since.then(way);
        let then = self.contracted(&then.intersection(&since.back(state)), event, 0.0)?;
        let known = state.intersection(&since.ahead(&then));
        // Everything in `then` leads into `state`, so nothing is left only where they touch, for want of digits.
        Ok(if known.is_empty() { *state } else { known })
    }

    /// The state contracted by one event that is stamped `lag_s` local seconds before it.
    fn contracted(&self, state: &State, event: &Event, lag_s: f64) -> Result<State, Contradiction> {
        let stamp_s = self.local_s(event.stamp);
        match &event.sense {
            Sense::Inertial { .. } | Sense::Dvl { .. } | Sense::Held => Ok(*state),
            Sense::Depth { depth_m } => state.with_depth(*depth_m),
            Sense::Gnss { position_m, time_s } => {
                state.with_fix(&interval_box(position_m), interval(*time_s), stamp_s)
            }
            Sense::Heard { frame } => {
                // Bytes that are no ping say nothing.
                let Ok(ping) = Ping::decode(frame) else { return Ok(*state) };
                let arrival = Moment {
                    stamp_s: stamp_s.inflate(self.timestamp_s),
                    apart_s: lag_s + self.timestamp_s + 2.0 * self.stamp_s,
                };
                state.with_ping(&ping, &self.sound, &arrival, self.travel.motion())
            }
        }
    }
}

impl Estimator for TubeEstimator {
    fn update(&mut self, sensed: &Sensed) -> Estimate {
        let mut emptied = None;
        let mut contractions = 0;
        let mut rejected = 0;
        let begun = self.travel.now();
        let stretch = self.travel.advance(sensed, &mut emptied);
        let mut state = self.history.last();
        let mut since = begun;
        let mut slice: Option<State> = None;
        let mut way = Way::none();

        let mut events = sensed.events.iter().peekable();
        loop {
            // All events up to the next moment are told before the tube moves on to it.
            let next = events.peek().map_or(sensed.stamp, |event| event.stamp.clamp(since, sensed.stamp));
            let moved = self.travel.motion().over(&stretch, seconds(since - begun), seconds(next - begun));
            let before = state;
            state = state.moved(&moved);
            way = way.then(&Way::from(&moved));
            let mut told = false;
            while let Some(event) = events.next_if(|event| event.stamp <= next) {
                told = true;
                match self.informed(&state, &way, event, seconds(next - event.stamp)) {
                    Ok(contracted) => {
                        contractions += u16::from(contracted.is_tighter_than(&state));
                        state = contracted;
                    }
                    Err(Contradiction(by)) => {
                        rejected += u16::from(matches!(by, Culprit::Ping(_)));
                        emptied.get_or_insert(Emptied { stamp: event.stamp, by });
                    }
                }
            }
            let swept = before.swept(&moved, &state);
            slice = Some(slice.map_or(swept, |slice| slice.hull(&swept)));
            since = next;
            if next == sensed.stamp && (!told || events.peek().is_none()) {
                break;
            }
        }

        let slice = slice.unwrap_or(state);
        self.odometry.append(Leg { begun, ended: sensed.stamp, state: self.history.last(), stretch, way });
        self.history.append(sensed.stamp, &slice, &state);
        Estimate { state, slice, emptied, contractions, rejected, components: 1, gaussian: None }
    }

    fn predict(&self, at: LocalTime) -> Prediction {
        self.travel.predict(&self.history.last(), at, self.local_s(at))
    }
}

#[cfg(test)]
mod tests;
