use shoal_bus::message::AuvId;
use shoal_bus::ping::Frame;
use shoal_bus::traffic::Boundary;
use shoal_scenario::model::{Kind, Noise};

use super::*;
use crate::acoustics::profile::{Node, Profile};
use crate::acoustics::ray::WaterColumn;
use crate::acoustics::reflection::{FluidBottom, SurfaceLoss};
use crate::body::Attitude;
use crate::draw::{Draws, Purpose};

const S: i64 = 1_000_000_000;

fn draws(number: u64) -> Draws {
    Draws::new(number, Purpose::Start, AuvId(0), Noise::Uniform)
}

/// Water 20 to 500 m deep with up to six layers, from nearly uniform to steep.
fn water(draws: &mut Draws) -> SeaWater {
    let steepness_m_s = [0.5, 5.0, 30.0][draws.between(0.0, 2.99) as usize];
    let (mut depth_m, mut speed_m_s) = (0.0, draws.between(1440.0, 1540.0));
    let nodes: Vec<Node> = (0..draws.between(1.0, 6.99) as usize)
        .map(|_| {
            let node = Node { depth_m, speed_m_s };
            depth_m += draws.between(1.0, 100.0);
            speed_m_s += draws.between(-steepness_m_s, steepness_m_s);
            node
        })
        .collect();
    let profile = Profile::new(&nodes).unwrap();
    let (slowest_m_s, _) = profile.speed_bounds_m_s(f64::NEG_INFINITY, f64::INFINITY);
    SeaWater {
        column: WaterColumn::new(profile, draws.between(20.0, 500.0)),
        slowest_m_s,
        density_kg_m3: 1025.0,
        bottom: FluidBottom {
            density_kg_m3: 1900.0,
            sound_speed_m_s: 1650.0,
            attenuation_db_per_wavelength: 0.8,
        },
        surface: SurfaceLoss::Constant { loss_db: 1.0 },
    }
}

fn place_m(draws: &mut Draws, water: &SeaWater, side_m: f64) -> Vec3 {
    let depth_m = draws.between(0.05, 0.95) * water.column.bottom_depth_m();
    Vec3::new(draws.between(-side_m, side_m), draws.between(-side_m, side_m), -depth_m)
}

fn kind(speed_max_m_s: f64) -> Kind {
    Kind {
        speed_max_m_s,
        acceleration_max_m_s2: 4.0,
        turn_rate_max_rad_s: 1.5,
        pitch_max_rad: 0.3,
        disturbance_m_s: [1.0, 1.0, 0.1],
        length_m: 1.0,
    }
}

/// A body that is steered about at random, and a bound of its speed.
fn body(draws: &mut Draws, number: u64, place_m: Vec3) -> (Body, f64) {
    let speed_m_s = draws.between(0.5, 40.0);
    let attitude = Attitude { heading_rad: draws.between(-3.0, 3.0), pitch_rad: 0.0, speed_m_s };
    let kind = kind(speed_m_s);
    let noise = (number, AuvId(0), Noise::Uniform);
    let mut body = Body::new(&kind, Vec3::zeros(), 10_000_000, place_m, attitude, noise);
    for step in 0..20 {
        let velocity_m_s = Vec3::from_fn(|_, _| draws.between(-speed_m_s, speed_m_s));
        let velocity_m_s = velocity_m_s.component_mul(&Vec3::new(1.0, 1.0, 0.05));
        body.steer(SimTime::from_ns(step * 222_222_222 + 1), velocity_m_s);
    }
    let fastest_m_s = Body::ground_speed_bound_m_s(&kind, &Vec3::zeros().into());
    (body, fastest_m_s)
}

fn wavefront(origin_m: Vec3, emitted_ns: i64) -> Wavefront {
    Wavefront {
        from: AuvId(1),
        group: 0,
        sequence: 0,
        emitted: SimTime::from_ns(emitted_ns),
        packet_ns: 0,
        origin_m,
        velocity_m_s: Vec3::zeros(),
        frame: Frame::new(&[]).unwrap(),
        box_width_m: 0.0,
        range_m: 0.0,
        is_false: false,
    }
}

