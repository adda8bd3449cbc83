//! Enclosures beside exact solutions and beside many small Runge-Kutta steps.

use super::*;
use crate::derivative::Direction;
use crate::time_domain::TimeDomain;
use crate::tube::Tube;
use nalgebra::{SVector, Vector2};
use proptest::prelude::*;
use shoal_interval::contractor::Contracted;
use shoal_interval::expression::Expression;
use shoal_interval::{Interval, IntervalBox};

fn over(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap()
}

fn at(value: f64) -> Interval {
    over(value, value)
}

/// The states at `count` equal steps after the start, by 16 Runge-Kutta steps in each.
fn runge_kutta<const N: usize>(
    field: impl Fn(f64, &SVector<f64, N>) -> SVector<f64, N>,
    start: SVector<f64, N>,
    step_s: f64,
    count: usize,
) -> Vec<SVector<f64, N>> {
    let h = step_s / 16.0;
    let (mut state, mut states) = (start, vec![start]);
    for index in 0..16 * count {
        let t = index as f64 * h;
        let k1 = field(t, &state);
        let k2 = field(t + h / 2.0, &(state + k1 * (h / 2.0)));
        let k3 = field(t + h / 2.0, &(state + k2 * (h / 2.0)));
        let k4 = field(t + h, &(state + k3 * h));
        state += (k1 + k2 * 2.0 + k3 * 2.0 + k4) * (h / 6.0);
        if index % 16 == 15 {
            states.push(state);
        }
    }
    states
}

/// Whether a tube holds the states at its gates up to the error of the truth, and so in the slices beside.
fn holds_all<const N: usize>(tube: &Tube<IntervalBox<N>>, truth: &[SVector<f64, N>]) -> bool {
    let gates = tube
        .gates()
        .zip(truth)
        .all(|(gate, state)| gate.inflate(1e-9 * (1.0 + state.amax())).contains(state));
    let slices = tube.slices().zip(truth.windows(2)).all(|(slice, states)| {
        let slice = slice.inflate(1e-9 * (1.0 + states[0].amax()));
        slice.contains(&states[0]) && slice.contains(&states[1])
    });
    truth.len() == tube.slice_count() + 1 && gates && slices
}

fn harmonic() -> Expression<2, 2> {
    Expression::system(|[x, v]| [v, -x])
}

fn naive<const N: usize>(
    evolution: &impl Evolution<N>,
) -> impl Fn(Interval, &IntervalBox<N>) -> IntervalBox<N> {
    |times_s, states| evolution.velocity(times_s, states)
}

#[test]
fn decay_is_enclosed_at_all_times() {
    let decay = Expression::new(|[x]| -x);
    let time = TimeDomain::uniform(0.0, 0.01, 500).unwrap();
    let start = IntervalBox::from([at(1.0)]);
    let x = Tube::solution(time.clone(), &decay, start, Steps::default()).unwrap();
    for (gate, time_s) in x.gates().zip(time.borders_s()) {
        let truth = at(-time_s).exp();
        assert!(truth.is_subset_of(gate[0]) || gate[0].is_subset_of(truth), "{time_s}: {gate} {truth}");
    }
    for (index, slice) in x.slices().enumerate() {
        assert!((-time.slice_span(index).unwrap()).exp().is_subset_of(slice[0]));
        assert!(slice.width() < 0.012);
    }
    let last = x.last_gate();
    println!("exp(-5) to {:e}, without Jacobian to {:e}", last.width(), {
        let x = Tube::solution(time, &naive(&decay), start, Steps::default()).unwrap();
        x.last_gate().width()
    });
    assert!(last.width() < 1e-5);
}

