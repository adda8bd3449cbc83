//! New minds for bodies that have lost theirs.

use shoal_bus::message::{AuvId, Born, Bounds, BoundsBox};
use shoal_bus::time::SimTime;
use shoal_scenario::model::{Fault, Scenario};

use super::Channel;
use crate::sensors::rounding;
use crate::vehicle::Vehicle;

impl Channel {
    /// Gives AUVs that were lost a new mind each, from the end of the window last accepted on, and returns what these are told, sorted
    /// by AUV. Those that live are left alone.
    ///
    /// Each is told where its body may be by now: wherever it can have moved to from the box that it was told before, and from
    /// where kidnappers put it. The clock's bound grows by the drift. Nothing else of its former life is known to it.
    ///
    /// ```
    /// use shoal_bus::lockstep::{Answers, Loss};
    /// use shoal_bus::message::AuvId;
    /// use shoal_bus::time::SimTime;
    /// use shoal_channel::channel::Channel;
    ///
    /// let (source_name, text) = shoal_scenario::load("two-circles")?;
    /// let mut channel = Channel::new(&shoal_scenario::parse(&source_name, &text)?)?;
    /// let sensed = channel.advance(SimTime::from_ns(9_000_000))?;
    /// let loss = Loss { auv: AuvId(1), reason: "its process ended".into() };
    /// channel.accept(sensed, Answers { acted: Vec::new(), losses: vec![loss] });
    /// let reborn = channel.revive(&[AuvId(0), AuvId(1)]);
    /// assert_eq!(reborn.len(), 1);
    /// assert!(reborn[0].wake.first_tick > reborn[0].birth);
    /// assert_eq!(channel.summary().agents.restarted[0].auv, 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn revive(&mut self, auvs: &[AuvId]) -> Vec<Born> {
        let mut auvs = auvs.to_vec();
        auvs.sort_unstable();
        auvs.dedup();
        let mut reborn = Vec::with_capacity(auvs.len());
        for auv in auvs {
            let Some(vehicle) = self.vehicles.get_mut(auv.0 as usize).filter(|vehicle| !vehicle.alive) else {
                continue;
            };
            let prior_position_m = reachable(&self.scenario, vehicle, self.now);
            vehicle.begin_again(self.now, prior_position_m);
            reborn.push(vehicle.born.clone());
            self.tally.restarted(self.now, auv);
        }
        reborn
    }
}

/// A box that holds wherever the body can be at `now`, by what was certain at its last birth.
fn reachable(scenario: &Scenario, vehicle: &Vehicle, now: SimTime) -> BoundsBox {
    let (auv, born_at) = (vehicle.born.auv.0, vehicle.born_at);
    let moved = |side: &Bounds, since: SimTime| {
        let farthest_m = vehicle.ground_speed_m_s * ((now - since) as f64 * 1e-9);
        let slack_m = farthest_m + rounding(farthest_m + side.lower.abs().max(side.upper.abs()));
        Bounds::new(side.lower - slack_m, side.upper + slack_m)
    };
    let mut reachable = vehicle.born.prior_position_m.map(|side| moved(&side, born_at));
    for &Fault::Kidnap { auv: whom, at_ns, to_m } in &scenario.faults {
        let at = SimTime::from_ns(at_ns);
        // The body leaps at the next knot.
        if whom == auv && born_at <= at + scenario.knot_ns && at <= now {
            for (side, to_m) in reachable.iter_mut().zip(to_m) {
                let there = moved(&Bounds::new(to_m, to_m), at);
                *side = Bounds::new(side.lower.min(there.lower), side.upper.max(there.upper));
            }
        }
    }
    reachable
}
