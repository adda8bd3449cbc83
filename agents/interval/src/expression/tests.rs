//! What holds for every expression, and what is known of a few.

mod properties;
mod seeds;

use super::*;
use crate::contractor::Contractor;
use crate::separator::Separator;

fn over(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap()
}

fn line(lower: f64, upper: f64) -> IntervalBox<1> {
    over(lower, upper).into()
}

#[test]
fn what_is_computed_twice_is_recorded_once() {
    let f = Expression::new(|[x, y]| (x + y).sin() * (y + x).sin() + 2.0 * x * (2.0 * x));
    // x + y, its sine, the square of that, 2 x, the square of that, the sum
    assert_eq!(f.tape.operations.len(), 6);
    assert_eq!(f.tape.constants, [over(2.0, 2.0)]);
}

#[test]
fn constants_are_folded_and_what_has_no_part_is_dropped() {
    let f = Expression::new(|[x]| {
        let _unused = x.exp();
        let one = x * 0.0 + 1.0;
        let two = (one * 0.0).sqrt() + 4.0;
        let _ = two;
        x + Interval::point(4.0).unwrap().sqrt() * Interval::ONE
    });
    assert_eq!(f.tape.operations.len(), 1);
    assert_eq!(f.tape.constants, [over(2.0, 2.0)]);
    let zero = Expression::new(|[x]| (x.powi(1) - 1.0).max(x.powi(1) - 1.0));
    assert_eq!(zero.tape.operations.len(), 1);
}

#[test]
fn a_constant_without_a_value_is_not_folded_away() {
    let f = Expression::new(|[x]| {
        let minus_one = 1.0 * -Interval::ONE;
        x + (0.0 * x.min(minus_one)).min(minus_one).sqrt()
    });
    let evaluation = f.evaluate(&line(0.0, 1.0));
    assert!(evaluation.range.is_empty() && !evaluation.defined);
    assert_eq!(f.inclusion_test(&line(0.0, 1.0), Interval::ENTIRE), Membership::Outside);
    let nothing = Expression::new(|[x]| x + Interval::EMPTY);
    let cut = nothing.separator(Interval::ENTIRE).separate(line(0.0, 1.0));
    assert_eq!((cut.inner, cut.outer), (line(0.0, 1.0), IntervalBox::EMPTY));
}

#[test]
fn every_mention_of_an_interval_is_a_number_of_its_own() {
    let parameter = over(1.0, 2.0);
    let apart = Expression::new(|[x]| (x - parameter) * (x - parameter));
    assert_eq!(apart.natural(&line(1.5, 1.5))[0], over(-0.25, 0.25));
    let same = Expression::new(|[x]| {
        let difference = x - parameter;
        difference * difference
    });
    assert_eq!(same.natural(&line(1.5, 1.5))[0], over(0.0, 0.25));
    let unknown = Expression::new(|[x]| x * f64::NAN);
    assert_eq!(unknown.natural(&line(1.0, 1.0))[0], Interval::ENTIRE);
}

#[test]
fn outputs_may_be_variables_and_constants() {
    let f = Expression::system(|[x, y]| [y, x, y, x * 0.0 + 3.0]);
    let domain = IntervalBox::from([over(0.0, 1.0), over(2.0, 3.0)]);
    assert_eq!(f.natural(&domain), IntervalBox::from([domain[1], domain[0], domain[1], over(3.0, 3.0)]));
    let target = IntervalBox::from([over(2.0, 2.5), Interval::ENTIRE, over(2.4, 3.0), Interval::ENTIRE]);
    let contracted = f.contractor(target).contract(domain);
    assert_eq!(contracted, IntervalBox::from([domain[0], over(2.4, 2.5)]));
    assert_eq!(f.affine(&domain), f.natural(&domain));
    assert_eq!(f.jacobian(&domain).rows()[0], [Interval::ZERO, Interval::ONE]);
}

#[test]
fn an_empty_domain_gives_nothing() {
    let f = Expression::new(|[x, y]| x + 0.0 * y);
    let mut flat = IntervalBox::from([over(0.0, 1.0), Interval::EMPTY]);
    assert!(f.natural(&flat).is_empty() && f.centred(&flat).is_empty());
    assert!(f.monotone(&flat).is_empty() && f.affine(&flat).is_empty());
    assert!(f.jacobian(&flat).is_empty());
    assert_eq!(f.contract(&mut flat, &mut line(0.0, 1.0)), crate::contractor::Contracted::Empty);
    assert_eq!(flat, IntervalBox::EMPTY);
    let cut = f.separator(over(0.0, 1.0)).separate(flat);
    assert!(cut.inner.is_empty() && cut.outer.is_empty());
    assert_eq!(f.inclusion_test(&flat, over(0.0, 1.0)), Membership::Outside);
}

