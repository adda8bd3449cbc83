use nalgebra::Vector2;
use proptest::prelude::*;

use super::*;

const RANGE_ERROR_M: f64 = 5.0;
const BEARING_ERROR_RAD: f64 = 0.1;
const STEP_S: f64 = 1.0;
const SPEED_M_S: f64 = 2.0;
/// Added to stated bounds, for the rounding of this file.
const ROUNDING: f64 = 1e-9;

/// What is decided at random at each step, in [-1, 1]: speed and turn of either, errors.
type Step = [f64; 8];

fn steps() -> impl Strategy<Value = Vec<Step>> {
    let anywhere = prop::collection::vec(prop::array::uniform8(-1.0..=1.0_f64), 1..40);
    (anywhere, any::<bool>()).prop_map(|(steps, at_bounds)| match at_bounds {
        true => steps.into_iter().map(|step| step.map(f64::signum)).collect(),
        false => steps,
    })
}

/// A pose of the model of seed 002, equation (5.2).
#[derive(Clone, Copy)]
struct Robot {
    at_m: Vector2<f64>,
    heading_rad: f64,
}

impl Robot {
    /// Goes on for one step; the displacement.
    fn go(&mut self, speed: f64, turn: f64) -> Vector2<f64> {
        self.heading_rad += 0.3 * turn;
        let (sin, cos) = pxfm::f_sincos(self.heading_rad);
        let moved_m = Vector2::new(cos, sin) * (0.5 * (1.0 + speed) * SPEED_M_S * STEP_S);
        self.at_m += moved_m;
        moved_m
    }
}

/// What was measured: a range, a bearing, or both.
#[derive(Clone, Copy, Debug)]
enum Measures {
    Both,
    Bearing,
    Range,
}

