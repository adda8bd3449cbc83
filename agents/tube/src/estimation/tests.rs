//! A robot on the plane hears beacons, and an oscillator is seen now and then.

use super::*;
use crate::derivative::Direction;
use crate::integration::{Driven, Evolution, Steps};
use crate::time_domain::TimeDomain;
use crate::tube::Tube;
use nalgebra::Vector2;
use shoal_interval::contractor::Contracted;
use shoal_interval::expression::Expression;
use shoal_interval::separator::{Ring, Separator};
use shoal_interval::{Interval, IntervalBox, IntervalMatrix};

fn over(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap()
}

const BEACONS_M: [[f64; 2]; 3] = [[-8.0, 9.0], [12.0, 3.0], [1.0, -10.0]];
const START_M: [f64; 2] = [-3.0, -2.0];
const SPEED_M_S: f64 = 0.8;

/// Where the robot is: it turns with 0.2 rad/s.
fn truth(time_s: f64) -> Vector2<f64> {
    let (sin, cos) = pxfm::f_sincos(0.2 * time_s);
    let radius_m = SPEED_M_S / 0.2;
    Vector2::from(START_M) + Vector2::new(radius_m * sin, radius_m * (1.0 - cos))
}

/// Speed and heading are known to 2 %.
fn drive() -> impl Evolution<2> {
    Driven::new(
        |time_s: Interval, _: &IntervalBox<2>| {
            let (sin, cos) = (time_s * 0.2).inflate(0.02).sin_cos();
            IntervalBox::from([cos, sin]) * over(0.98 * SPEED_M_S, 1.02 * SPEED_M_S)
        },
        |_: Interval, _: &IntervalBox<2>| IntervalMatrix::ZERO,
    )
}

/// A range to 0.1 m each second, of the beacons in turn; some of them are wrong.
fn robot(wrong: &[usize]) -> System<'static, 2, impl Evolution<2> + use<>> {
    let mut system = System::new(drive());
    for second in 1..=10 {
        let beacon_m = Vector2::from(BEACONS_M[second % 3]);
        let range_m =
            (truth(second as f64) - beacon_m).norm() + if wrong.contains(&second) { 2.0 } else { 0.03 };
        let ring = Ring::new(beacon_m, Interval::centred(range_m, 0.1));
        let time_s = Interval::centred(second as f64, 0.0);
        let gate = 10 * second;
        system = system.observed(from_contraction(time_s, move |states: &mut Tube<IntervalBox<2>>| {
            let near_m = ring.outer(states.gate(gate).unwrap_or(IntervalBox::ENTIRE));
            states.contract_gate(gate, &near_m)
        }));
    }
    system
}

fn pool() -> IntervalBox<2> {
    IntervalBox::from([over(-10.0, 10.0); 2])
}

/// 10 s in a pool, of which the robot cannot get out.
fn unknown() -> Tube<IntervalBox<2>> {
    Tube::constant(TimeDomain::uniform(0.0, 0.1, 100).unwrap(), pool().inflate(5.0))
}

fn holds_truth(tube: &Tube<IntervalBox<2>>, from_s: f64) -> bool {
    (0..=1000)
        .map(|index| f64::from(index) * 0.01)
        .filter(|&time_s| time_s >= from_s)
        .all(|time_s| tube.at(time_s).unwrap().contains(&truth(time_s)))
}

#[test]
fn ranges_tell_where_a_robot_started() {
    let mut states = unknown();
    let strangled = robot(&[]).strangle(&mut states, 0, pool(), &Search::new([0.1, 0.1])).unwrap();
    println!("{} contractions, {} kept, {}", strangled.contractions, strangled.kept.len(), strangled.hull());
    assert!(holds_truth(&states, 0.0));
    assert!(strangled.hull().contains(&truth(0.0)) && strangled.hull().width() < 0.6);
    assert_eq!(states.gate(0), Some(strangled.hull()));
    assert!(states.last_gate().width() < 0.6 && strangled.undecided.is_empty());
    // Nothing is missing, and nothing is twice.
    let volume: f64 = strangled.kept.iter().chain(&strangled.rejected).map(IntervalBox::volume).sum();
    assert!((volume - 400.0).abs() < 1e-6, "{volume}");
    let again = robot(&[]).strangle(&mut unknown(), 0, pool(), &Search::new([0.1, 0.1])).unwrap();
    assert_eq!(again, strangled);
}

#[test]
fn the_gate_may_be_anywhere() {
    let mut states = unknown();
    let strangled = robot(&[]).strangle(&mut states, 57, pool(), &Search::new([0.1, 0.1])).unwrap();
    assert!(holds_truth(&states, 0.0) && strangled.hull().contains(&truth(5.7)));
    assert!(states.gate(0).unwrap().width() < 1.0 && states.last_gate().width() < 0.6);
}

#[test]
fn a_wrong_range_contradicts_unless_it_may_be_wrong() {
    let search = Search::new([0.1, 0.1]);
    let mut states = unknown();
    let strangled = robot(&[4]).strangle(&mut states, 0, pool(), &search).unwrap();
    assert!(strangled.kept.is_empty() && states.is_empty() && strangled.hull().is_empty());

    let mut states = unknown();
    let relaxed = robot(&[4]).strangle_relaxed(&mut states, 0, pool(), &search, 1).unwrap();
    println!("{} contractions, {} kept, {}", relaxed.contractions, relaxed.kept.len(), relaxed.hull());
    assert!(holds_truth(&states, 0.0) && relaxed.hull().width() < 1.0);

    let mut states = unknown();
    let relaxed = robot(&[]).strangle_relaxed(&mut states, 0, pool(), &search, 1).unwrap();
    assert!(holds_truth(&states, 0.0) && relaxed.hull().width() < 1.0);
    let mut states = unknown();
    let relaxed = robot(&[4, 7]).strangle_relaxed(&mut states, 0, pool(), &search, 1).unwrap();
    assert!(relaxed.kept.is_empty() && states.is_empty());
}

