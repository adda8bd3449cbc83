//! Reports of real runs.

use std::path::Path;

use shoal_tests::{Command, scenario_file};

fn report(records: &[&Path]) -> shoal_tests::Finished {
    records.iter().fold(Command::new("report"), |command, record| command.with(record)).finish()
}

/// What links to nothing outside.
fn assert_self_contained(html: &str) {
    for outside in ["<script", "<link", "<img", "@import", "src=", "url(http"] {
        assert!(!html.contains(outside), "{outside}");
    }
    assert_eq!(html.matches("http").count(), html.matches("http://www.w3.org/2000/svg").count());
}

#[test]
fn a_page_says_what_a_run_amounts_to() {
    let folder = tempfile::tempdir().unwrap();
    let [record, page] = ["run.mcap", "run.html"].map(|name| folder.path().join(name));
    let summary = Command::new("run swarm-300 --duration 3 --bus local --record").with(&record).json();
    let html = report(&[&record]).succeeded().stdout;
    Command::new("report").with(&record).and("-o").with(&page).finish().succeeded();
    assert_eq!(std::fs::read_to_string(&page).unwrap(), html);
    assert_self_contained(&html);
    assert!(html.len() < 2_000_000, "{}", html.len());
    let digits = html.replace(',', "");
    let checks = &summary["containment"]["checks"];
    assert!(digits.contains(&format!("No enclosure lost the truth in {checks} checks.")), "{digits}");
    assert!(html.contains(summary["digest"].as_str().unwrap()));
    // What the record shows again: no comparison failed, and each report was compared.
    assert!(html.contains("the truth was inside in all"));
    let wakes = &summary["wakes"];
    assert!(
        digits.contains(&format!("position at a tick east</td><td class=\"number\">{wakes}</td>")),
        "{digits}"
    );
    assert!(
        digits.contains(&format!("<td>heard</td><td class=\"number\">{}</td>", summary["pings"]["heard"]))
    );
    for part in ["Where the AUVs are", "How well the AUVs know", "Who hears whom", "duration_s = "] {
        assert!(html.contains(part), "{part}");
    }
}

#[test]
fn a_page_of_two_runs_says_what_differs() {
    let folder = tempfile::tempdir().unwrap();
    let [first, second] = ["first.mcap", "second.mcap"].map(|name| folder.path().join(name));
    let run = |more: &str, record: &Path| {
        Command::new(&format!("run swarm-3 --duration 5 --bus local {more} --record")).with(record).json()
    };
    let a = run("", &first);
    let b = run("--seed 9 --set group.modem.range_m=123", &second);
    let html = report(&[&first, &second]).succeeded().stdout;
    assert_self_contained(&html);
    assert!(html.contains("<td>seed</td>") && html.contains("modem.range_m</td>"), "{html}");
    assert!(html.contains("<td class=\"number\">123</td>") || html.contains("<td>123</td>"), "{html}");
    for summary in [&a, &b] {
        assert!(html.contains(summary["digest"].as_str().unwrap()));
    }
    let same = report(&[&first, &first]).succeeded().stdout;
    assert!(
        same.contains("scenario and seed are the same") && same.contains("all that happened is the same")
    );
}

#[test]
fn markdown_has_the_same_words_and_its_figures_beside_it() {
    let folder = tempfile::tempdir().unwrap();
    let [record, page] = ["run.mcap", "run.md"].map(|name| folder.path().join(name));
    let summary = Command::new("run two-circles --bus local --record").with(&record).json();
    Command::new("report").with(&record).and("--markdown --auv 1 -o").with(&page).finish().succeeded();
    let text = std::fs::read_to_string(&page).unwrap();
    assert!(text.contains(&format!("| digest | {} |", summary["digest"].as_str().unwrap())), "{text}");
    let figures: Vec<&str> =
        text.split("](run-figures/").skip(1).map(|rest| rest.split(')').next().unwrap()).collect();
    assert!(figures.contains(&"tubes.svg") && figures.contains(&"widths.svg"), "{figures:?}");
    for figure in figures {
        let svg = std::fs::read_to_string(folder.path().join("run-figures").join(figure)).unwrap();
        assert!(svg.starts_with("<svg") && svg.contains("two-circles, seed"), "{figure}");
    }
    let printed = Command::new("report").with(&record).and("--markdown --auv 1").finish().succeeded().stdout;
    assert!(!printed.contains("!["));
}

#[test]
fn a_broken_promise_and_a_cut_record_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let [broken, cut] = ["broken.mcap", "cut.mcap"].map(|name| folder.path().join(name));
    let run =
        Command::new("run").with(scenario_file("shifted-truth")).and("--bus local --record").with(&broken);
    assert_eq!(run.finish().status.code(), Some(4));
    let html = report(&[&broken]).succeeded().stdout;
    assert!(html.contains("verdict bad") && html.contains("lost the truth in"), "{html}");
    assert!(html.contains("the truth was outside in"), "{html}");

    let bytes = std::fs::read(&broken).unwrap();
    std::fs::write(&cut, &bytes[..bytes.len() * 2 / 3]).unwrap();
    let finished = report(&[&cut]);
    assert_eq!(finished.status.code(), Some(3), "{}", finished.stderr);
    assert!(finished.stdout.contains("ends before the run does"));
    let refused = Command::new("report").with(&broken).and("--auv 99").finish();
    assert!(refused.status.code() == Some(2) && refused.stderr.contains("there is no AUV 99"), "{refused:?}");
}
