//! Consistent where its assumptions hold, robust where the gate helps, and honest about what it shares.

use nalgebra::{Matrix4, Vector4};
use shoal_bus::message::{AuvId, Bounds, Estimator as Orders, Fusion, MediumAccess};
use shoal_bus::ping::GaussianPing;

use super::ranging::listen;
use super::*;
use crate::newborn::{PERIOD_NS, newborn};

/// SplitMix64: numbers in [-1, 1).
struct Dice(u64);

impl Dice {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ mixed >> 31) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// Twelve uniform draws: near enough to a Gaussian of variance 1 for a mean of squares.
    fn gaussian(&mut self) -> f64 {
        (0..12).map(|_| self.unit()).sum::<f64>() * 0.5
    }
}

const GATE_SIGMA: f64 = 3.0;
const INDEPENDENT: (f64, Fusion) = (GATE_SIGMA, Fusion::Independent);
const INTERSECTION: (f64, Fusion) = (GATE_SIGMA, Fusion::CovarianceIntersection);
const SOUND: Sound = Sound { speed_m_s: 1_500.0, speed_variance: 0.0, stamp_variance: 1e-10 };

/// Known as well as `variances` say: position in m², offset in s²; rate and current exactly.
fn filter(mean: [f64; 4], variances: [f64; 4]) -> Filter {
    let mut filter = Filter { mean: Vector::zeros(), covariance: Matrix::zeros() };
    for index in 0..4 {
        filter.mean[index] = mean[index];
        filter.covariance[(index, index)] = variances[index];
    }
    filter
}

/// A beacon at the origin, known up to `variance_m2`, that pings at true time zero.
fn beacon(variance_m2: f64) -> Emitter {
    let mut covariance = [0.0; 10];
    for entry in [0, 4, 7] {
        covariance[entry] = variance_m2;
    }
    let ping = GaussianPing {
        sender: AuvId(1),
        sequence: 0,
        emission_s: 0.0,
        position_m: [0.0; 3],
        covariance,
        velocity_m_s: [0.0; 3],
    };
    Emitter::from(&ping)
}

/// Heard at the own clock's reading `stamp_s`, just now.
fn heard(stamp_s: f64) -> Arrival {
    Arrival { stamp_s, lag_s: 0.0, since_m: Vector3::zeros() }
}

/// The normalized error squared over position and offset.
fn nees(filter: &Filter, truth: &Vector4<f64>) -> f64 {
    let error = truth - filter.mean.fixed_rows::<4>(0);
    let covariance: Matrix4<f64> = filter.covariance.fixed_view::<4, 4>(0, 0).into_owned();
    error.dot(&(covariance.try_inverse().unwrap() * error))
}

/// A point with a rate and a current that walks and is measured as the filter is told: for 1,000 runs of 20 steps, the mean of the
/// normalized error squared over all eight coordinates is that of chi-square with 8,000 degrees of freedom over 1,000, 8 with a
/// standard deviation of `sqrt(2 * 8 / 1000) = 0.126`. Five of them either way.
#[test]
fn a_linear_gaussian_world_is_believed_in_as_it_is() {
    let mut dice = Dice(5);
    let mut transition = Matrix::identity();
    (0..3).for_each(|axis| transition[(POSITION + axis, CURRENT + axis)] = 0.5);
    transition[(OFFSET, RATE)] = 0.5;
    let noise = Matrix::identity() * 0.04;
    let (mut sum, runs) = (0.0, 1_000);
    for _ in 0..runs {
        let mut filter = Filter { mean: Vector::zeros(), covariance: Matrix::identity() };
        let mut truth = Vector::from_fn(|_, _| dice.gaussian());
        for step in 0..20 {
            truth = transition * truth + Vector::from_fn(|_, _| 0.2 * dice.gaussian());
            let mean = transition * filter.mean;
            filter.predict(mean, &transition, &noise);
            let row = Vector::from_fn(|index, _| if index == step % 4 { 1.0 } else { 0.25 });
            let measured = row.dot(&truth) + 0.5 * dice.gaussian();
            let innovation = measured - row.dot(&filter.mean);
            assert!(filter.update(&Measurement { row, innovation, variance: 0.25 }));
        }
        let error = truth - filter.mean;
        sum += error.dot(&(filter.covariance.try_inverse().unwrap() * error));
    }
    let mean = sum / f64::from(runs);
    assert!((mean - 8.0).abs() < 5.0 * 0.126, "{mean}");
}

