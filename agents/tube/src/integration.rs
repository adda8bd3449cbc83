//! Guaranteed integration: what a state equation says about a tube, as a proof.
//!
//! The seeds step with Euler's method, which follows the trajectory at samples and forgets what is between and beside
//! them. Here every slice holds the trajectories over all of its times:
//!
//! 1. An *a-priori enclosure* of a slice: a box `[B]` such that `[x0] + [0, h] f([B])` is in its interior. No solution that
//!    starts in `[x0]` leaves it before the slice ends (Picard's operator). The slice is cut further until there is one.
//! 2. The slice is contracted, and with it the gates on both of its sides.
//! 3. If the equation has a [Jacobian](Evolution::jacobian), the set of states is carried as a parallelepiped that turns with
//!    the flow (Lohner's method), so that the box around it is not wrapped into a larger one at each step.
//!
//! | what | how |
//! |---|---|
//! | the solutions that start in a box | [`Tube::solution`](crate::Tube::solution) |
//! | a tube contracted by its state equation, forward, backward or both | [`Tube::contract_evolution`](crate::Tube::contract_evolution) |
//! | the steps of the seeds, which prove nothing | [`Tube::contract_euler_unguaranteed`](crate::Tube::contract_euler_unguaranteed) |
//!
//! ```
//! use shoal_interval::expression::Expression;
//! use shoal_interval::{Interval, IntervalBox};
//! use shoal_tube::integration::Steps;
//! use shoal_tube::{TimeDomain, Tube};
//!
//! // A pendulum of 1 s^-2 for small angles: x' = v, v' = -x. An expression knows its own Jacobian.
//! let swing = Expression::<2, 2>::system(|[x, v]| [v, -x]);
//! let released = IntervalBox::from([Interval::new(0.9, 1.1)?, Interval::ZERO]);
//! let time = TimeDomain::uniform(0.0, 0.05, 400)?;
//! let states = Tube::solution(time, &swing, released, Steps::default())?;
//! // After 20 s and more than three periods it is still as well known as at the start.
//! assert!(states.last_gate()[0].width() < 0.2);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Source: seed 001, section 4.2.4, tables 4.1 and 4.2, which name guaranteed integration but do not use it; R. Lohner,
//! *Enclosing the Solutions of Ordinary Initial and Boundary Value Problems*, 1987; N. Nedialkov, K. Jackson and G. Corliss,
//! *Validated Solutions of Initial Value Problems for Ordinary Differential Equations*, 1999.

mod a_priori;
mod carrier;
mod contraction;
mod euler;
mod evolution;
mod orthonormal;
mod parallelepiped;
mod step;

pub(crate) use carrier::{Carrier, Way};
pub use carrier::{Diverged, Steps};
pub use contraction::Evolved;
pub use evolution::{Autonomous, Driven, Evolution};

#[cfg(test)]
mod tests;
