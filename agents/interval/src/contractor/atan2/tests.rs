//! The construction by symmetries and the direct contractor agree.

use super::*;
use proptest::prelude::*;

fn over(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn symmetries_of_one_octant_make_the_whole_plane(
        sides in prop::array::uniform2((-9.0..9.0_f64, prop_oneof![Just(0.0), 0.0..2.0_f64, 0.0..12.0_f64])),
        (angle, width) in (-9.0..9.0_f64, prop_oneof![Just(0.0), 0.0..1.0_f64, 0.0..12.0_f64]),
    ) {
        let [x, y] = sides.map(|(lower, width)| over(lower, lower + width));
        let domain = IntervalBox::from([x, y, over(angle, angle + width)]);
        let (direct, spread) = (Atan2.contract(domain), Atan2Seed.spread().contract(domain));
        // Two paths of rounding differ as two domains do that are a little apart, which is much along a steep line of sight.
        let wider = domain.inflate(1e-12);
        let of_wider = (Atan2.contract(wider).inflate(1e-12), Atan2Seed.spread().contract(wider).inflate(1e-12));
        prop_assert!(direct.is_subset_of(&of_wider.1) && spread.is_subset_of(&of_wider.0), "{}: {} or {}", domain, direct, spread);
    }

    #[test]
    fn no_point_is_lost(x in -9.0..9.0_f64, y in -9.0..9.0_f64, turns in -5_i32..5, widths in prop::array::uniform3((0.0..9.0_f64, 0.0..1.0_f64))) {
        let around = |truth: f64, (width, share): (f64, f64)| over(truth - share * width, truth + (1.0 - share) * width);
        let angle = Interval::spanning(pxfm::f_atan2(y, x).next_down(), pxfm::f_atan2(y, x).next_up()) + Interval::HALF_PI * f64::from(4 * turns);
        let domain = IntervalBox::from([around(x, widths[0]), around(y, widths[1]), angle | around(angle.mid(), widths[2])]);
        for contracted in [Atan2.contract(domain), Atan2Seed.spread().contract(domain)] {
            prop_assert!(contracted.is_subset_of(&domain));
            prop_assert!(contracted[0].contains(x) && contracted[1].contains(y) && !(contracted[2] & angle).is_empty());
        }
    }
}

#[test]
fn the_sector_of_the_seed() {
    // Figure 3.5: any interval of angles, [6, 7] here.
    let domain = IntervalBox::from([over(-10.0, 10.0), over(-10.0, 10.0), over(6.0, 7.0)]);
    let contracted = Atan2.contract(domain);
    assert!(contracted[0].lower() == 0.0 && contracted[0].upper() == 10.0);
    assert!(
        (contracted[1].lower() + 2.910061913847).abs() < 1e-9
            && (contracted[1].upper() - 8.714479827243).abs() < 1e-9
    );
    assert_eq!(contracted[2], over(6.0, 7.0));
}

#[test]
fn axes_belong_to_both_of_their_quadrants() {
    for contractor in [&Atan2 as &dyn Contractor<3>, &Atan2Seed.spread()] {
        let on_negative_x = IntervalBox::from([over(-2.0, -1.0), Interval::ZERO, over(-4.0, 4.0)]);
        let angle = contractor.contract(on_negative_x)[2];
        let half_turn = 2.0 * Interval::HALF_PI.lower();
        assert!((angle.upper() - half_turn).abs() < 1e-14 && (angle.lower() + half_turn).abs() < 1e-14);
        let on_y = IntervalBox::from([Interval::ZERO, over(1.0, 2.0), over(-4.0, 4.0)]);
        assert!((contractor.contract(on_y)[2].mid() - Interval::HALF_PI.lower()).abs() < 1e-14);
        let origin = IntervalBox::from([Interval::ZERO, Interval::ZERO, over(-4.0, 4.0)]);
        assert!(
            contractor.contract(origin).is_subset_of(&origin) && contractor.contract(origin)[2].width() > 7.9
        );
    }
}
