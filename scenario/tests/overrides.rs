//! What the command line may change, and what it is told when it may not.

use shoal_scenario::{Noise, OverrideError, Overrides, Scenario, load, parse};

fn scenario(name: &str) -> Scenario {
    let (source_name, text) = load(name).unwrap();
    parse(&source_name, &text).unwrap()
}

fn with_points() -> Scenario {
    let text = r#"
        name = "placed"
        duration_s = 30
        sabotage = { shifted_truth = { auv = 4, at_s = 20 } }
        environment.area_m = [[0, 100], [0, 100], [-50, 0]]
        [[group]]
        name = "placed"
        count = 2
        start.points_m = [[1, 1, -1], [9, 9, -9]]
        [[group]]
        name = "free"
        count = 8
    "#;
    parse("placed.toml", text).unwrap_or_else(|errors| panic!("{errors}"))
}

fn auvs(auvs: u32) -> Overrides {
    Overrides { auvs: Some(auvs), ..Overrides::default() }
}

#[test]
fn nothing_changes_nothing() {
    assert_eq!(Overrides::default().apply(scenario("swarm-3")).unwrap(), scenario("swarm-3"));
}

#[test]
fn everything_can_change() {
    let overrides = Overrides {
        seed: Some(9),
        auvs: Some(10),
        duration_s: Some(0.1),
        window_ms: Some(12.5),
        noise: Some("adversarial".parse().unwrap()),
    };
    let changed = overrides.apply(scenario("swarm-1000")).unwrap();
    assert_eq!((changed.seed, changed.duration_ns, changed.window_ns), (9, 100_000_000, 12_500_000));
    assert_eq!(changed.noise, Noise::Adversarial);
    assert_eq!(changed.groups.iter().map(|group| group.count).collect::<Vec<_>>(), [5, 3, 2]);
}

#[test]
fn placed_auvs_cannot_be_rescaled_unless_their_number_stays() {
    assert!(auvs(10).apply(with_points()).is_ok());
    assert!(auvs(9).apply(with_points()).is_ok());
    assert!(matches!(auvs(20).apply(with_points()), Err(OverrideError::StartPoints { count: 4, .. })));
}

#[test]
fn a_grid_has_room_for_fewer_but_not_for_more() {
    let fewer = auvs(300).apply(scenario("seismic-grid-3000")).unwrap();
    assert_eq!(fewer.auv_count(), 300);
    let more = auvs(3_100).apply(scenario("seismic-grid-3000"));
    assert!(matches!(more, Err(OverrideError::StartGrid { .. })), "{more:?}");
}

#[test]
fn refusals_name_the_flag_and_the_fix() {
    let seconds = |value| Overrides { duration_s: Some(value), ..Overrides::default() };
    let window = |value| Overrides { window_ms: Some(value), ..Overrides::default() };
    let refusals = [
        auvs(2).apply(scenario("swarm-1000")),
        auvs(65_537).apply(scenario("swarm-1000")),
        auvs(0).apply(scenario("swarm-3")),
        auvs(20).apply(with_points()),
        auvs(4).apply(with_points()),
        seconds(0.0).apply(scenario("swarm-3")),
        seconds(f64::NAN).apply(scenario("swarm-3")),
        seconds(1e-10).apply(scenario("swarm-3")),
        seconds(1e300).apply(scenario("swarm-3")),
        seconds(20.0).apply(with_points()),
        window(0.0).apply(scenario("swarm-3")),
        window(f64::INFINITY).apply(scenario("swarm-3")),
        window(91.0).apply(scenario("six-circles")),
    ];
    let shown: Vec<String> = refusals.into_iter().map(|refusal| refusal.unwrap_err().to_string()).collect();
    insta::assert_snapshot!("refusals", shown.join("\n"));
    assert!("gauss".parse::<Noise>().is_err());
}
