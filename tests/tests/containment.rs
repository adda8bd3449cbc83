//! No enclosure ever loses the truth, and windows never change a run: over the library and over scenarios drawn at random.

use shoal_bus::summary::{Lost, Summary};
use shoal_scenario::model::{Estimator, Noise, Scenario};
use shoal_scenario::{library, parse};
use shoal_tests::{Dice, library_scenario, random_scenario, random_sea_scenario, run_local};

/// Carries out `count` cases on all cores.
fn side_by_side(count: u64, case: impl Fn(u64) + Sync) {
    let next = std::sync::atomic::AtomicU64::new(0);
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..cores {
            scope.spawn(|| {
                loop {
                    let number = next.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
                    if number >= count {
                        return;
                    }
                    case(number);
                }
            });
        }
    });
}

fn random(number: u64, duration_s: f64) -> (Scenario, String) {
    valid(random_scenario(number, duration_s))
}

fn random_sea(number: u64, duration_s: f64) -> (Scenario, String) {
    valid(random_sea_scenario(number, duration_s))
}

fn valid(text: String) -> (Scenario, String) {
    let scenario =
        parse("random.toml", &text).unwrap_or_else(|errors| panic!("{}\n{text}", errors.render(false)));
    (scenario, text)
}

/// How many random scenarios: a hunt for violations sets the variable `SHOAL_RANDOM_SCENARIOS`.
fn scenarios(default: u64) -> u64 {
    std::env::var("SHOAL_RANDOM_SCENARIOS").ok().and_then(|count| count.parse().ok()).unwrap_or(default)
}

/// The number of the first random scenario, so that a hunt can go on where another ended: `SHOAL_RANDOM_FIRST`.
fn first() -> u64 {
    std::env::var("SHOAL_RANDOM_FIRST").ok().and_then(|first| first.parse().ok()).unwrap_or(0)
}

/// Every emitted ping meets one fate at every other AUV.
fn pings_add_up(summary: &Summary) -> bool {
    let pings = &summary.pings;
    let lost = &pings.lost;
    let heard_or_not = [
        pings.heard,
        lost.range,
        lost.noise,
        lost.collision,
        lost.half_duplex,
        lost.shadow,
        lost.asleep,
        lost.band,
        lost.dead,
    ];
    let fates: u64 = heard_or_not.iter().sum();
    pings.emitted * u64::from(summary.auvs - 1) == fates + pings.in_flight
}

#[test]
fn the_library_keeps_the_truth_in_both_moods() {
    let mut cases = Vec::new();
    for entry in library() {
        for noise in [Noise::Uniform, Noise::Adversarial] {
            let seeds = if library_scenario(entry.name).auv_count() < 3_000 { 3 } else { 1 };
            cases.extend((1..=seeds).map(|seed| (entry.name, noise, seed)));
        }
    }
    side_by_side(cases.len() as u64, |index| {
        let (name, noise, seed) = cases[index as usize];
        let mut scenario = library_scenario(name);
        let seconds = match scenario.auv_count() {
            300.. => 2,
            _ => 130,
        };
        scenario.duration_ns = scenario.duration_ns.min(seconds * 1_000_000_000);
        scenario.noise = noise;
        scenario.seed = seed;
        let summary = run_local(&scenario, None);
        assert_eq!(
            summary.containment.violations, 0,
            "{name} {noise:?} {seed}: {:?}",
            summary.containment.first
        );
        // Kalman filters promise nothing that could be checked.
        let promises = !scenario.groups.iter().any(|group| matches!(group.estimator, Estimator::Ekf(_)));
        assert!(!promises || summary.containment.checks >= 2 * summary.wakes, "{name}");
        assert!(pings_add_up(&summary), "{name}: {:?}", summary.pings);
    });
}

#[test]
fn random_scenarios_keep_the_truth() {
    let told = std::sync::Mutex::new([0_u64; 4]);
    let count = scenarios(400);
    side_by_side(count, |number| {
        let (scenario, text) = random(first() + number, 20.0);
        let summary = run_local(&scenario, None);
        let containment = &summary.containment;
        assert_eq!(containment.violations, 0, "{:#?}\n{text}", containment.first);
        assert!(pings_add_up(&summary), "{:?}\n{text}", summary.pings);
        let mut told = told.lock().unwrap();
        told[0] += containment.checks;
        told[1] += summary.pings.heard;
        told[2] += u64::from(summary.auvs);
        told[3] += u64::from(summary.position_width_m.end_median < summary.position_width_m.start_median);
    });
    let [checks, heard, auvs, contracted] = told.into_inner().unwrap();
    println!(
        "{checks} checks, {heard} pings heard, {auvs} AUVs, {contracted} swarms surer at the end than at the start"
    );
    assert!(
        checks > 250 * count && heard > 25 * count && 25 * contracted > count,
        "the scenarios are too dull to prove anything"
    );
}