fn sighting(measures: Measures, to_m: Vector2<f64>, step: &Step) -> Sighting {
    let range_m = Interval::centred(to_m.norm() + RANGE_ERROR_M * step[4], RANGE_ERROR_M + ROUNDING);
    let bearing_rad = Interval::centred(
        pxfm::f_atan2(to_m.y, to_m.x) + BEARING_ERROR_RAD * step[5],
        BEARING_ERROR_RAD + ROUNDING,
    );
    match measures {
        Measures::Both => Sighting::new(range_m, bearing_rad),
        Measures::Bearing => Sighting::new(Interval::ENTIRE, bearing_rad),
        Measures::Range => Sighting::new(range_m, Interval::ENTIRE),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Whatever both do and whatever is measured within bounds, with and without commands, whole path or last ping: the truth is
    /// inside, and the whole path never tells less than the last ping.
    #[test]
    fn the_neighbour_is_always_inside(
        steps in steps(),
        apart_m in (-150.0..150.0_f64, -150.0..150.0_f64),
        exchanged in any::<bool>(),
        remembered in 2..12_usize,
        pings in prop::collection::vec(any::<bool>(), 40),
    ) {
        for measures in [Measures::Both, Measures::Bearing, Measures::Range] {
            let mut own = Robot { at_m: Vector2::zeros(), heading_rad: 0.2 };
            let mut other = Robot { at_m: Vector2::new(apart_m.0, apart_m.1), heading_rad: 2.0 };
            let reach_m = IntervalBox::from([Interval::centred(0.0, 500.0); 2]);
            let mut whole = Track::new(reach_m, remembered);
            let mut last = Track::new(reach_m, 1);
            let mut has_seen = false;
            for (step, &pinged) in steps.iter().zip(&pings) {
                let own_moved_m = own.go(step[0], step[1]);
                let other_moved_m = other.go(step[2], step[3]);
                let odometry_m = Vector2::new(step[6], step[7]) * 0.1;
                let own_m = IntervalBox::centred(&(own_moved_m + odometry_m), 0.1 + ROUNDING);
                let other_m = if exchanged {
                    IntervalBox::centred(&(other_moved_m + odometry_m * 0.5), 0.1 + ROUNDING)
                } else {
                    IntervalBox::centred(&Vector2::zeros(), SPEED_M_S * STEP_S + ROUNDING)
                };
                let moved_m = other_m - own_m;
                whole.carry(&moved_m);
                last.carry(&moved_m);
                let truth_m = other.at_m - own.at_m;
                if pinged {
                    let seen = sighting(measures, truth_m, step);
                    prop_assert!(whole.see(seen) && last.see(seen), "{measures:?} contradicts itself");
                    has_seen = true;
                }
                let (whole_m, last_m) = (whole.position_m(), last.position_m());
                prop_assert!(whole_m.contains(&truth_m), "{truth_m:?} not in {whole_m}, {measures:?}");
                prop_assert!(last_m.contains(&truth_m), "{truth_m:?} not in {last_m}, {measures:?}");
                if has_seen {
                    prop_assert!(whole_m.is_subset_of(&last_m.inflate(1e-9)), "{whole_m} beyond {last_m}");
                }
            }
            if has_seen {
                let truth_m = other.at_m - own.at_m;
                let paving = whole.paving(20.0).unwrap();
                prop_assert!(paving.outer().any(|part| part.contains(&truth_m)));
                let before_m = whole.position_m();
                whole.refine(5.0, 64);
                prop_assert!(whole.position_m().contains(&truth_m));
                prop_assert!(whole.position_m().is_subset_of(&before_m));
            }
        }
    }

    #[test]
    fn turned_into_the_axes_of_the_body_the_neighbour_is_still_inside(
        at_m in (-90.0..90.0_f64, -90.0..90.0_f64),
        radius_m in 0.0..9.0_f64,
        heading_rad in -7.0..7.0_f64,
        error in (-1.0..1.0_f64, 0.0..0.5_f64),
    ) {
        let position_m = Vector2::new(at_m.0, at_m.1);
        let seen_m = ahead_and_port_m(
            &IntervalBox::centred(&position_m, radius_m),
            Interval::centred(heading_rad + error.0 * error.1, error.1),
        );
        let (sin, cos) = pxfm::f_sincos(heading_rad);
        let ahead_m = Vector2::new(cos, sin).dot(&position_m);
        let port_m = Vector2::new(-sin, cos).dot(&position_m);
        prop_assert!(seen_m.inflate(ROUNDING).contains(&Vector2::new(ahead_m, port_m)));
    }

    #[test]
    fn a_slant_range_holds_its_horizontal_part(
        (x, y, z) in (-90.0..90.0_f64, -90.0..90.0_f64, -90.0..90.0_f64),
        errors in (0.0..9.0_f64, 0.0..9.0_f64),
    ) {
        let range_m = (x * x + y * y + z * z).sqrt();
        let found = horizontal_m(Interval::centred(range_m, errors.0), Interval::centred(z, errors.1));
        prop_assert!(found.inflate(1e-6).contains((x * x + y * y).sqrt()), "{found}");
    }
}

#[test]
fn sightings_that_contradict_each_other_are_told_and_the_last_one_counts() {
    let mut track = Track::new(IntervalBox::from([Interval::centred(0.0, 500.0); 2]), 4);
    let ahead = |range_m: f64| Sighting::new(Interval::centred(range_m, 1.0), Interval::centred(0.0, 0.1));
    assert!(track.see(ahead(100.0)) && track.see(ahead(101.0)));
    assert_eq!(track.sightings(), 2);
    assert!(!track.see(ahead(200.0)));
    assert_eq!(track.sightings(), 1);
    assert!(track.position_m().contains(&Vector2::new(200.0, 0.0)));
}

#[test]
fn no_more_is_remembered_than_asked_for() {
    let mut track = Track::new(IntervalBox::from([Interval::centred(0.0, 500.0); 2]), 3);
    for _ in 0..9 {
        assert!(track.see(Sighting::new(Interval::centred(100.0, 1.0), Interval::ENTIRE)));
    }
    assert_eq!(track.sightings(), 3);
}
