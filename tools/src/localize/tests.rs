//! A synthetic data set in files, what can be wrong with such files, and the real one where it is there.

use std::fmt::Write;
use std::path::Path;

use clap::Parser;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use tempfile::TempDir;

use super::dataset::{estimate, start};
use super::files::Dataset;
use super::report::Report;
use super::{LocalizeArgs, localize, map};
use crate::figure::assert_well_formed;

/// Names the folder of the GOATS'02 data.
const GOATS02: &str = "SHOAL_GOATS02";

#[derive(Parser)]
struct CommandLine {
    #[command(flatten)]
    args: LocalizeArgs,
}

fn args(folder: &Path, more: &str) -> LocalizeArgs {
    let folder = folder.to_str().unwrap();
    let words = ["localize", "--dataset", folder].into_iter().chain(more.split_whitespace());
    CommandLine::try_parse_from(words).unwrap().args
}

fn localized(folder: &Path, more: &str) -> Report {
    let dataset = Dataset::read(folder).unwrap();
    let args = args(folder, more);
    estimate(&dataset, &start(&dataset, &args).unwrap(), &args).1
}

/// Writes a mission of 150 poses on two circles between three beacons, of which the reference is the truth: ranges are uniformly
/// wrong by at most 3 m, odometry by at most 0.1 m, and one range of 25 is far too short.
fn synthetic() -> TempDir {
    let mut rng = ChaCha8Rng::seed_from_u64(2002);
    let mut uniform = move || rng.next_u64() as f64 / u64::MAX as f64 * 2.0 - 1.0;
    let beacons = [("north", 100.0, 300.0), ("east", 300.0, 0.0), ("west", -200.0, 20.0)];
    let mut files = [
        "id,x_m,y_m\n",
        "from,to,dx_m,dy_m,dtheta_rad\n",
        "pose,beacon,range_m,sigma_m\n",
        "pose,x_m,y_m,theta_rad\n",
    ]
    .map(str::to_owned);
    for (id, x, y) in beacons {
        writeln!(files[0], "{id},{x},{y}").unwrap();
    }
    let (mut x, mut y, mut theta): (f64, f64, f64) = (10.0, 20.0, -0.4);
    let mut count = 0;
    for pose in 0..150 {
        writeln!(files[3], "{pose},{x},{y},{theta}").unwrap();
        if pose > 0 {
            for (id, beacon_x, beacon_y) in beacons {
                count += 1;
                let (dx, dy) = (x - beacon_x, y - beacon_y);
                let exact = (dx * dx + dy * dy).sqrt();
                let range = if count % 25 == 0 { 0.4 * exact } else { exact + 3.0 * uniform() };
                writeln!(files[2], "{pose}, {id}, {range}, 1.5").unwrap();
            }
        }
        let (forward, turn) = (3.0, if pose < 75 { 0.08 } else { -0.08 });
        let (dx, dy) = (forward + 0.07 * uniform(), 0.07 * uniform());
        if pose < 149 {
            writeln!(files[1], "{pose},{},{dx},{dy},{turn}", pose + 1).unwrap();
        }
        let (sin, cos) = pxfm::f_sincos(theta);
        (x, y, theta) = (x + cos * forward, y + sin * forward, theta + turn);
    }
    let folder = TempDir::new().unwrap();
    for (name, text) in ["beacons", "odom", "ranges", "ref_poses"].iter().zip(files) {
        std::fs::write(folder.path().join(format!("{name}.csv")), text).unwrap();
    }
    folder
}

#[test]
fn a_synthetic_mission() {
    let folder = synthetic();
    let bounds = "--start-m 1 --heading-rad 0.01 --range-m 3";
    let both_ways = localized(folder.path(), bounds);
    let online = both_ways.online.as_deref().unwrap();
    assert_eq!((both_ways.contained_fraction, online.contained_fraction), (Some(1.0), Some(1.0)));
    assert!(both_ways.width_median_m < online.width_median_m && online.width_median_m < 10.0, "{online:?}");
    assert_eq!((both_ways.ranges_rejected, both_ways.ranges_used, both_ways.emptied), (17, 430, 0));
    assert!(both_ways.centre_rms_m.unwrap() < 1.0);
    assert_eq!(localized(folder.path(), &format!("{bounds} --online")), *online);

    let gated = localized(folder.path(), "--estimator ekf");
    let open = localized(folder.path(), "--estimator ekf --gate 0");
    assert!(gated.centre_rms_m.unwrap() < 1.5 && open.centre_rms_m.unwrap() > 5.0, "{gated:?} {open:?}");
    let drifting = localized(folder.path(), &format!("{bounds} --estimator dead-reckoning"));
    assert_eq!((drifting.contained_fraction, drifting.ranges_used), (Some(1.0), 0));
    assert!(drifting.width_median_m > 3.0 * online.width_median_m);
}

