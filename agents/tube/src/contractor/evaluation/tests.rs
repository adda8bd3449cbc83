//! Values at uncertain times, on tubes simple enough to do by hand.

use super::*;
use crate::time_domain::TimeDomain;
use shoal_interval::IntervalBox;

fn over(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap()
}

/// Moves at 1 to 2 a second for ten seconds, from anywhere.
fn moving() -> (Tube<Interval>, Tube<Interval>) {
    let speed = Tube::constant(TimeDomain::uniform(0.0, 1.0, 10).unwrap(), over(1.0, 2.0));
    (Tube::constant(speed.domain().clone(), over(-100.0, 100.0)), speed)
}

#[test]
fn the_tube_keeps_what_any_time_of_passage_allows() {
    let (mut x, speed) = moving();
    let (mut time_s, mut value) = (over(3.0, 6.0), Interval::ZERO);
    let contracted = x.contract_evaluation_with_derivative(&speed, &mut time_s, &mut value);
    assert_eq!((contracted, time_s, value), (Ok(Contracted::Narrowed), over(3.0, 6.0), Interval::ZERO));
    // At 3 s at zero already, or up to three seconds before.
    assert_eq!(x.gate(3), Some(over(-6.0, 0.0)));
    assert_eq!(x.gate(4), Some(over(-4.0, 2.0)));
    assert_eq!(x.gate(6), Some(over(0.0, 6.0)));
    assert_eq!(x.slice(4), Some(over(-4.0, 4.0)));
    // The rest of the tube waits for the derivative.
    assert_eq!(x.gate(7), Some(over(-100.0, 100.0)));
    x.contract_derivative_around(&speed, time_s).unwrap();
    assert_eq!(x.gate(7), Some(over(1.0, 8.0)));
}

#[test]
fn a_known_time_is_a_measurement_even_between_gates() {
    let (mut x, speed) = moving();
    let (mut time_s, mut value) = (over(4.5, 4.5), over(0.0, 1.0));
    x.contract_evaluation_with_derivative(&speed, &mut time_s, &mut value).unwrap();
    assert_eq!((x.gate(4), x.gate(5)), (Some(over(-1.0, 0.5)), Some(over(0.5, 2.0))));
    let (mut time_s, mut value) = (over(5.0, 5.0), over(0.5, 0.75));
    x.contract_evaluation_with_derivative(&speed, &mut time_s, &mut value).unwrap();
    assert_eq!(x.gate(5), Some(over(0.5, 0.75)));
}

#[test]
fn times_and_values_learn_from_the_tube() {
    let (_, speed) = moving();
    let mut x = Tube::primitive(&speed, Interval::ZERO);
    let (mut time_s, mut value) = (over(2.5, 9.0), over(-7.0, 4.0));
    x.contract_evaluation_with_derivative(&speed, &mut time_s, &mut value).unwrap();
    assert_eq!((time_s, value), (over(2.5, 4.0), over(2.5, 4.0)));
}

#[test]
fn a_contradiction_empties_time_value_and_tube() {
    let (_, speed) = moving();
    let mut x = Tube::primitive(&speed, Interval::ZERO);
    let (mut time_s, mut value) = (over(2.0, 3.0), over(7.0, 8.0));
    assert_eq!(x.contract_evaluation(&mut time_s, &mut value), Ok(Contracted::Empty));
    assert!(time_s.is_empty() && value.is_empty() && x.is_empty());
    assert_eq!(x.emptied().and_then(|emptied| emptied.constraint), Some(Constraint::Evaluation));
    let mut x = Tube::primitive(&speed, Interval::ZERO);
    let (mut time_s, mut value) = (over(2.0, 3.0), over(7.0, 8.0));
    let contracted = x.contract_evaluation_with_derivative(&speed, &mut time_s, &mut value);
    assert_eq!(contracted, Ok(Contracted::Empty));
    assert_eq!(
        x.emptied().unwrap().to_string(),
        "gate 2, at 2 s, is empty: emptied by a value at an uncertain time"
    );
    let mut x = Tube::primitive(&speed, Interval::ZERO);
    let (mut never, mut value) = (Interval::EMPTY, Interval::ENTIRE);
    assert_eq!(x.contract_evaluation_with_derivative(&speed, &mut never, &mut value), Ok(Contracted::Empty));
    assert!(value.is_empty() && x.is_empty());
}

#[test]
fn nothing_is_known_outside_and_nothing_is_learnt_from_nan() {
    let (mut x, speed) = moving();
    let before = x.clone();
    let (mut time_s, mut value) = (over(9.0, 10.5), Interval::ZERO);
    assert!(x.contract_evaluation_with_derivative(&speed, &mut time_s, &mut value).is_err());
    assert!(x.contract_evaluation(&mut time_s, &mut value).is_err());
    assert_eq!((time_s, value), (over(9.0, 10.5), Interval::ZERO));
    let (mut time_s, mut lost) = (over(1.0, 2.0), Interval::spanning(f64::NAN, f64::NAN));
    x.contract_evaluation_with_derivative(&speed, &mut time_s, &mut lost).unwrap();
    assert_eq!((time_s, x), (over(1.0, 2.0), before));
}

#[test]
fn a_tube_of_one_gate_and_a_box_of_two_axes() {
    let mut x = Tube::starting_at(3.0, over(0.0, 2.0)).unwrap();
    let slope = Tube::starting_at(3.0, over(0.0, 1.0)).unwrap();
    let (mut time_s, mut value) = (over(3.0, 3.0), over(1.0, 5.0));
    x.contract_evaluation_with_derivative(&slope, &mut time_s, &mut value).unwrap();
    assert_eq!((value, x.gate(0)), (over(1.0, 2.0), Some(over(1.0, 2.0))));

    // The time at which one coordinate passes tells the other.
    let time = TimeDomain::uniform(0.0, 1.0, 10).unwrap();
    let mut path = Tube::from_function(time.clone(), |t| IntervalBox::from([t, t * -3.0]));
    let velocity = Tube::constant(time, IntervalBox::from([over(1.0, 1.0), over(-3.0, -3.0)]));
    let (mut time_s, mut place) = (over(0.0, 9.0), IntervalBox::from([over(2.25, 2.5), Interval::ENTIRE]));
    path.contract_evaluation_with_derivative(&velocity, &mut time_s, &mut place).unwrap();
    assert_eq!((time_s, place[1]), (over(2.25, 2.5), over(-7.5, -6.75)));
}
