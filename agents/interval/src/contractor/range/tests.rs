//! The ping contractor never loses a solution, and each bound that it leaves belongs to one.

use super::*;
use crate::strategies::everyday_number;
use nalgebra::SVector;
use proptest::prelude::*;

fn over(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap()
}

/// An interval that holds `truth` at a random place.
fn around(truth: f64, width: f64, share: f64) -> Interval {
    over(truth - share * width, truth + (1.0 - share) * width)
}

fn widths() -> impl Strategy<Value = [(f64, f64); 10]> {
    let width = prop_oneof![Just(0.0), 0.0..1.0e-6_f64, 0.0..1.0_f64, 0.0..300.0_f64];
    prop::array::uniform10((width, 0.0..=1.0_f64))
}

/// Whether the equation can hold over these sets: both sides are exact, as each variable appears once.
fn possible(
    p: IntervalBox<2>,
    e: IntervalBox<2>,
    speed: Interval,
    reception: Interval,
    emission: Interval,
) -> bool {
    let distance = (p - e).iter().fold(Interval::ZERO, |sum, side| sum + side.sqr()).sqrt();
    let travelled = speed * (reception - emission);
    !(distance.inflate(1e-9) & travelled.inflate(1e-9)).is_empty()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(5000))]

    #[test]
    fn a_ping_never_loses_the_truth(
        p in prop::array::uniform3(everyday_number()),
        e in prop::array::uniform3(everyday_number()),
        sound_speed in 50.0..1600.0_f64,
        emission in -100.0..100.0_f64,
        widths in widths(),
    ) {
        // The reception is known to rounding only: what encloses it is computed with intervals.
        let square = (0..3).fold(Interval::ZERO, |sum, axis| {
            sum + (Interval::point(p[axis]).unwrap() - Interval::point(e[axis]).unwrap()).sqr()
        });
        let true_reception = emission + square.sqrt() / sound_speed;
        let [.., speed_width, reception_width, emission_width, _] = widths;

        let mut position = IntervalBox::from([0, 1, 2].map(|i| around(p[i], widths[i].0, widths[i].1)));
        let mut emitter = IntervalBox::from([0, 1, 2].map(|i| around(e[i], widths[3 + i].0, widths[3 + i].1)));
        let mut speed = around(sound_speed, speed_width.0, speed_width.1);
        let mut received = true_reception + around(0.0, reception_width.0, reception_width.1);
        let mut emitted = around(emission, emission_width.0, emission_width.1);
        let before = (position, emitter, speed, received, emitted);

        let contracted = contract_range(&mut position, &mut emitter, &mut speed, &mut received, &mut emitted);
        prop_assert_ne!(contracted, Contracted::Empty);
        let unchanged = (position, emitter, speed, received, emitted) == before;
        prop_assert_eq!(contracted == Contracted::Unchanged, unchanged);
        prop_assert!(position.contains(&SVector::from(p)));
        prop_assert!(emitter.contains(&SVector::from(e)));
        prop_assert!(speed.contains(sound_speed));
        prop_assert!(!(received & true_reception).is_empty());
        prop_assert!(emitted.contains(emission));
        prop_assert!(position.is_subset_of(&before.0) && emitter.is_subset_of(&before.1));
        prop_assert!(speed.is_subset_of(before.2) && received.is_subset_of(before.3));
        prop_assert!(emitted.is_subset_of(before.4));
    }

    #[test]
    fn each_bound_belongs_to_a_solution(
        bounds in prop::array::uniform7((-3.0..3.0_f64, prop_oneof![Just(0.0), 0.0..1.0_f64, 0.0..4.0_f64])),
    ) {
        let [px, py, ex, ey, speed, reception, emission] = bounds.map(|(lower, width)| over(lower, lower + width));
        let before = (IntervalBox::from([px, py]), IntervalBox::from([ex, ey]), speed, reception, emission);
        let (p, e, ..) = before;
        let mut after = before;
        let contracted = contract_range(&mut after.0, &mut after.1, &mut after.2, &mut after.3, &mut after.4);
        if contracted == Contracted::Empty {
            return Ok(());
        }
        let ends = |x: Interval| [over(x.lower(), x.lower()), over(x.upper(), x.upper())];
        for axis in 0..2 {
            for end in ends(after.0[axis]) {
                let mut face = p;
                face[axis] = end;
                prop_assert!(possible(face, e, speed, reception, emission));
            }
            for end in ends(after.1[axis]) {
                let mut face = e;
                face[axis] = end;
                prop_assert!(possible(p, face, speed, reception, emission));
            }
        }
        for end in ends(after.2) {
            prop_assert!(possible(p, e, end, reception, emission));
        }
        for end in ends(after.3) {
            prop_assert!(possible(p, e, speed, end, emission));
        }
        for end in ends(after.4) {
            prop_assert!(possible(p, e, speed, reception, end));
        }
    }
}

#[test]
fn a_ping_heard_before_it_was_sent_is_a_contradiction() {
    let mut position = IntervalBox::from([over(-1.0, 1.0); 3]);
    let mut emitter = position;
    let (mut speed, mut reception, mut emission) = (over(1400.0, 1600.0), over(1.0, 2.0), over(2.5, 3.0));
    let contracted = contract_range(&mut position, &mut emitter, &mut speed, &mut reception, &mut emission);
    assert_eq!(contracted, Contracted::Empty);
    assert!(position.is_empty() && emitter.is_empty() && speed.is_empty() && reception.is_empty());
}

#[test]
fn an_unknown_sound_speed_and_an_unknown_clock_are_found() {
    let mut position = IntervalBox::from([over(300.0, 300.0), over(400.0, 400.0)]);
    let mut emitter = IntervalBox::from([Interval::ZERO; 2]);
    let (mut speed, mut reception, mut emission) = (Interval::ENTIRE, over(10.0, 10.5), over(9.5, 9.75));
    let contracted = contract_range(&mut position, &mut emitter, &mut speed, &mut reception, &mut emission);
    assert_eq!(contracted, Contracted::Narrowed);
    assert_eq!(speed, over(500.0, 2000.0));

    let (mut speed, mut reception) = (over(500.0, 1000.0), Interval::ENTIRE);
    let contracted = contract_range(&mut position, &mut emitter, &mut speed, &mut reception, &mut emission);
    assert_eq!(contracted, Contracted::Narrowed);
    assert_eq!(reception, over(10.0, 10.75));
}