#[test]
fn random_seas_keep_the_truth() {
    let told = std::sync::Mutex::new(([0_u64; 4], Lost::default()));
    side_by_side(scenarios(200), |number| {
        let (scenario, text) = random_sea(first() + number, 20.0);
        let summary = run_local(&scenario, None);
        let containment = &summary.containment;
        assert_eq!(containment.violations, 0, "{:#?}\n{text}", containment.first);
        assert!(summary.agents.lost.is_empty(), "{:?}\n{text}", summary.agents.lost);
        let pings = &summary.pings;
        assert!(pings_add_up(&summary), "{pings:?}\n{text}");
        // Only what came the long way round misleads, and whoever was carried elsewhere.
        let is_deceived = pings.outliers > 0 || containment.kidnapped.is_some();
        assert!(containment.misled.violations == 0 || is_deceived, "{containment:?}\n{text}");
        let (counts, lost) = &mut *told.lock().unwrap();
        counts[0] += containment.checks;
        counts[1] += pings.heard;
        counts[2] += pings.outliers;
        counts[3] += u64::from(containment.misled.violations > 0);
        add(lost, &pings.lost);
    });
    let ([checks, heard, outliers, misled], lost) = told.into_inner().unwrap();
    println!(
        "{checks} checks, {heard} pings heard, {outliers} outliers, somebody misled {misled} times, {lost:?}"
    );
    let reasons = [
        lost.range,
        lost.noise,
        lost.collision,
        lost.half_duplex,
        lost.shadow,
        lost.asleep,
        lost.band,
        lost.busy,
    ];
    let least = reasons.into_iter().chain([outliers, misled]).min();
    assert!(checks > 50_000 && heard > 2_000 && least > Some(0), "the seas are too dull to prove anything");
}

/// Adds up losses over scenarios.
fn add(sum: &mut Lost, lost: &Lost) {
    sum.range += lost.range;
    sum.noise += lost.noise;
    sum.collision += lost.collision;
    sum.half_duplex += lost.half_duplex;
    sum.shadow += lost.shadow;
    sum.asleep += lost.asleep;
    sum.band += lost.band;
    sum.busy += lost.busy;
    sum.unsent += lost.unsent;
    sum.late += lost.late;
    sum.dead += lost.dead;
}

#[test]
fn windows_never_change_a_random_scenario() {
    side_by_side(scenarios(60), |number| windows_never_change(number, random(1_000_000 + number, 6.0)));
}

#[test]
fn windows_never_change_a_random_sea() {
    side_by_side(scenarios(60), |number| windows_never_change(number, random_sea(1_000_000 + number, 6.0)));
}

/// Sound that is on its way meets whoever is carried into it at that moment, before its own motion would have let it: whatever the windows.
#[test]
fn windows_never_change_a_kidnapping() {
    let mut scenario = library_scenario("kidnapped");
    scenario.duration_ns = 24_000_000_000;
    // So slow that rings of sound lie all around, and a beacon in one out of three of them.
    scenario.environment.sound_speed_m_s = 60.0;
    let reference = run_local(&scenario, None);
    assert!(reference.pings.lost.asleep > 0, "{:?}", reference.pings);
    for window_ns in [3_456_789, 7_654_321, 10_000_000, 50_000_000] {
        assert!(run_local(&scenario, Some(window_ns)) == reference, "{window_ns} ns");
    }
}

/// Carries a scenario out in its own windows, the longest, odd, round and drawn ones.
fn windows_never_change(number: u64, (scenario, text): (Scenario, String)) {
    let limits = scenario
        .groups
        .iter()
        .map(|group| shoal_scenario::window_limit_ns(group.reaction_ns, group.clock.drift_bound));
    let longest_ns = limits.min().unwrap();
    let drawn_ns = Dice::new(number).whole(3_000_000, longest_ns as u64) as i64;
    let reference = run_local(&scenario, None);
    for window_ns in [longest_ns, 7_654_321, 10_000_000, 25_000_000, 50_000_000, 90_000_000, drawn_ns] {
        if window_ns > longest_ns {
            continue;
        }
        let other = run_local(&scenario, Some(window_ns));
        assert!(other == reference, "{window_ns} ns: {other:#?}\n{reference:#?}\n{text}");
    }
}
