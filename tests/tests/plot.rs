//! Figures of real runs.

use shoal_tests::{Command, scenario_file};

#[test]
fn a_record_becomes_figures() {
    let folder = tempfile::tempdir().unwrap();
    let [record, figure, cut] = ["run.mcap", "figure.svg", "cut.mcap"].map(|name| folder.path().join(name));
    let summary =
        Command::new("run --bus local").with(scenario_file("shadow")).and("--record").with(&record).json();
    let kinds = [
        "losses",
        "ranges",
        "reach",
        "rays",
        "sinr",
        "estimators",
        "flock",
        "tubes",
        "widths",
        "map",
        "links",
    ];
    for kind in kinds {
        Command::new("plot").with(&record).and(kind).and("-o").with(&figure).finish().succeeded();
        let svg = std::fs::read_to_string(&figure).unwrap();
        assert!(svg.starts_with("<svg") && svg.contains("shadow, seed 3, 30 AUVs"), "{kind}: {svg}");
        let printed = Command::new("plot").with(&record).and(kind).finish().succeeded().stdout;
        assert_eq!(printed, svg, "{kind}");
    }
    // What the figure counts is what the run counted.
    let svg = Command::new("plot").with(&record).and("losses").finish().succeeded().stdout;
    let digits: String = svg.replace(',', "");
    for (words, count) in
        [("heard", &summary["pings"]["heard"]), ("pings emitted", &summary["pings"]["emitted"])]
    {
        assert!(digits.contains(&format!("{words}: {count}<")), "{words}: {count}");
    }

    let bytes = std::fs::read(&record).unwrap();
    std::fs::write(&cut, &bytes[..bytes.len() * 2 / 3]).unwrap();
    let finished = Command::new("plot").with(&cut).and("reach").finish();
    assert_eq!(finished.status.code(), Some(3), "{finished:?}");
    assert!(finished.stdout.starts_with("<svg") && finished.stderr.contains("ends before the run does"));
}

#[test]
fn a_figure_becomes_a_picture_as_the_help_says() {
    let help = Command::new("plot --help").finish().succeeded().stdout;
    assert!(help.contains("rsvg-convert -z 2 losses.svg -o losses.png"), "{help}");
    let folder = tempfile::tempdir().unwrap();
    let [record, figure, picture] = ["run.mcap", "map.svg", "map.png"].map(|name| folder.path().join(name));
    Command::new("run swarm-3 --duration 5 --bus local --record").with(&record).json();
    Command::new("plot").with(&record).and("map --at-s 2.5 -o").with(&figure).finish().succeeded();
    let convert =
        |arguments: &[&std::path::Path]| std::process::Command::new("rsvg-convert").args(arguments).output();
    let [version, zoom, twice, out] = ["--version", "-z", "2", "-o"].map(std::path::Path::new);
    if convert(&[version]).is_err() {
        println!("skipped: there is no rsvg-convert (librsvg)");
        return;
    }
    let output = convert(&[zoom, twice, &figure, out, &picture]).unwrap();
    assert!(output.status.success(), "{output:?}");
    let bytes = std::fs::read(&picture).unwrap();
    assert!(bytes.starts_with(b"\x89PNG\r\n\x1a\n") && bytes.len() > 10_000, "{}", bytes.len());
}

/// The numbers of these attributes of an element.
fn numbers<const N: usize>(element: &str, attributes: [&str; N]) -> [f64; N] {
    attributes.map(|name| {
        let value = element.split(&format!(" {name}=\"")).nth(1).unwrap().split('"').next().unwrap();
        value.parse().unwrap()
    })
}

#[test]
fn the_truth_is_in_the_sub_paving_of_the_last_pings() {
    let folder = tempfile::tempdir().unwrap();
    let record = folder.path().join("run.mcap");
    Command::new("run swarm-300 --auvs 40 --duration 6 --bus local --record").with(&record).json();
    for (auv, at_s) in [(0, 3), (7, 2), (20, 6), (39, 4)] {
        let arguments = format!("paving --auv {auv} --at-s {at_s}");
        let svg = Command::new("plot").with(&record).and(&arguments).finish().succeeded().stdout;
        let panel = svg.split("clip-path=").nth(1).unwrap();
        let cross = panel.lines().find(|line| line.contains("href=\"#cross\"")).unwrap();
        let [x, y] = numbers(cross, ["x", "y"]);
        let is_inside = |line: &str| {
            let [left, top, width, height] = numbers(line, ["x", "y", "width", "height"]);
            (left - 0.01..=left + width + 0.01).contains(&x)
                && (top - 0.01..=top + height + 0.01).contains(&y)
        };
        // The first rectangles are those of the paving; the last one is the frame.
        let boxes = panel.split("<path").next().unwrap().lines().filter(|line| line.starts_with("<rect"));
        assert!(boxes.clone().any(is_inside), "AUV {auv} at {at_s} s: {} boxes", boxes.count());
        assert!(!svg.contains("in all rings but"), "AUV {auv} at {at_s} s");
    }
    let refused = Command::new("plot").with(&record).and("paving --auv 3 --at-s 0").finish();
    assert!(refused.status.code() == Some(1) && refused.stderr.contains("nothing to show"), "{refused:?}");
}

#[test]
fn estimators_are_drawn_beside_each_other_with_the_numbers_of_the_summary() {
    let folder = tempfile::tempdir().unwrap();
    let record = folder.path().join("run.mcap");
    let summary = Command::new("run data-incest --duration 60 --bus local --record").with(&record).json();
    let svg = Command::new("plot").with(&record).and("estimators").finish().succeeded().stdout;
    for line in summary["estimators"].as_array().unwrap() {
        let inside = 100.0 * line["contained_fraction"].as_f64().unwrap();
        let nees = line["nees_mean"].as_f64().map_or_else(String::new, |nees| format!(", NEES {nees:.1}"));
        let words = format!("{}: {inside:.2} %{nees}<", line["group"].as_str().unwrap());
        assert!(svg.contains(&words), "{words}");
    }
    assert!(svg.contains("truth inside (%)") && svg.contains("width of the box, mean (m)"));
}

#[test]
fn what_cannot_be_drawn_is_refused() {
    let refused = |arguments: &str, code: i32, words: &str| {
        let finished = Command::new(arguments).finish();
        assert_eq!(finished.status.code(), Some(code), "{finished:?}");
        assert!(finished.stderr.contains(words), "{finished:?}");
        assert_eq!(finished.stdout, "");
    };
    refused("plot nowhere.mcap losses", 1, "nowhere.mcap: ");
    refused("plot Cargo.toml losses", 1, "Cargo.toml: this is not an MCAP file");
    refused("plot nowhere.mcap lost", 2, "losses");
    refused("plot nowhere.mcap losses --auv 3", 2, "--auv is for `tubes`, `widths` and `paving`");
    refused("plot nowhere.mcap map --at-s soon", 2, "give seconds of true time");
}