#[test]
fn an_unknown_start_and_no_reference() {
    let folder = synthetic();
    let unknown = localized(folder.path(), "--start unknown --heading-rad 0.1 --range-m 3");
    assert!(unknown.contained_fraction.unwrap() == 1.0 && unknown.width_median_m < 20.0, "{unknown:?}");
    std::fs::remove_file(folder.path().join("ref_poses.csv")).unwrap();
    let told = localized(folder.path(), "--start 10,20,-0.4 --range-m 3");
    assert!(told.contained_fraction.is_none() && told.width_median_m < 12.0, "{told:?}");
    let without = Dataset::read(folder.path()).unwrap();
    let refused = start(&without, &args(folder.path(), "--start reference")).unwrap_err();
    assert!(refused.message.contains("--start unknown"), "{}", refused.message);
}

#[test]
fn a_start_that_is_wrong_is_told_and_leaves_numbers() {
    let folder = synthetic();
    let wrong = localized(folder.path(), "--start 300,-200,1 --range-m 3");
    for report in [wrong.online.as_deref().unwrap(), &wrong] {
        assert!(report.emptied > 0 && report.contained_fraction.unwrap() < 1.0, "{report:?}");
        assert!(report.width_max_m.is_finite() && report.centre_rms_m.unwrap().is_finite(), "{report:?}");
    }
}

#[test]
fn the_figure_and_the_json() {
    let folder = synthetic();
    let args = args(folder.path(), "--range-m 3");
    let dataset = Dataset::read(folder.path()).unwrap();
    let (track, report) = estimate(&dataset, &start(&dataset, &args).unwrap(), &args);
    let svg = map::figure(&dataset, &track, &report, "Two beacons").to_svg();
    assert_well_formed(&svg);
    assert!(svg.contains("Two beacons") && svg.contains("17 ranges rejected"));
    let json = serde_json::to_value(&report).unwrap();
    assert_eq!((&json["format"], &json["estimator"]), (&"shoal.localize/1".into(), &"tube".into()));
    assert_eq!((&json["poses"], &json["ranges_rejected"]), (&150.into(), &17.into()));
    assert_eq!(json["online"]["contained_fraction"], 1.0);
}