#[test]
fn unbounded_and_huge_boxes_behave() {
    let f = Expression::new(|[x, y]| (x * y).exp() / (x - y).sqrt() + x.atan2(y).tan() * y.powi(-3));
    let huge = IntervalBox::from([over(-f64::MAX, f64::MAX); 2]);
    for domain in
        [IntervalBox::ENTIRE, huge, IntervalBox::from([Interval::NON_NEGATIVE, -Interval::NON_NEGATIVE])]
    {
        assert!(!f.natural(&domain).is_empty() && !f.affine(&domain).is_empty());
        assert!(!f.centred(&domain).is_empty() && !f.monotone(&domain).is_empty());
        assert!(!f.contractor(Interval::ONE).contract(domain).is_empty());
    }
}

#[test]
fn where_a_function_is_undefined_or_jumps_is_known() {
    let behaviour = |f: Expression<1, 1>, lower, upper| {
        let evaluation = f.evaluate(&line(lower, upper));
        (evaluation.defined, evaluation.continuous)
    };
    let smooth = (true, true);
    let jumps = (true, false);
    let undefined = (false, false);
    assert_eq!(behaviour(Expression::new(|[x]| x.sqrt()), 0.0, 1.0), smooth);
    assert_eq!(behaviour(Expression::new(|[x]| x.sqrt()), -1e-300, 1.0), undefined);
    assert_eq!(behaviour(Expression::new(|[x]| x.ln()), 0.0, 1.0), undefined);
    assert_eq!(behaviour(Expression::new(|[x]| 1.0 / x), 0.0, 1.0), undefined);
    assert_eq!(behaviour(Expression::new(|[x]| 1.0 / x), -2.0, -1.0), smooth);
    assert_eq!(behaviour(Expression::new(|[x]| x.powi(-2)), -1.0, 1.0), undefined);
    assert_eq!(behaviour(Expression::new(|[x]| x.powf(0.5)), 0.0, 1.0), smooth);
    assert_eq!(behaviour(Expression::new(|[x]| x.powf(-0.5)), 0.0, 1.0), undefined);
    assert_eq!(behaviour(Expression::new(|[x]| x.asin()), -1.0, 1.0), smooth);
    assert_eq!(behaviour(Expression::new(|[x]| x.acos()), 0.0, 1.1), undefined);
    assert_eq!(behaviour(Expression::new(|[x]| x.tan()), -1.5, 1.5), smooth);
    assert_eq!(behaviour(Expression::new(|[x]| x.tan()), 1.5, 1.6), undefined);
    assert_eq!(behaviour(Expression::new(|[x]| x.floor()), 0.0, 0.9), smooth);
    assert_eq!(behaviour(Expression::new(|[x]| x.ceil()), 0.5, 1.5), jumps);
    assert_eq!(behaviour(Expression::new(|[x]| x.sign()), 0.0, 0.9), jumps);
    assert_eq!(behaviour(Expression::new(|[x]| x.atan2(-1.0)), -1.0, 0.9), jumps);
    assert_eq!(behaviour(Expression::new(|[x]| x.atan2(-1.0)), 0.0, 0.9), smooth);
    assert_eq!(behaviour(Expression::new(|[x]| x.atan2(0.0)), -1.0, 0.9), undefined);
}

#[test]
fn nothing_is_proved_inside_where_the_function_may_be_undefined() {
    let root = Expression::new(|[x]| x.sqrt());
    let domain = line(-1.0, 1.0);
    let cut = root.separator(over(0.0, 5.0)).separate(domain);
    assert_eq!((cut.inner, cut.outer), (domain, line(0.0, 1.0)));
    assert_eq!(root.inner_contractor(over(0.0, 5.0)).contract(domain), domain);
    assert!(root.inner_contractor(over(-1.0, 5.0)).contract(line(0.5, 1.0)).is_empty());
}

