//! What AUVs answer: reports are checked, setpoints and pings booked.

use nalgebra::Vector3;
use shoal_bus::chronicle::{Enclosure, Violation, What};
use shoal_bus::lockstep::{Batch, Loss};
use shoal_bus::message::{Acted, Around, AuvId, Sensed};
use shoal_bus::time::SimTime;
use shoal_bus::traffic::{Fate, LossReason, Traffic};

use super::{Channel, Share, excuse, promises};
use crate::check::{self, Check};
use crate::parallel::{PIECE, share_out};
use crate::tally::{Excuse, Score};
use crate::vehicle::{Tick, Vehicle};

/// A report that says where neighbours are: to be checked when nobody moves any more.
pub(super) struct Sighting {
    /// Where the answer stands among its share's entries.
    entry: usize,
    tick: Tick,
    excuse: Option<Excuse>,
}

/// When answers are taken. In lockstep, their ticks lie between `begun` and `now`, and what they decide beyond.
#[derive(Clone, Copy)]
struct Moment {
    now: SimTime,
    /// The beginning of the window, where what is late is told.
    begun: SimTime,
    /// The past before this is forgotten.
    remembered: SimTime,
}

impl Channel {
    /// Takes back what the AUVs were told.
    pub(super) fn take_back(&mut self, mut sensed: Vec<Batch<Sensed>>) {
        for batch in sensed.drain(..) {
            if let Some(share) = self.shares.get_mut(batch.auv.0 as usize / PIECE) {
                share.sensed.push(batch);
            }
        }
        self.batches = sensed;
    }

    /// Takes what the AUVs answer to their ticks, each for itself.
    pub(super) fn take_answers(&mut self, answers: Vec<Batch<Acted>>) {
        for batch in answers {
            if let Some(share) = self.shares.get_mut(batch.auv.0 as usize / PIECE) {
                share.answers.push(batch);
            }
        }
        let moment = Moment { now: self.now, begun: self.accepted, remembered: self.remembered };
        let scores = &mut self.tally.scores;
        share_out(&mut self.vehicles, scores, &mut self.shares, |vehicles, scores, share| {
            chronicle_senses(share);
            for Batch { auv, items } in std::mem::take(&mut share.answers) {
                let index = auv.0 as usize % PIECE;
                if let (Some(vehicle), Some(score)) = (vehicles.get_mut(index), scores.get_mut(index)) {
                    let answered =
                        items.into_iter().try_for_each(|acted| answer(vehicle, score, acted, share, moment));
                    share.losses.extend(answered.err().map(|reason| Loss { auv, reason }));
                }
            }
        });
        for share in &mut self.shares {
            check_sightings(share, &self.vehicles);
            self.tally.counts.take(&mut share.counts);
        }
        let losses: Vec<Loss> = self.shares.iter_mut().flat_map(|share| share.losses.drain(..)).collect();
        losses.into_iter().for_each(|loss| self.lose(loss));
    }
}

/// Enters what was told in the window.
fn chronicle_senses(share: &mut Share) {
    let Share { counts, sensed, sensed_at, spare, .. } = share;
    let mut sensed_at = sensed_at.drain(..);
    for Batch { auv, mut items } in sensed.drain(..) {
        for (sensed, at) in items.drain(..).zip(&mut sensed_at) {
            counts.happened(at, auv, What::Sensed(sensed));
        }
        spare.items.push(items);
    }
}

