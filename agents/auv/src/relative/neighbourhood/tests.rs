use nalgebra::Vector2;
use proptest::prelude::*;
use shoal_bus::message::{Bounds, Measured};

use super::*;
use crate::newborn::PERIOD_NS;
use crate::tube_estimator::tests::truth::{Pushes, Truth, pushes, told};

const TICKS: usize = 60;
const BEARING_ERROR_RAD: f64 = 0.1;
const HEADING_ERROR_RAD: f64 = 0.02;
/// Added to stated bounds, for the rounding of this file.
const ROUNDING: f64 = 1e-9;

/// The neighbour starts here, seen from the body, in metres.
const APART_M: [f64; 3] = [60.0, -35.0, 12.0];

fn around(value: f64, error: f64) -> Bounds {
    Bounds::new(value - error - ROUNDING, value + error + ROUNDING)
}

/// The local time of the body, to the nanosecond, at which it hears what leaves `from_m` at `emission_s`.
fn hears_at(own: &Truth, from_m: nalgebra::Vector3<f64>, emission_s: f64) -> i64 {
    let mut local_s = emission_s;
    for _ in 0..60 {
        let moment = own.at((local_s * 1e9) as i64);
        let arrives_s = emission_s + (moment.position_m - from_m).norm() / 1_500.0;
        local_s += arrives_s - moment.true_s;
    }
    (local_s * 1e9) as i64
}

/// All pings that a neighbour emits every `period` ticks of its own, as the body hears them: ping and bearing, both stamped
/// with `errors` in [-1, 1] of their bounds, told `late` ticks later.
fn events(
    own: &Truth,
    other: &Truth,
    born: &Born,
    (period, late): (usize, usize),
    errors: &[[f64; 3]],
) -> Vec<Vec<Event>> {
    let mut told = vec![Vec::new(); TICKS];
    for (index, emitted) in (1..TICKS).step_by(period).enumerate() {
        let moment = other.at(emitted as i64 * PERIOD_NS);
        let from_m = moment.position_m + nalgebra::Vector3::from(APART_M);
        let ground_m_s = moment.velocity_m_s + moment.current_m_s + moment.disturbance_m_s;
        let [stamped, azimuth, heading] = errors[index % errors.len()];
        let ping = Ping {
            sender: AuvId(7),
            sequence: index as u8,
            emission_s: around(moment.true_s, 1e-6),
            // Only the depth is used: what else it says is false.
            position_m: [around(1e3, 0.0), around(1e3, 0.0), around(from_m.z, 0.1)],
            velocity_m_s: std::array::from_fn(|axis| around(ground_m_s[axis], 0.01)),
        };
        let heard_ns = hears_at(own, from_m, moment.true_s);
        let stamp_ns = heard_ns + (stamped * 0.99e9 * born.modem.timestamp_s) as i64;
        let tick = ((heard_ns.max(stamp_ns) + PERIOD_NS - 1) / PERIOD_NS) as usize - 1 + late;
        let Some(events) = told.get_mut(tick) else { continue };
        let receiver = own.at(heard_ns);
        let to_m = from_m - receiver.position_m;
        let true_heading_rad = pxfm::f_atan2(receiver.velocity_m_s.y, receiver.velocity_m_s.x);
        let measured = |truth: f64, error: f64, share: f64| Measured {
            value: truth + share * error,
            error: error + ROUNDING,
        };
        let stamp = LocalTime::from_ns(stamp_ns);
        events.push(Event { stamp, sense: Sense::Heard { frame: ping.encode().unwrap() } });
        let sense = Sense::Bearing {
            sender: AuvId(7),
            azimuth_rad: measured(
                pxfm::f_atan2(to_m.y, to_m.x) - true_heading_rad,
                BEARING_ERROR_RAD,
                azimuth,
            ),
            elevation_rad: None,
            heading_rad: measured(true_heading_rad, HEADING_ERROR_RAD, heading),
        };
        events.push(Event { stamp, sense });
    }
    told
}

