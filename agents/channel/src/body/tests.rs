use shoal_scenario::model::CurrentField;

use super::*;

fn kind() -> Kind {
    Kind {
        speed_max_m_s: 2.0,
        acceleration_max_m_s2: 0.5,
        turn_rate_max_rad_s: 0.6,
        pitch_max_rad: 0.7,
        disturbance_m_s: [0.05; 3],
        length_m: 1.0,
    }
}

fn body(seed: u64, current: Current) -> Body {
    let attitude = Attitude { heading_rad: 0.3, pitch_rad: 0.0, speed_m_s: 1.0 };
    let stream = (seed, AuvId(0), Noise::Uniform);
    Body::new(&kind(), current, 10_000_000, Vec3::zeros(), attitude, stream)
}

/// A steady current, and two that differ much within a knot's way.
fn currents() -> [Current; 3] {
    let shear =
        CurrentField::Shear { surface_m_s: [0.9, 0.0, 0.1], deep_m_s: [0.0, -0.8, 0.0], depth_m: 0.7 };
    let vortex = CurrentField::Vortex { centre_m: [0.5, 0.5], core_radius_m: 0.4, speed_m_s: 0.9 };
    [CurrentField::Uniform, shear, vortex].map(|field| Current::new(Vec3::new(0.1, 0.0, 0.0), field))
}

fn ns(ms: i64) -> SimTime {
    SimTime::from_ns(ms * 1_000_000)
}

/// Steers along a fixed plan, integrating in windows of `window_ms`, and returns samples of the motion.
fn flown(window_ms: i64, current: Current) -> Vec<Vec3> {
    let plan =
        [(137, [0.0, 1.5, 0.4]), (1_003, [-2.0, -0.1, -3.0]), (2_500, [0.0; 3]), (3_111, [5.0, 5.0, 0.0])];
    let mut body = body(3, current);
    let mut seen = Vec::new();
    let (mut now, mut planned, mut sampled) = (0, 0, 0);
    while now < 5_000 {
        now = (now + window_ms).min(5_000);
        // A setpoint is decided up to 90 ms before it takes effect.
        while planned < plan.len() && plan[planned].0 < now + 90 {
            body.steer(ns(plan[planned].0), Vec3::from(plan[planned].1));
            planned += 1;
        }
        body.integrate(ns(now));
        while sampled < now {
            seen.push(body.at(ns(sampled)).position_m);
            sampled += 13;
        }
        body.forget_before(ns(now - 50));
    }
    seen
}

#[test]
fn windows_do_not_change_the_truth() {
    for current in currents() {
        let reference = flown(90, current.clone());
        for window_ms in [7, 10, 33, 50] {
            assert!(flown(window_ms, current.clone()) == reference, "{window_ms} ms in {current:?}");
        }
    }
}

#[test]
fn current_belongs_to_the_knot_and_is_that_of_its_place() {
    for current in currents() {
        let mut body = body(5, current.clone());
        body.steer(SimTime::from_ns(504_000_000), Vec3::new(0.0, -2.0, 0.3));
        body.steer(SimTime::from_ns(507_000_000), Vec3::new(0.0, 2.0, 0.0));
        body.integrate(ns(1_000));
        let drift_m_s = |t_ms| {
            let pose = body.at(ns(t_ms));
            pose.ground_velocity_m_s - pose.water_velocity_m_s
        };
        for knot_ms in (0..990).step_by(10) {
            let here_m_s = current.at(&body.at(ns(knot_ms)).position_m);
            let off_m_s = (drift_m_s(knot_ms) - here_m_s).map(f64::abs);
            assert!(off_m_s.max() <= 0.05 + 1e-12, "{off_m_s} is more than state noise at {knot_ms} ms");
            for later_ms in [3, 5, 9] {
                let change_m_s = (drift_m_s(knot_ms + later_ms) - drift_m_s(knot_ms)).norm();
                assert!(change_m_s < 1e-12, "{change_m_s} m/s inside the knot at {knot_ms} ms");
            }
        }
    }
}

#[test]
fn no_current_takes_a_body_beyond_its_bound_over_ground() {
    for current in currents() {
        let bound_m_s = Body::ground_speed_bound_m_s(&kind(), &current);
        let mut body = body(7, current);
        body.steer(ns(20), Vec3::new(1.2, 1.6, 0.0));
        body.integrate(ns(6_000));
        for step in 0..6_000 {
            let speed_m_s = body.at(ns(step)).ground_velocity_m_s.norm();
            assert!(speed_m_s <= bound_m_s, "{speed_m_s} m/s after {step} ms");
        }
    }
}

#[test]
fn motion_keeps_the_limits_of_the_kind() {
    let bound = Body::acceleration_bound_m_s2(&kind());
    let [steady, ..] = currents();
    let mut body = body(9, steady);
    for (at, wish) in [(10, [0.0, -9.0, 9.0]), (2_000, [-1.0, 0.2, -9.0]), (4_000, [0.0; 3])] {
        body.steer(ns(at), Vec3::from(wish));
    }
    body.integrate(ns(6_000));
    let mut before = body.at(SimTime::ZERO);
    for step in 1..60_000 {
        let now = body.at(SimTime::from_ns(step * 100_000));
        assert!(now.water_velocity_m_s.norm() <= 2.0 + 1e-12);
        let change = (now.water_velocity_m_s - before.water_velocity_m_s).norm() / 1e-4;
        assert!(change <= bound, "{change} at {step}");
        assert!((now.attitude.velocity_m_s() - now.water_velocity_m_s).norm() < 1e-8);
        assert!((now.position_m - before.position_m).norm() <= 1e-4 * 2.3);
        before = now;
    }
}
