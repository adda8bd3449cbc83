use shoal_bus::message::AuvId;
use shoal_bus::time::SimTime;
use shoal_scenario::model::{CurrentField, Noise};

use super::*;
use crate::birth;
use crate::draw::{Draws, Purpose};

const DURATION_MS: i64 = 4_000;

/// A scenario of one AUV that nothing but the current pushes, which is known to a few centimetres per second.
fn scenario(field: CurrentField, noise: Noise) -> Scenario {
    let text = r#"
        name = "adrift"
        duration_s = 10

        [environment]
        area_m = [[-100, 100], [-100, 100], [-100, 0]]
        current_m_s = [0.2, -0.1, 0]
        current_error_m_s = [0.05, 0.02, 0]

        [[group]]
        name = "green"
        count = 1
        kind = { speed_max_m_s = 2.5, acceleration_max_m_s2 = 2, turn_rate_max_rad_s = 1, pitch_max_rad = 0.5, disturbance_m_s = [0, 0, 0], length_m = 1 }
        start = { region_m = [[-5, 5], [-5, 5], [-20, -15]] }
    "#;
    let mut scenario = shoal_scenario::parse("adrift.toml", text).unwrap();
    scenario.environment.current_field = field;
    scenario.noise = noise;
    scenario
}

fn fields() -> [CurrentField; 3] {
    [
        CurrentField::Uniform,
        CurrentField::Shear { surface_m_s: [0.9, 0.0, 0.1], deep_m_s: [0.0, -0.8, 0.0], depth_m: 20.0 },
        CurrentField::Vortex { centre_m: [1.0, 2.0], core_radius_m: 3.0, speed_m_s: -0.7 },
    ]
}

/// The current met, millisecond by millisecond, by a body that is steered at random.
fn met(scenario: &Scenario) -> Vec<Vec3> {
    let mut body = birth::newborn(scenario, &Water::new(scenario).unwrap(), AuvId(0), 0, 0).body;
    let mut draws = Draws::new(scenario.seed, Purpose::Phase, AuvId(99), Noise::Uniform);
    let mut at_ms = 5;
    while at_ms < DURATION_MS {
        let wish_m_s = Vec3::from_fn(|_, _| draws.between(-3.0, 3.0));
        body.steer(SimTime::from_ns(at_ms * 1_000_000), wish_m_s);
        at_ms += draws.between(3.0, 900.0) as i64;
    }
    body.integrate(SimTime::from_ns(DURATION_MS * 1_000_000));
    (0..DURATION_MS)
        .map(|ms| body.at(SimTime::from_ns(ms * 1_000_000)))
        .map(|pose| pose.ground_velocity_m_s - pose.water_velocity_m_s)
        .collect()
}

#[test]
fn current_keeps_the_bounds_told() {
    for (field, noise) in fields()
        .into_iter()
        .flat_map(|field| [Noise::Uniform, Noise::Adversarial].map(|noise| (field.clone(), noise)))
    {
        let mut tightest = f64::INFINITY;
        let mut scenario = scenario(field.clone(), noise);
        for seed in 0..20 {
            scenario.seed = seed;
            let told = body(&scenario, &scenario.groups[0]);
            let met_m_s = met(&scenario);
            for axis in 0..3 {
                let keeps = |current: &Vec3| told.current_m_s[axis].contains(current[axis]);
                assert!(met_m_s.iter().all(keeps), "axis {axis} of {field:?}");
                for apart_ms in [1, 7, 100, 1_500] {
                    let bound_m_s =
                        told.current_change_m_s2[axis] * 1e-3 * apart_ms as f64 + told.current_step_m_s[axis];
                    for (earlier, later) in met_m_s.iter().zip(&met_m_s[apart_ms..]) {
                        let slack_m_s = bound_m_s - (later[axis] - earlier[axis]).abs();
                        // The differences of velocities above round.
                        assert!(slack_m_s > -1e-14, "axis {axis}, {apart_ms} ms apart in {field:?}");
                        if bound_m_s > 0.0 {
                            tightest = tightest.min(slack_m_s / bound_m_s);
                        }
                    }
                }
            }
        }
        // A bound that is never nearly met is no bound worth telling.
        assert!(field == CurrentField::Uniform || tightest < 0.6, "{tightest} in {field:?}");
    }
}

#[test]
fn a_uniform_current_is_told_as_one_that_never_changes() {
    let scenario = scenario(CurrentField::Uniform, Noise::Uniform);
    let told = body(&scenario, &scenario.groups[0]);
    assert_eq!((told.current_change_m_s2, told.current_step_m_s), ([0.0; 3], [0.0; 3]));
    assert!(
        (told.current_m_s[0].lower - 0.15).abs() < 1e-7 && (told.current_m_s[0].upper - 0.25).abs() < 1e-7
    );
}

#[test]
fn hull_of_the_field_is_added_to_the_current_told() {
    let [_, shear, _] = fields();
    let scenario = scenario(shear, Noise::Uniform);
    let told = body(&scenario, &scenario.groups[0]);
    for (side, [lower, upper]) in told.current_m_s.iter().zip([[0.15, 1.15], [-0.92, -0.08], [0.0, 0.1]]) {
        assert!((side.lower - lower).abs() < 1e-7 && (side.upper - upper).abs() < 1e-7, "{side:?}");
    }
    // 0.9 m/s over 20 m, at 2.5 m/s through the water and 0.1 m/s with it straight up, for one second and for a knot.
    assert!((told.current_change_m_s2[0] - 0.9 / 20.0 * 2.6).abs() < 1e-6);
    assert!((told.current_step_m_s[0] - 0.9 / 20.0 * 2.6 * 0.01).abs() < 1e-6);
}