#[test]
fn tubes_are_cut_until_they_are_narrow() {
    let start = IntervalBox::from([over(-8.0, 2.0), over(-6.0, 4.0)]);
    let mut states = unknown();
    states.contract_gate(0, &start).unwrap();
    let solutions = robot(&[]).tube_csivia(&states, &Search::new([0.5, 0.5])).unwrap();
    println!("{} contractions, {} tubes", solutions.contractions, solutions.tubes.len());
    assert!(!solutions.is_empty() && solutions.undecided.is_empty() && solutions.forgotten == 0);
    assert!(solutions.states_at(0).contains(&truth(0.0)) && solutions.states_at(0).width() < 1.0);
    let inside = |tube: &&Tube<IntervalBox<2>>| tube.gate(50).unwrap().contains(&truth(5.0));
    assert!(solutions.tubes.iter().filter(inside).count() >= 1);

    // Carried away by 2 m during the third second: the past is to be forgotten.
    let lost = robot(&[1, 2, 3]);
    assert!(lost.tube_csivia(&states, &Search::new([0.5, 0.5])).unwrap().is_empty());
    let found = lost.r_tube_csivia(&unknown(), &Search::new([0.5, 0.5]), 10).unwrap();
    println!("{} forgotten, {} contractions", found.forgotten, found.contractions);
    // The range of the third second is forgotten with the slice behind it.
    assert_eq!(found.forgotten, 40);
    assert!(found.states_at(100).contains(&truth(10.0)) && found.states_at(100).width() < 1.5);
}

#[test]
fn a_budget_leaves_the_rest_undecided_and_loses_nothing() {
    for budget in [0, 1, 5, 12, 20] {
        let search = Search::new([0.1, 0.1]).with_budget(budget);
        let mut states = unknown();
        let strangled = robot(&[]).strangle(&mut states, 0, pool(), &search).unwrap();
        assert_eq!(strangled.contractions, budget);
        assert!(holds_truth(&states, 0.0) && strangled.hull().contains(&truth(0.0)));
        assert!(!strangled.undecided.is_empty());
        let solutions = robot(&[]).tube_csivia(&unknown(), &search).unwrap();
        assert!(solutions.states_at(0).contains(&truth(0.0)));
    }
}

#[test]
fn bad_questions_are_refused() {
    let search = Search::new([0.1, 0.1]);
    let mut states = unknown();
    let system = robot(&[]);
    let mut refused = |gate: usize, initial: IntervalBox<2>, search: &Search<2>| {
        system.strangle(&mut states, gate, initial, search).unwrap_err()
    };
    assert_eq!(refused(0, IntervalBox::EMPTY, &search), EstimationError::EmptyBox);
    let strip = IntervalBox::from([over(0.0, 1.0), Interval::ENTIRE]);
    assert_eq!(refused(0, strip, &search), EstimationError::UnboundedBox { axis: 1 });
    assert!(matches!(
        refused(0, pool(), &Search::new([0.1, f64::NAN])),
        EstimationError::NotAPrecision { axis: 1, .. }
    ));
    assert!(matches!(refused(101, pool(), &search), EstimationError::Tube(_)));
    let mut short = Tube::constant(TimeDomain::uniform(0.0, 0.1, 50).unwrap(), pool());
    let outside = system.strangle(&mut short, 0, pool(), &search);
    assert!(matches!(outside, Err(EstimationError::Tube(crate::TubeError::OutsideDomain { .. }))));
    assert_eq!(states, unknown());
}

#[test]
fn contracting_one_box_both_ways_from_its_gate() {
    // x' = v, v' = -x: seen in the middle, known everywhere.
    let system = System::new(Expression::system(|[x, v]| [v, -x])).with_steps(Steps::default());
    let mut states = Tube::constant(TimeDomain::uniform(0.0, 0.01, 600).unwrap(), IntervalBox::ENTIRE);
    let box_at_3 = IntervalBox::centred(&Vector2::new(1.0, 0.0), 0.01);
    assert_eq!(system.contract(&mut states, 300, &box_at_3).unwrap(), Contracted::Narrowed);
    let (sin, cos) = pxfm::f_sincos(3.0);
    assert!(states.gate(0).unwrap().contains(&Vector2::new(cos, sin)));
    assert!(states.last_gate().contains(&Vector2::new(cos, -sin)));
    assert!(states.gate(0).unwrap().width() < 0.03 && states.last_gate().width() < 0.03);
    let mut beside = Tube::constant(states.domain().clone(), IntervalBox::ENTIRE);
    beside.contract_gate(300, &box_at_3).unwrap();
    beside.contract_evolution(&Expression::system(|[x, v]| [v, -x]), Direction::Both, Steps::default());
    assert_eq!(beside.last_gate(), states.last_gate());
    assert_eq!(system.contract(&mut states, 300, &IntervalBox::EMPTY).unwrap(), Contracted::Empty);
    assert_eq!(states.first_empty().unwrap().to_string(), "gate 300, at 3 s, is empty");
}
