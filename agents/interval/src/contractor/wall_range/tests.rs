//! Positions among walls: nothing lost, hidden walls not taken for visible ones.

use super::*;
use nalgebra::Vector2;
use proptest::prelude::*;
use pxfm::f_sincos;

fn over(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap()
}

type Ends = [f64; 4];

/// The nearest hit; `None` as the second when some determinant is too near zero to be trusted.
fn cast((x, y): (f64, f64), bearing: f64, walls: &[Ends]) -> (Option<f64>, Option<()>) {
    let (sine, cosine) = f_sincos(bearing);
    let mut nearest: Option<f64> = None;
    for &[ax, ay, bx, by] in walls {
        let z1 = (ax - x) * sine - (ay - y) * cosine;
        let z2 = cosine * (by - y) - sine * (bx - x);
        let z3 = (ax - x) * (by - ay) - (ay - y) * (bx - ax);
        if [z1, z2, z3].iter().any(|z| z.abs() < 1e-6) {
            return (None, None);
        }
        if z1 > 0.0 && z2 > 0.0 && z3 > 0.0 {
            let d = z3 / (z1 + z2);
            nearest = Some(nearest.map_or(d, |n: f64| n.min(d)));
        }
    }
    (nearest, Some(()))
}

fn built(walls: &[Ends]) -> Vec<Wall> {
    walls.iter().map(|&[ax, ay, bx, by]| Wall::new(Vector2::new(ax, ay), Vector2::new(bx, by))).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn no_position_is_lost(
        walls in prop::collection::vec(prop::array::uniform4(-5.0..5.0_f64), 1..5),
        (x, y) in (-5.0..5.0_f64, -5.0..5.0_f64),
        bearing in -7.0..7.0_f64,
        (radius, spread, error) in (0.0..6.0_f64, 0.0..0.3_f64, 1e-6..2.0_f64),
    ) {
        let (hit, trusted) = cast((x, y), bearing, &walls);
        if trusted.is_none() {
            return Ok(());
        }
        let list = built(&walls);
        let truth = Vector2::new(x, y);
        let domain = IntervalBox::centred(&truth, radius);
        let bearings = Interval::centred(bearing, spread);
        let contracted = match hit {
            Some(d) => {
                let other = WallRange::new(&list, bearings, over(d + 1e-6, d + 1.0)).complement().contract(domain);
                prop_assert!(other.contains(&truth));
                let seen = WallRange::new(&list, bearings, over(d - error, d + error));
                let short = NothingSeen::new(&list, bearings, d - 1e-6).contract(domain);
                prop_assert!(short.contains(&truth));
                seen.contract(domain)
            }
            None => NothingSeen::new(&list, bearings, f64::INFINITY).contract(domain),
        };
        prop_assert!(contracted.is_subset_of(&domain));
        prop_assert!(contracted.contains(&truth), "{} -> {}", domain, contracted);
        let smaller = IntervalBox::centred(&truth, radius / 2.0);
        if let Some(d) = hit {
            let seen = WallRange::new(&list, bearings, over(d - error, d + error));
            prop_assert!(seen.contract(smaller).is_subset_of(&contracted.inflate(1e-9)));
        }
    }

    #[test]
    fn points_are_decided(walls in prop::collection::vec(prop::array::uniform4(-5.0..5.0_f64), 1..5), (x, y) in (-5.0..5.0_f64, -5.0..5.0_f64), bearing in -7.0..7.0_f64, measured in 0.1..9.0_f64) {
        let (hit, trusted) = cast((x, y), bearing, &walls);
        let far = hit.is_none_or(|d| (d - measured).abs() > 0.02);
        if trusted.is_none() || !far {
            return Ok(());
        }
        let list = built(&walls);
        let at = IntervalBox::centred(&Vector2::new(x, y), 0.0);
        let bearings = Interval::centred(bearing, 0.0);
        prop_assert!(WallRange::new(&list, bearings, Interval::centred(measured, 0.01)).contract(at).is_empty());
        let nothing = NothingSeen::new(&list, bearings, measured).contract(at);
        prop_assert_eq!(nothing.is_empty(), hit.is_some_and(|d| d < measured));
    }
}

#[test]
fn a_hidden_wall_is_not_taken_for_the_one_that_was_seen() {
    let walls = built(&[[2.0, -5.0, 2.0, 5.0], [4.0, -50.0, 4.0, 50.0]]);
    // From [0.5, 1] the far wall is as far as was measured, but the near one would have been seen.
    let seen = WallRange::new(&walls, Interval::ZERO, over(3.0, 3.5));
    let room = |x: Interval| seen.contract(IntervalBox::from([x, over(-1.0, 1.0)]));
    assert_eq!(room(over(-9.0, 9.0))[0], over(-1.5, -1.0));
    assert!(room(over(0.0, 9.0)).is_empty());
    // Between the walls, the far one is seen.
    let near_the_far = WallRange::new(&walls, Interval::ZERO, over(0.5, 1.0));
    let between = near_the_far.contract(IntervalBox::from([over(2.1, 9.0), over(-1.0, 1.0)]));
    assert_eq!(between[0], over(3.0, 3.5));
}

#[test]
fn nothing_measured_and_nothing_around() {
    let walls = built(&[[2.0, -5.0, 2.0, 5.0]]);
    let domain = IntervalBox::from([over(-1.0, 1.0); 2]);
    assert!(WallRange::new(&[], Interval::ZERO, Interval::ENTIRE).contract(domain).is_empty());
    assert_eq!(NothingSeen::new(&[], Interval::ZERO, 5.0).contract(domain), domain);
    assert_eq!(NothingSeen::new(&walls, Interval::ZERO, f64::NAN).contract(domain), domain);
    assert!(NothingSeen::new(&walls, Interval::ZERO, f64::INFINITY).contract(domain).is_empty());
    assert!(NothingSeen::new(&walls, Interval::EMPTY, 5.0).contract(domain).is_empty());
    assert!(WallRange::new(&walls, Interval::ZERO, Interval::EMPTY).contract(domain).is_empty());
    assert_eq!(WallRange::new(&walls, Interval::ZERO, Interval::EMPTY).complement().contract(domain), domain);
    assert!(
        WallRange::new(&walls, Interval::ZERO, Interval::ENTIRE).complement().contract(domain).is_empty()
    );
    let everywhere = WallRange::new(&walls, Interval::ENTIRE, over(1.0, 2.0)).contract(IntervalBox::ENTIRE);
    assert_eq!(everywhere, IntervalBox::from([over(0.0, 2.0), over(-7.0, 7.0)]));
}
