//! One vehicle's mind: it lives in its own time, knows only what it senses, and encloses where it is.
//!
//! [`Auv`] is a pure state machine: [`Sensed`](shoal_bus::message::Sensed) in, [`Acted`](shoal_bus::message::Acted) out. No
//! thread, file, socket or clock of the machine is touched, and neither scenario nor channel is reachable from here.
//!
//! | file | idea |
//! |---|---|
//! | `auv.rs` | the mind: estimator, controller, modem |
//! | `estimator.rs` | what an estimator is |
//! | `tube_estimator.rs` | the state tube, online |
//! | `ekf.rs`, `ekf/` | an extended Kalman filter, to compare with |
//! | `dead_reckoning.rs` | log and clock alone, to compare with |
//! | `state.rs` | position and clock as one set, contracted by measurements |
//! | `motion.rs` | how far the body can have moved |
//! | `current.rs` | the current, as a Doppler velocity log sees it |
//! | `travel.rs` | how it travels from tick to tick, by log and attitude |
//! | `odometry.rs` | what it did from any remembered moment until now |
//! | `offline/` | all trajectories of a run at once, from its record |
//! | `controller/` | hold, circle, waypoints, reynolds |
//! | `neighbours.rs` | who is around |
//! | `medium_access/` | when to ping |
//! | `modem.rs` | what to say |
//! | `relative.rs` | where the neighbours are, seen from here |
//! | `rings.rs` | pings as rings around the present position |
//! | `set_observer.rs` | the robust set observer: some of what is heard may be wrong, or the start unknown |
//! | `relaxed.rs` | the last pings, of which some may be wrong |
//! | `hypotheses.rs` | the possible states, in several parts if need be |
//! | `together.rs` | all rings at once |
//! | `beacons/` | one vehicle and a few beacons, from the files of a real mission |
//! | `sabotage.rs` | broken promises for tests of the check |

mod auv;
pub mod beacons;
mod bounds;
pub mod controller;
pub mod current;
pub mod dead_reckoning;
pub mod ekf;
pub mod estimator;
pub mod hypotheses;
pub mod medium_access;
pub mod modem;
pub mod motion;
pub mod neighbours;
#[cfg(test)]
mod newborn;
pub mod odometry;
pub mod offline;
pub mod relative;
pub mod relaxed;
pub mod rings;
mod sabotage;
pub mod set_observer;
pub mod state;
pub mod together;
pub mod travel;
pub mod tube_estimator;

pub use auv::Auv;
