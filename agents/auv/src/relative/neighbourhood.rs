//! All neighbours, followed by what an AUV senses.

use std::collections::BTreeMap;

use shoal_bus::message::{AuvId, Born, Event, Measures, Relative, Sense, Sensed};
use shoal_bus::ping::Ping;
use shoal_bus::time::LocalTime;
use shoal_interval::{Interval, IntervalBox};

use super::fellow::Fellow;
use super::{Sighting, Track, horizontal_m};
use crate::bounds::{interval, interval_box, measured};
use crate::motion::{Motion, Stretch};
use crate::odometry::{Leg, Odometry, Way};
use crate::state::{Sound, State};
use crate::travel::{seconds, velocity};

/// A packet that began longer ago than this says nothing any more, in local nanoseconds.
const HORIZON_NS: i64 = 60_000_000_000;
/// What several sightings leave is paved as finely as this after each ping, with so many boxes at most.
const PRECISION_M: f64 = 2.0;
const BOXES: usize = 32;

/// Encloses every neighbour that was heard.
///
/// It needs the own clock, for the ranges, and the own depth, as a ping tells its sender's; of the own horizontal position and of what a
/// ping says of its sender's it knows nothing.
pub struct Neighbourhood {
    settings: Relative,
    motion: Motion,
    fellow: Fellow,
    sound: Sound,
    timestamp_s: f64,
    stamp_s: f64,
    now: LocalTime,
    velocity_m_s: IntervalBox<3>,
    odometry: Odometry,
    followed: BTreeMap<AuvId, Followed>,
}

/// One neighbour: where it was at the emission of its last ping, seen from where the body is now.
struct Followed {
    track: Track,
    emission_s: Interval,
    velocity_m_s: IntervalBox<3>,
}

impl Neighbourhood {
    /// Nobody was heard yet.
    pub fn new(born: &Born, settings: Relative) -> Self {
        let motion = Motion::new(&born.body, &born.clock);
        Self {
            settings,
            velocity_m_s: motion.any_velocity(),
            motion,
            fellow: Fellow::new(&settings.fellows),
            sound: Sound {
                speed_m_s: interval(born.modem.sound_speed_m_s),
                hearing_range_m: born.modem.hearing_range_m,
            },
            timestamp_s: born.modem.timestamp_s,
            stamp_s: born.clock.stamp_ns as f64 * 1e-9,
            now: born.birth,
            odometry: Odometry::new(HORIZON_NS),
            followed: BTreeMap::new(),
        }
    }

    /// Takes in one tick, at which the own state is enclosed by `own`.
    pub fn update(&mut self, sensed: &Sensed, own: &State) {
        self.move_on(sensed, own);
        for event in &sensed.events {
            let Sense::Heard { frame } = &event.sense else { continue };
            let Ok(ping) = Ping::decode(frame) else { continue };
            let bearing_rad = bearing_rad(event, &ping, sensed);
            self.hear(event.stamp, &ping, bearing_rad, own);
        }
    }

    /// Where the neighbours are at the last tick, seen from the body, in metres east and north; sorted by AUV.
    pub fn around(&self, own: &State) -> impl Iterator<Item = (AuvId, IntervalBox<2>)> {
        let now_s = own.true_time_s(self.local_s(self.now));
        self.followed.iter().map(move |(&auv, followed)| {
            let moved_m = self.fellow.since(&followed.velocity_m_s, now_s - followed.emission_s);
            (auv, followed.track.position_m() + moved_m)
        })
    }

    fn local_s(&self, stamp: LocalTime) -> Interval {
        let seconds = stamp.as_s();
        Interval::centred(seconds, self.stamp_s + seconds.abs() * f64::EPSILON)
    }

