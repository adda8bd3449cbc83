//! The scenarios that come with Shoal are good, and say what the design says they say.

use std::path::Path;

use shoal_scenario::model::MediumAccess;
use shoal_scenario::{Controller, LoadError, Overrides, Place, Scenario, library, load, parse};

fn scenario(name: &str) -> Scenario {
    let (source_name, text) = load(name).unwrap();
    parse(&source_name, &text).unwrap_or_else(|errors| panic!("{errors}"))
}

#[test]
fn every_scenario_parses_and_is_called_what_it_is_called() {
    for entry in library() {
        let scenario = scenario(entry.name);
        assert_eq!(scenario.name, entry.name);
        assert!(!scenario.summary.is_empty() && !scenario.source.is_empty(), "{}", entry.name);
    }
}

#[test]
fn a_file_and_its_copy_in_the_library_are_one() {
    for entry in library() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("library/{}.toml", entry.name));
        let (source_name, text) = load(path.to_str().unwrap()).unwrap();
        assert_eq!(text, entry.text);
        assert_eq!(parse(&source_name, &text).unwrap(), scenario(entry.name));
    }
}

#[test]
fn every_file_of_the_library_is_listed() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("library");
    let mut files: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|file| file.unwrap().file_name().into_string().unwrap())
        .collect();
    let mut listed: Vec<String> = library().iter().map(|entry| format!("{}.toml", entry.name)).collect();
    files.sort();
    listed.sort();
    assert_eq!(files, listed);
}

#[test]
fn the_windows_that_the_design_names_are_allowed() {
    let allowed = |name: &str, window_ms: f64| {
        Overrides { window_ms: Some(window_ms), ..Overrides::default() }.apply(scenario(name)).is_ok()
    };
    assert!([10.0, 50.0, 90.0].into_iter().all(|window_ms| allowed("six-circles", window_ms)));
    assert!(!allowed("six-circles", 91.0));
    assert!(allowed("two-circles", 9.0) && !allowed("two-circles", 10.0));
}

#[test]
fn swarms_have_their_sizes() {
    let counts = |name: &str| scenario(name).groups.iter().map(|group| group.count).collect::<Vec<_>>();
    assert_eq!(counts("swarm-3"), [3]);
    assert_eq!(counts("swarm-300"), [300]);
    assert_eq!(counts("swarm-1000"), [500, 300, 200]);
    assert_eq!(counts("swarm-10000"), [10_000]);
    assert_eq!(counts("seismic-grid-3000").iter().sum::<u32>(), 3_000);
    for (index, group) in scenario("swarm-1000").groups.iter().enumerate() {
        let Controller::Reynolds { trusts, .. } = &group.controller else { panic!("not a swarm") };
        assert_eq!(trusts, &[index as u16]);
    }
}

/// The comments of seismic-grid-3000.toml promise one grid of 60 columns and 50 rows, and that modems of one slot are 900 m apart.
#[test]
fn the_survey_is_one_grid_whose_slots_are_far_apart() {
    let scenario = scenario("seismic-grid-3000");
    let points_m: Vec<[f64; 3]> = scenario
        .groups
        .iter()
        .flat_map(|group| (0..group.count).map(|index| group.start.place.point_m(index).unwrap()))
        .collect();
    for (index, point_m) in points_m.iter().enumerate() {
        assert_eq!(point_m[..2], [100.0 * (index % 60) as f64, 100.0 * (index / 60) as f64]);
    }
    for group in &scenario.groups {
        let MediumAccess::Slotted { slots, .. } = group.modem.access else { panic!("no slots") };
        for (index, point_m) in points_m.iter().enumerate() {
            for other_m in points_m[index + 1..].iter().skip(slots as usize - 1).step_by(slots as usize) {
                let [east_m, north_m] = [point_m[0] - other_m[0], point_m[1] - other_m[1]];
                assert!(east_m * east_m + north_m * north_m >= 900.0 * 900.0, "{point_m:?} {other_m:?}");
            }
        }
    }
}

/// The comments of six-circles.toml promise a fix exactly where x < -9 and encounters closer than the range.
#[test]
fn six_circles_surface_where_printed_and_meet() {
    let scenario = scenario("six-circles");
    let circles: Vec<_> = scenario
        .groups
        .iter()
        .map(|group| match &group.controller {
            Controller::Circle { centre_m, radius_m, rate_rad_s, phase_rad, heave_m, heave_phase_rad } => {
                let (centre, radius, heave) = (*centre_m, *radius_m, *heave_m);
                let (rate, phase, heave_phase) = (*rate_rad_s, *phase_rad, *heave_phase_rad);
                move |t: f64, k: u32| {
                    let a = rate * t + phase + std::f64::consts::TAU * f64::from(k) / 3.0;
                    [
                        centre[0] + radius * pxfm::f_cos(a),
                        centre[1] + radius * pxfm::f_sin(a),
                        centre[2] + heave * pxfm::f_cos(a + heave_phase),
                    ]
                }
            }
            _ => panic!("not a circle"),
        })
        .collect();
    assert!(scenario.groups.iter().all(|group| group.start.place == Place::OnCircle));
    let depth_max_m = scenario.groups[0].sensors.gnss.as_ref().unwrap().depth_max_m;
    let mut closest_m = f64::INFINITY;
    for step in 0..6300 {
        let t = f64::from(step) * 1e-3;
        for k in 0..3 {
            let p = circles[0](t, k);
            if (p[0] + 9.0).abs() > 1e-6 {
                assert_eq!(p[2] > -depth_max_m, p[0] < -9.0, "x = {}, z = {}", p[0], p[2]);
            }
            for other in 0..3 {
                let q = circles[1](t, other);
                let apart_m =
                    (0..3).map(|axis| (p[axis] - q[axis]) * (p[axis] - q[axis])).sum::<f64>().sqrt();
                closest_m = closest_m.min(apart_m);
            }
        }
    }
    assert!((2.0..2.5).contains(&closest_m), "{closest_m}");
}

#[test]
fn an_unknown_name_is_answered_with_the_nearest() {
    let error = load("swarm300").unwrap_err();
    assert!(matches!(error, LoadError::Unknown { similar: Some("swarm-300"), .. }));
    insta::assert_snapshot!(error, @"there is no scenario `swarm300`, neither in the library nor as a file: did you mean `swarm-300`?; the library has two-circles, six-circles, six-auvs-3d, sea-trial, swarm-3, kidnapped, unknown-start, surface-bounce, echoes, thermocline, crowded-band, data-incest, sweep-16, swarm-300, swarm-1000, seismic-grid-3000, swarm-10000, or give the path of a .toml file");
}

#[test]
fn a_folder_is_no_scenario() {
    assert!(matches!(load(env!("CARGO_MANIFEST_DIR")), Err(LoadError::Unreadable { .. })));
}
