//! Angles modulo a full turn: what is kept, and in which pieces.

use super::*;
use crate::strategies::SplitMix64;
use crate::strategies::angles::{PI, fixed, wrapped};
use num_bigint::BigInt;

#[test]
fn members_stay_and_pieces_are_tight() {
    let mut random = SplitMix64(40);
    for _ in 0..10_000 {
        let angles = random.interval();
        let pieces = angles.wrap_angle_to_pair();
        let holds = |rest: &BigInt| {
            pieces.iter().any(|piece| {
                !piece.is_empty() && fixed(piece.lower()) <= *rest && *rest <= fixed(piece.upper())
            })
        };
        for member in [angles.lower(), angles.upper(), angles.mid()] {
            assert!(holds(&wrapped(member)), "{member:e} of {angles:?} is lost in {pieces:?}");
        }
        assert!(pieces.iter().all(|piece| piece.is_subset_of(Interval::HALF_TURNS)));
        assert_eq!(angles.wrap_angle(), pieces[0].hull(pieces[1]));
        // Two pieces have together the width of the set; one has it, or is all around.
        let width: f64 = pieces.iter().filter(|piece| !piece.is_empty()).map(|piece| piece.width()).sum();
        assert!(width <= angles.width() + 1e-14 || pieces[0] == Interval::HALF_TURNS, "{angles:?}");
        assert!(pieces[0] != Interval::HALF_TURNS || angles.width() > Interval::TWO_PI.lower() - 1e-14);
    }
}

#[test]
fn constants_hold_pi() {
    for (constant, fraction) in [
        (Interval::QUARTER_PI, &*PI / 4),
        (Interval::HALF_PI, &*PI / 2),
        (Interval::PI, PI.clone()),
        (Interval::TWO_PI, &*PI * 2),
    ] {
        assert!(fixed(constant.lower()) < fraction && fraction < fixed(constant.upper()));
        assert_eq!(constant.lower().next_up(), constant.upper());
    }
}

#[test]
fn special_sets() {
    let over = |lower, upper| Interval::new(lower, upper).unwrap();
    assert_eq!(Interval::EMPTY.wrap_angle_to_pair(), [Interval::EMPTY; 2]);
    assert!(Interval::EMPTY.wrap_angle().is_empty());
    assert_eq!(Interval::ENTIRE.wrap_angle_to_pair(), [Interval::HALF_TURNS, Interval::EMPTY]);
    assert_eq!(Interval::NON_NEGATIVE.wrap_angle(), Interval::HALF_TURNS);
    assert_eq!(over(-3.0, 3.0).wrap_angle_to_pair(), [over(-3.0, 3.0), Interval::EMPTY]);
    let nearly_all_around = over(0.0, 6.27).wrap_angle_to_pair();
    assert!(nearly_all_around[0].upper() < -0.01 && nearly_all_around[1].lower() == 0.0);
    assert_eq!(over(0.0, 6.29).wrap_angle_to_pair(), [Interval::HALF_TURNS, Interval::EMPTY]);
    assert_eq!(over(-100.0, 100.0).wrap_angle(), Interval::HALF_TURNS);
}
