//! When to ping: medium access as the AUV's own choice, on its own clock.
//!
//! The water keeps no order among those who share it: every AUV decides for itself, from what it senses and from how well it
//! knows the time. A ping is booked at the last tick that may book it, so that its payload is as fresh as can be.
//!
//! | file | idea |
//! |---|---|
//! | `periodic.rs` | every so often |
//! | `aloha.rs` | at random |
//! | `slotted.rs` | in an own slot of true time, kept by a clock that drifts |
//! | `csma.rs` | every so often, but not while others are heard |
//! | `gaps.rs` | random gaps from the AUV's own draws |

mod aloha;
mod csma;
mod gaps;
mod periodic;
mod slotted;
#[cfg(test)]
mod tests;

use shoal_bus::message::{MediumAccess as Orders, Sensed, Wake};
use shoal_bus::time::LocalTime;
use shoal_interval::Interval;

pub use slotted::Slotted;

/// A ping to be booked now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Booking {
    /// Local time of its emission.
    pub at: LocalTime,
    /// The modem holds it back when it heard something within so many local nanoseconds before; zero to emit anyway.
    pub listen_ns: i64,
}

/// One control tick as medium access sees it.
pub struct Tick<'a> {
    /// What was sensed.
    pub sensed: &'a Sensed,
    /// The first local time for which a ping can still be booked.
    pub from: LocalTime,
    /// From this local time on, the next tick can book it too.
    pub until: LocalTime,
    /// Encloses the true time in seconds at a local time that is not before the tick: of whatever happens at that stamp.
    pub true_time_s: &'a dyn Fn(LocalTime) -> Interval,
}

impl<'a> Tick<'a> {
    /// The tick at which `sensed` is told to an AUV that wakes by `wake`.
    pub fn new(sensed: &'a Sensed, wake: &Wake, true_time_s: &'a dyn Fn(LocalTime) -> Interval) -> Self {
        let from = sensed.stamp + wake.reaction_ns;
        Self { sensed, from, until: from + wake.period_ns, true_time_s }
    }
}

/// A way to share the water with others.
pub trait MediumAccess: Send {
    /// Adds the pings that this tick is the last to book: all at local times in `tick.from .. tick.until`.
    fn book(&mut self, tick: &Tick<'_>, booked: &mut Vec<Booking>);
}

/// The medium access that these orders ask for.
pub fn ordered(orders: &Orders) -> Box<dyn MediumAccess> {
    match *orders {
        Orders::Silent => Box::new(Silent),
        Orders::Periodic { first, period_ns } => Box::new(periodic::Periodic::new(first, period_ns)),
        Orders::Aloha { first, mean_period_ns, entropy } => {
            Box::new(aloha::Aloha::new(first, mean_period_ns, entropy))
        }
        Orders::Slotted { slot_ns, slots, slot, packet_ns, propagation_ns } => {
            Box::new(Slotted::new(slot_ns, slots, slot, packet_ns.saturating_add(propagation_ns)))
        }
        Orders::Csma { first, period_ns, listen_ns, backoff_ns, entropy } => Box::new(csma::Csma::new(
            periodic::Periodic::new(first, period_ns),
            listen_ns,
            backoff_ns,
            entropy,
        )),
    }
}

/// Never pings.
struct Silent;

impl MediumAccess for Silent {
    fn book(&mut self, _: &Tick<'_>, _: &mut Vec<Booking>) {}
}
