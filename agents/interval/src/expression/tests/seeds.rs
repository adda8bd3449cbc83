//! The numbers printed in the seeds.

use super::*;
use crate::contractor::Contracted;

fn at_most(bound: f64) -> Interval {
    over(f64::NEG_INFINITY, bound)
}

fn at_least(bound: f64) -> Interval {
    over(bound, f64::INFINITY)
}

/// Seed 001, equations (2.39) to (2.41); seed 003, section 6.2.
#[test]
fn a_sum_is_contracted_forward_and_backward() {
    let sum = Expression::new(|[x, y]| x + y);
    let mut terms = IntervalBox::from([at_most(2.0), at_most(3.0)]);
    let mut total = IntervalBox::from(at_least(4.0));
    assert_eq!(sum.contract(&mut terms, &mut total), Contracted::Narrowed);
    assert_eq!(terms, IntervalBox::from([over(1.0, 2.0), over(2.0, 3.0)]));
    assert_eq!(total[0], over(4.0, 5.0));
    assert_eq!(sum.contract(&mut terms, &mut total), Contracted::Unchanged);

    let balance = Expression::new(|[x, y, z]| x + y - z).contractor(Interval::ZERO);
    let contracted = balance.contract(IntervalBox::from([at_most(5.0), at_most(4.0), at_least(6.0)]));
    assert_eq!(contracted, IntervalBox::from([over(2.0, 5.0), over(1.0, 4.0), over(6.0, 9.0)]));
}

/// Seed 001, equations (2.42) to (2.49), which print `-x + 1` and compute with `-3 x + 1`; seed 003, section 6.3, with
/// `-2 x + 1` and `x y = 1`.
#[test]
fn three_constraints_that_contradict_each_other_leave_nothing() {
    for (product, slope) in [(2.0, -1.0), (1.0, -3.0), (2.0, -3.0), (1.0, -2.0)] {
        let parabola = Expression::new(|[x, y]| y - x.sqr()).contractor(Interval::ZERO);
        let hyperbola = Expression::new(|[x, y]| x * y - product).contractor(Interval::ZERO);
        let straight = Expression::new(|[x, y]| y - (slope * x + 1.0)).contractor(Interval::ZERO);

        let first = straight.contract(hyperbola.contract(parabola.contract(IntervalBox::ENTIRE)));
        assert!(first.is_subset_of(&[over(0.0, (-1.0 / slope).next_up()), over(0.0, 1.0)].into()));
        let one_by_one = parabola.then(hyperbola).then(straight).fixpoint(0.0);
        assert!(one_by_one.contract(IntervalBox::ENTIRE).is_empty());

        let all = Expression::system(|[x, y]| [y - x.sqr(), x * y - product, y - (slope * x + 1.0)]);
        assert!(all.contractor([Interval::ZERO; 3]).fixpoint(0.0).contract(IntervalBox::ENTIRE).is_empty());
    }
}

/// Seed 003, section 6.4: nothing can be removed from the printed box, and the decomposition is that of the seed.
#[test]
fn a_constraint_is_decomposed() {
    let balance = Expression::new(|[x, y, z]| x + y.sin() - x * z);
    assert_eq!(balance.tape.operations.len(), 4);
    let domain = IntervalBox::from([over(-1.0, 1.0); 3]);
    assert_eq!(balance.contractor(at_most(0.0)).contract(domain), domain);
}

/// Seed 003, section 6.5, to every printed digit: `[2.58, 3.35]` are the first digits of 2.5846 and 3.3548.
#[test]
fn the_circuit() {
    let laws = Expression::system(|[r1, r2, e, i, u1, u2, p]| {
        [e * i - p, (r1 + r2) * i - e, r1 * i - u1, r2 * i - u2, u1 + u2 - e]
    });
    let measured = IntervalBox::from([
        Interval::NON_NEGATIVE,
        Interval::NON_NEGATIVE,
        over(23.0, 26.0),
        over(4.0, 8.0),
        over(10.0, 11.0),
        over(14.0, 17.0),
        over(124.0, 130.0),
    ]);
    let circuit = laws.contractor([Interval::ZERO; 5]).fixpoint(0.0).contract(measured);
    let digits = |side: Interval, decimals: i32| {
        let scale = [1.0, 10.0, 100.0, 1000.0][decimals as usize];
        ((side.lower() * scale).floor() / scale, (side.upper() * scale).floor() / scale)
    };
    assert_eq!(digits(circuit[0], 2), (1.84, 2.30));
    assert_eq!(format!("{:.2}", circuit[0].upper()), "2.31");
    assert_eq!(digits(circuit[1], 2), (2.58, 3.35));
    assert_eq!(circuit[2], over(24.0, 26.0));
    assert_eq!(format!("{:.3}", circuit[3]), "[4.769, 5.417]");
    assert_eq!(circuit[4], over(10.0, 11.0));
    assert_eq!(circuit[5], over(14.0, 16.0));
    assert_eq!(circuit[6], over(124.0, 130.0));
}

/// Seed 001, table 2.1, beside the contractor written by hand.
#[test]
fn the_distance_is_contracted_as_by_hand() {
    let distance = Expression::new(|[x1, y1, x2, y2]| ((x1 - x2).sqr() + (y1 - y2).sqr()).sqrt());
    let mut domain = IntervalBox::from([over(1.0, 9.0), over(-3.0, 3.0), Interval::ZERO, Interval::ZERO]);
    let mut range = IntervalBox::from(over(4.0, 5.0));
    assert_eq!(distance.contract(&mut domain, &mut range), Contracted::Narrowed);
    assert_eq!(format!("{domain:.2}"), "[2.64, 5.00] x [-3.00, 3.00] x [0.00, 0.00] x [0.00, 0.00]");
}

/// Seed 001, the example of section 2.3.4: the natural inclusion function is the formula with intervals.
#[test]
fn the_natural_inclusion_function_is_the_formula_with_intervals() {
    let f = Expression::new(|[x, y]| x * y + (x + y).cos() - (x + 2.0).sqrt());
    for (x, y) in [
        (over(-1.0, 1.0), over(0.0, 3.0)),
        (over(-5.0, 2.0), over(-1.0, 7.0)),
        (Interval::ZERO, Interval::ONE),
    ] {
        let by_hand = x * y + (x + y).cos() - (x + 2.0).sqrt();
        assert_eq!(f.natural(&IntervalBox::from([x, y]))[0], by_hand);
    }
}
