//! One receiver: the packets that are on their way to it, and what its modem makes of them.

use shoal_bus::message::{AuvId, Bounds};
use shoal_bus::time::{LocalTime, SimTime};
use shoal_bus::traffic::{Fate, LossReason, SoundPath};
use shoal_scenario::LISTEN_MAX_NS;
use shoal_scenario::model::{DutyCycle, MediumAccess, Scenario, Sea as SeaModel};

use crate::body::Vec3;
use crate::budget::{self, Link};
use crate::draw::{Draws, Purpose};
use crate::reception::{Arrival, ArrivalKind, Ear, EarSettings, Outcome, Verdict};
use crate::sound::{ARRIVAL_TOLERANCE_S, Told, Wavefront, Wavefronts};
use crate::vehicle::Vehicle;

use super::SeaWater;
use super::crossing::{Crossing, Meeting};

/// What a receiver has to do with sound.
pub struct Listener {
    auv: AuvId,
    /// Its modem; `None` for a deaf one.
    ear: Option<Ear>,
    /// What is settled and was not taken yet.
    pub told: Vec<Told>,
    /// Numbers of wavefronts that left for it and that it will never notice.
    pub beyond: Vec<u64>,
    duty_cycle: Option<DutyCycle>,
    /// What it is told about the speed of sound, in m/s.
    stated_m_s: Bounds,
    /// Packets on their way or being received; unused ones keep their memory.
    packets: Vec<Packet>,
    unused: Vec<u32>,
    /// Those with a path on which sound has not arrived yet.
    crossing: Vec<u32>,
    outcomes: Vec<Outcome>,
}

/// A packet on its way to one receiver, by several paths.
#[derive(Default)]
struct Packet {
    /// Its wavefront's number; `None` when unused.
    wavefront: Option<u64>,
    known: bool,
    paths: Vec<Path>,
    settled: bool,
}

struct Path {
    crossing: Crossing,
    met: Option<(Meeting, LocalTime)>,
}

impl Packet {
    fn has_arrived(&self) -> bool {
        self.paths.iter().all(|path| path.met.is_some())
    }

    fn is_done(&self) -> bool {
        self.settled && self.has_arrived()
    }
}

impl Listener {
    /// The listeners of a run, of whom nobody has heard yet; `vehicles` are all of its AUVs, newborn.
    pub fn all(scenario: &Scenario, sea: &SeaModel, vehicles: &[Vehicle]) -> impl Iterator<Item = Self> {
        vehicles.iter().map(|vehicle| {
            let auv = vehicle.born.auv;
            let group = &scenario.groups[usize::from(vehicle.born.group)];
            let ear = group.modem.physical.map(|physical| {
                let listens = matches!(group.modem.access, MediumAccess::Csma { .. });
                let settings = EarSettings {
                    noise_db: budget::noise_db(sea, &physical),
                    physical,
                    fading: sea.fading,
                    sense_ns: if listens { LISTEN_MAX_NS } else { 0 },
                };
                Ear::new(settings, Draws::new(scenario.seed, Purpose::Reception, auv, scenario.noise))
            });
            Self {
                auv,
                ear,
                told: Vec::new(),
                beyond: Vec::new(),
                duty_cycle: group.modem.duty_cycle,
                stated_m_s: vehicle.born.modem.sound_speed_m_s,
                packets: Vec::new(),
                unused: Vec::new(),
                crossing: Vec::new(),
                outcomes: Vec::new(),
            }
        })
    }

    /// Its own modem emits.
    pub fn emit(&mut self, wavefront: &Wavefront) {
        if let Some(ear) = &mut self.ear {
            ear.emit(wavefront.emitted, wavefront.emitted + wavefront.packet_ns);
        }
    }

    /// Whether its modem has heard nothing, and not emitted, between `since` and `now`, up to which it has listened.
    pub fn is_quiet(&self, since: SimTime, now: SimTime) -> bool {
        self.ear.as_ref().is_none_or(|ear| !ear.busy(since, now))
    }

    /// The number of the earliest wavefront that it waits for.
    pub fn waits_for(&self) -> Option<u64> {
        self.packets.iter().filter_map(|packet| packet.wavefront).min()
    }

