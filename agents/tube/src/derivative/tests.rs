//! The contractor removes what it can, on trajectories simple enough to do by hand.

use super::*;
use crate::time_domain::TimeDomain;
use shoal_interval::Interval;

fn over(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap()
}

fn slow() -> Tube<Interval> {
    Tube::constant(TimeDomain::uniform(0.0, 1.0, 4).unwrap(), over(1.0, 2.0))
}

#[test]
fn the_integral_spreads_from_the_start() {
    let x = Tube::primitive(&slow(), over(0.0, 0.5));
    assert_eq!(x.gate(0), Some(over(0.0, 0.5)));
    assert_eq!(x.slice(0), Some(over(0.0, 2.5)));
    assert_eq!(x.last_gate(), over(4.0, 8.5));
}

#[test]
fn a_gate_is_carried_both_ways() {
    let mut x = Tube::constant(slow().domain().clone(), Interval::ENTIRE);
    assert_eq!(x.contract_gate(2, &Interval::ZERO), Ok(Contracted::Narrowed));
    assert_eq!(x.contract_derivative(&slow(), Direction::Both), Ok(Contracted::Narrowed));
    assert_eq!(x.gate(4), Some(over(2.0, 4.0)));
    assert_eq!(x.gate(0), Some(over(-4.0, -2.0)));
    assert_eq!(x.slice(1), Some(over(-2.0, 0.0)));
    assert_eq!(x.contract_derivative(&slow(), Direction::Both), Ok(Contracted::Unchanged));
}

#[test]
fn one_direction_leaves_the_other_alone() {
    let mut x = Tube::constant(slow().domain().clone(), Interval::ENTIRE);
    x.contract_gate(2, &Interval::ZERO).unwrap();
    let mut forward = x.clone();
    forward.contract_derivative(&slow(), Direction::Forward).unwrap();
    assert_eq!((forward.gate(0), forward.gate(4)), (Some(Interval::ENTIRE), Some(over(2.0, 4.0))));
    x.contract_derivative(&slow(), Direction::Backward).unwrap();
    assert_eq!((x.gate(0), x.gate(4)), (Some(over(-4.0, -2.0)), Some(Interval::ENTIRE)));
}

#[test]
fn contradictions_are_empty_and_other_domains_refused() {
    let mut x = Tube::primitive(&slow(), Interval::ZERO);
    x.contract_gate(4, &over(4.0, 4.5)).unwrap();
    x.contract_gate(1, &over(1.9, 9.0)).unwrap();
    assert_eq!(x.contract_derivative(&slow(), Direction::Both), Ok(Contracted::Empty));
    assert!(x.is_empty());
    let other = Tube::constant(TimeDomain::uniform(0.0, 1.0, 3).unwrap(), over(1.0, 2.0));
    assert_eq!(x.contract_derivative(&other, Direction::Both), Err(TubeError::DifferentDomains));
    assert!(x.contract_slice_derivative(4, Interval::ZERO, Direction::Both).is_err());
}
