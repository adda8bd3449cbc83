//! No form loses a value, no contractor a solution, no separator a vector: on expressions of many shapes.

use super::*;
use proptest::prelude::*;

/// Expressions of three variables that use every operation, with kinks, jumps, holes and repeated variables.
fn expressions() -> Vec<Expression<3, 1>> {
    vec![
        Expression::new(|[x, y, z]| ((x - y).sqr() + (y - 3.0 * z).sqr()).sqrt()),
        Expression::new(|[x, y, z]| x * y + (x + y).cos() - (z + 2.0).sqrt()),
        Expression::new(|[x, y, z]| x * (1.0 - x) * y - z / (x - y)),
        Expression::new(|[x, y, z]| (x * y).exp() - (x.sqr() + 1.0).ln() * z),
        Expression::new(|[x, y, z]| x.abs().max(y - z) - x.min(y * z)),
        Expression::new(|[x, y, z]| y.atan2(x) + (z * x).atan() * y),
        Expression::new(|[x, y, z]| x.tan() * y.sin() - z.powi(3) + y.powi(-2)),
        Expression::new(|[x, y, z]| (x / 4.0).asin() + (y / 4.0).acos() * (z - x)),
        Expression::new(|[x, y, z]| x.floor() * y - z.ceil() + (y - 0.5).sign()),
        Expression::new(|[x, y, z]| x.abs().powf(y) + z.powf(0.5) - x.powi(4)),
        Expression::new(|[x, y, z]| 1.0 / (x.sqr() + y.sqr() + z.sqr()) + x * y * z),
        Expression::new(|[x, y, z]| (x - x * y).sin() / (z - y).exp() + over(-0.5, 0.5) * x),
        Expression::new(|[x, y, z]| {
            let same = x;
            (x - same) / (x / same) + (y - z).powi(5) - y.sqr().powi(0)
        }),
        Expression::new(|[x, y, z]| (2.0 - x).sqrt().sqrt() - (y * z + z).ln() * 1.0e3),
    ]
}

/// A box, a smaller box in it and a vector in both. Often narrow, often with whole numbers for bounds.
fn nested_boxes() -> impl Strategy<Value = (IntervalBox<3>, IntervalBox<3>, [f64; 3])> {
    let member = prop_oneof![2 => -4.0..4.0_f64, 1 => (-4_i32..=4).prop_map(f64::from)];
    let reach = || prop_oneof![1 => Just(0.0), 2 => 0.0..1.0e-3_f64, 3 => 0.0..1.0_f64, 1 => 0.0..1.0e3_f64];
    let side = (member, [reach(), reach(), reach(), reach()]).prop_map(|(x, [a, b, c, d])| {
        let inner = over(x - a, x + b);
        (over(inner.lower() - c, inner.upper() + d), inner, x)
    });
    [side.clone(), side.clone(), side].prop_map(|sides| {
        (sides.map(|side| side.0).into(), sides.map(|side| side.1).into(), sides.map(|side| side.2))
    })
}

fn point(vector: [f64; 3]) -> IntervalBox<3> {
    vector.map(|x| over(x, x)).into()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn no_form_loses_a_value((domain, inner, vector) in nested_boxes()) {
        for (index, f) in expressions().iter().enumerate() {
            // Where the value is not known exactly, some of what encloses it must be in every enclosure.
            let value = f.natural(&point(vector));
            let natural = f.natural(&domain);
            prop_assert!(value.is_subset_of(&natural));
            prop_assert!(f.natural(&inner).is_subset_of(&natural), "expression {index} is not inclusion monotonic");
            for form in [Expression::<3, 1>::centred, Expression::monotone, Expression::affine] {
                for within in [&domain, &inner, &point(vector)] {
                    let range = form(f, within);
                    prop_assert!(range.is_subset_of(&f.natural(within)));
                    prop_assert_eq!((range & value).is_empty(), value.is_empty(), "expression {}", index);
                }
            }
            let evaluation = f.evaluate(&domain);
            prop_assert_eq!(evaluation.range, natural);
            prop_assert!(!evaluation.defined || !value.is_empty());
        }
    }

    #[test]
    fn no_contractor_loses_a_solution((domain, _, vector) in nested_boxes(), width in 0.0..2.0_f64) {
        for (index, f) in expressions().iter().enumerate() {
            let value = f.natural(&point(vector));
            if value.is_empty() {
                continue;
            }
            let target = value.inflate(width);
            let contracted = f.contractor(target).contract(domain);
            prop_assert!(contracted.contains(&vector.into()), "expression {index}: {contracted} lost {vector:?}");
            prop_assert!(contracted.is_subset_of(&domain));

            let (mut both, mut image) = (domain, target);
            f.contract(&mut both, &mut image);
            prop_assert_eq!(both, contracted);
            prop_assert!(!(image & value).is_empty());
        }
    }

    #[test]
    fn no_separator_misplaces_a_vector(
        (domain, _, vector) in nested_boxes(),
        from in -5.0..5.0_f64,
        width in 0.0..5.0_f64,
    ) {
        let target = over(from, from + width);
        for (index, f) in expressions().iter().enumerate() {
            let value = f.natural(&point(vector));
            let cut = f.separator(target).separate(domain);
            let may_be_outside = value.is_empty() || !value[0].is_subset_of(target) ;
            let may_be_inside = !(value[0] & target).is_empty();
            // A vector that is certainly outside is never proved inside, and the reverse.
            if (value[0] & target).is_empty() {
                prop_assert!(cut.inner.contains(&vector.into()), "expression {index}");
            }
            if !may_be_outside {
                prop_assert!(cut.outer.contains(&vector.into()), "expression {index}");
            }
            prop_assert!((cut.inner | cut.outer).is_subset_of(&domain));
            match f.inclusion_test(&domain, target) {
                Membership::Inside => prop_assert!(may_be_inside),
                Membership::Outside => prop_assert!(may_be_outside),
                Membership::Undecided => (),
            }
            prop_assert_eq!(f.contractor(target).contract(domain), cut.outer);
            prop_assert_eq!(f.inner_contractor(target).contract(domain), cut.inner);
        }
    }

    #[test]
    fn a_gradient_holds_the_slopes((domain, _, vector) in nested_boxes(), other in prop::array::uniform3(0.0..=1.0_f64)) {
        // Between two members of the box the value changes by a slope of the box.
        for (index, f) in expressions().iter().enumerate() {
            let evaluation = f.evaluate(&domain);
            if !evaluation.continuous || !domain.is_bounded() {
                continue;
            }
            let end: [f64; 3] = std::array::from_fn(|axis| {
                let side = domain[axis];
                (side.lower() + other[axis] * (side.upper() - side.lower())).clamp(side.lower(), side.upper())
            });
            let change = f.natural(&point(end)) - f.natural(&point(vector));
            let slopes = f.jacobian(&domain).rows()[0];
            let bound = (0..3).fold(Interval::ZERO, |sum, axis| {
                sum + slopes[axis] * (over(end[axis], end[axis]) - vector[axis])
            });
            prop_assert!(!(change[0] & bound).is_empty(), "expression {index}: {change} beyond {bound}");
        }
    }
}
