//! What `[group.modem]` says becomes the modem, and what is doubtful about it is said.

use shoal_scenario::{
    DutyCycle, MediumAccess, Modem, Modulation, Overrides, Scenario, Warning, parse, presets,
};

const SECOND_NS: i64 = 1_000_000_000;

/// Two groups at this level, `first` and `second` being what they say after name and count.
fn scenario(level: &str, counts: [u32; 2], first: &str, second: &str) -> Scenario {
    let text = format!(
        "name = \"test\"\nduration_s = 10\n[environment]\narea_m = [[0, 300], [0, 400], [-1200, 0]]\nlevel = \"{level}\"\n\
         [[group]]\nname = \"a\"\ncount = {}\n{first}\n[[group]]\nname = \"b\"\ncount = {}\n{second}\n",
        counts[0], counts[1]
    );
    parse("test.toml", &text).unwrap_or_else(|errors| panic!("{errors}"))
}

fn modem(level: &str, says: &str) -> Modem {
    scenario(level, [2, 3], says, says).groups[0].modem.clone()
}

#[test]
fn every_preset_can_be_named_and_put_to_sea() {
    for (name, preset) in presets::MODEMS {
        assert_eq!(modem("ideal", &format!("modem = \"{name}\"")), *preset);
        assert_eq!(modem("ideal", &format!("[group.modem]\nlike = \"{name}\"")), *preset);
        if preset.physical.is_some() {
            assert_eq!(modem("sea", &format!("modem = \"{name}\"")), *preset);
        }
    }
    assert_eq!(modem("ideal", ""), presets::IDEAL);
    assert_eq!(modem("ideal", "[group.modem]"), presets::IDEAL);
}

#[test]
fn keys_change_only_what_they_say() {
    let changed = modem(
        "sea",
        "[group.modem]\nlike = \"popoto\"\nsource_level_db = 170\nmodulation = \"fsk\"\nframe_bytes = 40\naddresses = 7\n\
         ping_period_s = 0.75\nduty_cycle = { period_s = 4, awake_s = 2.5 }",
    );
    let mut expected = presets::POPOTO;
    let layer = expected.physical.as_mut().unwrap();
    (layer.source_level_db, layer.modulation) = (170.0, Modulation::Fsk);
    (expected.frame_bytes, expected.addresses) = (40, Some(7));
    expected.access = MediumAccess::Periodic { period_ns: SECOND_NS * 3 / 4, phase_ns: None };
    expected.duty_cycle = Some(DutyCycle { period_ns: 4 * SECOND_NS, awake_ns: SECOND_NS * 5 / 2 });
    assert_eq!(changed, expected);
}

#[test]
fn a_modem_of_ones_own_needs_four_figures() {
    let own = modem(
        "sea",
        "[group.modem]\nsource_level_db = 180\ncentre_hz = 12000\nbandwidth_hz = 4000\nbit_rate_bit_s = 400",
    );
    let layer = own.physical.unwrap();
    assert_eq!((layer.preamble_s, layer.modulation, layer.capture_db), (0.0, Modulation::Bpsk, 6.0));
    assert_eq!(layer.packet_s(31), 248.0 / 400.0);
}

#[test]
fn each_access_is_read() {
    let access = |says: &str| modem("sea", &format!("[group.modem]\nlike = \"popoto\"\n{says}")).access;
    let period_ns = 2 * SECOND_NS;
    assert_eq!(access(""), MediumAccess::Periodic { period_ns, phase_ns: None });
    assert_eq!(
        access("ping_phase_s = 0.5"),
        MediumAccess::Periodic { period_ns, phase_ns: Some(SECOND_NS / 2) }
    );
    assert_eq!(access("access = \"aloha\""), MediumAccess::Aloha { mean_period_ns: period_ns });
    assert_eq!(
        access("access = { name = \"csma\", listen_s = 0.5, backoff_s = 3 }"),
        MediumAccess::Csma { period_ns, listen_ns: SECOND_NS / 2, backoff_ns: 3 * SECOND_NS }
    );
    // All five AUVs; the diagonal of 300 x 400 x 1200 m.
    assert_eq!(
        access("access = { name = \"slotted\", slot_s = 2 }"),
        MediumAccess::Slotted { slot_ns: period_ns, slots: 5, guard_range_m: 1300.0 }
    );
    for name in ["\"periodic\"", "\"aloha\"", "{ name = \"slotted\", slot_s = 2 }"] {
        assert_eq!(access(&format!("ping_period_s = false\naccess = {name}")), MediumAccess::Silent);
    }
}

