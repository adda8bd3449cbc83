//! What people see when a scenario file is wrong: the place, the cause, the fix. Each file of `tests/broken` is one way.

use std::path::Path;

use shoal_scenario::parse;

fn shown(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/broken").join(name);
    let text = std::fs::read_to_string(path).unwrap();
    let errors = parse(name, &text).expect_err("a broken scenario is refused");
    assert!(errors.errors.is_sorted_by_key(|error| error.span.start));
    errors.render(false)
}

macro_rules! broken {
    ($($test:ident: $name:literal),* $(,)?) => {
        $(
            #[test]
            fn $test() {
                insta::assert_snapshot!($name, shown(concat!($name, ".toml")));
            }
        )*

        #[test]
        fn no_broken_scenario_is_forgotten() {
            let mut known = vec![$(concat!($name, ".toml").to_string()),*];
            let listed = std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/broken")).unwrap();
            let mut found: Vec<String> =
                listed.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
            known.sort();
            found.sort();
            assert_eq!(known, found);
        }
    };
}

broken! {
    outliers_impossible: "outliers-impossible",
    syntax: "syntax",
    unknown_key: "unknown-key",
    wrong_types: "wrong-types",
    missing_keys: "missing-keys",
    impossible_values: "impossible-values",
    window_too_long: "window-too-long",
    slow_sound: "slow-sound",
    start_outside: "start-outside",
    grid_impossible: "grid-impossible",
    trusts_unknown: "trusts-unknown",
    circle_too_fast: "circle-too-fast",
    too_many: "too-many",
    unknown_names: "unknown-names",
    not_nanoseconds: "not-nanoseconds",
    estimator_impossible: "estimator-impossible",
    fault_impossible: "fault-impossible",
    start_unknown: "start-unknown",
    sabotage_outside: "sabotage-outside",
    one_bracket: "one-bracket",
    two_places: "two-places",
    too_many_errors: "too-many-errors",
    sea_below_floor: "sea-below-floor",
    sea_at_ideal: "sea-at-ideal",
    sea_impossible: "sea-impossible",
    sea_unknown_names: "sea-unknown-names",
    area_too_deep: "area-too-deep",
    profile_repeated_depths: "profile-repeated-depths",
    profile_lengths: "profile-lengths",
    profile_implausible: "profile-implausible",
    profile_beside_speed: "profile-beside-speed",
    profile_both_ways: "profile-both-ways",
    profile_too_deep: "profile-too-deep",
    profile_too_fresh: "profile-too-fresh",
    profile_one_depth: "profile-one-depth",
    slow_profile: "slow-profile",
    modem_unfit: "modem-unfit",
    modem_impossible: "modem-impossible",
    modem_unknown: "modem-unknown",
    access_impossible: "access-impossible",
    bearing_impossible: "bearing-impossible",
    command_impossible: "command-impossible",
}
