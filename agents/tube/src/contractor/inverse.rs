//! A trajectory that undoes another.

use super::composition::contract_composition;
use crate::contraction::together;
use crate::error::TubeError;
use crate::tube::Tube;
use shoal_interval::Interval;
use shoal_interval::contractor::Contracted;

/// Contracts two tubes of which one undoes the other: `g(h(t)) = t` and `h(g(s)) = s`, wherever both are in the domains.
/// As a clock `h`, that shows a local time at each true time, and the true time `g` at each local time.
///
/// ```
/// use shoal_interval::Interval;
/// use shoal_tube::contractor::contract_inverse;
/// use shoal_tube::{TimeDomain, Tube};
///
/// let true_time = TimeDomain::uniform(0.0, 0.125, 80)?;
/// let mut local_s = Tube::from_function(true_time, |t| t * Interval::spanning(1.0, 1.01));
/// let local_time = TimeDomain::uniform(0.0, 0.125, 80)?;
/// let mut true_s = Tube::constant(local_time, Interval::new(0.0, 10.0)?);
/// contract_inverse(&mut local_s, &mut true_s)?;
/// assert!(true_s.at(5.0)?.contains(4.98) && true_s.at(5.0)?.width() < 0.31);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// None of its own; those of [`contract_composition`], which this is twice.
///
/// Source: seed 001, section 5.4.1, the inverse tube of a clock.
pub fn contract_inverse(h: &mut Tube<Interval>, g: &mut Tube<Interval>) -> Result<Contracted, TubeError> {
    let mut time_s = Tube::from_function(h.domain.clone(), |time_s| time_s);
    let there = contract_composition(g, h, &mut time_s)?;
    let mut time_s = Tube::from_function(g.domain.clone(), |time_s| time_s);
    let back = contract_composition(h, g, &mut time_s)?;
    Ok(together(there, back))
}