/// Travel time of a path to a place, found without any guess.
fn travel_s(water: &SeaWater, path: SoundPath, origin_m: Vec3, place_m: Vec3) -> Option<f64> {
    let range_m = (place_m - origin_m).xy().norm();
    Some(water.column.ray(path, -origin_m.z, -place_m.z, range_m, None)?.travel_s)
}

fn crossing(
    water: &SeaWater,
    path: SoundPath,
    wavefront: &Wavefront,
    body: &Body,
    ratio: f64,
) -> Option<Crossing> {
    let place_m = body.position_at(wavefront.emitted);
    let range_m = (place_m - wavefront.origin_m).xy().norm();
    let ray = water.column.ray(path, -wavefront.origin_m.z, -place_m.z, range_m, None)?;
    Some(Crossing::new(path, ray, [range_m, -place_m.z], 0.0, ratio))
}

/// The first whole nanosecond at which sound has met the receiver, by bisection; `None` where a ray is missing or jumps.
fn bisected(
    water: &SeaWater,
    path: SoundPath,
    wavefront: &Wavefront,
    body: &Body,
    end: SimTime,
) -> Option<SimTime> {
    let behind_s = |t: SimTime| {
        let travel_s = travel_s(water, path, wavefront.origin_m, body.position_at(t))?;
        Some(travel_s - (t - wavefront.emitted) as f64 * 1e-9)
    };
    let (mut before, mut after) = (wavefront.emitted, end);
    while after - before > 1 {
        let middle = before + (after - before) / 2;
        *(if behind_s(middle)? > 0.0 { &mut before } else { &mut after }) = middle;
    }
    // Where a faster ray begins or ends, the travel time jumps, and there is no moment at which the two sides are equal.
    (behind_s(before)? - behind_s(after)? < 3e-9).then_some(after)
}

#[test]
fn the_moving_receiver_is_met_as_bisection_finds_it() {
    let (mut direct, mut bounced) = (0, 0);
    for number in 0..400 {
        let mut draws = draws(number);
        let water = water(&mut draws);
        let side_m = [5.0, 100.0, 1500.0][draws.between(0.0, 2.99) as usize];
        let origin_m = place_m(&mut draws, &water, side_m);
        let start_m = place_m(&mut draws, &water, side_m);
        let (mut body, fastest_m_s) = body(&mut draws, number, start_m);
        let end = SimTime::from_ns(8 * S);
        body.integrate(end);
        let wavefront = wavefront(origin_m, draws.between(0.0, 3e9) as i64);
        let ratio = fastest_m_s / water.slowest_m_s;
        for path in [
            SoundPath::Direct,
            SoundPath::Bounced { first: Boundary::Surface, bounces: 1 },
            SoundPath::Bounced { first: Boundary::Bottom, bounces: 2 },
        ] {
            let Some(mut crossing) = crossing(&water, path, &wavefront, &body, ratio) else { continue };
            let Some(expected) = bisected(&water, path, &wavefront, &body, end) else { continue };
            let met = crossing.meet(&wavefront, &body, ratio, &water, end).unwrap();
            let off_ns = (met.start - expected).abs();
            if path == SoundPath::Direct {
                direct += 1;
                // Both are rounded up to whole nanoseconds.
                assert!(off_ns <= 1, "{number}: {off_ns} ns");
            } else {
                bounced += 1;
                assert!(off_ns <= 1_001, "{number} {path}: {off_ns} ns");
            }
            let range_m = (body.position_at(expected) - origin_m).norm();
            assert!((met.range_m - range_m).abs() < 1e-6 * fastest_m_s * off_ns.max(1) as f64);
        }
    }
    assert!(direct > 250 && bounced > 300, "{direct} {bounced}");
}