#[test]
fn the_inner_contractor_keeps_both_ends() {
    let square = Expression::new(|[x]| x.sqr());
    let cut = square.separator(over(1.0, 4.0)).separate(line(0.5, 1.5));
    assert_eq!((cut.inner, cut.outer), (line(0.5, 1.0), line(1.0, 1.5)));
    let cut = square.separator(over(1.0, 4.0)).separate(line(0.5, 3.0));
    assert_eq!((cut.inner, cut.outer), (line(0.5, 3.0), line(1.0, 2.0)));
    let both = Expression::system(|[x, y]| [x, y]);
    let unit = IntervalBox::from([over(0.0, 1.0); 2]);
    let domain = IntervalBox::from([over(0.2, 0.4), over(0.5, 2.0)]);
    assert_eq!(both.inner_contractor(unit).contract(domain), IntervalBox::from([domain[0], over(1.0, 2.0)]));
    assert_eq!(both.inner_contractor(IntervalBox::EMPTY).contract(domain), domain);
}

#[test]
fn a_kink_with_an_infinite_slope_has_any_gradient() {
    let distance = Expression::new(|[x]| x.sqr().sqrt());
    assert_eq!(distance.jacobian(&line(0.0, 0.0))[(0, 0)], Interval::ENTIRE);
    assert_eq!(distance.jacobian(&line(1.0, 2.0))[(0, 0)], over(0.5, 2.0));
    let root = Expression::new(|[x]| x.sqrt());
    assert_eq!(root.jacobian(&line(0.0, 4.0))[(0, 0)], over(0.25, f64::INFINITY));
    assert_eq!(root.monotone(&line(0.0, 4.0))[0], over(0.0, 2.0));
    let product = Expression::new(|[x]| x * x.sign());
    assert_eq!(product.jacobian(&line(0.0, 0.0))[(0, 0)], Interval::ENTIRE);
}

#[test]
fn the_centred_form_converges_with_the_square_of_the_width() {
    let f = Expression::new(|[x, y]| (x * y).sin() * x - y / (x + 2.0) + (x - y).exp());
    let excess = |width: f64, form: fn(&Expression<2, 1>, &IntervalBox<2>) -> IntervalBox<1>| {
        let domain = IntervalBox::from([over(0.5, 0.5 + width), over(0.75, 0.75 + width)]);
        // The function rises or falls here, so the monotone form is minimal.
        form(&f, &domain).width() - f.monotone(&domain).width()
    };
    for form in [Expression::<2, 1>::centred, Expression::<2, 1>::affine] {
        let (wide, narrow) = (excess(1.0 / 64.0, form), excess(1.0 / 512.0, form));
        assert!((0.0..2.0e-3).contains(&wide), "{wide}");
        assert!((40.0..90.0).contains(&(wide / narrow)), "{}", wide / narrow);
    }
    let (wide, narrow) = (excess(1.0 / 64.0, Expression::natural), excess(1.0 / 512.0, Expression::natural));
    assert!((6.0..10.0).contains(&(wide / narrow)), "{}", wide / narrow);
}

#[test]
fn long_expressions_need_no_special_room() {
    let f = Expression::new(|[x]| (1..200).fold(x, |sum, term| sum + (x * f64::from(term)).sin()));
    let domain = line(0.0, 1.0e-3);
    assert!(f.natural(&domain).is_subset_of(&line(0.0, 20.0)));
    assert!(f.affine(&domain).is_subset_of(&f.natural(&domain)));
    assert!(f.contractor(over(30.0, 40.0)).contract(domain).is_empty());
}

#[test]
fn an_operation_may_use_one_variable_twice() {
    let difference = Expression::new(|[x]| {
        let same = x;
        x - same
    });
    let contracted = difference.contractor(Interval::ONE).contract(line(0.0, 5.0));
    assert_eq!(contracted, line(1.0, 4.0));
}

#[test]
fn zero_to_a_positive_power_is_kept() {
    let power = Expression::new(|[x, y]| x.powf(y)).contractor(Interval::ZERO);
    let domain = IntervalBox::from([over(-1.0, 3.0), over(-1.0, 2.0)]);
    assert_eq!(power.contract(domain), IntervalBox::from([Interval::ZERO, over(0.0, 2.0)]));
}

#[test]
fn expressions_cross_threads() {
    fn crosses<T: Send + Sync + Clone>(_: &T) {}
    let f = Expression::new(|[x]| x.sqr());
    crosses(&f);
    crosses(&f.separator(Interval::ONE));
    let there = std::thread::spawn(move || f.natural(&line(0.0, 2.0))).join().unwrap();
    assert_eq!(there, line(0.0, 4.0));
}
