//! A ping between two trajectories.

use std::collections::BTreeMap;

use shoal_bus::message::{Born, Sense};
use shoal_bus::ping::Ping;
use shoal_bus::time::LocalTime;
use shoal_interval::contractor::{Contracted, contract_range};
use shoal_interval::{Interval, IntervalBox};

use super::{Recorded, Trajectory};
use crate::bounds::{interval, interval_box};
use crate::state::Sound;
use crate::travel::{local_s, seconds};

/// A ping that was heard.
#[derive(Clone, Debug)]
pub struct Exchange {
    /// Who emitted it, and when; unknown when the record has lost the booking.
    pub emission: Option<Event>,
    /// Who heard it, and when.
    pub reception: Event,
    /// Where and when the emitter was at the emission: what the ping says, then what its trajectory says.
    pub emitter: Place,
    /// Where and when the receiver was at the reception.
    pub receiver: Place,
    /// What the receiver knows of sound.
    pub sound: Sound,
    /// Whether it left nothing.
    pub is_dropped: bool,
}

/// Which end of a ping.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum End {
    /// Where it left.
    Emission,
    /// Where it arrived.
    Reception,
}

/// An end of a ping, by the clock of the AUV there.
#[derive(Clone, Copy, Debug)]
pub struct Event {
    /// Which AUV.
    pub auv: usize,
    /// The moment of its trajectory to which the end belongs.
    pub stamp: LocalTime,
    /// Its stamp in seconds of local time, with every tolerance.
    pub stamp_s: Interval,
    /// Local seconds by which it may differ from that moment.
    pub apart_s: f64,
}

/// A position at a true time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// In metres.
    pub position_m: IntervalBox<3>,
    /// In seconds.
    pub time_s: Interval,
}

/// Nothing is known.
const ANYWHERE: Place = Place { position_m: IntervalBox::ENTIRE, time_s: Interval::ENTIRE };

impl Exchange {
    /// Takes in where its ends are now.
    pub fn look(&mut self, trajectories: &[Trajectory]) {
        let place = |event: &Event| trajectories.get(event.auv)?.place(event);
        if let Some(emitter) = self.emission.as_ref().and_then(place) {
            self.emitter = emitter;
        }
        if let Some(receiver) = place(&self.reception) {
            self.receiver = receiver;
        }
    }

    /// Contracts `own`, where the AUV at one end is, by what is known of the other end. None when nothing is left.
    pub fn contract(&self, end: End, own: &Place) -> Option<Place> {
        let (mut emitter, mut receiver) = (self.emitter, self.receiver);
        match end {
            End::Emission => emitter = *own,
            End::Reception => receiver = *own,
        }
        let mut speed_m_s = self.sound.speed_m_s;
        let longest_delay_s = Interval::spanning(0.0, self.sound.hearing_range_m) / speed_m_s;
        receiver.time_s = receiver.time_s.intersection(emitter.time_s + longest_delay_s);
        emitter.time_s = emitter.time_s.intersection(receiver.time_s - longest_delay_s);
        let contracted = contract_range(
            &mut receiver.position_m,
            &mut emitter.position_m,
            &mut speed_m_s,
            &mut receiver.time_s,
            &mut emitter.time_s,
        );
        let own = if end == End::Emission { emitter } else { receiver };
        (contracted != Contracted::Empty && !own.time_s.is_empty()).then_some(own)
    }
}

impl Event {
    /// What happened to an AUV at `stamp`, which is off by `error_s` seconds besides the stamp's own tolerance.
    fn new(auv: usize, born: &Born, stamp: LocalTime, error_s: f64) -> Self {
        let stamp_s = born.clock.stamp_ns as f64 * 1e-9;
        // A stamp may precede the birth by its own error.
        let within_life = stamp.max(born.birth);
        let apart_s = seconds(within_life - stamp) + error_s + 2.0 * stamp_s;
        Self { auv, stamp: within_life, stamp_s: local_s(stamp, stamp_s).inflate(error_s), apart_s }
    }
}

/// All pings that were heard, in the order of receivers and of what they heard, and for each AUV the moments of its pings.
///
/// A ping is known by its bytes, which say who sent it, its number and when. Should two have the same, neither is taken for the
/// other: only what they say counts.
pub fn exchanges(auvs: &[Recorded]) -> (Vec<Exchange>, Vec<Vec<LocalTime>>) {
    let mut booked: BTreeMap<&[u8], Option<Event>> = BTreeMap::new();
    for (auv, recorded) in auvs.iter().enumerate() {
        for ping in &recorded.booked {
            let event = Event::new(auv, &recorded.born, ping.at, 0.0);
            booked.entry(ping.frame.bytes()).and_modify(|other| *other = None).or_insert(Some(event));
        }
    }
    let mut exchanges = Vec::new();
    let mut moments = vec![Vec::new(); auvs.len()];
    for (auv, recorded) in auvs.iter().enumerate() {
        let modem = &recorded.born.modem;
        let sound =
            Sound { speed_m_s: interval(modem.sound_speed_m_s), hearing_range_m: modem.hearing_range_m };
        for event in recorded.sensed.iter().flat_map(|sensed| &sensed.events) {
            let Sense::Heard { frame } = &event.sense else { continue };
            let emission =
                booked.get(frame.bytes()).copied().flatten().filter(|emission| emission.auv != auv);
            // A trajectory says where its AUV was, whatever the frame says. A frame alone must be certain, as a Gaussian is not.
            let emitter = match Ping::decode(frame) {
                Ok(ping) => {
                    Place { position_m: interval_box(&ping.position_m), time_s: interval(ping.emission_s) }
                }
                Err(_) if emission.is_some() => ANYWHERE,
                Err(_) => continue,
            };
            let reception = Event::new(auv, &recorded.born, event.stamp, modem.timestamp_s);
            for end in emission.iter().chain([&reception]) {
                moments[end.auv].push(end.stamp);
            }
            exchanges.push(Exchange {
                emission,
                reception,
                emitter,
                receiver: ANYWHERE,
                sound,
                is_dropped: false,
            });
        }
    }
    (exchanges, moments)
}
