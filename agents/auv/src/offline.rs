//! All trajectories of a run at once, after the run: every ping contracts both its ends, forward and backward in time.
//!
//! Online, an AUV contracts its present state by what a ping says of its emitter, and what it learns later never helps what it
//! was. Once all records lie side by side, each trajectory is a chain of [`State`](crate::state::State)s with the odometry's ways in between, and each
//! ping ties one link of the emitter's chain to one of the receiver's: `|p_i(a) - p_j(b)| in [c] (t_j(b) - t_i(a))` (seed 001,
//! equations 5.4 and 5.7, and figure 5.9 (3)). What an emitter believed when it sent the ping is not needed: its chain says better
//! where it was.
//!
//! One **round** sweeps over each chain forward and backward, contracting by the pings as all chains stood after the round before.
//! So the sweeps of a round do not depend on each other, may run side by side, and give the same bits in any order. Rounds end at
//! a global fixed point: when none makes anything smaller by more than [`STOPPING_RATIO`].
//!
//! A ping that leaves nothing is dropped, as the online estimator does; so is the last one that told something before a chain
//! breaks. What it contracted by then has gone everywhere, so all is begun again without it.
//!
//! Each ping contracts boxes on its own. What several say together ([`together`](crate::together)) is not looked at, so an AUV that keeps rings
//! may have known itself better at some moment online.

mod exchange;
mod trajectory;

use shoal_bus::message::{Born, Sensed};
use shoal_bus::ping::Frame;
use shoal_bus::time::LocalTime;

use exchange::{Exchange, exchanges};
pub use trajectory::{Tick, Trajectory};

/// A round that makes no interval smaller by this part of its width is the last.
pub const STOPPING_RATIO: f64 = 0.01;

/// No more rounds than this: contraction that goes on for so long gains little.
pub const ROUNDS_MAX: u32 = 200;

/// So often at most, all is begun again without the pings that left nothing.
const RESTARTS_MAX: u32 = 20;

/// What the record holds of one AUV.
#[derive(Clone, Debug)]
pub struct Recorded {
    /// What it was told at birth.
    pub born: Born,
    /// What it sensed, tick by tick.
    pub sensed: Vec<Sensed>,
    /// The pings that it booked, in order.
    pub booked: Vec<Booked>,
}

/// A ping that an AUV booked.
#[derive(Clone, Copy, Debug)]
pub struct Booked {
    /// Local time of the emission.
    pub at: LocalTime,
    /// The bytes to emit.
    pub frame: Frame,
}

/// Reconstructs the trajectories of a run.
///
/// ```
/// use shoal_auv::offline::Reconstruction;
///
/// // Of nobody: nothing to do, and no round gains anything.
/// let mut nobody = Reconstruction::new(&[]);
/// let one_by_one = |trajectories: &mut [_], sweep: &(dyn Fn(&mut _) + Sync)| trajectories.iter_mut().for_each(sweep);
/// assert!(!nobody.round(&one_by_one));
/// ```
#[derive(Debug)]
pub struct Reconstruction {
    trajectories: Vec<Trajectory>,
    exchanges: Vec<Exchange>,
    rounds: u32,
    restarts: u32,
}

/// Sweeps over all trajectories, in any order or side by side.
pub type Sweeps<'a> = dyn Fn(&mut [Trajectory], &(dyn Fn(&mut Trajectory) + Sync)) + 'a;

impl Reconstruction {
    /// The trajectories of `auvs`, an AUV's id being its index, each as its own log, depths and fixes tell it.
    pub fn new(auvs: &[Recorded]) -> Self {
        let (exchanges, moments) = exchanges(auvs);
        let trajectories = auvs
            .iter()
            .zip(moments)
            .map(|(recorded, moments)| Trajectory::new(recorded, &moments, &exchanges))
            .collect();
        Self { trajectories, exchanges, rounds: 0, restarts: 0 }
    }

    /// One round. False when there will be no other: it made nothing smaller by [`STOPPING_RATIO`], or [`ROUNDS_MAX`] are done.
    pub fn round(&mut self, sweeps: &Sweeps<'_>) -> bool {
        for exchange in &mut self.exchanges {
            exchange.look(&self.trajectories);
        }
        let exchanges = &self.exchanges;
        sweeps(&mut self.trajectories, &|trajectory| trajectory.sweep(exchanges));
        self.rounds += 1;
        let mut is_shorter = false;
        for dropped in self.trajectories.iter().flat_map(Trajectory::dropped) {
            if let Some(exchange) = self.exchanges.get_mut(dropped) {
                is_shorter |= !exchange.is_dropped;
                exchange.is_dropped = true;
            }
        }
        if is_shorter && self.restarts < RESTARTS_MAX {
            self.restarts += 1;
            self.trajectories.iter_mut().for_each(Trajectory::restart);
        }
        let gains = |trajectory: &Trajectory| trajectory.gain() >= STOPPING_RATIO;
        self.rounds < ROUNDS_MAX && (is_shorter || self.trajectories.iter().any(gains))
    }

    /// The trajectories, by AUV.
    pub fn trajectories(&self) -> &[Trajectory] {
        &self.trajectories
    }

    /// Rounds so far.
    pub fn rounds(&self) -> u32 {
        self.rounds
    }

    /// How often all was begun again without pings that left nothing.
    pub fn restarts(&self) -> u32 {
        self.restarts
    }

    /// Pings that tie two trajectories, and pings of which only what they say is known.
    pub fn pings(&self) -> (usize, usize) {
        let tied = self.exchanges.iter().filter(|exchange| exchange.emission.is_some()).count();
        (tied, self.exchanges.len() - tied)
    }

    /// Pings that were dropped because they left nothing.
    pub fn dropped(&self) -> usize {
        self.exchanges.iter().filter(|exchange| exchange.is_dropped).count()
    }
}

#[cfg(test)]
mod tests;
