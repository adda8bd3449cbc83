//! One trajectory never above another, and two that are one.

use super::lift::lifted;
use crate::enclosure::Enclosure;
use crate::error::{Constraint, TubeError};
use crate::tube::Tube;
use shoal_interval::Interval;
use shoal_interval::contractor::Contracted;

/// Contracts two tubes by `x(t) <= y(t)` at all times. Minimal.
///
/// ```
/// use shoal_interval::Interval;
/// use shoal_tube::contractor::contract_order;
/// use shoal_tube::{TimeDomain, Tube};
///
/// let time = TimeDomain::uniform(0.0, 1.0, 4)?;
/// let mut depth_m = Tube::constant(time.clone(), Interval::new(0.0, 50.0)?);
/// let mut bottom_m = Tube::from_function(time, |t| (t * 5.0 + 20.0).inflate(1.0));
/// contract_order(&mut depth_m, &mut bottom_m)?;
/// assert_eq!(depth_m.slice(0), Some(Interval::new(0.0, 26.0)?));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When the tubes are cut at different times.
///
/// Source: seed 001, proposition 1, equation (4.14).
pub fn contract_order(x: &mut Tube<Interval>, y: &mut Tube<Interval>) -> Result<Contracted, TubeError> {
    x.check_same_domain(y)?;
    let contract = |[x, y]: &mut [Interval; 2]| {
        let below_y = Interval::spanning(f64::NEG_INFINITY, y.upper());
        let above_x = Interval::spanning(x.lower(), f64::INFINITY);
        (*x, *y) = (*x & below_y, *y & above_x);
    };
    Ok(lifted([x, y], contract, Constraint::Order))
}

/// Contracts two tubes by `x(t) = y(t)` at all times: both become their intersection. Minimal.
///
/// ```
/// use shoal_interval::Interval;
/// use shoal_tube::contractor::contract_equality;
/// use shoal_tube::{TimeDomain, Tube};
///
/// let time = TimeDomain::uniform(0.0, 1.0, 4)?;
/// let mut from_sonar_m = Tube::constant(time.clone(), Interval::new(3.0, 5.0)?);
/// let mut from_map_m = Tube::constant(time, Interval::new(4.0, 9.0)?);
/// contract_equality(&mut from_sonar_m, &mut from_map_m)?;
/// assert_eq!(from_map_m.at(2.5)?, Interval::new(4.0, 5.0)?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When the tubes are cut at different times.
///
/// Source: seed 001, proposition 2, equation (4.16).
pub fn contract_equality<T: Enclosure>(x: &mut Tube<T>, y: &mut Tube<T>) -> Result<Contracted, TubeError> {
    x.check_same_domain(y)?;
    let contract = |[x, y]: &mut [T; 2]| {
        let both = *x & *y;
        (*x, *y) = (both, both);
    };
    Ok(lifted([x, y], contract, Constraint::Equality))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time_domain::TimeDomain;

    #[test]
    fn no_bound_and_no_trajectory() {
        let time = TimeDomain::uniform(0.0, 1.0, 2).unwrap();
        let mut anything = Tube::constant(time.clone(), Interval::ENTIRE);
        let mut other = anything.clone();
        assert_eq!(contract_order(&mut anything, &mut other), Ok(Contracted::Unchanged));
        let mut nothing = Tube::constant(time.clone(), Interval::EMPTY);
        assert_eq!(contract_order(&mut anything, &mut nothing), Ok(Contracted::Empty));
        assert!(anything.is_empty());
        let mut high = Tube::constant(time.clone(), Interval::ONE);
        let mut low = Tube::constant(time, Interval::ZERO);
        assert_eq!(contract_order(&mut high, &mut low), Ok(Contracted::Empty));
        assert_eq!(low.emptied().unwrap().constraint, Some(Constraint::Order));
    }
}
