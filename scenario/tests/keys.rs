//! The table of keys in the documentation lists every key that the reader knows.

use shoal_scenario::parse;

/// One unknown key in every table, too unlike any key to be taken for a slip: the fix then lists the keys there are.
const UNKNOWN_EVERYWHERE: &str = r#"
name = "all"
duration_s = 1
zz = 0
[environment]
area_m = [[0, 9], [0, 9], [-9, 0]]
zz = 0
[kind.a]
like = "lauv"
zz = 0
[clock.a]
like = "tcxo"
zz = 0
[sabotage]
shifted_truth = { auv = 0, at_s = 0, zz = 0 }
zz = 0
[[group]]
name = "hold"
count = 1
estimator = { name = "tube", zz = 0 }
controller = { name = "hold", zz = 0 }
zz = 0
[group.sensors]
zz = 0
[group.sensors.gnss]
zz = 0
[group.modem]
access = { name = "csma", listen_s = 1, backoff_s = 1, zz = 0 }
duty_cycle = { period_s = 1, awake_s = 1, zz = 0 }
zz = 0
[group.start]
zz = 0
[[group]]
name = "circle"
count = 1
modem.access = { name = "slotted", slot_s = 1, zz = 0 }
controller = { name = "circle", centre_m = [4, 4, -4], radius_m = 1, rate_rad_s = 0.1, zz = 0 }
[[group]]
name = "waypoints"
count = 1
controller = { name = "waypoints", points_m = [[1, 1, -1]], zz = 0 }
[[group]]
name = "reynolds"
count = 1
controller = { name = "reynolds", zz = 0 }
"#;

#[test]
fn every_key_is_documented() {
    let documented = include_str!("../src/lib.rs");
    let errors = parse("all.toml", UNKNOWN_EVERYWHERE).unwrap_err();
    assert_eq!((errors.errors.len(), errors.omitted), (19, 0), "{errors}");
    for error in &errors.errors {
        let (_, keys) = error.fix.split_once(" has the keys ").unwrap_or_else(|| panic!("{errors}"));
        for key in keys.split(", ") {
            let forms = [
                format!("`{key}`"),
                format!(".{key}`"),
                format!("[{key}]"),
                format!("[{key}."),
                format!(".{key}]"),
                format!("{key} = "),
            ];
            assert!(
                forms.iter().any(|form| documented.contains(form)),
                "`{key}` is not in the table of lib.rs"
            );
        }
    }
}
