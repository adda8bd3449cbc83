use shoal_scenario::model::Dvl;

use super::*;

const BOTTOM_DEPTH_M: f64 = 50.0;

fn log(velocity_error_m_s: f64, noise: Noise) -> Sensors {
    let model = SensorsModel {
        heading_error_rad: 0.01,
        pitch_error_rad: 0.01,
        speed_error_m_s: 0.02,
        depth_error_m: None,
        dvl: Some(Dvl { altitude_max_m: 20.0, velocity_error_m_s }),
        gnss: None,
    };
    Sensors::new(&model, BOTTOM_DEPTH_M, (1, AuvId(0), noise), LocalTime::ZERO)
}

/// A body that moves over ground at `over_ground_m_s` although it points elsewhere.
fn pose(z_m: f64, attitude: Attitude, over_ground_m_s: [f64; 3]) -> Pose {
    Pose {
        position_m: Vec3::new(4.0, 5.0, z_m),
        water_velocity_m_s: attitude.velocity_m_s(),
        ground_velocity_m_s: Vec3::from(over_ground_m_s),
        attitude,
    }
}

fn over_ground(sensors: &mut Sensors, pose: &Pose) -> Option<[Measured; 3]> {
    let mut events = Vec::new();
    sensors.sense(LocalTime::ZERO, SimTime::ZERO, pose, &mut events);
    events.into_iter().find_map(|event| match event.sense {
        Sense::Dvl { velocity_m_s } => Some(velocity_m_s),
        _ => None,
    })
}

#[test]
fn a_perfect_log_tells_the_velocity_in_the_axes_of_the_body() {
    let quarter_rad = std::f64::consts::FRAC_PI_2;
    let level = |heading_rad| Attitude { heading_rad, pitch_rad: 0.0, speed_m_s: 1.0 };
    let nose_up = Attitude { heading_rad: 0.0, pitch_rad: quarter_rad, speed_m_s: 0.0 };
    // East, north and up as seen by a body that points east, north, and straight up (its top side to the west).
    for (attitude, forward_port_up) in
        [(level(0.0), [0.3, 0.2, 0.1]), (level(quarter_rad), [0.2, -0.3, 0.1]), (nose_up, [0.1, 0.2, -0.3])]
    {
        let told =
            over_ground(&mut log(0.0, Noise::Uniform), &pose(-40.0, attitude, [0.3, 0.2, 0.1])).unwrap();
        for (measured, expected) in told.iter().zip(forward_port_up) {
            assert!((measured.value - expected).abs() < 1e-15, "{told:?} at {attitude:?}");
        }
    }
}

#[test]
fn errors_stay_inside_the_stated_bound_on_every_axis() {
    for noise in [Noise::Uniform, Noise::Adversarial] {
        let mut sensors = log(0.02, noise);
        let mut farthest_m_s = 0.0_f64;
        for step in 0..1_000 {
            let attitude = Attitude { heading_rad: f64::from(step) * 0.1, pitch_rad: 0.4, speed_m_s: 1.0 };
            let pose = pose(-40.0, attitude, [1.0, -0.5, 0.2]);
            let told = over_ground(&mut sensors, &pose).unwrap();
            for (measured, axis) in told.iter().zip(body_axes(&attitude)) {
                let off_m_s = (measured.value - axis.dot(&pose.ground_velocity_m_s)).abs();
                assert!(off_m_s <= measured.error && measured.error < 0.02 + 2e-8);
                farthest_m_s = farthest_m_s.max(off_m_s);
            }
        }
        assert!(farthest_m_s > 0.0199, "{farthest_m_s} is no error of up to 0.02 m/s");
    }
}

#[test]
fn the_bottom_is_seen_from_the_bottom_up_to_the_greatest_altitude() {
    let attitude = Attitude { heading_rad: 0.0, pitch_rad: 0.0, speed_m_s: 1.0 };
    let mut sensors = log(0.02, Noise::Uniform);
    let mut sees = |z_m| over_ground(&mut sensors, &pose(z_m, attitude, [1.0, 0.0, 0.0])).is_some();
    assert!(sees(-50.0) && sees(-40.0) && sees(-30.0));
    assert!(!sees(-50.1) && !sees(-29.9) && !sees(0.0));
}

#[test]
fn axes_are_right_handed_and_agree_with_the_velocity_of_the_attitude() {
    let attitude = Attitude { heading_rad: 2.2, pitch_rad: -0.6, speed_m_s: 1.5 };
    let [forward, port, up] = body_axes(&attitude);
    assert!((forward.cross(&port) - up).norm() < 1e-15);
    assert!((forward * 1.5 - attitude.velocity_m_s()).norm() < 1e-15);
    assert!((up.norm() - 1.0).abs() < 1e-15 && up.z > 0.0);
}
