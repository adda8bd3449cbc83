//! Sums, products and squares: nothing lost, and each bound attained.

use super::*;
use crate::strategies::{everyday_number, interval_with_members};
use proptest::prelude::*;

fn over(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap()
}

/// An everyday interval, often touching or holding zero.
fn everyday() -> impl Strategy<Value = Interval> {
    let bound = || prop_oneof![3 => everyday_number(), 1 => Just(0.0), 1 => (-3_i32..=3).prop_map(f64::from)];
    (bound(), bound()).prop_map(|(one, other)| Interval::spanning(one, other))
}

/// The interval, a little wider than rounding can make it.
fn loosened(interval: Interval) -> Interval {
    interval.inflate(1e-12 * interval.magnitude().max(1e-3))
}

fn point(x: f64) -> Interval {
    over(x, x)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn no_sum_is_lost(x in interval_with_members(), y in interval_with_members(), extra in interval_with_members()) {
        let exact = point(x.1) + point(y.1);
        let before = IntervalBox::from([x.0, y.0, exact | extra.0]);
        let after = Sum.contract(before);
        prop_assert!(after.is_subset_of(&before));
        prop_assert!(after[0].contains(x.1) && after[1].contains(y.1) && !(after[2] & exact).is_empty());
        let smaller = Sum.contract(IntervalBox::from([x.0 & over(x.1.min(x.2), x.1.max(x.2)), y.0, before[2]]));
        prop_assert!(smaller.is_subset_of(&after));
    }

    #[test]
    fn no_product_is_lost(x in interval_with_members(), y in interval_with_members(), extra in interval_with_members()) {
        let exact = point(x.1) * point(y.1);
        let before = IntervalBox::from([x.0, y.0, exact | extra.0]);
        let after = Product.contract(before);
        prop_assert!(after.is_subset_of(&before));
        prop_assert!(after[0].contains(x.1) && after[1].contains(y.1) && !(after[2] & exact).is_empty());
        let smaller = Product.contract(IntervalBox::from([x.0, over(y.1.min(y.2), y.1.max(y.2)), before[2]]));
        prop_assert!(smaller.is_subset_of(&after));
    }

    #[test]
    fn no_square_is_lost(x in interval_with_members(), extra in interval_with_members()) {
        let exact = point(x.1).sqr();
        let before = IntervalBox::from([x.0, exact | extra.0]);
        let after = Square.contract(before);
        prop_assert!(after.is_subset_of(&before));
        prop_assert!(after[0].contains(x.1) && !(after[1] & exact).is_empty());
    }

    #[test]
    fn each_bound_of_a_sum_is_attained(x in everyday(), y in everyday(), z in everyday()) {
        let after = Sum.contract(IntervalBox::from([x, y, z]));
        if after.is_empty() {
            prop_assert!((z & (x + y)).is_empty());
        } else {
            for bound in [after[0].lower(), after[0].upper()] {
                prop_assert!(!(loosened(z) & (point(bound) + loosened(y))).is_empty());
            }
            for bound in [after[1].lower(), after[1].upper()] {
                prop_assert!(!(loosened(z) & (point(bound) + loosened(x))).is_empty());
            }
            for bound in [after[2].lower(), after[2].upper()] {
                prop_assert!(!(point(bound) & (loosened(x) + loosened(y))).is_empty());
            }
        }
    }

    #[test]
    fn each_bound_of_a_product_is_attained(x in everyday(), y in everyday(), z in everyday()) {
        // For one number as a factor the image is exact, so it tells whether the bound belongs to a solution.
        let after = Product.contract(IntervalBox::from([x, y, z]));
        if after.is_empty() {
            prop_assert!((z & (x * y)).is_empty());
        } else {
            for bound in [after[0].lower(), after[0].upper()] {
                prop_assert!(!(loosened(z) & (point(bound) * y)).is_empty(), "{} * {} = {}: {}", x, y, z, after);
            }
            for bound in [after[1].lower(), after[1].upper()] {
                prop_assert!(!(loosened(z) & (point(bound) * x)).is_empty(), "{} * {} = {}: {}", x, y, z, after);
            }
            for bound in [after[2].lower(), after[2].upper()] {
                prop_assert!(!(point(bound) & (x * y)).is_empty());
            }
        }
    }

    #[test]
    fn each_bound_of_a_square_is_attained(x in everyday(), y in everyday()) {
        let after = Square.contract(IntervalBox::from([x, y]));
        if after.is_empty() {
            prop_assert!((y & x.sqr()).is_empty());
        } else {
            for bound in [after[0].lower(), after[0].upper()] {
                prop_assert!(!(loosened(y) & point(bound).sqr()).is_empty());
            }
            for bound in [after[1].lower(), after[1].upper()] {
                let root = loosened(point(bound).sqrt());
                prop_assert!(!(x & root).is_empty() || !(x & -root).is_empty());
            }
        }
    }
}

#[test]
fn zero_factors() {
    let anything = over(-5.0, 7.0);
    let contracted = |x, y, z| Product.contract(IntervalBox::from([x, y, z]));
    assert_eq!(contracted(anything, Interval::ZERO, anything)[2], Interval::ZERO);
    assert_eq!(contracted(anything, Interval::ZERO, anything)[0], anything);
    assert!(contracted(anything, Interval::ZERO, Interval::ONE).is_empty());
    assert_eq!(contracted(Interval::ENTIRE, anything, Interval::ONE)[0], Interval::ENTIRE);
    assert_eq!(contracted(over(-0.1, 9.0), over(-1.0, 1.0), over(1.0, 2.0))[0], over(1.0, 9.0));
}

#[test]
fn what_happened_is_told() {
    let (mut x, mut y, mut z) = (over(0.0, 1.0), over(0.0, 1.0), over(0.0, 2.0));
    assert_eq!(contract_sum(&mut x, &mut y, &mut z), Contracted::Unchanged);
    z = over(1.5, 9.0);
    assert_eq!(contract_sum(&mut x, &mut y, &mut z), Contracted::Narrowed);
    z = over(3.0, 9.0);
    assert_eq!(contract_sum(&mut x, &mut y, &mut z), Contracted::Empty);
    assert!(x.is_empty() && y.is_empty() && z.is_empty());
    assert_eq!(contract_product(&mut x, &mut y, &mut z), Contracted::Empty);
}