    /// A packet too faint to be noticed leaves `distance_m` away; all that matters of it is its energy.
    pub fn disturb(&mut self, wavefront: &Wavefront, level_db: f64, distance_m: f64, water: &SeaWater) {
        let Some(ear) = &mut self.ear else { return };
        let start = wavefront.emitted + (distance_m / water.slowest_m_s * 1e9) as i64;
        ear.expect(Arrival {
            from: wavefront.from,
            sequence: wavefront.sequence,
            path: SoundPath::Direct,
            start,
            end: start + wavefront.packet_ns,
            level_db,
            doppler: 1.0,
            flight: 0,
            kind: ArrivalKind::Interference,
        });
    }

    /// A packet leaves for this receiver, who is at `place_m`. False when no path leads to it that is loud enough to matter.
    pub fn await_packet(
        &mut self,
        (wavefront_number, wavefront): (u64, &Wavefront),
        paths: &[SoundPath],
        link: &Link,
        water: &SeaWater,
        speed_ratio: f64,
        place_m: Vec3,
    ) -> bool {
        let number = self.unused.pop().unwrap_or_else(|| {
            self.packets.push(Packet::default());
            self.packets.len() as u32 - 1
        });
        let packet = &mut self.packets[number as usize];
        packet.paths.clear();
        let range_m = (place_m - wavefront.origin_m).xy().norm();
        let depths_m = [-wavefront.origin_m.z, -place_m.z];
        for &path in paths {
            if water.shortest_m(path, depths_m, range_m) > link.floor_m {
                continue;
            }
            let Some((ray, bounces_db)) = water.ray(path, depths_m, range_m, link.frequency_khz) else {
                continue;
            };
            let level_db = link.level_db(ray.length_m, bounces_db);
            if level_db >= link.floor_db {
                let crossing = Crossing::new(path, ray, [range_m, depths_m[1]], level_db, speed_ratio);
                packet.paths.push(Path { crossing, met: None });
            }
        }
        if packet.paths.is_empty() {
            self.unused.push(number);
            return false;
        }
        packet.wavefront = Some(wavefront_number);
        packet.known = link.known;
        packet.settled = false;
        self.crossing.push(number);
        true
    }

    /// Lets all sound arrive that arrives before `horizon`, and settles what can be settled by then.
    pub fn listen(
        &mut self,
        horizon: SimTime,
        vehicle: &mut Vehicle,
        water: &SeaWater,
        wavefronts: &Wavefronts,
    ) {
        self.arrive(horizon, vehicle, water, wavefronts);
        let Some(ear) = &mut self.ear else { return };
        let mut outcomes = std::mem::take(&mut self.outcomes);
        ear.settle(horizon, &mut outcomes);
        for outcome in outcomes.drain(..) {
            let told = self.settle(outcome, wavefronts);
            self.told.extend(told);
        }
        self.outcomes = outcomes;
    }

    /// Packets on their way that are not settled.
    pub fn unsettled(&self) -> usize {
        self.packets.iter().filter(|packet| packet.wavefront.is_some() && !packet.settled).count()
    }

    fn arrive(&mut self, horizon: SimTime, vehicle: &mut Vehicle, water: &SeaWater, wavefronts: &Wavefronts) {
        let Some(ear) = &mut self.ear else { return };
        let speed_ratio = vehicle.ground_speed_m_s / water.slowest_m_s;
        let (packets, unused, duty_cycle) = (&mut self.packets, &mut self.unused, self.duty_cycle);
        self.crossing.retain(|&number| {
            let packet = &mut packets[number as usize];
            let Some(wavefront) = packet.wavefront.map(|number| wavefronts.get(number)) else { return false };
            let copies = packet.paths.len() as u8;
            for path in packet.paths.iter_mut().filter(|path| path.met.is_none()) {
                let body = &vehicle.body;
                let Some(meeting) = path.crossing.meet(wavefront, body, speed_ratio, water, horizon) else {
                    continue;
                };
                let Meeting { start, doppler, .. } = meeting;
                let end = start + (wavefront.packet_ns as f64 / doppler).ceil() as i64;
                let stamp = vehicle.clock.read(start);
                let asleep =
                    duty_cycle.is_some_and(|cycle| !is_awake(&cycle, stamp, vehicle.clock.read(end)));
                path.met = Some((meeting, stamp));
                ear.expect(Arrival {
                    from: wavefront.from,
                    sequence: wavefront.sequence,
                    path: path.crossing.path,
                    start,
                    end,
                    level_db: path.crossing.level_db,
                    doppler,
                    flight: number,
                    kind: ArrivalKind::Packet {
                        copies,
                        bits: 8 * wavefront.frame.bytes().len() as u32,
                        asleep,
                        known: packet.known,
                    },
                });
            }
            if packet.is_done() {
                packet.wavefront = None;
                unused.push(number);
            }
            !packet.has_arrived()
        });
    }

