//! What walls return, compared with rays that are followed one by one.

use super::*;
use proptest::prelude::*;
use pxfm::f_sincos;

fn over(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap()
}

/// Whether the ray hits, how far, and whether that is far from undecided.
fn cast(m: Vector2<f64>, bearing: f64, wall: Wall) -> (Option<f64>, bool) {
    let (sine, cosine) = f_sincos(bearing);
    let det = |a: Vector2<f64>, b: Vector2<f64>| a.x * b.y - a.y * b.x;
    let (u, ma, mb, ab) = (Vector2::new(cosine, sine), wall.a - m, wall.b - m, wall.b - wall.a);
    let z = [det(ma, u), det(u, mb), det(ma, ab)];
    let certain = z.iter().all(|z| z.abs() > 1e-9);
    (z.iter().all(|&z| z >= 0.0).then(|| z[2] / det(u, ab)), certain)
}

fn walls() -> impl Strategy<Value = Vec<Wall>> {
    let wall = prop::array::uniform4(-5.0..5.0_f64)
        .prop_map(|[ax, ay, bx, by]| Wall::new(Vector2::new(ax, ay), Vector2::new(bx, by)));
    prop::collection::vec(wall, 1..5)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn no_return_is_lost(
        walls in walls(), (x, y) in (-5.0..5.0_f64, -5.0..5.0_f64), bearing in -7.0..7.0_f64,
        (radius, spread) in (prop_oneof![Just(0.0), 0.0..4.0_f64], prop_oneof![Just(0.0), 0.0..1.0_f64]),
    ) {
        let m = Vector2::new(x, y);
        let (position, bearings) = (IntervalBox::centred(&m, radius), Interval::centred(bearing, spread));
        let mut nearest: Option<f64> = None;
        let mut all_certain = true;
        for &wall in &walls {
            let (hit, certain) = cast(m, bearing, wall);
            all_certain &= certain;
            nearest = hit.map_or(nearest, |d| Some(nearest.map_or(d, |n| n.min(d))));
            let answer = wall_return(position, bearings, wall);
            if certain {
                match hit {
                    Some(d) => prop_assert!(answer.distance.inflate(1e-6 * (1.0 + d)).contains(d), "{:?} {}", answer, d),
                    None => prop_assert!(answer.may_miss),
                }
                if radius == 0.0 && spread == 0.0 {
                    prop_assert_eq!(answer.may_miss, hit.is_none());
                    prop_assert_eq!(answer.distance.is_empty(), hit.is_none());
                    prop_assert!(answer.distance.is_empty() || answer.distance.width() < 1e-6);
                }
            }
        }
        if all_certain {
            let answer = nearest_return(position, bearings, &walls);
            match nearest {
                Some(d) => prop_assert!(answer.distance.inflate(1e-6 * (1.0 + d)).contains(d)),
                None => prop_assert!(answer.may_miss),
            }
        }
    }
}

#[test]
fn the_example_of_the_seed() {
    let wall = Wall::new(Vector2::new(2.0, -1.0), Vector2::new(2.0, 1.0));
    let origin = IntervalBox::from([Interval::ZERO; 2]);
    assert_eq!(
        wall_return(origin, Interval::ZERO, wall),
        WallReturn { distance: over(2.0, 2.0), may_miss: false }
    );
    let away = wall_return(origin, over(3.1, 3.2), wall);
    assert!(away.distance.is_empty() && away.may_miss);
    let transparent = wall_return(origin, Interval::ZERO, wall.reversed());
    assert!(transparent.distance.is_empty() && transparent.may_miss);
    // Half of the positions see the wall.
    let wide = IntervalBox::from([over(-1.0, 0.0), over(0.0, 2.0)]);
    assert_eq!(
        wall_return(wide, Interval::ZERO, wall),
        WallReturn { distance: over(2.0, 3.0), may_miss: true }
    );
}

#[test]
fn a_nearer_wall_hides_the_farther() {
    let at = |x: f64| Wall::new(Vector2::new(x, -1.0), Vector2::new(x, 1.0));
    let origin = IntervalBox::from([Interval::ZERO; 2]);
    let seen = nearest_return(origin, Interval::ZERO, &[at(5.0), at(2.0), at(9.0)]);
    assert_eq!(seen, WallReturn { distance: over(2.0, 2.0), may_miss: false });
    assert!(nearest_return(origin, Interval::ZERO, &[]).may_miss);
    let nowhere = nearest_return(IntervalBox::EMPTY, Interval::ZERO, &[at(5.0)]);
    assert!(nowhere.distance.is_empty() && !nowhere.may_miss);
}

#[test]
fn walls_that_are_points_or_unknown() {
    let origin = IntervalBox::from([Interval::ZERO; 2]);
    let post = Wall::new(Vector2::new(2.0, 0.0), Vector2::new(2.0, 0.0));
    let grazed = wall_return(origin, Interval::ZERO, post);
    assert!(grazed.may_miss && grazed.distance.contains(2.0));
    let unknown = Wall::new(Vector2::new(f64::NAN, 0.0), Vector2::new(2.0, f64::INFINITY));
    let answer = wall_return(origin, Interval::ZERO, unknown);
    assert!(answer.may_miss && answer.distance.contains(1.0));
}
