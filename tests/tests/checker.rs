//! The check of enclosures against the truth really checks: each kind of broken promise ends a run with exit code 4, and the
//! summary names AUV, time and margin.

use serde_json::Value;
use shoal_tests::{Command, Finished, scenario_file};

fn run(scenario: &str, more: &str) -> Finished {
    Command::new("run --quiet").with(scenario_file(scenario)).and(more).finish()
}

/// The violations told, after checking that people are told the same.
fn violations(scenario: &str, more: &str) -> Vec<Value> {
    let summary = run(scenario, &format!("{more} --json")).exited(4).json();
    let containment = &summary["containment"];
    let told = containment["first"].as_array().unwrap().clone();
    assert!(containment["violations"].as_u64().unwrap() >= told.len() as u64);
    assert_eq!(summary["reproducible"], true);

    let text = run(scenario, more).exited(4).stdout;
    assert!(text.contains("THE TRUTH WAS LOST"), "{text}");
    for violation in &told {
        let (name, auv) = (violation["name"].as_str().unwrap(), &violation["auv"]);
        let begins = format!("{name} (AUV {auv}) at {:.3} s, ", violation["time_s"].as_f64().unwrap());
        let line =
            text.lines().find(|line| line.contains(&begins)).unwrap_or_else(|| panic!("{begins}:\n{text}"));
        if let Some(margin) = violation["margin"].as_f64() {
            let unit = violation["unit"].as_str().unwrap();
            assert!(text.contains(&format!("is {margin:.3e} {unit} outside")), "{line}\n{text}");
        }
    }
    told
}

fn assert_clean(scenario: &str, more: &str) {
    let summary = run(scenario, &format!("{more} --json")).succeeded().json();
    assert_eq!(summary["containment"]["violations"], 0);
    assert!(summary["containment"]["checks"].as_u64().unwrap() > 100);
    assert_eq!(summary["containment"]["first"], Value::Null);
}

#[test]
fn a_clock_believed_twice_as_good_is_caught() {
    // At its bound the clock gains 10 ms a second, twice what is believed: the enclosure of the offset loses it at once, but
    // for the width of the stamps.
    let told = violations("halved-clock", "--noise adversarial");
    for violation in &told {
        assert!(["report", "slice"].contains(&violation["enclosure"].as_str().unwrap()), "{violation}");
        assert_eq!((&violation["coordinate"], &violation["unit"]), (&"time".into(), &"s".into()));
        let (time_s, margin_s) =
            (violation["time_s"].as_f64().unwrap(), violation["margin"].as_f64().unwrap());
        // It drifts away by half of 1 %.
        assert!(margin_s > 0.0 && margin_s < 0.0051 * time_s, "{violation}");
    }
    assert!(told[0]["time_s"].as_f64().unwrap() < 0.2, "{told:?}");
    assert_clean("drifters", "--noise adversarial");
    assert_clean("drifters", "");
}

#[test]
fn a_truth_shifted_by_a_metre_is_caught() {
    for bus in ["iceoryx2", "local"] {
        let told = violations("shifted-truth", &format!("--bus {bus}"));
        let first = &told[0];
        assert_eq!((&first["auv"], &first["name"]), (&1.into(), &"eye-1".into()));
        assert_eq!((&first["coordinate"], &first["unit"]), (&"x".into(), &"m".into()));
        let time_s = first["time_s"].as_f64().unwrap();
        assert!((5.0..5.2).contains(&time_s), "{first}");
        let margin_m = first["margin"].as_f64().unwrap();
        assert!(margin_m > 0.0 && margin_m < 1.0, "{first}");
        // Its pings mislead the others, who notice, and drop what contradicts their sets.
        assert!(
            told.iter().all(|violation| violation["auv"] == 1 || violation["enclosure"] == "emptied"),
            "{told:?}"
        );
    }
    let summary = run("surveyors", "--json").succeeded().json();
    assert!(
        summary["position_width_m"]["end_max"].as_f64().unwrap() < 1.0,
        "{}",
        summary["position_width_m"]
    );
    assert_clean("surveyors", "--noise adversarial");
}

#[test]
fn a_ping_that_lies_is_caught() {
    let told = violations("lying-ping", "");
    let lies: Vec<&Value> = told.iter().filter(|violation| violation["enclosure"] == "ping").collect();
    assert!(!lies.is_empty(), "{told:?}");
    for lie in lies {
        assert_eq!((&lie["auv"], &lie["name"]), (&3.into(), &"other-0".into()));
        assert_eq!((&lie["coordinate"], &lie["unit"]), (&"x".into(), &"m".into()));
        // Ten metres and a box width away from the box: ten at least from the truth, but for what the frame rounds.
        assert!(lie["margin"].as_f64().unwrap() > 9.0, "{lie}");
    }
    assert_eq!(told[0]["enclosure"], "ping");
    assert_clean("talkers", "");
    assert_clean("talkers", "--noise adversarial");
}

#[test]
fn an_empty_set_that_nobody_declared_is_caught() {
    let told = violations("empty-set", "");
    assert_eq!(told.len(), 1);
    let emptied = &told[0];
    assert_eq!((&emptied["auv"], &emptied["name"]), (&3.into(), &"other-0".into()));
    assert_eq!((&emptied["enclosure"], &emptied["coordinate"]), (&"emptied".into(), &"all".into()));
    // Nothing has no margin. It is the eleventh tick of ten a second.
    assert!(emptied["margin"].is_null());
    assert!((1.0..1.2).contains(&emptied["time_s"].as_f64().unwrap()), "{emptied}");
    let text = run("empty-set", "").stdout;
    assert!(text.contains("reported an empty set, though no fault was declared"), "{text}");
}