#[test]
fn a_measurement_without_variance_changes_nothing() {
    let before = filter([1.0; 4], [0.0; 4]);
    let mut row = Vector::zeros();
    row[0] = 1.0;
    for (innovation, variance) in [(1.0, 0.0), (1.0, -1.0), (f64::NAN, 1.0), (1.0, f64::NAN)] {
        let mut after = before.clone();
        assert!(!after.update(&Measurement { row, innovation, variance }));
        assert_eq!(after, before);
    }
}

#[test]
fn what_was_told_bounds_what_is_not_known() {
    let mut known = filter([0.0; 4], [4.0; 4]);
    known.covariance[(0, 1)] = 2.0;
    known.covariance[(1, 0)] = 2.0;
    known.limit(0, 1.0);
    assert_eq!((known.covariance[(0, 0)], known.covariance[(1, 1)]), (1.0, 4.0));
    assert_eq!((known.covariance[(0, 1)], known.covariance[(1, 0)]), (1.0, 1.0));
}

/// 90 m east of the beacon, sound takes 60 ms; the filter believes in 87 m.
#[test]
fn a_ping_draws_the_receiver_onto_its_ring() {
    for how in [INDEPENDENT, INTERSECTION] {
        let mut far = filter([87.0, 0.0, 0.0, 0.0], [4.0, 1e-6, 1e-6, 1e-12]);
        assert!(listen(&mut far, &beacon(0.01), &heard(0.06), &SOUND, how));
        assert!((far.mean[0] - 90.0).abs() < 0.05, "{}", far.mean[0]);
        assert!(far.covariance[(0, 0)] < 0.05);
        // With a position that is known, the same ping tells the clock.
        let mut unset = filter([90.0, 0.0, 0.0, 0.0], [1e-6, 1e-6, 1e-6, 1e-4]);
        assert!(listen(&mut unset, &beacon(0.01), &heard(0.062), &SOUND, how));
        assert!((unset.mean[OFFSET] + 0.002).abs() < 1e-5, "{}", unset.mean[OFFSET]);
    }
}

#[test]
fn a_ping_told_late_is_applied_to_where_the_auv_was() {
    // 90 m away when it arrived, ten metres further now.
    let late = Arrival { stamp_s: 0.06, lag_s: 2.0, since_m: Vector3::new(10.0, 0.0, 0.0) };
    let mut here = filter([97.0, 0.0, 0.0, 0.0], [4.0, 1e-6, 1e-6, 1e-12]);
    assert!(listen(&mut here, &beacon(0.01), &late, &SOUND, INDEPENDENT));
    assert!((here.mean[0] - 100.0).abs() < 0.05, "{}", here.mean[0]);
}

#[test]
fn the_gate_rejects_what_came_the_long_way_round() {
    // 30 m too far: fifteen standard deviations.
    for how in [INDEPENDENT, INTERSECTION] {
        let before = filter([90.0, 0.0, 0.0, 0.0], [4.0, 1e-6, 1e-6, 1e-12]);
        let mut after = before.clone();
        assert!(!listen(&mut after, &beacon(0.01), &heard(0.08), &SOUND, how));
        assert_eq!(after, before);
        let mut ungated = before.clone();
        assert!(listen(&mut ungated, &beacon(0.01), &heard(0.08), &SOUND, (f64::INFINITY, how.1)));
        assert!((ungated.mean[0] - 120.0).abs() < 1.0);
    }
}

