use super::*;
use crate::strategies::{everyday_number, number};
use proptest::prelude::*;
use std::f64::consts::PI;

type Unary = (&'static str, fn(Interval) -> Interval, fn(Interval, Interval) -> Interval);
type Binary =
    (&'static str, fn(Interval, Interval) -> Interval, fn(Interval, Interval, Interval) -> Interval);

/// Each function with its reverse, `f(x)` and `c.f_rev(x)`.
const UNARY: [Unary; 22] = [
    ("sqr", Interval::sqr, Interval::sqr_rev),
    ("sqrt", Interval::sqrt, Interval::sqrt_rev),
    ("abs", Interval::abs, Interval::abs_rev),
    ("recip", Interval::recip, Interval::recip_rev),
    ("sign", Interval::sign, Interval::sign_rev),
    ("floor", Interval::floor, Interval::floor_rev),
    ("ceil", Interval::ceil, Interval::ceil_rev),
    ("exp", Interval::exp, Interval::exp_rev),
    ("ln", Interval::ln, Interval::ln_rev),
    ("sin", Interval::sin, Interval::sin_rev),
    ("cos", Interval::cos, Interval::cos_rev),
    ("tan", Interval::tan, Interval::tan_rev),
    ("wrap_angle", Interval::wrap_angle, Interval::wrap_angle_rev),
    ("asin", Interval::asin, Interval::asin_rev),
    ("acos", Interval::acos, Interval::acos_rev),
    ("atan", Interval::atan, Interval::atan_rev),
    ("cube", |x| x.powi(3), |c, x| c.pown_rev(x, 3)),
    ("power 8", |x| x.powi(8), |c, x| c.pown_rev(x, 8)),
    ("power -1", |x| x.powi(-1), |c, x| c.pown_rev(x, -1)),
    ("power -2", |x| x.powi(-2), |c, x| c.pown_rev(x, -2)),
    ("power -5", |x| x.powi(-5), |c, x| c.pown_rev(x, -5)),
    ("power 0", |x| x.powi(0), |c, x| c.pown_rev(x, 0)),
];

/// Each function with the reverse for its sought argument, `f(x, b)` and `b.f_rev(c, x)`.
const BINARY: [Binary; 12] = [
    ("add", |x, b| x + b, Interval::add_rev),
    ("sub 1", |x, b| x - b, Interval::sub_rev1),
    ("sub 2", |x, a| a - x, Interval::sub_rev2),
    ("mul", |x, b| x * b, Interval::mul_rev),
    ("div 1", |x, b| x / b, Interval::div_rev1),
    ("div 2", |x, a| a / x, Interval::div_rev2),
    ("min", Interval::min, Interval::min_rev),
    ("max", Interval::max, Interval::max_rev),
    ("pow 1", Interval::powf, Interval::pow_rev1),
    ("pow 2", |x, a| a.powf(x), Interval::pow_rev2),
    ("atan2 1", Interval::atan2, Interval::atan2_rev1),
    ("atan2 2", |x, a| a.atan2(x), Interval::atan2_rev2),
];

fn point(x: f64) -> Interval {
    Interval::from_bounds(x, x)
}

/// The solution stays, nothing is added, and close to each end that moved there is a solution: `image` of its neighbourhood
/// and `c` meet.
fn is_sound_and_tight(
    name: &str,
    (solution, x): (f64, Interval),
    c: Interval,
    image: impl Fn(Interval) -> Interval,
    reverse: impl Fn(Interval) -> Interval,
) -> Result<(), TestCaseError> {
    let result = reverse(x);
    prop_assert!(result.contains(solution), "{name}: {solution:e} of {x:?} is lost from {result:?}, {c:?}");
    prop_assert!(result.is_subset_of(x), "{name}: {result:?} is not in {x:?}");
    prop_assert!(reverse(result).contains(solution), "{name}: {solution:e} is lost the second time");
    const UNITS: usize = 8;
    // Where a root is about to overflow, its correction does.
    const TIGHT_BELOW: f64 = 1e307;
    let outwards = |end: f64, step: fn(f64) -> f64| (0..UNITS).fold(end, |end, _| step(end));
    if result.lower() > x.lower() && result.lower() < TIGHT_BELOW {
        let near =
            Interval::from_bounds(result.lower(), outwards(result.lower(), f64::next_up).min(f64::MAX));
        prop_assert!(
            !(image(near) & c).is_empty(),
            "{name}: no solution near the lower end of {result:?}, {c:?}"
        );
    }
    if result.upper() < x.upper() {
        let near =
            Interval::from_bounds(outwards(result.upper(), f64::next_down).max(f64::MIN), result.upper());
        prop_assert!(
            !(image(near) & c).is_empty(),
            "{name}: no solution near the upper end of {result:?}, {c:?}"
        );
    }
    Ok(())
}

/// Sets with a solution inside, and at either end, where a branch that is met wrongly loses it.
fn around(solution: f64, one: f64, other: f64) -> [(f64, Interval); 4] {
    let between = Interval::spanning(one, other);
    let inside = solution.clamp(between.lower(), between.upper());
    [
        (solution, Interval::spanning(solution, one)),
        (solution, Interval::spanning(solution, other)),
        (solution, Interval::ENTIRE),
        (inside, between),
    ]
}

fn argument() -> impl Strategy<Value = f64> {
    prop_oneof![1 => number(), 2 => everyday_number(), 1 => -2.0..2.0_f64]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4096))]

    #[test]
    fn unary_functions(solution in argument(), one in argument(), other in argument(), wide in any::<bool>()) {
        for (name, function, reverse) in UNARY {
            for (solution, x) in around(solution, one, other) {
                let mut c = function(point(solution));
                if c.is_empty() {
                    continue;
                }
                if wide {
                    c = c | function(point(other));
                }
                is_sound_and_tight(name, (solution, x), c, function, |x| reverse(c, x))?;
            }
        }
    }

    #[test]
    fn binary_functions(
        solution in argument(), one in argument(), other in argument(),
        known in argument(), unknown in argument(), wide in any::<bool>(),
    ) {
        for (name, function, reverse) in BINARY {
            for (solution, x) in around(solution, one, other) {
                let mut c = function(point(solution), point(known));
                if c.is_empty() {
                    continue;
                }
                if wide {
                    c = c | function(point(other), point(known));
                }
                let b = if wide { point(known) } else { Interval::spanning(known, unknown) };
                is_sound_and_tight(name, (solution, x), c, |x| function(x, b), |x| reverse(b, c, x))?;
            }
        }
    }

    #[test]
    fn both_quotients(factor in argument(), other_factor in argument(), solution in argument(), other in argument()) {
        let b = Interval::spanning(factor, other_factor);
        let c = (point(factor) * point(solution)) | point(other);
        let (below, above) = b.mul_rev_to_pair(c);
        prop_assert!(below.contains(solution) || above.contains(solution));
        prop_assert!(above.is_empty() || below.upper() <= above.lower());
        prop_assert_eq!(below | above, b.mul_rev(c, Interval::ENTIRE));
    }
}

