//! Lines are near their functions, and hold them.

use super::*;

fn over(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap()
}

/// The width of the remainder of a function over `[from, from + width]`, which must hold values on all of it.
fn remainder_width(function: Unary, from: f64, width: f64) -> f64 {
    let domain = over(from, from + width);
    let x = Form::<1>::variable(0, domain);
    let line = unary(function, &x);
    assert!(line.slopes[0].width() < 1.0e-12 * (1.0 + line.slopes[0].magnitude()));
    for step in 0..=64 {
        let at = over(from + width * f64::from(step) / 64.0, from + width * f64::from(step) / 64.0);
        let enclosure = line.constant + line.slopes[0] * (at - middle_of(domain));
        assert!(!(function.image(at) & enclosure).is_empty(), "{function:?} at {at}: {enclosure}");
    }
    line.constant.width()
}

#[test]
fn a_line_holds_the_function_and_leaves_a_remainder_of_second_order() {
    let smooth = [
        Unary::Square,
        Unary::SquareRoot,
        Unary::Exponential,
        Unary::Logarithm,
        Unary::Sine,
        Unary::Cosine,
        Unary::Tangent,
        Unary::ArcTangent,
        Unary::Power(3),
        Unary::Power(-1),
    ];
    for function in smooth {
        for from in [0.1, 0.25, 0.6] {
            let (wide, narrow) =
                (remainder_width(function, from, 0.125), remainder_width(function, from, 0.0625));
            let ratio = wide / narrow;
            assert!((2.5..6.0).contains(&ratio), "{function:?} from {from}: {wide} / {narrow}");
        }
    }
}

#[test]
fn the_best_lines_are_known() {
    // x^2 on [0, 2] is within 1/2 of 2 x - 1/2, |x| on [-1, 1] within 1/2 of 1/2.
    assert_eq!(remainder_width(Unary::Square, 0.0, 2.0), 1.0);
    assert_eq!(remainder_width(Unary::Absolute, -1.0, 2.0), 1.0);
    assert_eq!(remainder_width(Unary::Absolute, -1.0, 0.5), 0.0);
    assert!((remainder_width(Unary::SquareRoot, 0.0, 1.0) - 0.25).abs() < 1.0e-12);
    let reciprocal =
        binary(Binary::Quotient, &Form::remainder(Interval::ONE), &Form::<1>::variable(0, over(1.0, 4.0)));
    // 1 / x on [1, 4] is between -x / 4 + 1 and -x / 4 + 5/4.
    assert!((reciprocal.constant.width() - 0.25).abs() < 1.0e-12);
}

#[test]
fn extreme_ranges_give_up_the_slopes_only() {
    let functions = [Unary::Square, Unary::SquareRoot, Unary::Exponential, Unary::Logarithm, Unary::Power(7)];
    for function in functions {
        for domain in
            [over(0.0, f64::MAX), over(0.0, 0.0), over(0.0, f64::from_bits(1)), Interval::NON_NEGATIVE]
        {
            let from_middle = [domain - middle_of(domain)];
            let form = unary(function, &Form::<1>::variable(0, domain)).narrowed(&from_middle);
            assert!(
                form.range.is_subset_of(function.image(domain)) && !form.range.is_empty()
                    || domain.upper() == 0.0
            );
        }
    }
}
