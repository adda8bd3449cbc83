//! Tests of the sweep: what it goes over, what its table says.

use super::axes::check;
use super::figures::FIGURES;
use super::*;
use crate::cli::Changes;

fn axes(texts: &[&str]) -> Vec<Axis> {
    texts.iter().map(|text| Axis::parse(text).unwrap()).collect()
}

/// Rows as `sweep` makes them.
fn rows(scenario_name: &str, seeds: &[u64], axes: &[Axis], duration_s: f64) -> Vec<Row> {
    let (source_name, text) = load(scenario_name).unwrap();
    let changes = Changes { duration_s: Some(duration_s), ..Changes::default() };
    let run = |settings: &[Setting], seed: u64| {
        let (name, text) = with_settings(&source_name, &text, settings)?;
        let scenario = scenario(&name, &text, Some(seed), &changes)?;
        carry_out(&scenario, &AtomicBool::new(false)).map(Option::unwrap)
    };
    let row = |settings: Vec<Setting>| {
        let outcome = seeds.iter().map(|seed| run(&settings, *seed)).collect::<Result<Vec<_>, Failure>>();
        let outcome = match outcome {
            Ok(summaries) => Outcome::Ran(summaries),
            Err(failure) => {
                let reason = failure.message.lines().next().unwrap().replace("error: ", "");
                Outcome::Stopped(failure.exit, reason)
            }
        };
        Row { settings, outcome }
    };
    combinations(axes).into_iter().map(row).collect()
}

#[test]
fn a_table_says_what_came_of_each_combination() {
    let axes = axes(&["group.modem.range_m=600,1500,-1"]);
    let rows = rows("swarm-3", &[1, 2, 3], &axes, 8.0);
    let keys: Vec<&str> = axes.iter().map(Axis::key).collect();
    insta::assert_snapshot!("table", table::text("swarm-3", 3, &keys, &rows));
    insta::assert_snapshot!("csv", table::csv(&keys, &rows));
    assert_eq!(exit(&rows, false), Exit::Loss);
    assert_eq!(exit(&rows[..2], false), Exit::Good);
    assert_eq!(exit(&rows[..2], true), Exit::Loss);
    assert_eq!(exit(&rows[2..], false), Exit::Usage);
}

#[test]
fn mean_spread_and_worst_are_over_the_seeds() {
    let rows = rows("swarm-3", &[4, 5], &[], 2.0);
    let Outcome::Ran(mut summaries) = rows.into_iter().next().unwrap().outcome else { panic!() };
    summaries[0].pings.lost.collision = 2;
    summaries[1].pings.lost.collision = 5;
    let of = |name| FIGURES.iter().find(|figure| figure.name == name).unwrap();
    let collisions = Figures::over(of("lost_collision"), &summaries).unwrap();
    assert_eq!((collisions.mean, collisions.worst), (3.5, 5.0));
    assert!((collisions.spread.unwrap() - 4.5_f64.sqrt()).abs() < 1e-15);
    summaries[0].pings = Default::default();
    summaries[1].pings.heard = 9;
    summaries[1].pings.lost =
        shoal_bus::summary::Lost { range: 70, noise: 1, late: 5, collision: 0, ..Default::default() };
    let ratio = Figures::over(of("delivery_ratio"), &summaries).unwrap();
    assert_eq!((ratio.mean, ratio.spread, ratio.worst), (0.9, None, 0.9));
    assert_eq!(Figures::over(of("delivery_ratio"), &summaries[..1]), None);
}

#[test]
fn every_combination_comes_once() {
    let shown: Vec<String> =
        combinations(&axes(&["a=1,2", "b=x,y,z"])).iter().map(|settings| describe(settings)).collect();
    assert_eq!(shown, ["a=1 b=x", "a=1 b=y", "a=1 b=z", "a=2 b=x", "a=2 b=y", "a=2 b=z"]);
    assert_eq!(combinations(&[]).len(), 1);
}

#[test]
fn seeds_are_ranges_with_both_ends_or_lists() {
    assert_eq!(Seeds::parse("1..5").unwrap().0, [1, 2, 3, 4, 5]);
    assert_eq!(Seeds::parse("7, 2..3").unwrap().0, [7, 2, 3]);
    for wrong in ["", "5..1", "-1", "1..", "a", "1,1", "0..18446744073709551615"] {
        assert!(Seeds::parse(wrong).is_err(), "{wrong}");
    }
}

#[test]
fn saying_it_twice_is_refused() {
    assert!(check(&axes(&["a=1", "b=2"]), true).is_ok());
    let twice = check(&axes(&["a=1", "a=2"]), false).unwrap_err();
    assert!(twice.message.contains("--set a is given twice"), "{}", twice.message);
    assert_eq!(check(&axes(&["seed=1"]), true).unwrap_err().exit, Exit::Usage);
}
