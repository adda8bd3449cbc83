//! What happens to the AUVs in a window, each for itself: pings arrive, ticks come.

use shoal_bus::chronicle::{Truth, What};
use shoal_bus::lockstep::Batch;
use shoal_bus::message::Sensed;
use shoal_bus::time::SimTime;
use shoal_bus::traffic::{Fate, LossReason, Traffic};

use super::{Channel, Moment, Share, flying};
use crate::flock::Flock;
use crate::medium::{Level, Receiver};
use crate::parallel::share_out;
use crate::sound::{Told, Wavefronts};
use crate::tally::Counts;
use crate::vehicle::Vehicle;

impl Channel {
    /// All motion, all that is settled and all ticks before `to`: what each AUV senses, sorted by AUV.
    ///
    /// Each AUV has its whole window at once, while it is at hand in the processor's cache.
    pub(super) fn live(&mut self, to: SimTime) -> Vec<Batch<Sensed>> {
        let (now, remembered) = (self.now, self.remembered);
        let (level, wavefronts) = (&self.medium.level, &self.medium.wavefronts);
        let receivers = &mut self.medium.receivers;
        let moments: Vec<SimTime> = Flock::samples(now, to).collect();
        share_out(&mut self.vehicles, receivers, &mut self.shares, |vehicles, receivers, share| {
            share.waits_for = None;
            for (vehicle, receiver) in vehicles.iter_mut().zip(receivers) {
                vehicle.move_on(remembered, to);
                hear(level, wavefronts, receiver, vehicle, to, share);
                tick(vehicle, to, share);
                share.moments_m.extend(moments.iter().map(|&at| vehicle.body.position_at(at)));
                share.places_m.push(vehicle.body.position_at(to));
            }
        });
        for (index, &at) in moments.iter().enumerate() {
            let mut positions_m = Vec::with_capacity(self.vehicles.len());
            for share in &self.shares {
                positions_m.extend(share.moments_m.iter().skip(index).step_by(moments.len()));
            }
            let is_told = self.is_flock_watched && Flock::is_second(at);
            let flying = is_told.then(|| flying(&self.vehicles, at));
            self.moments[0].push(Moment { at, positions_m, flying });
        }
        self.tell_departures();
        let mut batches = std::mem::take(&mut self.batches);
        self.places_m.clear();
        for share in &mut self.shares {
            self.tally.counts.take(&mut share.counts);
            self.places_m.append(&mut share.places_m);
            batches.append(&mut share.batches);
            share.moments_m.clear();
        }
        let waits_for = self.shares.iter().filter_map(|share| share.waits_for).min();
        let wavefronts = &mut self.medium.wavefronts;
        wavefronts.forget_before(waits_for.unwrap_or(wavefronts.next()));
        batches
    }
}

/// All pings that are settled at one receiver before `to`.
fn hear(
    level: &Level,
    wavefronts: &Wavefronts,
    receiver: &mut Receiver,
    vehicle: &mut Vehicle,
    to: SimTime,
    share: &mut Share,
) {
    let Share { told, beyond, counts, waits_for, .. } = share;
    level.hear(receiver, vehicle, wavefronts, to, (told, beyond));
    told.sort_by_key(|told| {
        let wavefront = wavefronts.get(told.wavefront);
        (told.at, wavefront.from, wavefront.sequence)
    });
    for told in told.drain(..) {
        take_in(told, wavefronts, vehicle, counts);
    }
    // The earliest of all, of whom some wait for none.
    *waits_for = waits_for.iter().copied().chain(receiver.waits_for()).min();
}

/// What one ping is to its receiver.
fn take_in(told: Told, wavefronts: &Wavefronts, receiver: &mut Vehicle, counts: &mut Counts) {
    let Told { at, wavefront, mut fate, stamp, incidence } = told;
    let wavefront = wavefronts.get(wavefront);
    let (from, sequence, to) = (wavefront.from, wavefront.sequence, receiver.born.auv);
    match fate {
        Fate::Heard { range_m, .. } if !receiver.alive => {
            fate = Fate::lost(Some(to), LossReason::Dead, range_m);
        }
        Fate::Heard { range_m, .. } if receiver.was_kidnapped_between(wavefront.emitted, at) => {
            fate = Fate::lost(Some(to), LossReason::Asleep, range_m);
        }
        Fate::Heard { ref mut outlier, .. } => {
            let late_ns = receiver.draw_false_arrival();
            *outlier |= late_ns.is_some();
            let is_false = *outlier || wavefront.is_false;
            receiver.hear(at, stamp, late_ns.unwrap_or(0), wavefront, incidence.as_ref(), is_false);
        }
        _ => {}
    }
    counts.traffic(to, Traffic { at, from, sequence, fate });
}

/// All ticks of one AUV before `to`.
fn tick(vehicle: &mut Vehicle, to: SimTime, share: &mut Share) {
    if !vehicle.alive || vehicle.next_tick_at() >= to {
        return;
    }
    let Share { counts, batches, sensed_at, spare, .. } = share;
    let auv = vehicle.born.auv;
    let mut items = spare.items.pop().unwrap_or_default();
    while vehicle.next_tick_at() < to {
        let (tick, sensed) = vehicle.sense(spare.events.pop().unwrap_or_default());
        let truth = Truth {
            tick: tick.index,
            local: tick.stamp,
            position_m: tick.pose.position_m.into(),
            velocity_m_s: tick.pose.water_velocity_m_s.into(),
            heading_rad: tick.pose.attitude.heading_rad,
            pitch_rad: tick.pose.attitude.pitch_rad,
        };
        counts.happened(tick.at, auv, What::Truth(truth));
        // What it sensed is chronicled when it comes back.
        sensed_at.push(tick.at);
        items.push(sensed);
    }
    batches.push(Batch { auv, items });
}
