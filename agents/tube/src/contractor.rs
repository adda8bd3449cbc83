//! Contractors on tubes: what narrows tubes without losing a trajectory that obeys a constraint.
//!
//! Every contractor keeps two promises: what it leaves is inside what it was given, and every trajectory that was inside
//! and obeys the constraint is still inside. None changes how time is cut. Constraints between different times, such as a
//! delay, reach only where both times are in the domains of the tubes: outside nothing is known, and nothing is removed. What
//! changes one tube is a method of it, what changes several is a function.
//!
//! | constraint | contractor | between |
//! |---|---|---|
//! | `x(t) <= y(t)` | [`contract_order`] | tubes cut at the same times |
//! | `x(t) = y(t)` | [`contract_equality`] | tubes cut at the same times |
//! | any constraint between values of one time | [`lift`], [`lift_pair`], [`Tube::contract_with`](crate::Tube::contract_with) | tubes cut at the same times |
//! | `x(t) = y(t - tau)` | [`contract_delay`] | any two tubes |
//! | the same, tau uncertain and contracted | [`contract_uncertain_delay`] | any two tubes and an interval |
//! | `x(t) = x(t - tau)` | [`Tube::contract_period`](crate::Tube::contract_period) | a tube |
//! | `x(tau + t) = x(tau - t)` | [`Tube::contract_axial_symmetry`](crate::Tube::contract_axial_symmetry) | a tube |
//! | `x(tau + t) - c = c - x(tau - t)` | [`Tube::contract_central_symmetry`](crate::Tube::contract_central_symmetry) | a tube |
//! | `dx/dt = v` | [`Tube::contract_derivative`](crate::Tube::contract_derivative), [within](crate::Tube::contract_derivative_within) or [around](crate::Tube::contract_derivative_around) a window | tubes cut at the same times |
//! | `dx/dt = f(t, x)`, guaranteed integration | [`Tube::contract_evolution`](crate::Tube::contract_evolution) | a tube of boxes |
//! | the same, one derivative contraction a pass, from what is already enclosed | [`Tube::contract_state_equation`](crate::Tube::contract_state_equation) | any tube |
//! | `dx/dt = v = f(x, u)` | [`contract_chain`] | three tubes cut at the same times |
//! | `y = x(t)`, both uncertain (then carry it on: `contract_derivative_around`) | [`Tube::contract_evaluation`](crate::Tube::contract_evaluation), [with the derivative](crate::Tube::contract_evaluation_with_derivative) | a tube and two sets |
//! | `y(t) = x(h(t))` | [`contract_composition`] | `y` and `h` cut at the same times, and any `x` |
//! | `g = h⁻¹` | [`contract_inverse`] | any two tubes |
//! | `‖p(b) - q(a)‖ = c (b - a)` | [`contract_ping`] | any two tubes and three intervals |
//!
//! When nothing is left, all that was contracted becomes empty, and [`Tube::emptied`](crate::Tube::emptied) says where,
//! when, and by which [`Constraint`](crate::Constraint).
//!
//! Source: seed 001, sections 4.2.3 and 5.3.

mod asynchronous;
mod composition;
mod delay;
mod evaluation;
mod inverse;
mod lift;
mod order;
mod period;
mod ping;
mod state_equation;
mod symmetry;
mod uncertain_delay;
mod window;

pub use composition::contract_composition;
pub use delay::contract_delay;
pub use inverse::contract_inverse;
pub use lift::{lift, lift_pair};
pub use order::{contract_equality, contract_order};
pub use ping::{Moving, Ping, contract_ping};
pub use state_equation::contract_chain;
pub use uncertain_delay::contract_uncertain_delay;
