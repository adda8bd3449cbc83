use nalgebra::Vector3;
use proptest::prelude::*;

use super::*;

const SOUND: Sound = Sound { speed_m_s: Interval::ONE, hearing_range_m: f64::INFINITY };
const BEACONS_M: [[f64; 2]; 5] = [[60.0, 10.0], [-20.0, 70.0], [-50.0, -60.0], [10.0, -80.0], [40.0, -40.0]];

fn point(value: f64) -> Interval {
    Interval::centred(value, 1e-9)
}

fn level(east_m: f64, north_m: f64) -> IntervalBox<3> {
    IntervalBox::from([point(east_m), point(north_m), Interval::ZERO])
}

/// A ping of a beacon, `range_m` away as the travel time says.
fn ring(beacon: usize, range_m: f64) -> Ring {
    let [east_m, north_m] = BEACONS_M[beacon % BEACONS_M.len()];
    Ring {
        sender: AuvId(beacon as u32),
        emitter_m: level(east_m, north_m),
        emission_s: Interval::ZERO,
        arrival_s: Interval::centred(range_m, 0.5),
        since: Way::none(),
    }
}

fn range_m(beacon: usize, truth_m: &Vector3<f64>) -> f64 {
    let [east_m, north_m] = BEACONS_M[beacon % BEACONS_M.len()];
    (truth_m - Vector3::new(east_m, north_m, 0.0)).norm()
}

fn area() -> Hypotheses {
    let sides = [Interval::centred(0.0, 100.0), Interval::centred(0.0, 100.0), Interval::ZERO];
    Hypotheses::one(State { offset_s: Interval::ZERO, position_m: IntervalBox::from(sides) })
}

fn window(window: u16, tolerated: u16, margin: Option<u16>) -> Window {
    Window::new(Outliers { window, tolerated, margin })
}

const TRUTH_M: Vector3<f64> = Vector3::new(5.0, 20.0, 0.0);

/// A window with these errors of the ranges of the beacons in turn.
fn heard(mut window: Window, errors_m: &[f64]) -> Window {
    for (beacon, error_m) in errors_m.iter().enumerate() {
        window.append(
            Some(AuvId(beacon as u32)),
            Some(ring(beacon, range_m(beacon, &TRUTH_M) + error_m)),
            area(),
        );
    }
    window
}

#[test]
fn one_wrong_ping_of_five_is_seen_through() {
    let errors_m = [0.0, 0.3, 25.0, -0.4, 0.1];
    assert!(heard(window(5, 0, None), &errors_m).observe(&SOUND).is_none());
    let observed = heard(window(5, 1, None), &errors_m).observe(&SOUND).unwrap();
    let hull = observed.states.hull();
    assert!(hull.position_m.contains(&TRUTH_M) && hull.position_m.width() < 8.0, "{hull:?}");
    // That ping is the one that disagrees.
    let mut window = heard(window(5, 1, None), &errors_m);
    let hull = window.observe(&SOUND).unwrap().states.hull();
    let disagree: Vec<_> =
        window.agreeing(&hull, &SOUND).filter(|(_, agrees)| !agrees).map(|(sender, _)| sender).collect();
    assert_eq!(disagree, [AuvId(2)]);
}

#[test]
fn the_fewest_wrong_pings_are_found() {
    let errors_m = [0.0, 0.3, 25.0, -0.4, 0.1];
    let tolerated = |margin| heard(window(5, 3, margin), &errors_m).observe(&SOUND).unwrap().tolerated;
    assert_eq!((tolerated(Some(0)), tolerated(Some(1)), tolerated(Some(9))), (1, 2, 3));
    assert_eq!(tolerated(None), 3);
    let relaxed = heard(window(5, 0, None), &errors_m).relax(&SOUND).unwrap();
    assert_eq!(relaxed.tolerated, 1);
    assert!(relaxed.states.hull().position_m.contains(&TRUTH_M));
}

#[test]
fn too_few_pings_say_nothing() {
    let width_m = |errors_m: &[f64]| {
        heard(window(9, 2, None), errors_m).observe(&SOUND).unwrap().states.hull().position_m.width()
    };
    assert_eq!(width_m(&[0.0, 0.0]), area().hull().position_m.width());
    assert!(width_m(&[0.0; 5]) < 0.5 * area().hull().position_m.width());
}

