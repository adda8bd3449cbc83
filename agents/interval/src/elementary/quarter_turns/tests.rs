//! The walk against exact whole-number arithmetic with 1400 bits of pi.

use super::*;
use crate::strategies::SplitMix64;
use crate::strategies::angles::quarters;

#[test]
fn walks_are_exact_at_every_size() {
    let mut random = SplitMix64(20);
    let mut by_signs = 0;
    for round in 0..20_000 {
        let from = if round % 2 == 0 { random.number() } else { random.near_a_quarter_turn() };
        let to = match random.next() % 4 {
            0 => from + random.between(0.0, 20.0),
            1 => from + (random.next() % 12) as f64 * std::f64::consts::FRAC_PI_2,
            2 => f64::from_bits(from.to_bits().saturating_add(random.next() % 16)),
            _ => random.number(),
        };
        if !to.is_finite() {
            continue;
        }
        let angles = Interval::spanning(from, to);
        let (first, last) = (quarters(angles.lower()), quarters(angles.upper()));
        let passed = i64::try_from(&last - &first).unwrap_or(EVERY).min(EVERY);
        let start = i64::try_from(((first % 4) + 4) % 4).unwrap();
        let walk = QuarterTurns::through(angles);
        assert_eq!(walk.passed, passed, "{angles:?}");
        assert!(passed == EVERY || walk.start & 3 == start, "{angles:?}: {walk:?} but {start}");
        by_signs += usize::from(counted(from).is_none());
    }
    assert!(by_signs > 5_000, "both ways are tried");
}

#[test]
fn zero_begins_the_first_quarter() {
    let (zero, one) = (0.0, 1.0);
    let over = |from, to| QuarterTurns::through(Interval::new(from, to).unwrap());
    assert_eq!((over(zero, one).start & 3, over(zero, one).passed), (0, 0));
    assert_eq!((over(-one, zero).start & 3, over(-one, zero).passed), (3, 1));
    assert_eq!((over(-0.0, zero).start & 3, over(-0.0, zero).passed), (0, 0));
}
