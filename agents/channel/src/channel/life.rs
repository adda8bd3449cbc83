//! What happens to the AUVs in a window, each for itself: pings arrive, ticks come.

use shoal_bus::chronicle::{Truth, What};
use shoal_bus::lockstep::Batch;
use shoal_bus::message::Sensed;
use shoal_bus::time::SimTime;
use shoal_bus::traffic::{Fate, LossReason, Traffic};

use super::{Channel, Share};
use crate::medium::{Level, Receiver};
use crate::parallel::share_out;
use crate::sound::{Told, Wavefronts};
use crate::tally::Counts;
use crate::vehicle::Vehicle;

impl Channel {
    /// All that is settled and all ticks before `to`: what each AUV senses, sorted by AUV.
    pub(super) fn live(&mut self, to: SimTime) -> Vec<Batch<Sensed>> {
        let (level, wavefronts) = (&self.medium.level, &self.medium.wavefronts);
        let receivers = &mut self.medium.receivers;
        share_out(&mut self.vehicles, receivers, &mut self.shares, |vehicles, receivers, share| {
            share.waits_for = None;
            for (vehicle, receiver) in vehicles.iter_mut().zip(receivers) {
                hear(level, wavefronts, receiver, vehicle, to, share);
                tick(vehicle, to, share);
            }
        });
        let mut batches = Vec::with_capacity(self.vehicles.len());
        for share in &mut self.shares {
            self.tally.counts.take(&mut share.counts);
            batches.append(&mut share.batches);
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
    let Share { told, counts, waits_for, .. } = share;
    level.hear(receiver, vehicle, wavefronts, to, told);
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
    let Share { counts, batches, spare, .. } = share;
    let auv = vehicle.born.auv;
    let mut items = Vec::new();
    while vehicle.next_tick_at() < to {
        let (tick, sensed) = vehicle.sense();
        let truth = Truth {
            tick: tick.index,
            local: tick.stamp,
            position_m: tick.pose.position_m.into(),
            velocity_m_s: tick.pose.water_velocity_m_s.into(),
            heading_rad: tick.pose.attitude.heading_rad,
            pitch_rad: tick.pose.attitude.pitch_rad,
        };
        counts.happened(tick.at, auv, What::Truth(truth));
        let mut events = spare.pop().unwrap_or_default();
        events.clone_from(&sensed.events);
        counts.happened(tick.at, auv, What::Sensed(Sensed { events, ..sensed }));
        items.push(sensed);
    }
    batches.push(Batch { auv, items });
}