/// Takes one answer: checks its report, books its setpoint and pings. The reason is why the AUV has lost its place.
fn answer(
    vehicle: &mut Vehicle,
    score: &mut Score,
    acted: Acted,
    share: &mut Share,
    moment: Moment,
) -> Result<(), String> {
    if !vehicle.alive {
        return Ok(());
    }
    let Some(tick) = vehicle.answer_tick() else {
        return Err("it answered a tick that it was not asked".to_owned());
    };
    vehicle.validate(&acted, &tick)?;

    let (auv, counts) = (vehicle.born.auv, &mut share.counts);
    let wake = vehicle.born.wake;
    let takes_effect = tick.stamp + wake.reaction_ns;
    let velocity_m_s = Vector3::from(acted.setpoint.velocity_m_s);
    let told_at = tick.at.max(moment.begun);
    vehicle.body.steer(vehicle.clock.reaches(takes_effect).max(moment.now), velocity_m_s);
    let offset_s = (tick.at.ns() - tick.stamp.ns()) as f64 * 1e-9;
    let report = &acted.report;
    let (promises, excuse) = (promises(&vehicle.born), excuse(vehicle, tick.at, tick.at));
    if promises {
        let at_tick = Check::of(Enclosure::Report)
            .position(&report.position_m, &tick.pose.position_m)
            .time(&report.clock_offset_s, offset_s)
            .violation();
        let between_ticks = Check::of(Enclosure::Slice)
            .position(&report.slice.position_m, &tick.between_position_m)
            .time(&report.slice.clock_offset_s, tick.between_offset_s)
            .violation();
        counts.check(auv, told_at, at_tick, excuse);
        counts.check(auv, told_at, between_ticks, excuse);
        if report.emptied.is_some() {
            counts.check(auv, told_at, Some(check::nothing(Enclosure::Emptied)), excuse);
            counts.noticed_after_ns.extend(vehicle.notices(tick.at));
        }
    }
    score.reported(report, &tick.pose.position_m, offset_s);
    for (index, ping) in acted.pings.iter().enumerate() {
        if ping.at < takes_effect || vehicle.clock.reaches(ping.at) < moment.now {
            // It never left, so it has no number but its place in the answer.
            let sequence = index as u32;
            let fate = Fate::lost(None, LossReason::Late, 0.0);
            counts.traffic(auv, Traffic { at: told_at, from: auv, sequence, fate });
        } else {
            vehicle.plan(ping.clone(), tick.at);
        }
    }
    if promises && !report.around.is_empty() && tick.at >= moment.remembered {
        share.sightings.push(Sighting { entry: counts.entries.len(), tick, excuse });
    }
    let acted = match share.spare.acted.pop() {
        Some(mut spare) => {
            *spare = acted;
            spare
        }
        None => Box::new(acted),
    };
    counts.happened(told_at, auv, What::Acted(acted));
    Ok(())
}

/// Checks where AUVs see their neighbours.
fn check_sightings(share: &mut Share, vehicles: &[Vehicle]) {
    let Share { counts, sightings, .. } = share;
    for Sighting { entry, tick, excuse } in sightings.drain(..) {
        let auv = counts.entries[entry].auv;
        for index in 0.. {
            let What::Acted(acted) = &counts.entries[entry].what else { break };
            let Some(&around) = acted.report.around.get(index) else { break };
            let violation = check_around(&around, &tick, vehicles);
            let excuse = excuse_around(auv, &around, tick.at, vehicles).or(excuse);
            counts.check(auv, counts.entries[entry].at, violation, excuse);
        }
    }
}

/// Why no promise covers where an AUV sees a neighbour at `at`, besides what excuses all that it states: its past sightings do not know
/// that one of both was carried elsewhere.
fn excuse_around(auv: AuvId, around: &Around, at: SimTime, vehicles: &[Vehicle]) -> Option<Excuse> {
    // No number of wrong pings is assumed of neighbours.
    if vehicles.get(auv.0 as usize).is_some_and(|vehicle| vehicle.is_deceived_at(at)) {
        return Some(Excuse::Misled);
    }
    let both = [auv, around.auv].into_iter().filter_map(|auv| vehicles.get(auv.0 as usize));
    let mut kidnapped = both.filter(|vehicle| vehicle.was_kidnapped_between(SimTime::ZERO, at));
    kidnapped.next().map(|_| Excuse::Kidnapped)
}

/// Checks where an AUV sees a neighbour at its tick, which lies in the window just advanced.
fn check_around(around: &Around, tick: &Tick, vehicles: &[Vehicle]) -> Option<Violation> {
    let Some(neighbour) = vehicles.get(around.auv.0 as usize) else {
        return Some(check::nothing(Enclosure::Around));
    };
    let apart_m = neighbour.body.position_at(tick.at) - tick.pose.position_m;
    Check::of(Enclosure::Around).horizontal(&around.position_m, &apart_m).violation()
}
