//! The estimators beside each other: who holds the truth, who only believes it, and that only promises are checked.

use shoal_bus::summary::{EstimatorLine, Summary};
use shoal_scenario::model::{EkfSettings, Estimator, Fusion, Scenario};
use shoal_tests::{library_scenario, run_local};

const SEEDS: std::ops::RangeInclusive<u64> = 1..=8;

fn ekf(fusion: Fusion) -> Estimator {
    Estimator::Ekf(EkfSettings { gate_sigma: 3.0, fusion })
}

fn tube() -> Estimator {
    library_scenario("swarm-3").groups[0].estimator.clone()
}

fn flown(mut scenario: Scenario, seed: u64, estimator: &Estimator) -> Summary {
    scenario.seed = seed;
    scenario.groups.iter_mut().for_each(|group| group.estimator = estimator.clone());
    run_local(&scenario, None)
}

/// One line for each seed.
fn incest(estimator: &Estimator) -> Vec<(Summary, EstimatorLine)> {
    let line = |summary: Summary| (summary.clone(), summary.estimators[0].clone());
    SEEDS.map(|seed| line(flown(library_scenario("data-incest"), seed, estimator))).collect()
}

/// The mean over seeds: within one run all AUVs share their errors, so one run is little more than one draw.
fn mean_nees(lines: &[(Summary, EstimatorLine)]) -> f64 {
    lines.iter().filter_map(|(_, line)| line.nees_mean).sum::<f64>() / lines.len() as f64
}

#[test]
fn a_rumour_that_comes_round_again_convinces_the_naive_only() {
    let naive = incest(&ekf(Fusion::Independent));
    let careful = incest(&ekf(Fusion::CovarianceIntersection));
    // Four dimensions: 4 for an honest Gaussian.
    assert!(mean_nees(&naive) > 100.0, "{}", mean_nees(&naive));
    assert!(mean_nees(&careful) < 6.0, "{}", mean_nees(&careful));
    for (summary, line) in naive.iter().chain(&careful) {
        assert_eq!((summary.containment.checks, summary.containment.violations), (0, 0));
        assert_eq!((line.estimator.as_str(), line.auvs), ("ekf", 6));
    }
    assert!(naive.iter().all(|(_, line)| line.contained_fraction < 0.5));
    assert!(careful.iter().all(|(_, line)| line.contained_fraction > 0.95));
    for estimator in [tube(), Estimator::DeadReckoning] {
        for (summary, line) in incest(&estimator) {
            assert_eq!((line.contained_fraction, line.nees_mean), (1.0, None));
            assert!(summary.containment.checks > 0 && summary.containment.violations == 0);
        }
    }
}

#[test]
fn promises_are_kept_among_those_who_promise_nothing() {
    let mut scenario = library_scenario("data-incest");
    let mut believers = scenario.groups[0].clone();
    believers.name = "believers".to_owned();
    scenario.groups[0].estimator = tube();
    scenario.groups.push(believers);
    let summary = run_local(&scenario, None);
    assert_eq!((summary.containment.violations, summary.containment.misled.auvs), (0, 0));
    assert_eq!(summary.estimators[0].contained_fraction, 1.0);
    assert_eq!(summary.estimators[1].group, "believers");
    // Two checks a report and one a ping, of the tubes alone.
    let (reports, pings) = (summary.estimators[0].reports, summary.pings.emitted / 2);
    assert!(summary.containment.checks.abs_diff(2 * reports + pings) <= 12, "{:?}", summary.containment);
}

#[test]
fn windows_change_no_figure_of_an_estimator() {
    let mut scenario = library_scenario("data-incest");
    scenario.duration_ns = 60_000_000_000;
    let [short, long] = [7_000_000, 190_000_000].map(|window_ns| run_local(&scenario, Some(window_ns)));
    assert_eq!((short.digest, short.estimators), (long.digest, long.estimators));
}