    fn settle(&mut self, outcome: Outcome, wavefronts: &Wavefronts) -> Option<Told> {
        let Outcome { arrival, at, reception, verdict } = outcome;
        let packet = self.packets.get_mut(arrival.flight as usize)?;
        let number = packet.wavefront?;
        let wavefront = wavefronts.get(number);
        let (meeting, stamp) = packet.paths.iter().find(|path| path.crossing.path == arrival.path)?.met?;
        let (to, range_m) = (self.auv, meeting.range_m);
        let fate = match verdict {
            Verdict::Heard => {
                let travel_s = (meeting.start - wavefront.emitted) as f64 * 1e-9;
                Fate::Heard {
                    to,
                    range_m,
                    travel_s,
                    box_width_m: wavefront.box_width_m,
                    reception: Some(reception),
                    outlier: !explains(&self.stated_m_s, range_m, meeting.range_error_m, travel_s),
                }
            }
            Verdict::Lost { reason, colliding } => {
                let is_direct = |path: &Path| path.crossing.path == SoundPath::Direct;
                let in_shadow = reason == LossReason::Noise && !packet.paths.iter().any(is_direct);
                let reason = if in_shadow { LossReason::Shadow } else { reason };
                Fate::Lost { to: Some(to), reason, range_m, reception: Some(reception), colliding }
            }
        };
        packet.settled = true;
        if packet.is_done() {
            packet.wavefront = None;
            self.unused.push(arrival.flight);
        }
        Some(Told { at, wavefront: number, fate, stamp: Some(stamp), incidence: Some(meeting.incidence) })
    }
}

/// Whether a modem listens from one local time to another without a break.
fn is_awake(cycle: &DutyCycle, from: LocalTime, to: LocalTime) -> bool {
    let since_waking_ns = from.ns().rem_euclid(cycle.period_ns);
    cycle.awake_ns >= cycle.period_ns || since_waking_ns + (to - from) < cycle.awake_ns
}

/// Whether a speed of sound within these bounds explains such a travel time, whatever the range's error is: the AUV allows for
/// no more than the tolerance of its arrival.
fn explains(stated_m_s: &Bounds, range_m: f64, range_error_m: f64, travel_s: f64) -> bool {
    let (soonest_s, latest_s) = ((travel_s - ARRIVAL_TOLERANCE_S).max(0.0), travel_s + ARRIVAL_TOLERANCE_S);
    stated_m_s.lower * soonest_s <= range_m - range_error_m
        && range_m + range_error_m <= stated_m_s.upper * latest_s
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_outlier_is_within_what_the_auv_allows_for() {
        let stated_m_s = Bounds::new(1_480.0, 1_520.0);
        let (tolerance_m, moved_m) = (1_480.0 * ARRIVAL_TOLERANCE_S, 1e-5);
        // An echo as late as can be, of which the receiver may be nearer by what it moves meanwhile.
        let nearest_m = 1_480.0 - tolerance_m;
        assert!(explains(&stated_m_s, nearest_m + moved_m + 1e-9, moved_m, 1.0));
        assert!(!explains(&stated_m_s, nearest_m + moved_m - 1e-9, moved_m, 1.0));
        let farthest_m = 1_520.0 * (1.0 + ARRIVAL_TOLERANCE_S);
        assert!(explains(&stated_m_s, farthest_m - moved_m - 1e-9, moved_m, 1.0));
        assert!(!explains(&stated_m_s, farthest_m - moved_m + 1e-9, moved_m, 1.0));
        assert!(explains(&stated_m_s, 0.0, 0.0, 0.0));
    }
}
