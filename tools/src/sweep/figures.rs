//! The numbers of a sweep: what is taken from each run, and what it comes to over seeds.

use shoal_bus::summary::Summary;

/// A number that a run comes to.
pub struct Figure {
    /// In a table for people.
    pub title: &'static str,
    /// In a file for programs.
    pub name: &'static str,
    /// Whether more of it is worse.
    pub more_is_worse: bool,
    /// Digits after the point: of the number itself, and of mean and spread.
    pub decimals: [usize; 2],
    /// The number; `None` where there is none to tell, as of a ratio of nothing.
    pub of: fn(&Summary) -> Option<f64>,
}

/// Every column of the table.
pub const FIGURES: [Figure; 8] = [
    Figure {
        title: "pings emitted",
        name: "emitted",
        more_is_worse: false,
        decimals: [0, 1],
        of: |summary| Some(summary.pings.emitted as f64),
    },
    Figure {
        title: "heard",
        name: "heard",
        more_is_worse: false,
        decimals: [0, 1],
        of: |summary| Some(summary.pings.heard as f64),
    },
    Figure {
        title: "delivery ratio",
        name: "delivery_ratio",
        more_is_worse: false,
        decimals: [3, 3],
        of: delivery_ratio,
    },
    Figure {
        title: "lost by collision",
        name: "lost_collision",
        more_is_worse: true,
        decimals: [0, 1],
        of: |summary| Some(summary.pings.lost.collision as f64),
    },
    Figure {
        title: "end width (m)",
        name: "end_width_median_m",
        more_is_worse: true,
        decimals: [2, 2],
        of: |summary| Some(summary.position_width_m.end_median),
    },
    Figure {
        title: "truth inside",
        name: "contained_fraction",
        more_is_worse: false,
        decimals: [4, 4],
        of: contained_fraction,
    },
    Figure { title: "NEES (4)", name: "nees_mean", more_is_worse: true, decimals: [2, 2], of: nees_mean },
    Figure {
        title: "violations",
        name: "violations",
        more_is_worse: true,
        decimals: [0, 1],
        of: |summary| Some(summary.containment.violations as f64),
    },
];

/// Receptions that worked, of those that could have: heard and lost within range. Pings that never left (`busy`, `late`) are
/// neither.
fn delivery_ratio(summary: &Summary) -> Option<f64> {
    let lost = &summary.pings.lost;
    let failed =
        lost.noise + lost.collision + lost.half_duplex + lost.shadow + lost.asleep + lost.band + lost.dead;
    let tried = summary.pings.heard + failed;
    (tried > 0).then(|| summary.pings.heard as f64 / tried as f64)
}

/// Reports that held the truth, of all of every group.
fn contained_fraction(summary: &Summary) -> Option<f64> {
    let reports: u64 = summary.estimators.iter().map(|line| line.reports).sum();
    let contained: f64 =
        summary.estimators.iter().map(|line| line.contained_fraction * line.reports as f64).sum();
    (reports > 0).then(|| contained / reports as f64)
}

/// Normalized estimation error squared over all reports that have one: 4 for honest Gaussians.
fn nees_mean(summary: &Summary) -> Option<f64> {
    let told = || summary.estimators.iter().filter_map(|line| Some((line.nees_mean?, line.reports as f64)));
    let reports: f64 = told().map(|(_, reports)| reports).sum();
    (reports > 0.0).then(|| told().map(|(nees, part)| nees * (part / reports)).sum())
}

/// What a figure comes to over the seeds of one combination.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figures {
    /// Arithmetic mean.
    pub mean: f64,
    /// Standard deviation of the sample; `None` of fewer than two.
    pub spread: Option<f64>,
    /// The worst of them.
    pub worst: f64,
}

impl Figures {
    /// Of these runs; `None` when no run has the figure.
    pub fn over(figure: &Figure, summaries: &[Summary]) -> Option<Self> {
        let values: Vec<f64> = summaries.iter().filter_map(figure.of).collect();
        let first = *values.first()?;
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
        let spread = (values.len() > 1).then(|| (squares / (count - 1.0)).sqrt());
        let worse = if figure.more_is_worse { f64::max } else { f64::min };
        Some(Self { mean, spread, worst: values.into_iter().fold(first, worse) })
    }
}