#[test]
fn a_wrong_ping_is_forgotten_when_it_has_left_the_window() {
    // Two wrong ones where one is tolerated.
    let mut window = heard(window(5, 1, None), &[30.0, 30.0, 0.0, 0.0, 0.0]);
    let lost = window.observe(&SOUND).is_none_or(|of| !of.states.hull().position_m.contains(&TRUTH_M));
    assert!(lost);
    for beacon in [0, 1] {
        window.append(Some(AuvId(9)), Some(ring(beacon, range_m(beacon, &TRUTH_M))), area());
    }
    let hull = window.observe(&SOUND).unwrap().states.hull();
    assert!(hull.position_m.contains(&TRUTH_M) && hull.position_m.width() < 8.0);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// The truth is never lost while no more pings are wrong than assumed, whatever the wrong ones say and wherever the truth is. The body
    /// moves by a metre north between pings, as odometry knows to a tenth.
    #[test]
    fn the_truth_survives_what_was_assumed(
        truth in (-60.0..60.0_f64, -60.0..40.0_f64),
        pings in prop::collection::vec((-0.4..0.4_f64, prop::option::weighted(0.3, -60.0..60.0_f64), -0.1..0.1_f64), 1..25),
        (size, tolerated) in (3..9_u16).prop_flat_map(|size| (Just(size), 0..size - 1)),
        margin in prop::bool::ANY,
    ) {
        let mut truth_m = Vector3::new(truth.0, truth.1, 0.0);
        // With the margin q, GOMNE never assumes less than q where that leaves something.
        let mut window = window(size, tolerated, margin.then_some(tolerated));
        let mut states = area();
        let mut last = VecDeque::new();
        for (beacon, &(error_m, wrong_m, swerve_m)) in pings.iter().enumerate() {
            truth_m.y += 1.0 + swerve_m;
            let way = Way {
                displacement_m: IntervalBox::from([Interval::ZERO, Interval::centred(1.0, 0.101), Interval::ZERO]),
                offset_gain_s: Interval::ZERO,
            };
            states.carry(&way);
            window.carry(&way);
            // Only as many wrong ones as the window may have.
            last.push_back(false);
            if last.len() > usize::from(size) {
                last.pop_front();
            }
            let wrong_m = wrong_m.filter(|_| {
                last.iter().filter(|wrong| **wrong).count() < usize::from(tolerated)
            });
            *last.back_mut().unwrap() = wrong_m.is_some();
            let told_m = range_m(beacon, &truth_m) + error_m + wrong_m.unwrap_or(0.0);
            window.append(Some(AuvId(1)), Some(ring(beacon, told_m)), states.clone());
            let observed = window.observe(&SOUND);
            prop_assert!(observed.is_some(), "emptied at ping {beacon}");
            states = observed.unwrap().states;
            prop_assert!(states.boxes().iter().any(|state| state.position_m.contains(&truth_m)), "ping {beacon}");
        }
    }
}

/// Lost truths among `runs` of a hundred pings with each wrong with probability `wrong`, and the most that the bound of seed 004 allows.
fn lost_rate(wrong: f64, size: u16, tolerated: u16) -> (f64, f64) {
    let mut draw = 0x9e37_79b9_7f4a_7c15_u64;
    let mut unit = || {
        draw = draw.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (draw >> 11) as f64 / (1_u64 << 53) as f64
    };
    let (mut lost, mut all) = (0, 0);
    let pings = 40;
    for _ in 0..40 {
        let truth_m = Vector3::new(80.0 * unit() - 40.0, 80.0 * unit() - 40.0, 0.0);
        let mut window = window(size, tolerated, None);
        let mut states = area();
        for beacon in 0..pings {
            let error_m = if unit() < wrong { 60.0 * unit() + 1.0 } else { 0.8 * unit() - 0.4 };
            window.append(None, Some(ring(beacon, range_m(beacon, &truth_m) + error_m)), states.clone());
            match window.observe(&SOUND) {
                Some(observed) => states = observed.states,
                None => window.ignore_last(),
            }
        }
        all += 1;
        lost += i32::from(!states.boxes().iter().any(|state| state.position_m.contains(&truth_m)));
    }
    let chance = |count: u16| {
        let ways = (0..count).fold(1.0, |ways, of| ways * f64::from(size - of) / f64::from(of + 1));
        let product = |factor: f64, times: u16| (0..times).fold(1.0, |product, _| product * factor);
        ways * product(wrong, count) * product(1.0 - wrong, size - count)
    };
    let window_holds: f64 = (0..=tolerated).map(chance).sum();
    let bound = 1.0 - pxfm::f_pow(window_holds, f64::from(pings as u32) / f64::from(size));
    (f64::from(lost) / f64::from(all), bound)
}

#[test]
fn the_truth_is_lost_no_more_often_than_the_bound_says() {
    for wrong in [0.01, 0.05, 0.10, 0.20] {
        let (lost, bound) = lost_rate(wrong, 10, 3);
        println!("{:.0} % outliers, 3 of 10 tolerated: lost {lost:.3}, bound {bound:.3}", 100.0 * wrong);
        // Forty runs: three standard deviations of their count.
        assert!(
            lost <= bound + 3.0 * (bound * (1.0 - bound) / 40.0).sqrt() + 1e-9,
            "{wrong}: {lost} > {bound}"
        );
    }
    // An assumption that is surely broken loses the truth: the test can fail.
    assert!(lost_rate(0.5, 10, 1).0 > 0.2);
}
