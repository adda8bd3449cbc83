pub(crate) mod truth;

use nalgebra::Vector3;
use proptest::prelude::*;
use shoal_bus::message::{Bounds, TubeSettings};

use self::truth::{Pushes, Truth, pushes, told};
use super::*;
use crate::newborn::PERIOD_NS;

/// Runs an estimator through the events of each tick, on top of log and attitude; fails where it loses the truth. The
/// estimates are given back.
fn enclosed(born: &Born, truth: &Truth, told: &[Vec<Event>]) -> Result<Vec<Estimate>, TestCaseError> {
    enclosed_by(&mut TubeEstimator::new(born), truth, told)
}

/// The same for any estimator.
pub(crate) fn enclosed_by(
    estimator: &mut dyn Estimator,
    truth: &Truth,
    told: &[Vec<Event>],
) -> Result<Vec<Estimate>, TestCaseError> {
    let mut estimates = Vec::new();
    for (index, events) in told.iter().enumerate() {
        let local_ns = (index as i64 + 1) * PERIOD_NS;
        let mut events = events.clone();
        events.push(truth.inertial(local_ns));
        events.sort_by_key(|event| event.stamp);
        let stamp = LocalTime::from_ns(local_ns);
        let estimate = estimator.update(&Sensed { tick: index as u64, stamp, events });
        prop_assert!(estimate.emptied.is_none(), "{:?} at tick {index}", estimate.emptied);
        let holds = |state: &State, local_ns: i64| {
            let moment = truth.at(local_ns);
            state.position_m.contains(&moment.position_m)
                && state.offset_s.contains(moment.true_s - local_ns as f64 * 1e-9)
        };
        prop_assert!(holds(&estimate.state, local_ns), "tick {index}: {:?}", estimate.state);
        for part in 0..=4 {
            let between_ns = local_ns - PERIOD_NS + part * PERIOD_NS / 4;
            prop_assert!(
                holds(&estimate.slice, between_ns),
                "tick {index}, part {part}: {:?}",
                estimate.slice
            );
        }
        let ahead_ns = local_ns + 3 * PERIOD_NS;
        let moment = truth.at(ahead_ns);
        let ahead = estimator.predict(LocalTime::from_ns(ahead_ns));
        prop_assert!(ahead.position_m.contains(&moment.position_m) && ahead.time_s.contains(moment.true_s));
        let ground_m_s = moment.velocity_m_s + moment.current_m_s + moment.disturbance_m_s;
        prop_assert!(ahead.velocity_m_s.contains(&ground_m_s), "tick {index}: {:?}", ahead.velocity_m_s);
        estimates.push(estimate);
    }
    Ok(estimates)
}

const BEACONS_M: [[f64; 3]; 4] =
    [[300.0, 20.0, -5.0], [-40.0, 250.0, 10.0], [-200.0, -220.0, 40.0], [15.0, -30.0, 180.0]];

/// Pings of the beacons in turn, as (local time of arrival, from arrival to the moment it can be told), by tick.
pub(crate) fn heard(truth: &Truth, arrivals: &[(i64, i64)], ticks: usize) -> Vec<Vec<Event>> {
    let mut told = vec![Vec::new(); ticks];
    for (index, &(local_ns, length_ns)) in arrivals.iter().enumerate() {
        let beacon_m = Vector3::from(BEACONS_M[index % BEACONS_M.len()]);
        let event = truth.heard(beacon_m, local_ns);
        // At the first tick after the end of the packet, and not before the stamp.
        let known_ns = (local_ns + length_ns).max(event.stamp.ns());
        let tick = ((known_ns + PERIOD_NS - 1) / PERIOD_NS - 1).max(0) as usize;
        if let Some(events) = told.get_mut(tick) {
            events.push(event);
        }
    }
    told
}

pub(crate) const TICKS: usize = 100;

/// The truth of AUVs that live a little longer than they are looked at, for their predictions.
pub(crate) fn lives() -> impl Strategy<Value = Pushes> {
    pushes(TICKS + 10)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Pings that are told late, in any order, contract what was, and never lose what is.
    #[test]
    fn late_pings_never_lose_the_truth(
        pushes in lives(),
        drift in prop_oneof![Just(0.0), 1e-6..0.02_f64],
        arrivals in prop::collection::vec(
            (0..TICKS as i64 * PERIOD_NS, prop_oneof![Just(0), 0..5_000_000_000_i64]), 0..40),
    ) {
        let mut born = told(drift, 0.05);
        // Some packets are longer than what is remembered.
        born.orders.estimator = Orders::Tube(TubeSettings::forward(40 * PERIOD_NS));
        let truth = Truth::new(&born, &pushes);
        enclosed(&born, &truth, &heard(&truth, &arrivals, TICKS))?;
    }
}

