use nalgebra::Vector3;
use proptest::prelude::*;
use shoal_bus::message::{AuvId, Culprit};
use shoal_interval::IntervalBox;

use super::*;

const SCALE: Scale = Scale { grain_m: 1.0, metres_per_s: 1500.0 };

fn side(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap()
}

fn state(sides: [Interval; 3]) -> State {
    State { offset_s: Interval::ZERO, position_m: IntervalBox::from(sides) }
}

fn area() -> State {
    state([side(-100.0, 100.0), side(-100.0, 100.0), Interval::ZERO])
}

/// Two beacons on the x axis leave two places, one the mirror image of the other.
fn by_two_ranges(state: &State) -> Option<State> {
    let mut left = *state;
    for (east_m, range_m) in [(-50.0, 70.0), (50.0, 70.0)] {
        let mut centre_m = IntervalBox::from([side(east_m, east_m), Interval::ZERO, Interval::ZERO]);
        let mut range = Interval::centred(range_m, 1.0);
        shoal_interval::contractor::contract_distance(&mut left.position_m, &mut centre_m, &mut range);
        if left.is_empty() {
            return None;
        }
    }
    Some(left)
}

#[test]
fn mirror_images_are_two_parts() {
    let found = Hypotheses::refined([area()].into_iter(), &SCALE, by_two_ranges).unwrap();
    let parts = found.components();
    assert_eq!(parts.len(), 2, "{parts:?}");
    // 70 m from both: sqrt(70² - 50²) = 48.99 m north or south.
    for north_m in [48.99, -48.99] {
        let truth_m = Vector3::new(0.0, north_m, 0.0);
        let holding: Vec<_> = parts.iter().filter(|part| part.position_m.contains(&truth_m)).collect();
        assert!(holding.len() == 1 && holding[0].position_m.width() < 6.0, "{parts:?}");
    }
    assert!(found.hull().position_m[1].width() > 97.0);
    // A third range leaves one.
    let northern = |state: &State| by_two_ranges(state).filter(|left| left.position_m[1].upper() > 0.0);
    let found = Hypotheses::refined(found.boxes().iter().copied(), &SCALE, northern).unwrap();
    assert_eq!(found.components().len(), 1);
}

#[test]
fn nothing_left_is_said_and_nothing_lost() {
    let mut found = Hypotheses::one(area());
    let refuse = |_: &State| Err(Contradiction(Culprit::Ping(AuvId(3))));
    assert_eq!(found.contract(refuse), Err(Contradiction(Culprit::Ping(AuvId(3)))));
    assert_eq!(found.hull().position_m, area().position_m);
    assert!(Hypotheses::refined([area()].into_iter(), &SCALE, |_| None).is_none());
}

#[test]
fn a_clock_is_cut_when_it_is_what_is_least_known() {
    // A second of clock is 1,500 m.
    let unknown = State { offset_s: side(-1.0, 1.0), ..area() };
    let found = Hypotheses::refined([unknown].into_iter(), &SCALE, |state| {
        (state.offset_s.lower() >= 0.0 || state.offset_s.width() > 0.9).then_some(*state)
    });
    assert!(found.unwrap().hull().offset_s.lower() >= 0.0);
}

proptest! {
    /// However boxes are cut, merged and carried, none of the states that the constraint allows is lost, and their number is bounded.
    #[test]
    fn no_solution_is_lost(
        radii_m in prop::collection::vec((-90.0..90.0_f64, -90.0..90.0_f64, 1.0..20.0_f64), 1..6),
        truth in (-100.0..100.0_f64, -100.0..100.0_f64),
        grain_m in 0.2..20.0_f64,
    ) {
        let truth_m = Vector3::new(truth.0, truth.1, 0.0);
        let rings: Vec<_> = radii_m.iter().map(|&(east_m, north_m, half_m)| {
            let centre_m = Vector3::new(east_m, north_m, 0.0);
            (centre_m, Interval::centred((truth_m - centre_m).norm() + 0.5 * half_m, half_m))
        }).collect();
        let contract = |state: &State| {
            let mut left = *state;
            for &(centre_m, mut range) in &rings {
                let mut centre_m = IntervalBox::centred(&centre_m, 0.0);
                shoal_interval::contractor::contract_distance(&mut left.position_m, &mut centre_m, &mut range);
            }
            (!left.is_empty()).then_some(left)
        };
        let scale = Scale { grain_m, ..SCALE };
        let mut found = Hypotheses::refined([area()].into_iter(), &scale, contract).unwrap();
        for _ in 0..3 {
            let holds = |state: &State| state.position_m.contains(&truth_m);
            prop_assert!(found.boxes().iter().any(holds) && found.boxes().len() <= BOXES_MAX);
            prop_assert!(found.components().iter().any(holds));
            let around = IntervalBox::from([side(-1.0, 1.0); 3]);
            found.carry(&Way { displacement_m: around, offset_gain_s: Interval::ZERO });
            found = Hypotheses::refined(found.boxes().iter().copied(), &scale, contract).unwrap();
        }
    }
}