#[test]
fn an_oscillator_does_not_wrap() {
    let start = IntervalBox::from([over(0.9, 1.1), over(-0.1, 0.1)]);
    let time = TimeDomain::uniform(0.0, 0.01, 3200).unwrap();
    let turned = Tube::solution(time.clone(), &harmonic(), start, Steps::default()).unwrap();
    let wrapped = Tube::solution(time.clone(), &naive(&harmonic()), start, Steps::default()).unwrap();
    for periods in 1..=5 {
        let gate = periods * 628;
        let width = |tube: &Tube<IntervalBox<2>>| tube.gate(gate).unwrap().width();
        println!("after {periods} periods: turned {:.4}, wrapped {:e}", width(&turned), width(&wrapped));
    }
    assert!(wrapped.last_gate().width() > 1e10);
    assert!(turned.slices().all(|slice| slice.width() < 0.33));
    for corner in start.corners() {
        let truth: Vec<_> = time
            .borders_s()
            .map(|t| {
                let (sin, cos) = pxfm::f_sincos(t);
                Vector2::new(corner.x * cos + corner.y * sin, corner.y * cos - corner.x * sin)
            })
            .collect();
        assert!(holds_all(&turned, &truth));
    }
}

#[test]
fn predators_and_prey() {
    let wild = Expression::system(|[x, y]| [x - x * y * 0.2, x * y / 3.0 - y]);
    let field = |_: f64, s: &Vector2<f64>| Vector2::new(s.x - s.x * s.y * 0.2, s.x * s.y / 3.0 - s.y);
    let start = Vector2::new(10.0, 2.0);
    let time = TimeDomain::uniform(0.0, 0.01, 1000).unwrap();
    let radius = 1e-3;
    let tube =
        Tube::solution(time, &wild, IntervalBox::centred(&start, radius), Steps { least: 4, most: 64 })
            .unwrap();
    for corner in IntervalBox::centred(&start, 0.99 * radius).corners().chain([start]) {
        assert!(holds_all(&tube, &runge_kutta(field, corner, 0.01, 1000)));
    }
    println!("prey and predators, from 0.002: {:.2e} after 10 years", tube.last_gate().width());
    assert!(tube.last_gate().width() < 0.2);
}

/// Seed 000, equation (2.14), with the derivative of its set-point put right. Time is a state, so that nothing but the
/// state appears in the equation.
#[test]
fn controlled_prey() {
    let controlled = Expression::system(|[t, x, y]| {
        let one = t * 0.0 + 1.0;
        let set_point = (t * 0.5).sin() + 3.0;
        [one, set_point - x + (t * 0.5).cos() * 0.5, y * (x / 3.0 - 1.0)]
    });
    let start = IntervalBox::from([at(0.0), at(10.0), at(2.0)]);
    let time = TimeDomain::uniform(0.0, 0.01, 500).unwrap();
    let tube = Tube::solution(time, &controlled, start, Steps { least: 4, most: 64 }).unwrap();
    let [_, x, y] = tube.last_gate().sides();
    println!("x(5) = {x}, {y}");
    assert!(x.inflate(5e-10).contains(3.645637773) && x.width() < 1e-4);
    assert!(y.inflate(5e-8).contains(67.4590703) && y.width() < 1e-2);
    for (gate, time_s) in tube.gates().zip(tube.domain().borders_s()) {
        let truth = 3.0 + (at(time_s) * 0.5).sin() + (-at(time_s)).exp() * 7.0;
        assert!(!truth.is_disjoint_from(gate[1]));
    }
}

#[test]
fn van_der_pol_forward_and_backward() {
    let oscillator = Expression::system(|[x, v]| [v, (1.0 - x.sqr()) * v - x]);
    let field = |_: f64, s: &Vector2<f64>| Vector2::new(s.y, (1.0 - s.x * s.x) * s.y - s.x);
    let time = TimeDomain::uniform(0.0, 0.01, 1500).unwrap();
    let start = Vector2::new(0.5, -0.3);
    let truth = runge_kutta(field, start, 0.01, 1500);
    let box_around = IntervalBox::centred(&start, 0.001);
    let mut tube = Tube::solution(time, &oscillator, box_around, Steps { least: 4, most: 64 }).unwrap();
    assert!(holds_all(&tube, &truth));
    let before = tube.volume();
    println!("Van der Pol, from 0.002: {:.3} after 15 s", tube.last_gate().width());

    // What is learnt after 2 s says where it started.
    tube.contract_gate(200, &IntervalBox::centred(&truth[200], 1e-4)).unwrap();
    let evolved = tube.contract_evolution(&oscillator, Direction::Both, Steps::default());
    assert_eq!(evolved, Evolved { contracted: Contracted::Narrowed, diverged: None });
    assert!(holds_all(&tube, &truth));
    assert!(tube.gate(0).unwrap().width() < 1.8e-3 && tube.volume() < before);
    assert!(tube.gates().zip(tube.slices()).all(|(gate, slice)| gate.is_subset_of(&slice)));
    assert_eq!(tube.codomain(), tube.slices().reduce(|hull, slice| hull | slice).unwrap());
}

