//! The estimators beside each other: who holds the truth, who only believes it, and that only promises are checked.

use shoal_bus::summary::{EstimatorLine, Summary};
use shoal_tests::{library_scenario, run_local};

const SEEDS: std::ops::RangeInclusive<u64> = 1..=8;

fn incest() -> Vec<Summary> {
    let flown = |seed| {
        let mut scenario = library_scenario("data-incest");
        scenario.seed = seed;
        run_local(&scenario, None)
    };
    SEEDS.map(flown).collect()
}

/// The line of one group in each run.
fn lines<'a>(summaries: &'a [Summary], group: &str) -> Vec<&'a EstimatorLine> {
    let lines: Vec<_> =
        summaries.iter().flat_map(|summary| &summary.estimators).filter(|line| line.group == group).collect();
    assert_eq!(lines.len(), summaries.len());
    lines
}

/// The mean over seeds: within one run all AUVs share their errors, so one run is little more than one draw.
fn mean_nees(lines: &[&EstimatorLine]) -> f64 {
    lines.iter().filter_map(|line| line.nees_mean).sum::<f64>() / lines.len() as f64
}

#[test]
fn a_rumour_that_comes_round_again_convinces_the_naive_only() {
    let summaries = incest();
    let [naive, careful] = ["naive", "careful"].map(|group| lines(&summaries, group));
    // Four dimensions: 4 for an honest Gaussian.
    assert!(mean_nees(&naive) > 100.0, "{}", mean_nees(&naive));
    assert!(mean_nees(&careful) < 6.0, "{}", mean_nees(&careful));
    assert!(naive.iter().chain(&careful).all(|line| (line.estimator.as_str(), line.auvs) == ("ekf", 6)));
    assert!(naive.iter().all(|line| line.contained_fraction < 0.5));
    assert!(careful.iter().all(|line| line.contained_fraction > 0.95));
    for group in ["tube", "dead-reckoning"] {
        for line in lines(&summaries, group) {
            assert_eq!((line.estimator.as_str(), line.auvs), (group, 6));
            assert_eq!((line.contained_fraction, line.nees_mean), (1.0, None));
        }
    }
    // Promises are kept among those who promise nothing: two checks a report, and one a ping, of half of the groups.
    for summary in &summaries {
        assert_eq!((summary.containment.violations, summary.containment.misled.auvs), (0, 0));
        let reports: u64 = summary.estimators[2..].iter().map(|line| line.reports).sum();
        let expected = 2 * reports + summary.pings.emitted / 2;
        assert!(summary.containment.checks.abs_diff(expected) <= 24, "{:?}", summary.containment);
    }
}

#[test]
fn windows_change_no_figure_of_an_estimator() {
    let mut scenario = library_scenario("data-incest");
    scenario.duration_ns = 60_000_000_000;
    let [short, long] = [7_000_000, 190_000_000].map(|window_ns| run_local(&scenario, Some(window_ns)));
    assert_eq!((short.digest, short.estimators), (long.digest, long.estimators));
}
