//! Pings that leave: who is held back, what the payload is worth, whom it may touch.

use shoal_bus::chronicle::{Enclosure, Violation};
use shoal_bus::message::{AuvId, Born, box_width};
use shoal_bus::ping::{Frame, Payload};
use shoal_bus::time::SimTime;
use shoal_bus::traffic::{Fate, LossReason, Traffic};

use super::{Channel, excuse, promises};
use crate::body::Vec3;
use crate::check::{self, Check};
use crate::parallel::share_out;
use crate::sound::Wavefront;
use crate::vehicle::Planned;

impl Channel {
    /// All pings that leave before `to`. Bodies that emit move to there, the others may wait for their turn.
    pub(super) fn depart(&mut self, to: SimTime) {
        self.let_go(to);
        let mut leaving: Vec<(AuvId, Planned)> = Vec::new();
        for share in &mut self.shares {
            leaving.append(&mut share.leaving);
        }
        if leaving.is_empty() {
            return;
        }
        self.grid.sort(&self.places_m, self.medium.level.farthest_m() / CELLS_IN_REACH);
        let leapt_m = self.shares.iter().map(|share| share.leapt_m).fold(0.0, f64::max);
        if leaving.iter().any(|(_, planned)| planned.listen_ns > 0) {
            // What a modem hears decides whether it emits, so what came before has to be known.
            leaving.sort_by_key(|&(auv, planned)| (planned.at, auv));
            for (from, planned) in leaving {
                self.emit(from, planned, leapt_m);
                self.medium.spread(&self.grid);
            }
        } else {
            // Otherwise only an emitter's own order counts, and neighbours in space share neighbours in memory.
            leaving.sort_by_key(|&(auv, planned)| (self.grid.cell_of(auv.0 as usize), auv, planned.at));
            for (from, planned) in leaving {
                self.emit(from, planned, leapt_m);
            }
            self.medium.spread(&self.grid);
        }
    }

    fn let_go(&mut self, to: SimTime) {
        let (now, remembered) = (self.now, self.remembered);
        let receivers = &mut self.medium.receivers;
        share_out(&mut self.vehicles, receivers, &mut self.shares, |vehicles, _, share| {
            share.leapt_m = 0.0;
            for vehicle in vehicles {
                if vehicle.is_ever_kidnapped() || vehicle.emits_before(to) {
                    vehicle.move_on(remembered, to);
                    share.leapt_m = share.leapt_m.max(vehicle.body.leapt_since(now));
                }
                while let Some(planned) = vehicle.next_emission(to) {
                    share.leaving.push((vehicle.born.auv, planned));
                }
            }
        });
    }

    /// One ping that leaves; kidnappers carried nobody farther than `leapt_m` since `now`.
    fn emit(&mut self, from: AuvId, planned: Planned, leapt_m: f64) {
        let at = planned.at;
        if let Some(reason) = self.held_back(from, &planned) {
            let sequence = self.vehicles[from.0 as usize].emitted;
            let fate = Fate::lost(None, reason, 0.0);
            self.tally.counts.traffic(from, Traffic { at, from, sequence, fate });
            return;
        }
        let emitter = &mut self.vehicles[from.0 as usize];
        let group = emitter.born.group;
        let packet_ns = self.medium.level.packet_ns(group, planned.frame.bytes().len() as u16);
        let sequence = emitter.emitted;
        emitter.emitted += 1;
        emitter.emits_until = at + packet_ns;
        let pose = emitter.body.at(at);
        let excuse = excuse(emitter, at, planned.booked);
        let Checked { is_promise, violation, box_width_m } =
            check_ping(&emitter.born, at, &planned.frame, &pose.position_m, &pose.ground_velocity_m_s);
        let wavefront = Wavefront {
            from,
            group,
            sequence,
            emitted: at,
            packet_ns,
            origin_m: pose.position_m,
            velocity_m_s: pose.ground_velocity_m_s,
            frame: planned.frame,
            box_width_m,
            range_m: emitter.born.modem.range_m,
            is_false: violation.is_some(),
        };
        let moved_m = self.fastest_m_s * ((at - self.now) as f64 * 1e-9) + 1e-6 + leapt_m;
        self.medium.emit(wavefront, moved_m);
        if is_promise {
            self.tally.counts.check(from, at, violation, excuse);
        }
    }

    /// Tells of all that left in the window, when it is known who will never notice it.
    pub(super) fn tell_departures(&mut self) {
        let counts = &mut self.tally.counts;
        let beyond = self.shares.iter_mut().flat_map(|share| share.beyond.drain(..));
        self.medium.departed(beyond, |wavefront, beyond_range| {
            let &Wavefront { from, sequence, emitted: at, origin_m, box_width_m, packet_ns, .. } = wavefront;
            let fate = Fate::Emitted {
                position_m: origin_m.into(),
                bytes: wavefront.frame.bytes().len() as u16,
                box_width_m,
                beyond_range,
                packet_s: packet_ns as f64 * 1e-9,
            };
            counts.traffic(from, Traffic { at, from, sequence, fate });
        });
    }

    /// Why a modem does not emit what is booked for now, if it does not.
    fn held_back(&mut self, from: AuvId, planned: &Planned) -> Option<LossReason> {
        let at = planned.at;
        if at < self.vehicles[from.0 as usize].emits_until {
            return Some(LossReason::HalfDuplex);
        }
        if planned.listen_ns == 0 {
            return None;
        }
        if self.medium.is_quiet(from, at + -planned.listen_ns, at, &mut self.vehicles) {
            return None;
        }
        self.vehicles[from.0 as usize].hold(planned.stamp, at);
        Some(LossReason::Busy)
    }
}

/// How many cells lie in a row as long as the longest reach: fewer hold more who are too far away, more cost more themselves.
const CELLS_IN_REACH: f64 = 3.0;

/// What a payload is worth.
struct Checked {
    is_promise: bool,
    violation: Option<Violation>,
    box_width_m: f64,
}

/// Checks a payload at its emission. The Gaussian of an AUV that promises nothing is not false, whatever it says: only estimators
/// that promise nothing either take it in.
fn check_ping(emitter: &Born, at: SimTime, frame: &Frame, position_m: &Vec3, velocity_m_s: &Vec3) -> Checked {
    let (is_promise, violation, box_width_m) = match Payload::decode(frame) {
        Ok(Payload::Intervals(ping)) if ping.sender == emitter.auv => {
            let violation = Check::of(Enclosure::Ping)
                .position(&ping.position_m, position_m)
                .velocity(&ping.velocity_m_s, velocity_m_s)
                .time(&ping.emission_s, at.as_s())
                .violation();
            (true, violation, box_width(&ping.position_m))
        }
        Ok(Payload::Gaussian(ping)) if ping.sender == emitter.auv && !promises(emitter) => {
            (false, None, box_width(&ping.position_box_m()))
        }
        _ => (true, Some(check::nothing(Enclosure::Ping)), 0.0),
    };
    Checked { is_promise, violation, box_width_m }
}
