//! Packets that meet at a receiver, and receivers that cannot listen.

use shoal_bus::message::AuvId;
use shoal_bus::traffic::LossReason;
use shoal_scenario::model::{MediumAccess, Place};

use crate::runs::{STEADY, shown, standing};

/// So many places on a circle around the middle.
fn around(count: usize, radius_m: f64) -> Vec<[f64; 3]> {
    (0..count)
        .map(|index| {
            let angle_rad = 2.0 * std::f64::consts::PI * index as f64 / count as f64;
            let (sin, cos) = pxfm::f_sincos(angle_rad);
            [radius_m * cos, radius_m * sin, -50.0]
        })
        .collect()
}

#[test]
fn packets_equally_loud_at_once_are_all_lost_to_each_other() {
    for count in [2, 3, 7, 20] {
        let mut points_m = around(count, 400.0);
        points_m.push([0.0, 0.0, -50.0]);
        let middle = AuvId(count as u32);
        // As many bits as the band has hertz: nothing is gained by spreading.
        let modem = "ping_period_s = 4\nping_phase_s = 1\nbit_rate_bit_s = 16000\ncoding_gain_db = 0";
        let mut scenario = standing(&points_m, modem, STEADY);
        let mut silent = scenario.groups[0].clone();
        // The one in the middle only listens: emitting it would be deaf.
        silent.modem.access = MediumAccess::Silent;
        silent.name = "ear".to_owned();
        silent.count = 1;
        scenario.groups[0].count = count as u32;
        if let Place::Points(points) = &mut silent.start.place {
            points.drain(..count);
        }
        scenario.groups.push(silent);
        let (shown, summary) = shown(&scenario);
        let in_the_middle: Vec<_> = shown.lost.iter().filter(|lost| lost.1 == middle).collect();
        assert_eq!(in_the_middle.len(), 2 * count, "{:?}", summary.pings);
        for (from, _, reason, colliding) in in_the_middle {
            assert_eq!(*reason, LossReason::Collision);
            let others: Vec<_> = (0..count as u32).filter(|other| other != from).map(AuvId).collect();
            assert_eq!(colliding, &others, "{from}");
        }
        // The others emit at once too: neighbours are deaf before the first sound is there.
        assert!(count < 20 || summary.pings.lost.half_duplex > 0, "{:?}", summary.pings);
    }
}

#[test]
fn the_loudest_by_far_is_captured_and_the_faint_are_lost_to_it() {
    // 30 m away and 600 m away: 26 dB and more between them; the far one begins first and is overtaken.
    let points_m = [[30.0, 0.0, -50.0], [600.0, 0.0, -50.0], [0.0, 0.0, -50.0]];
    let mut scenario = standing(&points_m, "ping_period_s = 4\nping_phase_s = 1", STEADY);
    let near = scenario.groups[0].clone();
    let single = |index: usize, phase_ns: Option<i64>| {
        let mut group = near.clone();
        group.name = format!("g{index}");
        group.count = 1;
        group.start.place = Place::Points(vec![points_m[index]]);
        group.modem.access = match phase_ns {
            Some(phase_ns) => MediumAccess::Periodic { period_ns: 4_000_000_000, phase_ns: Some(phase_ns) },
            None => MediumAccess::Silent,
        };
        group
    };
    // An eighth of a second into the far one's packet at the middle.
    scenario.groups = vec![single(0, Some(1_500_000_000)), single(1, Some(1_000_000_000)), single(2, None)];
    let (shown, _) = shown(&scenario);
    let heard: Vec<_> = shown.heard.iter().filter(|passage| passage.to == 2).collect();
    assert!(heard.len() == 2 && heard.iter().all(|passage| passage.from == 0), "{heard:?}");
    let lost: Vec<_> = shown.lost.iter().filter(|lost| lost.1 == AuvId(2)).collect();
    assert_eq!(lost.len(), 2);
    for lost in lost {
        assert_eq!((lost.0, lost.2, lost.3.as_slice()), (1, LossReason::Collision, [AuvId(0)].as_slice()));
    }
}

#[test]
fn who_emits_is_deaf_and_who_sleeps_hears_nothing() {
    let points_m = [[0.0, 0.0, -50.0], [150.0, 0.0, -50.0]];
    // 0.1 s apart, packets of 0.454 s.
    let scenario = standing(&points_m, "ping_period_s = 4\nping_phase_s = 1", STEADY);
    let (shown_deaf, summary) = shown(&scenario);
    assert!(shown_deaf.heard.is_empty());
    assert_eq!(summary.pings.lost.half_duplex, 4);
    assert!(shown_deaf.lost.iter().all(|lost| lost.2 == LossReason::HalfDuplex), "{:?}", summary.pings);

    // Awake for the first second of every four: one emits in the third, the other in the fourth.
    let asleep = "ping_period_s = 4\nping_phase_s = 1\nduty_cycle = { period_s = 4, awake_s = 1 }";
    let mut scenario = standing(&points_m, asleep, STEADY);
    let mut other = scenario.groups[0].clone();
    scenario.groups[0].count = 1;
    other.name = "other".to_owned();
    other.count = 1;
    for (group, (index, phase_ns)) in
        [&mut scenario.groups[0], &mut other].into_iter().zip([(0, 2_000_000_000), (1, 3_100_000_000)])
    {
        group.start.place = Place::Points(vec![points_m[index]]);
        group.modem.access = MediumAccess::Periodic { period_ns: 4_000_000_000, phase_ns: Some(phase_ns) };
    }
    scenario.groups.push(other);
    let (_, summary) = shown(&scenario);
    assert_eq!((summary.pings.heard, summary.pings.lost.asleep), (0, summary.pings.emitted));
    // At the beginning of a cycle they listen.
    for (group, phase_ns) in scenario.groups.iter_mut().zip([4_050_000_000, 8_000_000_000]) {
        group.modem.access = MediumAccess::Periodic { period_ns: 4_000_000_000, phase_ns: Some(phase_ns) };
    }
    let (_, summary) = shown(&scenario);
    assert_eq!((summary.pings.emitted, summary.pings.heard), (1, 1), "{:?}", summary.pings);
}