/// 0.5875 s of packet and 1300 m at 1500 m/s: 1.454166667 s, to the nanosecond.
#[test]
fn a_slot_just_long_enough_is_good_and_a_nanosecond_less_is_not() {
    let slot = |level: &str, slot_s: &str| {
        let says = format!(
            "[group.modem]\nlike = \"popoto\"\naccess = {{ name = \"slotted\", slot_s = {slot_s}, guard_range_m = 1300 }}\n"
        );
        let text = format!(
            "name = \"a\"\nduration_s = 1\n[environment]\narea_m = [[0, 9], [0, 9], [-9, 0]]\nlevel = \"{level}\"\n\
             [[group]]\nname = \"a\"\ncount = 2\n{says}"
        );
        parse("slot.toml", &text).is_ok()
    };
    assert!(slot("sea", "1.454166667") && !slot("sea", "1.454166666"));
    // At level `ideal`, sound alone.
    assert!(slot("ideal", "0.866666667") && !slot("ideal", "0.866666666"));
}

#[test]
fn a_swarm_beyond_the_addresses_is_warned_of_once() {
    let both = "modem = \"micromodem-psk\"";
    assert_eq!(scenario("ideal", [8, 8], both, both).warnings(), []);
    let warnings = scenario("ideal", [8, 9], both, both).warnings();
    let expected = Warning::Extrapolation { modem: "micromodem-psk".into(), addresses: 16, auvs: 17 };
    assert_eq!(warnings, [expected]);
    // Other modems have addresses of their own.
    assert_eq!(scenario("ideal", [8, 9], both, "modem = \"seatrac\"").warnings(), []);
    assert_eq!(scenario("sea", [1, 1], both, both).warnings(), []);
}

#[test]
fn slots_that_are_shared_or_differ_are_warned_of() {
    let slotted = |slot_s: u32, slots: u32| {
        format!("modem.access = {{ name = \"slotted\", slot_s = {slot_s}, slots = {slots} }}")
    };
    assert_eq!(scenario("ideal", [2, 3], &slotted(2, 5), &slotted(2, 5)).warnings(), []);
    let warnings = scenario("ideal", [2, 3], &slotted(2, 4), &slotted(3, 5)).warnings();
    assert_eq!(
        warnings,
        [
            Warning::SlotsShared { group: "a".into(), slots: 4, auvs: 5 },
            Warning::SlotsDiffer { first: "a".into(), second: "b".into() }
        ]
    );
    insta::assert_snapshot!(warnings[0], @"group `a` divides time into 4 slots for 5 AUVs: AUVs that are 4 apart ping at the same time");
    insta::assert_snapshot!(warnings[1], @"groups `a` and `b` divide time into different slots, which overlap");
}

#[test]
fn a_band_with_more_packets_than_time_is_warned_of() {
    // 0.996 s every 5 s: five AUVs fill the band, six overfill it.
    let both = "modem = \"micromodem-psk\"";
    assert_eq!(scenario("sea", [2, 3], both, both).warnings(), []);
    let warnings = scenario("sea", [3, 3], both, both).warnings();
    assert!(
        matches!(warnings[..], [Warning::Overload { centre_hz: 25_000.0, load }] if (load - 6.0 * 0.996 / 5.0).abs() < 1e-12)
    );
    insta::assert_snapshot!(warnings[0], @"the AUVs around 25000 Hz send 1.2 s of packets each second: where all of them hear each other, pings must collide");
    // A packet takes no time at level `ideal`; a silent AUV sends none; the bands of others are others.
    assert_eq!(scenario("ideal", [3, 3], both, both).warnings(), []);
    let silent = "modem = { like = \"micromodem-psk\", ping_period_s = false }";
    assert_eq!(scenario("sea", [3, 3], both, silent).warnings(), []);
    assert_eq!(scenario("sea", [3, 3], both, "modem = \"evologics-18-34\"").warnings(), []);
}

#[test]
fn one_slot_for_each_auv_stays_one_for_each() {
    let slots = |written: &str, auvs: u32| {
        let says = format!("modem.access = {{ name = \"slotted\", slot_s = 2{written} }}");
        let scenario = scenario("ideal", [4, 6], &says, &says);
        let scaled = Overrides { auvs: Some(auvs), ..Overrides::default() }.apply(scenario).unwrap();
        scaled
            .groups
            .into_iter()
            .map(|group| match group.modem.access {
                MediumAccess::Slotted { slots, .. } => slots,
                _ => 0,
            })
            .collect::<Vec<_>>()
    };
    assert_eq!(slots("", 5), [5, 5]);
    assert_eq!(slots("", 100), [100, 100]);
    assert_eq!(slots(", slots = 16", 5), [16, 16]);
}

#[test]
fn the_library_has_nothing_doubtful() {
    for entry in shoal_scenario::library() {
        let scenario = parse(entry.name, entry.text).unwrap();
        assert_eq!(scenario.warnings(), [], "{}", entry.name);
    }
}