#[test]
fn steps_halve_until_a_slice_has_an_enclosure() {
    let time = TimeDomain::uniform(0.0, 2.0, 3).unwrap();
    let start = IntervalBox::from([at(1.0), at(0.0)]);
    let coarse = Tube::solution(time.clone(), &harmonic(), start, Steps::default()).unwrap();
    assert!(coarse.last_gate()[0].contains(pxfm::f_cos(6.0)));
    println!("cos 6 in steps of at most 2 s to {:.3}", coarse.last_gate().width());
    let fine = Tube::solution(time.clone(), &harmonic(), start, Steps { least: 512, most: 512 }).unwrap();
    assert!(fine.last_gate()[0].contains(pxfm::f_cos(6.0)) && fine.last_gate().width() < 1e-4);
    let diverged = Tube::solution(time.clone(), &harmonic(), start, Steps::ONE).unwrap_err();
    assert_eq!(diverged, Diverged { slice: 0, from_s: 0.0, to_s: 2.0 });

    // What is known already takes the place of an enclosure.
    let mut known = Tube::constant(time, IntervalBox::from([over(-3.0, 3.0); 2]));
    known.contract_gate(0, &start).unwrap();
    let evolved = known.contract_evolution(&harmonic(), Direction::Forward, Steps::ONE);
    assert_eq!(evolved.diverged, None);
    assert!(known.gate(1).unwrap()[0].contains(pxfm::f_cos(2.0)));
}

#[test]
fn a_blast_diverges_and_ends() {
    let blast = Expression::new(|[x]| x.sqr());
    let mut tube = Tube::constant(TimeDomain::uniform(0.0, 0.01, 200).unwrap(), IntervalBox::ENTIRE);
    tube.contract_gate(0, &IntervalBox::from([at(1.0)])).unwrap();
    let evolved = tube.contract_evolution(&blast, Direction::Both, Steps::default());
    let diverged = evolved.diverged.unwrap();
    assert!(diverged.to_s > 0.95 && diverged.from_s < 1.0, "{diverged}");
    assert!(tube.at(0.9).unwrap()[0].contains(10.0));
    assert_eq!(tube.last_gate(), IntervalBox::ENTIRE);
}

#[test]
fn empty_and_unbounded_states() {
    let time = TimeDomain::uniform(0.0, 0.1, 10).unwrap();
    let empty = Tube::solution(time.clone(), &harmonic(), IntervalBox::EMPTY, Steps::default()).unwrap();
    assert!(empty.is_empty());
    // A vehicle of known speed that may be anywhere.
    let drift = |_: Interval, _: &IntervalBox<2>| IntervalBox::from([at(1.0), over(-0.5, 0.5)]);
    let anywhere = IntervalBox::from([Interval::ENTIRE, at(0.0)]);
    let tube = Tube::solution(time.clone(), &drift, anywhere, Steps::default()).unwrap();
    assert_eq!(tube.last_gate()[0], Interval::ENTIRE);
    assert!(tube.last_gate()[1].width() < 1.0 + 1e-9);
    // A root that is defined nowhere leaves no solution.
    let nowhere = Expression::new(|[x]| x.sqrt());
    let tube = Tube::solution(time, &nowhere, IntervalBox::from([over(-2.0, -1.0)]), Steps::default());
    assert!(tube.unwrap().is_empty());
}

