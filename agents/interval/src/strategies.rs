//! What the property tests draw from: numbers of every kind, intervals around them, and exact arithmetic to judge by.

use crate::interval::Interval;
use num_bigint::BigInt;
use proptest::prelude::*;

/// Any finite number: the awkward ones, every power of two, the everyday ones and small whole ones.
pub(crate) fn number() -> impl Strategy<Value = f64> {
    let awkward = prop::sample::select(vec![
        0.0,
        -0.0,
        1.0,
        -1.0,
        f64::from_bits(1),
        -f64::from_bits(1),
        f64::MIN_POSITIVE,
        f64::MIN_POSITIVE.next_down(),
        f64::MAX,
        f64::MIN,
        f64::MAX.sqrt(),
        f64::EPSILON,
        1.0 + f64::EPSILON,
        0.1,
        -0.1,
    ]);
    let any = any::<u64>().prop_map(f64::from_bits).prop_filter("finite", |x| x.is_finite());
    let whole = (-1000_i32..=1000).prop_map(f64::from);
    prop_oneof![1 => awkward, 3 => any, 3 => -1.0e3..1.0e3_f64, 2 => whole]
}

/// Any number that is not far from 1 in size, or its negative.
pub(crate) fn everyday_number() -> impl Strategy<Value = f64> {
    prop_oneof![4 => -1.0e3..1.0e3_f64, 1 => (-10_i32..=10).prop_map(f64::from)]
}

/// An interval and two numbers in it.
pub(crate) fn interval_with_members() -> impl Strategy<Value = (Interval, f64, f64)> {
    (number(), number(), number(), number()).prop_map(|(one, other, first, second)| {
        let interval = Interval::spanning(one, other);
        let inside = |x: f64| x.clamp(interval.lower(), interval.upper());
        (interval, inside(first), inside(second))
    })
}

/// A finite number, exactly, in units of the smallest positive `f64`, 2^-1074.
pub(crate) fn exact(x: f64) -> BigInt {
    let bits = x.to_bits();
    let exponent = (bits >> 52) & 0x7ff;
    let fraction = bits & ((1 << 52) - 1);
    let size = match exponent {
        0 => BigInt::from(fraction),
        _ => BigInt::from(fraction | (1 << 52)) << (exponent - 1),
    };
    if x.is_sign_negative() { -size } else { size }
}

/// The square of the unit of [`exact`] is this many times smaller than the unit, as a power of two.
pub(crate) const UNIT_SHIFT: u32 = 1074;
