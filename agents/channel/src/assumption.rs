//! What it is worth to assume that at most q of any m pings in a row are wrong.
//!
//! When each ping is right with probability pi, independently of the others, a window of m holds at least m - q right ones with probability
//! `alpha^m`, and the robust set observer's set holds the truth after k pings with at least `alpha^k` (seed 004, section 3):
//!
//! ```text
//! alpha = (sum of C(m, i) pi^i (1 - pi)^(m - i) over i = m-q .. m)^(1/m)
//! ```
//!
//! Beside either bound stands what was measured: how many windows really kept to the assumption, and how many reports held the truth.

use pxfm::f_pow;
use shoal_bus::summary::Assumption;
use shoal_scenario::model::{Estimator, Scenario};

use crate::accuracy::{Accuracy, contained_fraction};

/// What the assumptions of all groups are worth that say how likely a ping is right; by AUV, `heard` has the pings that it heard,
/// `windows` those that ended with one, and of these those that kept to the assumption, and `accuracy` what became of its reports.
pub fn assumptions(
    scenario: &Scenario,
    heard: &[u64],
    windows: &[(u64, u64)],
    accuracy: &[Accuracy],
) -> Vec<Assumption> {
    let mut first = 0;
    let mut worth = Vec::new();
    for group in &scenario.groups {
        let auvs = first..first + group.count as usize;
        first = auvs.end;
        let Estimator::Tube(settings) = group.estimator else { continue };
        let Some(assumed) = settings.outliers else { continue };
        let Some(inlier_probability) = assumed.inlier_probability else { continue };
        let own = windows.get(auvs.clone()).unwrap_or_default();
        let (told, kept) = own.iter().fold((0, 0), |sum, of| (sum.0 + of.0, sum.1 + of.1));
        let contained_fraction = contained_fraction(accuracy.get(auvs.clone()).unwrap_or_default());
        let pings = heard.get(auvs).into_iter().flatten().copied().max().unwrap_or(0);
        let window_holds = window_holds(assumed.window, assumed.tolerated, inlier_probability);
        worth.push(Assumption {
            group: group.name.clone(),
            window: assumed.window,
            tolerated: assumed.tolerated,
            inlier_probability,
            window_holds,
            pings,
            holds: holds_after(assumed.window, window_holds, pings),
            windows_kept_fraction: if told == 0 { 1.0 } else { kept as f64 / told as f64 },
            contained_fraction,
        });
    }
    worth
}

/// The probability that at most `tolerated` of `window` pings are wrong: `alpha^m`.
pub fn window_holds(window: u16, tolerated: u16, inlier_probability: f64) -> f64 {
    let (right, wrong) = (inlier_probability, 1.0 - inlier_probability);
    // The chances of 0, 1, 2 ... wrong ones, ping by ping: sums of products, in which nothing overflows.
    let most = usize::from(tolerated.min(window));
    let mut chances = vec![0.0; most + 1];
    chances[0] = 1.0;
    for _ in 0..window {
        for count in (0..=most).rev() {
            let one_more = if count > 0 { chances[count - 1] * wrong } else { 0.0 };
            chances[count] = chances[count] * right + one_more;
        }
    }
    chances.iter().sum::<f64>().min(1.0)
}

/// The probability that the set holds the truth after `pings` pings, at least: `alpha^k`.
pub fn holds_after(window: u16, window_holds: f64, pings: u64) -> f64 {
    f_pow(window_holds, pings as f64 / f64::from(window.max(1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_near(value: f64, expected: f64, within: f64) {
        assert!((value - expected).abs() <= within, "{value} is not {expected}");
    }

    #[test]
    fn the_binomial_sum() {
        // Summed with exact binomials: m = 50, q = 10 as in the comparison of seed 004, section 6.
        assert_near(window_holds(50, 10, 0.9), 0.990_645_398_412_671, 1e-14);
        assert_near(window_holds(50, 10, 0.95), 0.999_970_353_950_468, 1e-14);
        assert_near(window_holds(50, 10, 0.8), 0.583_559_418_466_066, 1e-14);
        assert_near(window_holds(12, 4, 0.9), 0.995_670_656_730_000, 1e-14);
        assert_near(window_holds(12, 12, 0.3), 1.0, 1e-15);
        assert_eq!((window_holds(12, 0, 1.0), window_holds(12, 3, 0.0)), (1.0, 0.0));
        assert_near(window_holds(3, 0, 0.5), 0.125, 0.0);
    }

    #[test]
    fn the_table_of_the_seed() {
        // Seed 004, section 4, prints probabilities but neither m, q nor pi. A window of 3 s with m = 200, q = 50 and pi = 0.8 yields them all
        // within a unit of the last digit.
        let window = window_holds(200, 50, 0.8);
        for (time_s, printed) in
            [(3.0, 0.965), (6.0, 0.932), (9.0, 0.899), (12.0, 0.869), (15.0, 0.838), (16.2, 0.827)]
        {
            let pings = (time_s / 3.0 * 200.0) as u64;
            assert_near(holds_after(200, window, pings), printed, 1.1e-3);
        }
    }
}
