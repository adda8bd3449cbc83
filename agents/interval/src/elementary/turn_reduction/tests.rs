//! The rest of a turn against exact arithmetic.

use super::*;
use crate::strategies::SplitMix64;
use crate::strategies::angles::{BITS, PI, fixed, hardest, wrapped as exactly_wrapped};
use num_bigint::BigInt;

fn check(angle: f64) {
    let bounds = wrapped(angle);
    let rest = exactly_wrapped(angle);
    let (lower, upper) = (bounds.lower(), bounds.upper());
    assert!(fixed(lower) <= rest && rest <= fixed(upper), "{angle:e}: [{lower:e}, {upper:e}]");
    let tight = fixed(lower.next_up().next_up()) > rest && fixed(upper.next_down().next_down()) < rest;
    assert!(tight, "{angle:e}: [{lower:e}, {upper:e}]");
}

#[test]
fn every_size_is_wrapped_to_the_last_bit() {
    let mut random = SplitMix64(30);
    for _ in 0..20_000 {
        check(random.number());
        check(random.near_a_quarter_turn());
    }
    check(f64::MAX);
    check(consts::PI.next_up());
}

#[test]
fn the_hardest_angles_too() {
    hardest().into_iter().for_each(check);
}

#[test]
fn the_digits_are_those_of_one_by_two_pi() {
    let words = TURNS_PER_RADIAN.iter().fold(BigInt::ZERO, |digits, &word| (digits << 64) + word);
    let digits = 19 * 64;
    assert_eq!(words, (BigInt::from(1) << (BITS + digits - 1)) / &*PI);
}