#[test]
fn what_is_wrong_in_a_file_is_told() {
    let complaint = |file: &str, line: usize, text: &str| {
        let folder = synthetic();
        let path = folder.path().join(file);
        let before = std::fs::read_to_string(&path).unwrap();
        let after: Vec<&str> = before
            .lines()
            .enumerate()
            .map(|(index, old)| if index + 1 == line { text } else { old })
            .collect();
        std::fs::write(&path, after.join("\n")).unwrap();
        let message = Dataset::read(folder.path()).unwrap_err().message;
        let place = format!("{file}:{line}: ");
        let (_, cause) = message.split_once(&place).unwrap_or_else(|| panic!("no {place} in: {message}"));
        cause.to_owned()
    };
    let cases = [
        ("ranges.csv", 4, "1,west,abc,1.5", "range_m is `abc`: give a number, such as 12.5"),
        ("ranges.csv", 4, "1,west,NaN,1.5", "range_m is NaN: give a number of at most 1e9"),
        ("ranges.csv", 4, "1,west,inf,1.5", "range_m is inf: give a number of at most 1e9"),
        ("ranges.csv", 4, "1,west,-3,1.5", "range_m is -3: a distance is never negative, leave the line out"),
        ("ranges.csv", 4, "1,west,3,0", "sigma_m is 0: give a standard deviation above zero, such as 0.75"),
        ("ranges.csv", 4, "1,wets,3,1", "beacon `wets` is not in beacons.csv, which has north, east, west"),
        ("ranges.csv", 4, "150,west,3,1", "pose 150 is none: odom.csv ends with pose 149"),
        ("ranges.csv", 7, "0,west,3,1", "pose 0 comes after a later one: sort the lines by pose"),
        ("ranges.csv", 4, "-1,west,3,1", "pose is `-1`: give the number of a pose, counted from 0"),
        ("ranges.csv", 4, "1,west,3", "3 values where the first line names 4: give as many"),
        (
            "ranges.csv",
            1,
            "pose,beacon,range,sigma_m",
            "there is no column `range_m`: begin with the line `pose,beacon,range_m,sigma_m`",
        ),
        (
            "odom.csv",
            3,
            "1,3,1,0,0",
            "this leads from pose 1 to 3, but from 1 to 2 is next: give every step, in order",
        ),
        ("odom.csv", 3, "1,2,1,,0", "dy_m is ``: give a number, such as 12.5"),
        ("beacons.csv", 3, "north,1,2", "beacon `north` is there already: give each its own id"),
        ("ref_poses.csv", 3, "7,1,2,3", "this is pose 7: give poses 0 to 149, each once, in order"),
    ];
    for (file, line, text, expected) in cases {
        assert_eq!(complaint(file, line, text), expected);
    }
    let folder = synthetic();
    std::fs::write(folder.path().join("odom.csv"), [0x66, 0xff, 0x2c, 0x0a]).unwrap();
    assert!(
        Dataset::read(folder.path()).unwrap_err().message.contains("odom.csv:1: this is no text in UTF-8")
    );
    std::fs::write(folder.path().join("beacons.csv"), "id,x_m,y_m\n").unwrap();
    assert!(Dataset::read(folder.path()).unwrap_err().message.contains("there is no beacon"));
    std::fs::remove_file(folder.path().join("beacons.csv")).unwrap();
    assert!(Dataset::read(folder.path()).unwrap_err().message.contains("beacons.csv: "));
}

#[test]
fn arguments() {
    let refused = |more: &str| {
        let words = ["localize", "--dataset", "x"].into_iter().chain(more.split_whitespace());
        CommandLine::try_parse_from(words).is_err()
    };
    for wrong in [
        "--start 1,2",
        "--start 1,2,nan",
        "--range-m 0",
        "--range-m nan",
        "--window 0",
        "--step-m -1",
        "--gate inf",
    ] {
        assert!(refused(wrong), "{wrong}");
    }
    assert!(!refused("--start -1.5,2,-3") && !refused("--gate 0 --sigma-m 5"));
}

#[test]
fn what_only_the_filter_heeds_is_refused_elsewhere() {
    let folder = synthetic();
    let refusal = |more: &str| localize(&args(folder.path(), more)).err().map(|failure| failure.message);
    let told = refusal("--estimator tube --gate 3").unwrap();
    assert!(told.contains("--gate means nothing to --estimator tube"), "{told}");
    assert!(refusal("--estimator dead-reckoning --sigma-m 2").is_some());
    assert_eq!(refusal("--estimator ekf --gate 3 --sigma-m 2"), None);
}

/// Published-style baselines on the same file: dead reckoning 5.81 m, gated filter 5.28-5.31 m, ungated 14.5-16.2 m.
#[test]
fn goats02() {
    let Some(folder) = std::env::var_os(GOATS02) else {
        eprintln!("skipped: set {GOATS02} to the folder with the GOATS'02 data");
        return;
    };
    let folder = Path::new(&folder);
    let both_ways = localized(folder, "");
    for report in [both_ways.online.as_deref().unwrap(), &both_ways] {
        assert_eq!((report.poses, report.emptied), (679, 0));
        assert!(report.contained_fraction.unwrap() >= 0.98, "{report:?}");
        assert!(report.width_median_m < 25.0 && report.centre_rms_m.unwrap() < 6.0, "{report:?}");
        assert!((10..25).contains(&report.ranges_rejected), "{report:?}");
    }
    let rms_m = |more| localized(folder, more).centre_rms_m.unwrap();
    for (more, published_m, tolerance_m) in [
        ("--estimator dead-reckoning", 5.81, 0.02),
        ("--estimator ekf", 5.3, 0.1),
        ("--estimator ekf --gate 0", 15.3, 0.9),
    ] {
        let rms_m = rms_m(more);
        assert!((rms_m - published_m).abs() < tolerance_m, "{more}: {rms_m}");
    }
}
