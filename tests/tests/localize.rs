//! `shoal localize --offline` on records of real runs.

use shoal_tests::Command;

#[test]
fn a_record_becomes_trajectories_and_a_figure() {
    let folder = tempfile::tempdir().unwrap();
    let [record, out, figure] =
        ["run.mcap", "run.offline.mcap", "tubes.svg"].map(|name| folder.path().join(name));
    // What an AUV is told at birth depends on the mood of noise, which is no part of the scenario's text here.
    let run = "run six-circles --duration 25 --noise adversarial --seed 3 --bus local --record";
    let summary = Command::new(run).with(&record).json();
    let told = Command::new("localize --offline").with(&record).json();
    assert_eq!((&told["format"], &told["estimator"]), (&"shoal.localize/1".into(), &"offline".into()));
    assert_eq!((&told["poses"], &told["contained_fraction"]), (&summary["wakes"], &1.0.into()));
    assert_eq!(told["all"]["contained_online"], summary["wakes"]);
    assert_eq!((&told["ranges_used"], &told["ranges_rejected"]), (&summary["pings"]["heard"], &0.into()));
    let width = |which: &str| told["all"]["position_width_m"]["median"][which].as_f64().unwrap();
    assert!(width("offline") < 0.9 * width("online") && width("online") <= width("none"), "{told}");

    let info = Command::new("record info --json").with(&out).finish().succeeded().json();
    assert_eq!(info["digest"], summary["digest"]);
    let of_auv = |auv: &str| {
        Command::new("plot").with(&out).and("tubes --auv").with(auv).and("-o").with(&figure).finish()
    };
    assert_eq!(of_auv("3").code(), Some(0));
    let svg = std::fs::read_to_string(&figure).unwrap();
    assert!(svg.starts_with("<svg") && svg.contains("(3) offline") && svg.contains("deep-0"));
    assert!(!svg.contains("NaN"));
    let refused = |finished: shoal_tests::Finished, code: i32, words: &str| {
        assert!(finished.code() == Some(code) && finished.stderr.contains(words), "{finished:?}");
    };
    refused(of_auv("6"), 1, "there is no AUV 6");
    refused(Command::new("plot").with(&record).and("losses --auv 1").finish(), 2, "--auv is for `tubes`");
    refused(Command::new("localize").with(&record).finish(), 2, "--offline");
    let itself = Command::new("localize --offline").with(&record).and("--out").with(&record).finish();
    refused(itself, 2, "would be overwritten");

    let text = Command::new("localize --offline").with(&record).finish().succeeded().stdout;
    assert!(text.contains("surface-1") && text.contains("holds the truth: offline 100.0000 %"), "{text}");

    let cut = folder.path().join("cut.mcap");
    let bytes = std::fs::read(&record).unwrap();
    std::fs::write(&cut, &bytes[..bytes.len() / 2]).unwrap();
    let finished = Command::new("localize --offline --json").with(&cut).finish().exited(3);
    assert!(finished.stderr.contains("ends before the run does"), "{finished:?}");
    let part = finished.json();
    assert_eq!(part["contained_fraction"], 1.0);
    assert!(part["poses"].as_u64().unwrap() < told["poses"].as_u64().unwrap());
    for length in [0, 100, 3_000] {
        std::fs::write(&cut, &bytes[..length]).unwrap();
        let finished = Command::new("localize --offline").with(&cut).finish().exited(1);
        assert!(
            finished.stderr.starts_with("error: ") && finished.stderr.lines().count() == 1,
            "{finished:?}"
        );
    }
}

#[test]
fn who_was_kidnapped_is_counted_apart() {
    let folder = tempfile::tempdir().unwrap();
    let record = folder.path().join("run.mcap");
    Command::new("run kidnapped --bus local --quiet --record").with(&record).finish().succeeded();
    let text = Command::new("localize --offline").with(&record).finish().succeeded().stdout;
    assert!(text.contains("counted apart: diver-0 lost the truth at 400 ticks"), "{text}");
    assert!(!text.contains("violated"), "{text}");
}

#[test]
fn misuse_is_refused_with_a_way_out() {
    let refused = |arguments: &str, code: i32, words: &str| {
        let finished = Command::new(arguments).finish();
        assert!(finished.code() == Some(code) && finished.stderr.contains(words), "{finished:?}");
        assert_eq!(finished.stdout, "");
    };
    refused("localize", 2, "`RECORD --offline`, or `--dataset DIR`");
    refused("localize run.mcap", 2, "add `--offline`");
    refused("localize run.mcap --dataset folder", 2, "both a record and a data set");
    refused("localize run.mcap --offline --gate 3", 2, "--dataset <DIR>");
    refused("localize run.mcap --offline --estimator ekf", 2, "--dataset <DIR>");
    refused("localize --dataset folder --offline", 2, "<RECORD>");
    refused("localize nowhere.mcap --offline", 1, "nowhere.mcap: ");
    refused(
        "localize --dataset nowhere",
        1,
        "beacons.csv: there is no such file: a data set is a folder that has it",
    );
    refused("localize --dataset nowhere --estimator kalman", 2, "tube, ekf, dead-reckoning");
    refused("localize --dataset nowhere --start here", 2, "`499.2,334,2.34`");
}