/// How wide the neighbour is at the end; fails where it is not inside.
fn followed(
    settings: Relative,
    born: &Born,
    (own, other): (&Truth, &Truth),
    told: &[Vec<Event>],
) -> Result<f64, TestCaseError> {
    let mut neighbourhood = Neighbourhood::new(born, settings);
    let mut width_m = f64::INFINITY;
    for (index, events) in told.iter().enumerate() {
        let local_ns = (index as i64 + 1) * PERIOD_NS;
        let stamp = LocalTime::from_ns(local_ns);
        let mut events = events.clone();
        events.push(own.inertial(local_ns));
        events.sort_by_key(|event| event.stamp);
        let (here, there) = (own.at(local_ns), other_at(other, own.at(local_ns).true_s));
        // What an estimator may know of the own state: no more than a few metres and a tenth of a millisecond.
        let state = State {
            offset_s: Interval::centred(here.true_s - local_ns as f64 * 1e-9, 1e-4),
            position_m: IntervalBox::centred(&here.position_m, 3.0),
        };
        neighbourhood.update(&Sensed { tick: index as u64, stamp, events }, &state);
        let truth_m: Vector2<f64> = (there + nalgebra::Vector3::from(APART_M) - here.position_m).xy();
        for (auv, box_m) in neighbourhood.around(&state) {
            prop_assert_eq!(auv, AuvId(7));
            prop_assert!(
                box_m.contains(&truth_m),
                "{truth_m:?} not in {box_m} at tick {index}, {settings:?}"
            );
            width_m = box_m.width();
        }
    }
    Ok(width_m)
}

/// The neighbour's position at a true time: its own clock is searched.
fn other_at(other: &Truth, true_s: f64) -> nalgebra::Vector3<f64> {
    let mut local_s = true_s;
    for _ in 0..60 {
        local_s += true_s - other.at((local_s * 1e9) as i64).true_s;
    }
    other.at((local_s * 1e9) as i64).position_m
}

fn both(own_pushes: &Pushes, other_pushes: &Pushes, drift: f64) -> (Born, Truth, Truth) {
    let born = told(drift, 0.05);
    let mut fellow = told(1e-3, 0.05);
    fellow.clock.offset_s = Bounds::new(-0.31, -0.29);
    let (own, other) = (Truth::new(&born, own_pushes), Truth::new(&fellow, other_pushes));
    (born, own, other)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Any two motions within bounds, clocks that drift, late packets, every way of following: the neighbour is inside.
    #[test]
    fn a_neighbour_is_always_inside(
        own_pushes in pushes(TICKS + 40),
        other_pushes in pushes(TICKS + 40),
        drift in prop::sample::select(vec![0.0, 1e-4, 1e-2]),
        schedule in (1..9_usize, 0..12_usize),
        errors in prop::collection::vec(prop::array::uniform3(-1.0..=1.0_f64), 1..20),
        at_bounds in any::<bool>(),
        remembered in prop::sample::select(vec![1_u16, 2, 16]),
    ) {
        let errors: Vec<[f64; 3]> = match at_bounds {
            true => errors.into_iter().map(|error| error.map(f64::signum)).collect(),
            false => errors,
        };
        let (born, own, other) = both(&own_pushes, &other_pushes, drift);
        let told = events(&own, &other, &born, schedule, &errors);
        for measures in [Measures::RangeAndBearing, Measures::Bearing, Measures::Range] {
            for exchanged in [true, false] {
                let settings = Relative { measures, exchanged, remembered, fellows: born.body };
                followed(settings, &born, (&own, &other), &told)?;
            }
        }
    }
}

#[test]
fn commands_and_memory_each_tell_more() {
    let pushes: Pushes = (0..2 * (TICKS + 40))
        .map(|knot| {
            let phase = 0.05 * knot as f64;
            std::array::from_fn(|which| pxfm::f_sin(phase * (1.0 + which as f64) + which as f64))
        })
        .collect();
    let (born, own, other) = both(&pushes, &pushes.iter().rev().copied().collect(), 1e-4);
    let told = events(&own, &other, &born, (5, 0), &[[0.3, 0.9, -0.5], [-0.8, -0.7, 0.9], [0.1, 0.2, 0.3]]);
    let width_m = |exchanged, remembered| {
        let measures = Measures::RangeAndBearing;
        let settings = Relative { measures, exchanged, remembered, fellows: born.body };
        followed(settings, &born, (&own, &other), &told).unwrap()
    };
    assert!(width_m(true, 16) < 0.8 * width_m(true, 1), "{} {}", width_m(true, 16), width_m(true, 1));
    assert!(width_m(true, 1) < width_m(false, 1), "{} {}", width_m(true, 1), width_m(false, 1));
}
