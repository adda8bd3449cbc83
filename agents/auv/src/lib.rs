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
//! | `state.rs` | position and clock as one set, contracted by measurements |
//! | `motion.rs` | how far the body can have moved |
//! | `current.rs` | the current, as a Doppler velocity log sees it |
//! | `odometry.rs` | what it did from any remembered moment until now |
//! | `history.rs` | the tube that is remembered |
//! | `controller/` | hold, circle, waypoints, reynolds |
//! | `neighbours.rs` | who is around |
//! | `medium_access/` | when to ping |
//! | `modem.rs` | what to say |
//! | `relative.rs` | where the neighbours are, seen from here |
//! | `rings.rs` | pings as rings around the present position |
//! | `together.rs` | all rings at once |
//! | `sabotage.rs` | broken promises for tests of the check |

mod auv;
mod bounds;
pub mod controller;
pub mod current;
pub mod estimator;
mod history;
pub mod medium_access;
pub mod modem;
pub mod motion;
pub mod neighbours;
#[cfg(test)]
mod newborn;
pub mod odometry;
pub mod relative;
pub mod rings;
mod sabotage;
pub mod state;
pub mod together;
pub mod tube_estimator;

pub use auv::Auv;
