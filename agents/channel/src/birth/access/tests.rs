use std::collections::BTreeSet;

use shoal_scenario::model::SoundSpeed;

use super::*;
use crate::birth;
use crate::water::tests::sea;

const SECOND_NS: i64 = 1_000_000_000;

/// What each of four AUVs of two groups is told when all have this access.
fn told(access: model::MediumAccess) -> Vec<MediumAccess> {
    told_in(access, |_| ())
}

fn told_in(access: model::MediumAccess, change: impl Fn(&mut Scenario)) -> Vec<MediumAccess> {
    let text = r#"
        name = "four"
        duration_s = 10
        [environment]
        area_m = [[0, 100], [0, 100], [-100, 0]]
        sound_speed_m_s = 1480
        sound_speed_error_m_s = 20
        [[group]]
        name = "green"
        count = 3
        clock = "ideal"
        start = { region_m = [[5, 50], [5, 50], [-20, -15]] }
        [[group]]
        name = "red"
        count = 1
        clock = "ideal"
        start = { region_m = [[5, 50], [5, 50], [-20, -15]] }
    "#;
    let mut scenario = shoal_scenario::parse("four.toml", text).unwrap();
    scenario.groups.iter_mut().for_each(|group| group.modem.access = access);
    change(&mut scenario);
    let water = Water::new(&scenario).unwrap();
    [(0, 0), (0, 1), (0, 2), (1, 0)]
        .into_iter()
        .zip(0..)
        .map(|((group, index), auv)| {
            birth::newborn(&scenario, &water, AuvId(auv), group, index).born.orders.access
        })
        .collect()
}

#[test]
fn random_accesses_begin_within_a_period_and_with_entropy_of_their_own() {
    let aloha = told(model::MediumAccess::Aloha { mean_period_ns: 4 * SECOND_NS });
    let csma = told(model::MediumAccess::Csma {
        period_ns: 2 * SECOND_NS,
        listen_ns: 300_000_000,
        backoff_ns: SECOND_NS,
    });
    let mut entropies = BTreeSet::new();
    for access in aloha {
        let MediumAccess::Aloha { first, mean_period_ns, entropy } = access else { panic!("{access:?}") };
        assert_eq!(mean_period_ns, 4 * SECOND_NS);
        assert!((0..=4 * SECOND_NS).contains(&first.ns()));
        entropies.insert(entropy);
    }
    assert_eq!(entropies.len(), 4);
    for access in csma {
        let MediumAccess::Csma { first, period_ns, listen_ns, backoff_ns, entropy } = access else {
            panic!("{access:?}")
        };
        assert_eq!([period_ns, listen_ns, backoff_ns], [2 * SECOND_NS, 300_000_000, SECOND_NS]);
        assert!((0..=2 * SECOND_NS).contains(&first.ns()));
        // The same AUV draws alike, whatever it draws for.
        assert!(entropies.contains(&entropy));
    }
}

#[test]
fn a_drawn_first_ping_is_that_of_periodic_pings_whatever_the_access() {
    let first = |access: &MediumAccess| match *access {
        MediumAccess::Periodic { first, .. } | MediumAccess::Aloha { first, .. } => first,
        _ => panic!("{access:?}"),
    };
    let periodic = told(model::MediumAccess::Periodic { period_ns: SECOND_NS, phase_ns: None });
    let aloha = told(model::MediumAccess::Aloha { mean_period_ns: SECOND_NS });
    assert!(periodic.iter().map(first).eq(aloha.iter().map(first)));
    let stated = told(model::MediumAccess::Periodic { period_ns: SECOND_NS, phase_ns: Some(7) });
    assert!(stated.iter().all(|access| first(access) == LocalTime::from_ns(7)));
    assert!(told(model::MediumAccess::Silent).iter().all(|access| *access == MediumAccess::Silent));
}

#[test]
fn slots_go_round_all_auvs_and_leave_room_for_the_slowest_sound() {
    let access = model::MediumAccess::Slotted { slot_ns: SECOND_NS, slots: 3, guard_range_m: 730.0 };
    for (auv, access) in (0..).zip(told(access)) {
        let MediumAccess::Slotted { slot_ns, slots, slot, packet_ns, propagation_ns } = access else {
            panic!("{access:?}")
        };
        assert_eq!((slot_ns, slots, slot), (SECOND_NS, 3, auv % 3));
        // An instant at level ideal; 730 m at 1460 m/s, and a rounding more.
        assert_eq!(packet_ns, 0);
        assert!((500_000_000..500_000_010).contains(&propagation_ns), "{propagation_ns}");
    }
}

#[test]
fn a_slot_is_told_the_packet_of_its_modem_at_level_sea() {
    let access = model::MediumAccess::Slotted { slot_ns: 9 * SECOND_NS, slots: 4, guard_range_m: 100.0 };
    let told = told_in(access, |scenario| {
        scenario.environment.level = sea(SoundSpeed::Uniform, 100.0);
        let modem = &mut scenario.groups[0].modem;
        *modem = shoal_scenario::presets::SEATRAC;
        modem.access = access;
    });
    let packet_ns = |index: usize| match told[index] {
        MediumAccess::Slotted { packet_ns, .. } => packet_ns,
        ref other => panic!("{other:?}"),
    };
    // 0.4 s of preamble and 248 bits at 100 bit/s.
    assert!((2_880_000_000..2_880_000_003).contains(&packet_ns(0)), "{}", packet_ns(0));
}
