//! What the property tests draw from: numbers of every kind, intervals around them, and exact arithmetic to judge by.

use crate::interval::Interval;
use num_bigint::BigInt;
use proptest::prelude::*;

pub(crate) mod angles;

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

/// Where every million of arguments comes from: a generator that is the same in every run.
///
/// Source: G. L. Steele et al., *Fast Splittable Pseudorandom Number Generators*, 2014 (SplitMix64).
pub(crate) struct SplitMix64(pub(crate) u64);

impl SplitMix64 {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// Every finite number: bits without order, so that all exponents are as likely, subnormal numbers included.
    pub(crate) fn any_size(&mut self) -> f64 {
        loop {
            let x = f64::from_bits(self.next());
            if x.is_finite() {
                return x;
            }
        }
    }

    /// A subnormal number, or its negative.
    pub(crate) fn subnormal(&mut self) -> f64 {
        f64::from_bits(self.next() & (1 << 63 | ((1 << 52) - 1)))
    }

    /// A number from `from` up to `to`.
    pub(crate) fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * ((self.next() >> 11) as f64 / (1_u64 << 53) as f64)
    }

    /// A finite number of one of the kinds above, or a small whole one.
    pub(crate) fn number(&mut self) -> f64 {
        match self.next() % 16 {
            0..=5 => self.any_size(),
            6 => self.subnormal(),
            7..=9 => self.between(-1.0, 1.0),
            10..=12 => self.between(-30.0, 30.0),
            13..=14 => self.between(-1.0e3, 1.0e3),
            _ => self.between(-20.0, 20.0).round(),
        }
    }

    /// A number close to a multiple of pi/2, of any size.
    pub(crate) fn near_a_quarter_turn(&mut self) -> f64 {
        let bits = self.next() % 62;
        let quarters = (self.next() >> (63 - bits)) as f64;
        let steps = (self.next() % 7) as i64 - 3;
        let nearest = quarters * std::f64::consts::FRAC_PI_2;
        f64::from_bits(nearest.to_bits().saturating_add_signed(steps))
    }

    /// An interval of numbers of any size: now narrow, now wide.
    pub(crate) fn interval(&mut self) -> Interval {
        let one = self.number();
        let other = match self.next() % 4 {
            0 => self.number(),
            1 => one + self.between(0.0, 8.0),
            2 => one * (1.0 + self.between(0.0, 1e-12)),
            _ => f64::from_bits(one.to_bits().saturating_add(self.next() % 8)),
        };
        let other = if other.is_finite() { other } else { one };
        Interval::spanning(one, other)
    }
}
