//! Elementary functions of intervals, rounded outwards: one file a family.
//!
//! What is computed with `pxfm` is widened by one step on each side, as its results are the nearest `f64` and thus not
//! proven to be on the right side: a bound is then at most one unit in the last place from the tightest one, however
//! large or small the arguments are. What can be computed exactly is not widened.

mod angle;
pub(crate) mod atan2;
mod cancellative;
mod corners;
mod error_free;
mod exponential;
mod fused;
mod integer_powers;
mod inverse_trigonometry;
mod outward;
mod powers;
mod quarter_turns;
mod roots_and_order;
mod scaled;
mod steps;
mod trigonometry;
mod turn_reduction;

#[cfg(test)]
mod tests;
