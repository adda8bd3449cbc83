use shoal_bus::message::Bounds;

use super::*;

fn side(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap()
}

/// Of a ping that left the origin at true time 10 s and arrived at `local_s` of the own clock, now.
fn ring(local_s: f64) -> Ring {
    let ping = Ping {
        sender: AuvId(3),
        sequence: 0,
        emission_s: Bounds::new(10.0, 10.0),
        position_m: [Bounds::default(); 3],
        velocity_m_s: [Bounds::default(); 3],
    };
    Ring::new(&ping, Interval::point(local_s).unwrap(), Way::none())
}

const SOUND: Sound = Sound { speed_m_s: Interval::ONE, hearing_range_m: f64::INFINITY };

#[test]
fn a_ping_contracts_position_and_clock_at_once() {
    // Between 30 and 50 m east; the clock is off by up to 10 s; sound goes at 1 m/s; heard at 45 s of the own clock.
    let state = State {
        offset_s: side(-10.0, 10.0),
        position_m: IntervalBox::from([side(30.0, 50.0), Interval::ZERO, Interval::ZERO]),
    };
    let known = ring(45.0).contract(&state, &SOUND).unwrap();
    // Travel time is 25 to 45 s, and 30 to 50 m at 1 m/s: 30 to 45 of both.
    assert!(
        (known.position_m[0].lower() - 30.0).abs() < 1e-6
            && (known.position_m[0].upper() - 45.0).abs() < 1e-6
    );
    assert!((known.offset_s.lower() + 5.0).abs() < 1e-6 && (known.offset_s.upper() - 10.0).abs() < 1e-6);
    assert!(known.is_tighter_than(&state));
}

#[test]
fn what_is_heard_is_near() {
    let anywhere = State { offset_s: side(-1e3, 1e3), position_m: IntervalBox::from([side(-1e4, 1e4); 3]) };
    let sound = Sound { hearing_range_m: 5.0, ..SOUND };
    let known = ring(45.0).contract(&anywhere, &sound).unwrap();
    assert!(known.position_m.width() < 10.001 && known.offset_s.width() < 5.001);
}

#[test]
fn a_contradiction_names_its_culprit() {
    let state = State {
        offset_s: Interval::ZERO,
        position_m: IntervalBox::from([side(300.0, 301.0), Interval::ZERO, Interval::ZERO]),
    };
    assert_eq!(ring(45.0).contract(&state, &SOUND).unwrap_err(), Contradiction(Culprit::Ping(AuvId(3))));
}

#[test]
fn a_ring_goes_along_with_the_body() {
    let state = State {
        offset_s: Interval::ZERO,
        position_m: IntervalBox::from([side(-1e3, 1e3), Interval::ZERO, Interval::ZERO]),
    };
    let mut carried = ring(45.0);
    // 35 m from the origin then, at least 100 m farther east now, and one more for what the log may have missed.
    let displacement_m = IntervalBox::from([side(100.0, 101.0), Interval::ZERO, Interval::ZERO]);
    carried.carry(&Way { displacement_m, offset_gain_s: Interval::ZERO });
    let known = carried.contract(&state, &SOUND).unwrap().position_m[0];
    assert!(known.contains(65.0) && known.contains(136.0) && known.width() < 71.001, "{known}");
}

#[test]
fn each_ring_goes_along_from_when_it_was_heard() {
    let mut rings = Rings::new(3, 10.0);
    let metre = Way {
        displacement_m: IntervalBox::from([Interval::ONE, Interval::ZERO, Interval::ZERO]),
        offset_gain_s: Interval::ZERO,
    };
    rings.carry(&metre);
    rings.push(ring(0.0));
    rings.carry(&metre);
    rings.carry(&metre);
    rings.push(ring(1.0));
    rings.carry(&metre);
    let gone_m: Vec<f64> = rings.present().iter().map(|ring| ring.since.displacement_m[0].mid()).collect();
    assert!((gone_m[0] - 3.0).abs() < 1e-9 && (gone_m[1] - 1.0).abs() < 1e-9, "{gone_m:?}");
}

#[test]
fn only_the_last_are_remembered() {
    let mut rings = Rings::new(3, 10.0);
    (0..5).for_each(|second| rings.push(ring(f64::from(second))));
    let arrivals =
        |rings: &mut Rings| rings.present().iter().map(|ring| ring.arrival_s.mid()).collect::<Vec<_>>();
    assert_eq!(arrivals(&mut rings), [2.0, 3.0, 4.0]);
    rings.forget(12.5);
    assert_eq!(arrivals(&mut rings), [3.0, 4.0]);
    rings.drop_newest(1);
    assert_eq!(arrivals(&mut rings), [3.0]);
    rings.drop_newest(2);
    assert!(rings.present().is_empty());
    let mut none = Rings::new(0, 10.0);
    none.push(ring(1.0));
    assert!(none.present().is_empty());
}