/// An AUV that swims straight on, its errors somewhere in their bounds.
pub(crate) fn steady() -> Pushes {
    let wave = |index: usize, which: usize| pxfm::f_sin((index * (which + 3)) as f64);
    let pushes = (0..2 * (TICKS + 10)).map(|index| std::array::from_fn(|which| wave(index, which)));
    pushes
        .map(|mut push: [f64; 19]| {
            push[1..4].fill(0.0);
            push
        })
        .collect()
}

/// Width of the last box in m, and of the last clock interval in s, when a ping arrives every 100 ms with packets of `length_ns`.
fn last_widths(length_ns: i64) -> (f64, f64) {
    let born = told(1e-6, 0.05);
    let truth = Truth::new(&born, &steady());
    let arrivals: Vec<_> =
        (0..TICKS as i64).map(|index| (index * PERIOD_NS + 12_345_678, length_ns)).collect();
    let estimates = enclosed(&born, &truth, &heard(&truth, &arrivals, TICKS)).unwrap();
    let last = estimates.last().unwrap().state;
    (last.position_m.width(), last.offset_s.width())
}

#[test]
fn a_late_ping_costs_what_the_odometry_lost_since() {
    let ((prompt_m, prompt_s), (late_m, late_s)) = (last_widths(0), last_widths(3_000_000_000));
    // In 3 s: current and disturbance within 2 (0.05 + 0.02) m/s; log and attitude within 2 (0.01 + 0.02 m/s) per axis, each
    // less than twice, and a quarter of the acceleration times a tick. A body that may be anywhere within 3 s adds 12 m.
    let grown_m = late_m - prompt_m;
    assert!(prompt_m < 0.5 && grown_m < 3.0 * (0.14 + 0.12 + 0.05), "{prompt_m} m, late {late_m} m");
    assert!(late_s - prompt_s < 1e-4, "{prompt_s} s, late {late_s} s");
}

#[test]
fn a_ping_beyond_the_horizon_is_ignored() {
    let mut born = told(1e-6, 0.05);
    born.orders.estimator = Orders::Tube(TubeSettings::forward(20 * PERIOD_NS));
    let truth = Truth::new(&born, &steady());
    let width_m = |arrivals: &[(i64, i64)]| {
        let estimates = enclosed(&born, &truth, &heard(&truth, arrivals, TICKS)).unwrap();
        estimates.last().unwrap().state.position_m[0].width()
    };
    let arrived_ns = 50 * PERIOD_NS + 1;
    let never = width_m(&[]);
    assert!(width_m(&[(arrived_ns, 19 * PERIOD_NS)]) < never - 0.1);
    assert!((width_m(&[(arrived_ns, 23 * PERIOD_NS)]) - never).abs() < 1e-6);
}

/// Runs an AUV that knows the speed of sound, 1,500 m/s, to 50 m/s only; the estimator is given back, with its last box's width in m.
fn unsure_of_sound(
    is_constant: bool,
    drift: f64,
    pushes: &Pushes,
    arrivals: &[(i64, i64)],
) -> Result<(TubeEstimator, f64), TestCaseError> {
    let mut born = told(drift, 0.05);
    let truth = Truth::new(&born, pushes);
    born.modem.sound_speed_m_s = Bounds::new(1_465.0, 1_515.0);
    born.modem.sound_speed_is_constant = is_constant;
    let mut estimator = TubeEstimator::new(&born);
    let estimates = enclosed_by(&mut estimator, &truth, &heard(&truth, arrivals, TICKS))?;
    Ok((estimator, estimates.last().map_or(0.0, |last| last.state.position_m.width())))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Pings contract the speed of sound where it is one number, late ones too, and never lose it.
    #[test]
    fn the_speed_of_sound_is_never_lost(
        pushes in lives(),
        drift in prop_oneof![Just(0.0), 1e-6..0.02_f64],
        arrivals in prop::collection::vec(
            (0..TICKS as i64 * PERIOD_NS, prop_oneof![Just(0), 0..5_000_000_000_i64]), 0..40),
    ) {
        let (estimator, _) = unsure_of_sound(true, drift, &pushes, &arrivals)?;
        prop_assert!(estimator.sound_speed_m_s().contains(1_500.0), "{}", estimator.sound_speed_m_s());
    }
}