/// Two that know nothing but each other's word, 60 m apart and each off by the same 4 m, tell it to each other twenty times.
#[test]
fn hearing_oneself_say_it_is_news_to_the_naive_only() {
    let told = |of: &Filter| {
        let mut covariance = [0.0; 10];
        let pairs = (0..4).flat_map(|row| (row..4).map(move |column| (row, column)));
        covariance.iter_mut().zip(pairs).for_each(|(entry, pair)| *entry = of.covariance[pair]);
        Emitter::from(&GaussianPing {
            sender: AuvId(1),
            sequence: 0,
            emission_s: 0.0,
            position_m: [of.mean[0], of.mean[1], of.mean[2]],
            covariance,
            velocity_m_s: [0.0; 3],
        })
    };
    let last = |how| {
        let believed = |east_m: f64| filter([east_m, 0.0, 0.0, 0.0], [4.0, 1e-4, 1e-4, 1e-10]);
        let mut pair = [believed(4.0), believed(64.0)];
        for turn in 0..20 {
            let emitter = told(&pair[turn % 2]);
            assert!(listen(&mut pair[(turn + 1) % 2], &emitter, &heard(0.04), &SOUND, how));
        }
        nees(&pair[0], &Vector4::zeros())
    };
    // Two standard deviations off at first: 4. All that was told came from what both knew at first.
    assert!(last(INDEPENDENT) > 20.0, "{}", last(INDEPENDENT));
    assert!(last(INTERSECTION) < 4.0 + 1e-9, "{}", last(INTERSECTION));
}

/// An interval is a uniform distribution, with nothing in common among its coordinates.
#[test]
fn intervals_are_taken_as_uniform() {
    assert_eq!(uniform(Bounds::new(-3.0, 9.0)), (3.0, 12.0));
    assert_eq!(half_width_variance(3.0), 3.0);
}

/// East at 1 m/s through the water, with a current of 0.2 m/s to the north that was told as 0.1 ± 0.3; a fix every second.
#[test]
fn fixes_teach_it_the_current_and_the_rate() {
    let mut born = newborn(MediumAccess::Silent);
    let settings = EkfSettings { gate_sigma: GATE_SIGMA, fusion: Fusion::Independent };
    born.orders.estimator = Orders::Ekf(settings);
    born.body.current_m_s = [Bounds::default(), Bounds::new(-0.2, 0.4), Bounds::default()];
    let rate = 5e-5;
    let mut ekf = Ekf::new(&born, settings);
    let around = |of: f64, error: f64| Bounds::new(of - error, of + error);
    let measured = |value: f64, error: f64| Measured { value, error };
    let mut told = None;
    for tick in 1..=600 {
        let stamp = LocalTime::from_ns(tick * PERIOD_NS);
        let local_s = stamp.as_s();
        let true_s = local_s * (1.0 + rate);
        let log = Sense::Inertial {
            heading_rad: measured(0.0, 0.01),
            pitch_rad: measured(0.0, 0.01),
            speed_m_s: measured(1.0, 0.02),
        };
        let mut events = vec![Event { stamp, sense: log }];
        if tick % 10 == 0 {
            let place = [around(true_s, 0.5), around(0.2 * true_s, 0.5), around(0.0, 0.5)];
            let sense = Sense::Gnss { position_m: place, time_s: around(true_s, 1e-6) };
            events.push(Event { stamp, sense });
        }
        told = Some(ekf.update(&Sensed { tick: tick as u64, stamp, events }));
    }
    let told = told.unwrap();
    assert!((ekf.filter.mean[CURRENT + 1] - 0.2).abs() < 0.02, "{}", ekf.filter.mean);
    assert!((ekf.filter.mean[RATE] - rate).abs() < 3e-5, "{}", ekf.filter.mean[RATE]);
    let gaussian = told.gaussian.unwrap();
    assert!((gaussian.mean[0] - 60.0).abs() < 0.2 && (gaussian.mean[1] - 12.0).abs() < 0.2);
    assert!(told.state.position_m.contains(&Vector3::new(60.003, 12.0006, 0.0)));
    // A prediction goes on in the same way, and its Gaussian tells true time.
    let ahead = ekf.predict(LocalTime::from_ns(610 * PERIOD_NS));
    let [east_m, north_m, _, time_s] = ahead.gaussian.unwrap().mean;
    assert!((east_m - 61.0).abs() < 0.2 && (north_m - 12.2).abs() < 0.2 && (time_s - 61.003).abs() < 1e-3);
    assert!(ahead.position_m.width() > told.state.position_m.width());
}