#[test]
fn an_empty_operand_leaves_nothing() {
    let (empty, entire) = (Interval::EMPTY, Interval::ENTIRE);
    for (name, _, reverse) in UNARY {
        assert!(reverse(empty, entire).is_empty() && reverse(entire, empty).is_empty(), "{name}");
    }
    for (name, _, reverse) in BINARY {
        let results =
            [reverse(empty, entire, entire), reverse(entire, empty, entire), reverse(entire, entire, empty)];
        assert!(results.into_iter().all(Interval::is_empty), "{name}: {results:?}");
    }
    assert_eq!(empty.mul_rev_to_pair(entire), (empty, empty));
    assert_eq!(entire.mul_rev_to_pair(empty), (empty, empty));
}

#[test]
fn a_limit_that_is_not_reached_is_no_solution() {
    let over = |lower, upper| Interval::new(lower, upper).unwrap();
    let not_positive = over(-1.0, 0.0);
    assert!(over(f64::NEG_INFINITY, 1.0).ln_rev(not_positive).is_empty());
    assert!(over(0.0, 1.0).div_rev1(over(1.0, 2.0), not_positive).is_empty());
    assert!(over(0.0, 1.0).div_rev2(over(1.0, 2.0), not_positive).is_empty());
    assert!(Interval::NON_NEGATIVE.recip_rev(not_positive).is_empty());
    assert!(over(0.0, 5.0).atan2_rev1(over(0.1, 1.0), not_positive).is_empty());
    assert!(over(0.0, 5.0).atan2_rev2(over(0.1, 1.0), not_positive).is_empty());
    assert!(Interval::ONE.sign_rev(not_positive).is_empty());
    assert!(over(1.6, 9.0).asin_rev(Interval::ENTIRE).is_empty());
    assert!(over(1.6, 9.0).atan_rev(Interval::ENTIRE).is_empty());
    assert!(over(3.2, 9.0).acos_rev(Interval::ENTIRE).is_empty());
}

#[test]
fn the_lowest_and_the_highest_branch_count() {
    let solutions = Interval::ONE.sin_rev(Interval::from_bounds(2.0, 1e6));
    assert_eq!(format!("{solutions:.6}"), "[7.853981, 999995.645176]");
    let solutions = Interval::ZERO.cos_rev(Interval::from_bounds(-1e9, 1e9));
    assert!(solutions.width() > 2e9 - 2.0 * PI && solutions.is_subset_of(Interval::from_bounds(-1e9, 1e9)));
    assert!(Interval::ONE.sin_rev(Interval::from_bounds(2.0, 7.0)).is_empty());
}

#[test]
fn angles_beyond_counting_are_left_as_they_are() {
    let far = Interval::from_bounds(1e300, 2e300);
    let half = point(0.5);
    for reverse in [Interval::sin_rev, Interval::cos_rev, Interval::tan_rev, Interval::wrap_angle_rev] {
        assert_eq!(reverse(half, far), far);
        assert_eq!(reverse(half, Interval::ENTIRE), Interval::ENTIRE);
    }
}

#[test]
fn bearings_all_around() {
    let over = |lower, upper| Interval::new(lower, upper).unwrap();
    let quarter = Interval::HALF_PI;
    assert_eq!(Interval::ZERO.atan2_rev1(quarter, over(-3.0, 5.0)), over(0.0, 5.0));
    let across = over(-2.0, -1.0).atan2_rev1(Interval::PI, over(-3.0, 5.0));
    assert!(across.lower() == 0.0 && across.upper() < 1e-15);
    assert_eq!(Interval::ZERO.atan2_rev2(Interval::PI, over(-3.0, 5.0)), over(-3.0, 0.0));
    assert_eq!(Interval::ZERO.atan2_rev2(Interval::ZERO, over(-3.0, 5.0)), over(0.0, 5.0));
    assert!(over(1.0, 2.0).atan2_rev2(-quarter, Interval::ENTIRE).is_empty());
}