    /// The body's own motion since the last tick.
    fn move_on(&mut self, sensed: &Sensed, own: &State) {
        let length_s = seconds(sensed.stamp - self.now);
        let possible_m_s = self.motion.velocity_after(&self.velocity_m_s, length_s);
        let logged_m_s = sensed.events.iter().rev().find_map(|event| match event.sense {
            Sense::Inertial { heading_rad, pitch_rad, speed_m_s } => {
                let then_m_s = velocity(heading_rad, pitch_rad, speed_m_s);
                Some(self.motion.velocity_after(&then_m_s, seconds(sensed.stamp - event.stamp)))
            }
            _ => None,
        });
        let after_m_s = logged_m_s.map_or(possible_m_s, |logged_m_s| {
            let both_m_s = possible_m_s.intersection(&logged_m_s);
            if both_m_s.is_empty() { logged_m_s } else { both_m_s }
        });
        let stretch = Stretch {
            before_m_s: self.velocity_m_s,
            after_m_s,
            current_m_s: self.motion.any_current(),
            length_s,
        };
        let way = Way::from(&self.motion.over(&stretch, 0.0, length_s));
        self.odometry.append(Leg { begun: self.now, ended: sensed.stamp, state: *own, stretch, way });
        (self.now, self.velocity_m_s) = (sensed.stamp, after_m_s);
        for followed in self.followed.values_mut() {
            followed.track.carry(&-horizontal(&way.displacement_m));
        }
    }

    fn hear(&mut self, stamp: LocalTime, ping: &Ping, bearing_rad: Option<Interval>, own: &State) {
        let Some((_, way)) = self.odometry.recall(stamp, &self.motion) else { return };
        let since = Way::within(&self.motion, self.timestamp_s + 2.0 * self.stamp_s).then(&way);
        let Some(mut sighting) = self.sighting(stamp, ping, bearing_rad, &since.back(own)) else { return };
        sighting.carry(&-horizontal(&since.displacement_m));

        let emission_s = interval(ping.emission_s);
        let velocity_m_s = match self.settings.exchanged {
            true => interval_box(&ping.velocity_m_s),
            false => self.fellow.any_velocity(),
        };
        let remembered = usize::from(self.settings.remembered);
        let followed = self.followed.entry(ping.sender).or_insert_with(|| Followed {
            track: Track::new(IntervalBox::ENTIRE, remembered),
            emission_s,
            velocity_m_s,
        });
        if followed.track.sightings() > 0 {
            let between_s = emission_s - followed.emission_s;
            // What was emitted before the last ping, and is told after it, is no news.
            if between_s.lower() <= 0.0 {
                return;
            }
            followed.track.carry(&self.fellow.between(&followed.velocity_m_s, &velocity_m_s, between_s));
        }
        followed.track.see(sighting);
        if remembered > 1 {
            followed.track.refine(PRECISION_M, BOXES);
        }
        (followed.emission_s, followed.velocity_m_s) = (emission_s, velocity_m_s);
    }

    /// What a ping tells that arrived when the own state was `then`; nothing when it has not what is asked for.
    fn sighting(
        &self,
        stamp: LocalTime,
        ping: &Ping,
        bearing_rad: Option<Interval>,
        then: &State,
    ) -> Option<Sighting> {
        let reception_s = then.true_time_s(self.local_s(stamp).inflate(self.timestamp_s));
        let slant_m = (reception_s - interval(ping.emission_s)) * self.sound.speed_m_s;
        let heard_m = Interval::spanning(0.0, self.sound.hearing_range_m);
        let above_m = interval(ping.position_m[2]) - then.position_m[2];
        let range_m = horizontal_m(slant_m.intersection(heard_m), above_m);
        match self.settings.measures {
            Measures::RangeAndBearing => Some(Sighting::new(range_m, bearing_rad?)),
            Measures::Bearing => Some(Sighting::new(heard_m, bearing_rad?)),
            Measures::Range => Some(Sighting::new(range_m, Interval::ENTIRE)),
        }
    }
}

/// The direction of a ping that was heard, counter-clockwise from east, if an array measured it.
fn bearing_rad(heard: &Event, ping: &Ping, sensed: &Sensed) -> Option<Interval> {
    sensed.events.iter().filter(|event| event.stamp == heard.stamp).find_map(|event| match event.sense {
        Sense::Bearing { sender, azimuth_rad, heading_rad, .. } if sender == ping.sender => {
            Some(measured(heading_rad) + measured(azimuth_rad))
        }
        _ => None,
    })
}

/// East and north.
fn horizontal(of: &IntervalBox<3>) -> IntervalBox<2> {
    IntervalBox::from([of[0], of[1]])
}

#[cfg(test)]
mod tests;
