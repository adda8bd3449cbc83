//! Tests of the sweep: what it goes over, what its table says.

use super::axes::check;
use super::figures::FIGURES;
use super::*;
use crate::cli::Changes;

fn axes(texts: &[&str]) -> Vec<Axis> {
    texts.iter().map(|text| Axis::parse(text).unwrap()).collect()
}

/// Rows as `sweep` makes them, on so many threads.
fn swept(scenario_name: &str, seeds: &[u64], axes: &[Axis], duration_s: f64, jobs: usize) -> Vec<Row> {
    let (source_name, text) = load(scenario_name).unwrap();
    let changes = Changes { duration_s: Some(duration_s), ..Changes::default() };
    let combinations = read(&source_name, &text, axes, &changes);
    let seeds = Some(Seeds(seeds.to_vec()));
    let tasks = tasks(&combinations, seeds.as_ref());
    let mut outcomes: Vec<Option<RunOutcome>> = tasks.iter().map(|_| None).collect();
    let run = |task: &Task<'_>| attempt(&task.scenario, &|of| carry_out(of, &AtomicBool::new(false)));
    side_by_side(&tasks, jobs, run, |index, outcome| {
        outcomes[index] = outcome;
        Ok(())
    })
    .unwrap();
    drop(tasks);
    rows(combinations, &seeds, outcomes)
}

#[test]
fn a_table_says_what_came_of_each_combination() {
    let axes = axes(&["group.modem.range_m=600,1500,-1"]);
    let mut rows = swept("swarm-3", &[1, 2, 3], &axes, 8.0, 2);
    let keys: Vec<&str> = axes.iter().map(Axis::key).collect();
    insta::assert_snapshot!("table", table::text("swarm-3", &keys, &rows));
    insta::assert_snapshot!("csv", table::csv(&keys, &rows));
    assert_eq!(exit(&rows, false), Exit::Loss);
    assert_eq!(exit(&rows[..2], false), Exit::Good);
    assert_eq!(exit(&rows[..2], true), Exit::Loss);
    assert_eq!(exit(&rows[2..], false), Exit::Usage);
    // Any number of threads.
    let alone = swept("swarm-3", &[1, 2, 3], &axes, 8.0, 1);
    assert_eq!(table::csv(&keys, &alone), table::csv(&keys, &rows));

    // One run that fails is a line with its reason beside those that do not.
    let Outcome::Ran(runs) = &mut rows[0].outcome else { panic!() };
    runs[1].1 = RunOutcome::Failed("it rains".to_owned());
    let told = table::text("swarm-3", &keys, &rows[..2]);
    assert!(told.ends_with("\ngroup.modem.range_m=600 seed 2: failed: it rains\n"), "{told}");
    let csv = table::csv(&keys, &rows[..2]);
    let lines: Vec<&str> = csv.lines().collect();
    let cells = |line: usize| lines[line].matches(',').count();
    assert_eq!((lines.len(), cells(0), cells(1)), (4, cells(2), cells(2)));
    assert!(lines[1].starts_with("600,,2,1,23,"), "{}", lines[1]);
    assert!(lines[2].starts_with("600,2,,") && lines[2].ends_with(",failed: it rains"), "{}", lines[2]);
    assert_eq!(exit(&rows[..2], false), Exit::Failed);
}

#[test]
fn a_run_that_panics_is_one_that_failed() {
    let (source_name, text) = load("swarm-3").unwrap();
    let scenario = scenario(&source_name, &text, None, &Changes::default()).unwrap();
    let outcome =
        attempt(&scenario, &|scenario| panic!("seed {} is unlucky\nand more", scenario.seed)).unwrap();
    assert_eq!(outcome.trouble().unwrap(), "failed: a bug in shoal, it panicked: seed 1 is unlucky");
    assert_eq!(attempt(&scenario, &|_| Ok(None)), None);
}

#[test]
fn a_crew_stops_when_its_results_are_not_taken() {
    let tasks: Vec<u32> = (0..10_000).collect();
    let mut sum = 0;
    side_by_side(
        &tasks,
        3,
        |task| *task,
        |index, task| {
            assert_eq!(index, task as usize);
            sum += task;
            Ok(())
        },
    )
    .unwrap();
    assert_eq!(sum, 9_999 * 5_000);
    let begun = std::sync::atomic::AtomicUsize::new(0);
    let slow = |_: &u32| {
        begun.fetch_add(1, Ordering::Relaxed);
        std::thread::sleep(std::time::Duration::from_millis(1));
    };
    let refused = side_by_side(&tasks, 2, slow, |_, ()| Err(Failure::failed("the disk is full")));
    assert!(refused.is_err() && begun.into_inner() < 1_000);
    side_by_side(&[0_u32; 0], 2, |_| (), |_, ()| panic!("nothing to do")).unwrap();
}

#[test]
fn mean_spread_best_and_worst_are_over_the_seeds() {
    let rows = swept("swarm-3", &[4, 5], &[], 2.0, 1);
    let Outcome::Ran(runs) = &rows[0].outcome else { panic!() };
    let mut summaries: Vec<Summary> = runs.iter().map(|(_, run)| run.summary().unwrap().clone()).collect();
    summaries[0].pings.lost.collision = 2;
    summaries[1].pings.lost.collision = 5;
    let of = |name| FIGURES.iter().find(|figure| figure.name == name).unwrap();
    let collisions = Figures::over(of("lost_collision"), summaries.iter()).unwrap();
    assert_eq!((collisions.mean, collisions.best, collisions.worst), (3.5, 2.0, 5.0));
    assert!((collisions.spread.unwrap() - 4.5_f64.sqrt()).abs() < 1e-15);
    summaries[0].pings = Default::default();
    summaries[1].pings.heard = 9;
    summaries[1].pings.lost =
        shoal_bus::summary::Lost { range: 70, noise: 1, late: 5, collision: 0, ..Default::default() };
    let ratio = Figures::over(of("delivery_ratio"), summaries.iter()).unwrap();
    assert_eq!((ratio.mean, ratio.spread, ratio.best, ratio.worst), (0.9, None, 0.9, 0.9));
    assert_eq!(Figures::over(of("delivery_ratio"), summaries[..1].iter()), None);
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