#[test]
fn windows_hide_a_meeting_but_never_move_it() {
    for number in 0..60 {
        let mut draws = draws(1_000 + number);
        let water = water(&mut draws);
        let origin_m = place_m(&mut draws, &water, 600.0);
        let start_m = place_m(&mut draws, &water, 600.0);
        let seed = draws.entropy();
        let bodies = || {
            let mut draws = self::draws(seed);
            body(&mut draws, number, start_m)
        };
        let (mut whole, fastest_m_s) = bodies();
        let end = SimTime::from_ns(8 * S);
        whole.integrate(end);
        let wavefront = wavefront(origin_m, 500_000_000);
        let ratio = fastest_m_s / water.slowest_m_s;
        let Some(mut at_once) = crossing(&water, SoundPath::Direct, &wavefront, &whole, ratio) else {
            continue;
        };
        let expected = at_once.meet(&wavefront, &whole, ratio, &water, end).unwrap();
        for window_ns in [7_000_001, 25_000_000, 90_000_000] {
            let (mut growing, _) = bodies();
            let mut horizon = wavefront.emitted;
            growing.integrate(horizon);
            let mut crossing = crossing(&water, SoundPath::Direct, &wavefront, &growing, ratio).unwrap();
            let met = loop {
                growing.forget_before(horizon);
                horizon = horizon + window_ns;
                growing.integrate(horizon);
                if let Some(met) = crossing.meet(&wavefront, &growing, ratio, &water, horizon) {
                    break met;
                }
            };
            assert_eq!(
                (met.start, met.range_m, met.doppler),
                (expected.start, expected.range_m, expected.doppler)
            );
            // It was met in the window that it lies in, or is rounded up to the end of.
            assert!(met.start <= horizon && horizon - met.start <= window_ns);
        }
    }
}

#[test]
fn no_range_is_met_at_once() {
    let mut draws = draws(7);
    let water = water(&mut draws);
    let origin_m = Vec3::new(3.0, 4.0, -10.0);
    let (mut body, fastest_m_s) = body(&mut draws, 7, origin_m);
    body.integrate(SimTime::from_ns(S));
    let ratio = fastest_m_s / water.slowest_m_s;
    let wavefront = wavefront(origin_m, 0);
    let mut crossing = crossing(&water, SoundPath::Direct, &wavefront, &body, ratio).unwrap();
    let met = crossing.meet(&wavefront, &body, ratio, &water, SimTime::from_ns(S)).unwrap();
    assert_eq!((met.start, met.range_m), (SimTime::ZERO, 0.0));
    assert!((met.doppler - 1.0).abs() < 0.1);
}

#[test]
fn one_who_flees_from_sound_is_met_all_the_same() {
    // Half as fast as sound, the most that a scenario may say.
    let water = {
        let mut draws = draws(3);
        SeaWater {
            column: WaterColumn::new(Profile::uniform(1500.0).unwrap(), 100.0),
            slowest_m_s: 1500.0,
            ..water(&mut draws)
        }
    };
    let speed_m_s = 748.0;
    let attitude = Attitude { heading_rad: 0.0, pitch_rad: 0.0, speed_m_s };
    let kind = Kind { disturbance_m_s: [0.0; 3], ..kind(speed_m_s) };
    let start_m = Vec3::new(500.0, 0.0, -20.0);
    let mut body =
        Body::new(&kind, Vec3::zeros(), 10_000_000, start_m, attitude, (1, AuvId(0), Noise::Uniform));
    let end = SimTime::from_ns(2 * S);
    body.integrate(end);
    let ratio = speed_m_s / 1500.0;
    let wavefront = wavefront(Vec3::new(0.0, 0.0, -20.0), 0);
    let mut crossing = crossing(&water, SoundPath::Direct, &wavefront, &body, ratio).unwrap();
    let met = crossing.meet(&wavefront, &body, ratio, &water, end).unwrap();
    assert!((met.start.as_s() - 500.0 / (1500.0 - speed_m_s)).abs() < 2.1e-9, "{}", met.start);
    assert!((met.doppler - (1500.0 - speed_m_s) / 1500.0).abs() < 1e-12, "{}", met.doppler);
}
