//! AUVs on a line that do not move, and their pings.

use shoal_bus::message::{AuvId, Bounds, Event, Measured, MediumAccess, Sense, Sensed};
use shoal_bus::ping::Ping;
use shoal_interval::Interval;

use super::*;
use crate::newborn::{PERIOD_NS, newborn};

const TICKS: i64 = 30;

/// An AUV somewhere in `x_m`, whose log says that it stands still.
fn still(auv: u32, x_m: [f64; 2]) -> Recorded {
    let mut born = newborn(MediumAccess::Silent);
    born.auv = AuvId(auv);
    born.prior_position_m[0] = Bounds::new(x_m[0], x_m[1]);
    let zero = Measured::default();
    let inertial = Sense::Inertial { heading_rad: zero, pitch_rad: zero, speed_m_s: zero };
    let sensed = |tick: i64| {
        let stamp = LocalTime::from_ns((tick + 1) * PERIOD_NS);
        Sensed { tick: tick as u64, stamp, events: vec![Event { stamp, sense: inertial.clone() }] }
    };
    Recorded { born, sensed: (0..TICKS).map(sensed).collect(), booked: Vec::new() }
}

/// A ping that says next to nothing itself, emitted by `from` at a time in ms and heard by `to` so many ms later.
fn exchange(auvs: &mut [Recorded], from: usize, to: usize, sequence: u8, (at_ms, delay_ms): (i64, i64)) {
    let at = LocalTime::from_ns(at_ms * 1_000_000);
    let ping = Ping {
        sender: AuvId(from as u32),
        sequence,
        emission_s: Bounds::new(at.as_s() - 1.0, at.as_s() + 1.0),
        position_m: [Bounds::new(-1e3, 1e3); 3],
        velocity_m_s: [Bounds::default(); 3],
    };
    let frame = ping.encode().unwrap();
    auvs[from].booked.push(Booked { at, frame });
    let stamp = at + delay_ms * 1_000_000;
    let told = auvs[to].sensed.iter_mut().find(|sensed| sensed.stamp >= stamp).unwrap();
    told.events.insert(0, Event { stamp, sense: Sense::Heard { frame } });
}

fn solved(auvs: &[Recorded]) -> Reconstruction {
    let mut reconstruction = Reconstruction::new(auvs);
    while reconstruction.round(&|trajectories, sweep| trajectories.iter_mut().for_each(sweep)) {}
    reconstruction
}

/// x of an AUV at its first and its last tick.
fn ends(reconstruction: &Reconstruction, auv: usize) -> [Interval; 2] {
    let ticks: Vec<Tick> = reconstruction.trajectories()[auv].ticks().collect();
    [ticks[0], ticks[ticks.len() - 1]].map(|tick| tick.state.position_m[0])
}

/// Sound goes 1.5 m in a millisecond: AUVs at 0, 150 and -60 m.
fn three() -> Vec<Recorded> {
    let mut auvs = vec![still(0, [0.0, 0.0]), still(1, [0.0, 200.0]), still(2, [-100.0, 200.0])];
    exchange(&mut auvs, 0, 1, 0, (1_000, 100));
    exchange(&mut auvs, 2, 1, 0, (2_000, 140));
    auvs
}

#[test]
fn a_ping_contracts_receiver_and_emitter_all_their_lives_long() {
    let reconstruction = solved(&three());
    assert_eq!((reconstruction.pings(), reconstruction.dropped()), ((2, 0), 0));
    for (auv, x_m) in [(1, 150.0), (2, -60.0)] {
        for x in ends(&reconstruction, auv) {
            // Clocks that drift by 1e-4 are off by 0.2 ms after 2 s, which is 0.3 m; a body that speeds up by 1 m/s² and back within
            // a tick goes astray by a quarter of a cm a tick, either way.
            assert!(x.contains(x_m) && x.width() < 2.5, "AUV {auv}: {x}");
        }
        let alone = reconstruction.trajectories()[auv].ticks().last().unwrap().alone;
        assert!(alone.position_m[0].width() > 200.0);
    }
}

#[test]
fn a_ping_whose_booking_is_lost_is_believed_as_far_as_it_goes() {
    let mut auvs = three();
    auvs[0].booked.clear();
    let reconstruction = solved(&auvs);
    assert_eq!(reconstruction.pings(), (1, 1));
    // What is left is the ping of AUV 2, which came 210 m from no farther west than -100 m.
    assert!(ends(&reconstruction, 1)[0].width() > 85.0);
}

#[test]
fn bytes_that_two_pings_share_tie_neither() {
    let mut auvs = three();
    let again = Booked { at: LocalTime::from_ns(500_000_000), ..auvs[0].booked[0] };
    auvs[0].booked.push(again);
    assert_eq!(solved(&auvs).pings(), (1, 1));
}

#[test]
fn a_ping_that_leaves_nothing_is_dropped_everywhere() {
    let mut auvs = three();
    // An echo: 45 m too far.
    exchange(&mut auvs, 0, 1, 1, (1_500, 130));
    let reconstruction = solved(&auvs);
    assert_eq!((reconstruction.dropped(), reconstruction.restarts()), (1, 1));
    let honest = solved(&three());
    for auv in 0..3 {
        for (with, without) in ends(&reconstruction, auv).into_iter().zip(ends(&honest, auv)) {
            assert!((with.width() - without.width()).abs() < 1e-3, "AUV {auv}: {with}, {without}");
        }
    }
}

#[test]
fn nothing_recorded_is_no_reason_to_fail() {
    let mut auvs = three();
    auvs[1].sensed.clear();
    auvs[2].sensed.truncate(1);
    let reconstruction = solved(&auvs);
    assert_eq!(reconstruction.trajectories()[1].ticks().len(), 0);
    assert_eq!(reconstruction.pings(), (0, 0));
}
