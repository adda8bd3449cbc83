//! The nightly suite: a hundred million checks of the promise that no enclosure ever loses the truth.
//!
//! ```text
//! cargo test --release -p shoal-tests --test nightly -- --ignored --nocapture
//! ```
//!
//! Swarms of 2 to 1,000 AUVs, at both levels, in both moods, with every clock that has a name, three seeds each. `SHOAL_NIGHTLY_CHECKS`
//! sets another number of checks: all runs are shortened or lengthened by the same factor.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use shoal_scenario::model::Noise;
use shoal_scenario::parse;
use shoal_scenario::presets::CLOCKS;
use shoal_tests::{Swarm, run_local};

/// AUVs, and simulated seconds that make a hundred million checks of all.
const SIZES: [(u32, f64); 5] = [(2, 60.0), (12, 60.0), (50, 40.0), (300, 18.0), (1_000, 8.0)];
const SEEDS: u64 = 3;
const CHECKS: f64 = 1e8;

/// The whole matrix, the longest runs first.
fn swarms(factor: f64) -> Vec<Swarm> {
    let mut swarms = Vec::new();
    for (count, duration_s) in SIZES.into_iter().rev() {
        for seed in 1..=SEEDS {
            for (clock, _) in CLOCKS {
                for noise in [Noise::Uniform, Noise::Adversarial] {
                    for at_sea in [true, false] {
                        let duration_s = (duration_s * factor).max(0.5);
                        swarms.push(Swarm { at_sea, noise, clock, count, duration_s, seed });
                    }
                }
            }
        }
    }
    swarms
}

#[test]
#[ignore = "takes six and a half minutes on two cores"]
fn a_hundred_million_checks_find_no_enclosure_without_the_truth() {
    let asked = std::env::var("SHOAL_NIGHTLY_CHECKS").ok().and_then(|checks| checks.parse().ok());
    let asked: f64 = asked.unwrap_or(CHECKS);
    let swarms = swarms(asked / CHECKS);
    let (next, checks) = (AtomicUsize::new(0), Mutex::new([0_u64; 4]));
    let begun = std::time::Instant::now();
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                while let Some(swarm) = swarms.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let text = swarm.text();
                    let scenario = parse("nightly.toml", &text)
                        .unwrap_or_else(|errors| panic!("{}\n{text}", errors.render(false)));
                    let summary = run_local(&scenario, None);
                    let containment = &summary.containment;
                    assert_eq!(containment.violations, 0, "{swarm:?}: {:?}", containment.first);
                    let mut sums = checks.lock().unwrap();
                    for (sum, count) in sums.iter_mut().zip([
                        containment.checks,
                        summary.pings.heard,
                        summary.pings.outliers,
                        containment.misled.violations,
                    ]) {
                        *sum += count;
                    }
                }
            });
        }
    });
    let [checks, heard, outliers, misled] = checks.into_inner().unwrap();
    println!(
        "{} runs, {checks} checks, no violation; {heard} pings heard, {outliers} outliers, and {misled} enclosures apart of AUVs \
         that heard more outliers than they tolerate; {:.0} s",
        swarms.len(),
        begun.elapsed().as_secs_f64()
    );
    assert!(checks as f64 >= 0.95 * asked, "{checks} checks are fewer than {asked}");
}
