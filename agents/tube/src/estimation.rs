//! State estimation with an unknown start: boxes are cut at one time, and those whose tube empties are thrown away.
//!
//! A [`System`] is a state equation, integrated with a guarantee, and [observations](Observation), which may link states at
//! different times. Contracting a tube from time zero alone fails when nothing is known there. So a box of possible states
//! at a chosen gate is cut into parts, each part is carried along the tube both ways, met with the observations, and
//! thrown away if no trajectory is left. The hull of the tubes that remain holds every solution that starts in the box.
//!
//! | algorithm | here | source |
//! |---|---|---|
//! | CONTRACT | [`System::contract`] | seed 001, tables 4.1 and 4.3 |
//! | STRANGLE | [`System::strangle`] | seed 001, tables 4.2 and 4.4 |
//! | TubeCSIVIA | [`System::tube_csivia`] | seed 002, algorithm 4.1 |
//! | RTubeCSIVIA | [`System::r_tube_csivia`], which forgets the past | seed 002, algorithm 4.2 |
//! | the same with at most `q` wrong observations | [`System::strangle_relaxed`] | seed 002, section 3.6; seed 001, section 2.5 |
//!
//! What the seeds leave open is settled so that nothing is lost: slices hold all times and not only samples, the box meets
//! what is known already in place of replacing it, and what a budget leaves undecided is kept. A sweep ends where it
//! has nothing more to say.

mod error;
mod observation;
mod outliers;
mod search;
mod sweep;
mod system;
mod tube_csivia;

pub use error::EstimationError;
pub use observation::{FromContraction, Observation, from_contraction};
pub use search::{Search, Strangled};
pub use system::System;
pub use tube_csivia::Solutions;

#[cfg(test)]
mod tests;