#[test]
fn euler_loses_the_truth_and_says_so_in_its_name() {
    let time = TimeDomain::uniform(0.0, 0.01, 100).unwrap();
    let mut tube = Tube::constant(time, IntervalBox::ENTIRE);
    tube.contract_gate(0, &IntervalBox::from([at(1.0), at(0.0)])).unwrap();
    assert_eq!(tube.contract_euler_unguaranteed(&harmonic(), Direction::Forward), Contracted::Narrowed);
    assert!(!tube.last_gate()[0].contains(pxfm::f_cos(1.0)));
    assert!((tube.last_gate()[0].mid() - pxfm::f_cos(1.0)).abs() < 0.01);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Random quadratic fields with an input that jumps from slice to slice.
    #[test]
    fn no_solution_is_lost(
        linear in prop::array::uniform4(-2.0..2.0_f64),
        quadratic in prop::array::uniform4(-0.3..0.3_f64),
        start in prop::array::uniform2(-1.5..1.5_f64),
        offset in prop::array::uniform2(-1.0..1.0_f64),
        inputs in prop::array::uniform16(-1.0..1.0_f64),
        radius in 0.0..0.1_f64,
        noise in 0.0..0.3_f64,
        measured in 0..=16_usize,
        with_jacobian: bool,
    ) {
        let [a, b, c, d] = linear;
        let [e, f, g, h] = quadratic;
        let step_s = 0.05;
        let time = TimeDomain::uniform(0.0, step_s, 16).unwrap();
        let truth = {
            let mut truth = vec![Vector2::from(start)];
            for input in inputs {
                let field = |_: f64, s: &Vector2<f64>| Vector2::new(
                    a * s.x + b * s.y + e * s.x * s.y + f * s.x * s.x + input,
                    c * s.x + d * s.y + g * s.x * s.y + h * s.y * s.y - 0.5 * input,
                );
                truth.push(*runge_kutta(field, truth[truth.len() - 1], step_s, 1).last().unwrap());
            }
            truth
        };
        // A truth that blows up is none to compare with.
        prop_assume!(truth.iter().all(|state| state.amax() < 20.0));
        // Off centre, so that the truth may be on an edge.
        let command = Tube::from_parts(
            time.clone(),
            inputs.map(|input| at(input + noise * offset[0]).inflate(noise)),
            [Interval::ENTIRE; 17],
        ).unwrap();
        let velocity = |times_s: Interval, s: &IntervalBox<2>| {
            let input = command.over(times_s).unwrap();
            let [x, y] = s.sides();
            IntervalBox::from([
                x * a + y * b + x * y * e + x.sqr() * f + input,
                x * c + y * d + x * y * g + y.sqr() * h - input * 0.5,
            ])
        };
        let driven = Driven::new(velocity, |_: Interval, s: &IntervalBox<2>| {
            let [x, y] = s.sides();
            shoal_interval::IntervalMatrix::from([
                [y * e + x * f * 2.0 + a, x * e + b],
                [y * g + c, x * g + y * h * 2.0 + d],
            ])
        });
        let contract = |tube: &mut Tube<IntervalBox<2>>| {
            if with_jacobian {
                tube.contract_evolution(&driven, Direction::Both, Steps::default())
            } else {
                tube.contract_evolution(&velocity, Direction::Both, Steps::default())
            }
        };
        let mut tube = Tube::constant(time, IntervalBox::ENTIRE);
        let off = truth[measured] + Vector2::from(offset) * radius;
        tube.contract_gate(measured, &IntervalBox::centred(&off, radius)).unwrap();
        contract(&mut tube);
        prop_assert!(holds_all(&tube, &truth), "lost after one contraction");
        let before = tube.clone();
        contract(&mut tube);
        prop_assert!(holds_all(&tube, &truth), "lost after two contractions");
        prop_assert!(tube.is_subset_of(&before).unwrap());
    }
}