#[test]
fn pings_tell_the_speed_of_sound_and_with_it_the_position() {
    let arrivals: Vec<_> = (0..TICKS as i64).map(|index| (index * PERIOD_NS + 12_345_678, 0)).collect();
    let (learned, learned_m) = unsure_of_sound(true, 1e-6, &steady(), &arrivals).unwrap();
    let (told, told_m) = unsure_of_sound(false, 1e-6, &steady(), &arrivals).unwrap();
    assert_eq!(told.sound_speed_m_s().width(), 50.0);
    assert!(learned.sound_speed_m_s().width() < 15.0, "{}", learned.sound_speed_m_s());
    assert!(learned_m < 0.8 * told_m, "{learned_m} m, not learning {told_m} m");
}

/// A Doppler velocity log at every so many ticks.
fn over_ground(truth: &Truth, every: usize) -> Vec<Vec<Event>> {
    let at = |tick: usize| truth.dvl((tick as i64 + 1) * PERIOD_NS);
    (0..TICKS).map(|tick| if tick % every == every - 1 { vec![at(tick)] } else { Vec::new() }).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Whatever current the AUV meets within its bounds, what a Doppler velocity log makes of it never loses the truth; nor do
    /// late pings carried on by it.
    #[test]
    fn a_doppler_velocity_log_never_loses_the_truth(
        pushes in lives(),
        drift in prop_oneof![Just(0.0), 1e-6..0.02_f64],
        (error_m_s, change_m_s2, step_m_s) in (
            0.05..1.0_f64,
            prop_oneof![Just(0.0), 0.001..0.5_f64],
            prop_oneof![Just(0.0), 0.001..0.05_f64],
        ),
        every in 1usize..20,
        arrivals in prop::collection::vec((0..TICKS as i64 * PERIOD_NS, 0..5_000_000_000_i64), 0..10),
    ) {
        let mut born = told(drift, error_m_s);
        born.body.current_change_m_s2 = [change_m_s2, 0.0, 0.3 * change_m_s2];
        born.body.current_step_m_s = [step_m_s; 3];
        let truth = Truth::new(&born, &pushes);
        let mut events = over_ground(&truth, every);
        for (told, late) in events.iter_mut().zip(heard(&truth, &arrivals, TICKS)) {
            told.extend(late);
        }
        enclosed(&born, &truth, &events)?;
    }
}

#[test]
fn a_doppler_velocity_log_narrows_the_box_in_an_uncertain_current() {
    let grown_m = |change_m_s2: f64, every: usize| {
        let mut born = told(1e-6, 0.5);
        born.body.current_change_m_s2 = [change_m_s2; 3];
        let truth = Truth::new(&born, &steady());
        let estimates = enclosed(&born, &truth, &over_ground(&truth, every)).unwrap();
        let width_m = |tick: usize| estimates[tick].state.position_m[1].width();
        width_m(TICKS - 1) - width_m(0)
    };
    let (without, uniform, varied) = (grown_m(0.0, usize::MAX), grown_m(0.0, 5), grown_m(0.02, 5));
    // 9.9 s of a current within +-0.5 m/s, and of a disturbance, log and attitude within about +-0.1 m/s.
    assert!(without > 10.0 && without < 12.5, "{without}");
    assert!(uniform < 0.3 * without, "{uniform}");
    assert!(varied < 0.4 * without && uniform < varied, "{varied}");
}

#[test]
fn a_current_that_was_ruled_out_is_told_and_forgotten() {
    let born = told(1e-6, 0.3);
    let truth = Truth::new(&born, &steady());
    let mut estimator = TubeEstimator::new(&born);
    let mut step = |tick: i64, stray_m_s: f64| {
        let stamp = LocalTime::from_ns((tick + 1) * PERIOD_NS);
        let mut dvl = truth.dvl(stamp.ns());
        if let Sense::Dvl { velocity_m_s } = &mut dvl.sense {
            velocity_m_s[1].value += stray_m_s;
        }
        let events = vec![truth.inertial(stamp.ns()), dvl];
        let emptied = estimator.update(&Sensed { tick: tick as u64, stamp, events }).emptied;
        (emptied, estimator.predict(stamp).current_m_s)
    };
    let (emptied, known) = step(0, 0.0);
    assert!(emptied.is_none() && known.width() < 0.2, "{known:?}");
    let (emptied, known) = step(1, 1.0);
    assert_eq!(emptied.map(|emptied| emptied.by), Some(Culprit::Dvl));
    assert_eq!(known, interval_box(&born.body.current_m_s));
    let (emptied, known) = step(2, 0.0);
    assert!(emptied.is_none() && known.width() < 0.2, "{known:?}");
}
