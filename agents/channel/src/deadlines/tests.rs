use shoal_bus::chronicle::What;
use shoal_bus::lockstep::{Answers, Batch};
use shoal_bus::message::{Acted, Bounds, PlannedPing, Report, Sensed, Setpoint, Slice};
use shoal_bus::ping::Frame;

use super::*;
use crate::channel::Channel;

const MS: i64 = 1_000_000;

fn channel() -> Channel {
    let (name, text) = shoal_scenario::load("two-circles").unwrap();
    Channel::new(&shoal_scenario::parse(&name, &text).unwrap()).unwrap()
}

/// An answer that believes everything possible, flies west and pings as soon as it may.
fn answer(sensed: &Sensed, reaction_ns: i64) -> Acted {
    let all = Bounds::new(-1e9, 1e9);
    let ping =
        PlannedPing { at: sensed.stamp + reaction_ns, listen_ns: 0, frame: Frame::new(&[0; 4]).unwrap() };
    Acted {
        tick: sensed.tick,
        setpoint: Setpoint { velocity_m_s: [-1.0, 0.0, 0.0] },
        pings: vec![ping],
        report: Report {
            position_m: [all; 3],
            clock_offset_s: all,
            slice: Slice { position_m: [all; 3], clock_offset_s: all },
            emptied: None,
            neighbours: 0,
            contractions: 0,
            rejected: 0,
            around: Vec::new(),
            components: 1,
            gaussian: None,
        },
    }
}

#[test]
fn every_tick_that_is_not_answered_in_time_counts_once() {
    let mut channel = channel();
    let wake = channel.born()[0].wake;
    let ticks_of_first = |sensed: &[Batch<Sensed>]| sensed[0].items.clone();
    let mut told = ticks_of_first(&channel.advance(SimTime::from_ns(9 * MS)).unwrap());
    // None has come to its deadline yet: the reaction time is longer than the window.
    channel.accept_late(Vec::new(), Answers::default(), channel.now());
    assert_eq!(channel.summary().free_run.unwrap().deadline_misses, 0);

    told.extend(ticks_of_first(&channel.advance(SimTime::from_ns(18 * MS)).unwrap()));
    let second = channel.born()[1].auv;
    let now = channel.now();
    // The clock of the other one is another.
    let missed = |channel: &Channel| channel.summary().free_run.unwrap();
    channel.accept_late(Vec::new(), Answers::default(), now);
    let of_first = missed(&channel).late.iter().find(|late| late.auv == 0).unwrap().misses;
    let past = told.iter().filter(|sensed| (sensed.stamp + wake.reaction_ns).ns() < now.ns() - MS);
    assert!((past.clone().count() as u64..=past.count() as u64 + 2).contains(&of_first), "{of_first}");
    // Looking again changes nothing, answering late does not either.
    channel.accept_late(Vec::new(), Answers::default(), now);
    let items = told.iter().map(|sensed| answer(sensed, wake.reaction_ns)).collect();
    channel.accept_late(
        Vec::new(),
        Answers { acted: vec![Batch { auv: channel.born()[0].auv, items }], losses: Vec::new() },
        now,
    );
    let after = missed(&channel);
    assert_eq!(after.late.iter().find(|late| late.auv == 0).unwrap().misses, of_first);
    assert!(after.late.iter().any(|late| late.auv == second.0) && after.worst_s > 0.0, "{after:?}");
    // The wall clock decides, where it is ahead of the water.
    channel.accept_late(Vec::new(), Answers::default(), now + 100 * MS);
    let behind = missed(&channel);
    assert!(
        behind.deadline_misses > after.deadline_misses && behind.worst_s > after.worst_s + 0.09,
        "{behind:?}"
    );
    assert!(!channel.summary().reproducible);
}

#[test]
fn what_is_decided_too_late_takes_effect_now_and_is_told_now() {
    let mut channel = channel();
    let born = channel.born();
    let (auv, reaction_ns) = (born[0].auv, born[0].wake.reaction_ns);
    let mut told = Vec::new();
    for window in 1..=20 {
        told.extend(channel.advance(SimTime::from_ns(window * 9 * MS)).unwrap()[0].items.clone());
        channel.accept_late(Vec::new(), Answers::default(), channel.now());
        let _told = channel.chronicle().unwrap().len();
    }
    let before = channel.now();
    channel.advance(before + 9 * MS).unwrap();
    let items: Vec<Acted> = told.iter().map(|sensed| answer(sensed, reaction_ns)).collect();
    let by = channel.now();
    channel.accept_late(Vec::new(), Answers { acted: vec![Batch { auv, items }], losses: Vec::new() }, by);
    let entries = channel.chronicle().unwrap();
    assert!(entries.iter().all(|entry| entry.at >= before));
    let acted = entries.iter().filter(|entry| matches!(entry.what, What::Acted(_))).count();
    assert_eq!(acted, told.len());
    let summary = channel.summary();
    // Those booked for moments that have passed never left; the bodies' checks found the truth of the ticks.
    assert!(
        summary.pings.lost.late as usize > told.len() - 25 && (summary.pings.lost.late as usize) < told.len()
    );
    assert_eq!((summary.containment.checks, summary.containment.violations), (2 * told.len() as u64, 0));
    // The body turns from now on, not from what is past.
    let west = |channel: &mut Channel, to: SimTime| {
        channel.advance(to).unwrap();
        channel.accept_late(Vec::new(), Answers::default(), to);
    };
    for window in 1..=300 {
        west(&mut channel, by + window * 9 * MS);
    }
    let truth = channel.chronicle().unwrap().iter().rev().find_map(|entry| match &entry.what {
        What::Truth(truth) if entry.auv == auv => Some(*truth),
        _ => None,
    });
    let velocity_m_s = truth.unwrap().velocity_m_s;
    assert!(velocity_m_s[0] < -0.5, "{velocity_m_s:?}");
}
