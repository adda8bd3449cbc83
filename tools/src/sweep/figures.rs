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
    /// Whether people see it.
    pub shown: Shown,
    /// The number; `None` where there is none to tell, as of a ratio of nothing.
    pub of: fn(&Summary) -> Option<f64>,
}

/// Whether a figure stands in the table for people; the one for programs has them all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shown {
    /// Always.
    Always,
    /// When it is other than zero in any run.
    WhereAny,
    /// Never.
    Never,
}

const fn figure(
    title: &'static str,
    name: &'static str,
    more_is_worse: bool,
    decimals: [usize; 2],
    shown: Shown,
    of: fn(&Summary) -> Option<f64>,
) -> Figure {
    Figure { title, name, more_is_worse, decimals, shown, of }
}

/// Every column of the table.
pub const FIGURES: [Figure; 32] = [
    figure("pings emitted", "emitted", false, [0, 1], Shown::Always, |run| Some(run.pings.emitted as f64)),
    figure("heard", "heard", false, [0, 1], Shown::Always, |run| Some(run.pings.heard as f64)),
    figure("delivery ratio", "delivery_ratio", false, [3, 3], Shown::Always, delivery_ratio),
    figure("lost by collision", "lost_collision", true, [0, 1], Shown::Always, |run| {
        Some(run.pings.lost.collision as f64)
    }),
    figure("out of range", "lost_range", true, [0, 1], Shown::Never, |run| Some(run.pings.lost.range as f64)),
    figure("by noise", "lost_noise", true, [0, 1], Shown::WhereAny, |run| Some(run.pings.lost.noise as f64)),
    figure("half duplex", "lost_half_duplex", true, [0, 1], Shown::WhereAny, |run| {
        Some(run.pings.lost.half_duplex as f64)
    }),
    figure("in shadow", "lost_shadow", true, [0, 1], Shown::WhereAny, |run| {
        Some(run.pings.lost.shadow as f64)
    }),
    figure("asleep", "lost_asleep", true, [0, 1], Shown::WhereAny, |run| Some(run.pings.lost.asleep as f64)),
    figure("other band", "lost_band", true, [0, 1], Shown::WhereAny, |run| Some(run.pings.lost.band as f64)),
    figure("held back", "lost_busy", true, [0, 1], Shown::WhereAny, |run| Some(run.pings.lost.busy as f64)),
    figure("unsent", "lost_unsent", true, [0, 1], Shown::WhereAny, |run| Some(run.pings.lost.unsent as f64)),
    figure("late", "lost_late", true, [0, 1], Shown::WhereAny, |run| Some(run.pings.lost.late as f64)),
    figure("to the dead", "lost_dead", true, [0, 1], Shown::WhereAny, |run| Some(run.pings.lost.dead as f64)),
    figure("outliers", "outliers", true, [0, 1], Shown::WhereAny, |run| Some(run.pings.outliers as f64)),
    figure("end width (m)", "end_width_median_m", true, [2, 2], Shown::Always, |run| {
        Some(run.position_width_m.end_median)
    }),
    figure("widest (m)", "end_width_max_m", true, [2, 2], Shown::Always, |run| {
        Some(run.position_width_m.end_max)
    }),
    figure("end clock (s)", "end_clock_width_median_s", true, [6, 6], Shown::Never, |run| {
        Some(run.clock_width_s.end_median)
    }),
    figure("widest clock (s)", "end_clock_width_max_s", true, [6, 6], Shown::Never, |run| {
        Some(run.clock_width_s.end_max)
    }),
    figure("off station (m)", "off_station_median_m", true, [2, 2], Shown::WhereAny, |run| {
        Some(run.off_station_m?.end_median)
    }),
    figure("farthest off (m)", "off_station_max_m", true, [2, 2], Shown::WhereAny, |run| {
        Some(run.off_station_m?.end_max)
    }),
    figure("truth inside", "contained_fraction", false, [4, 4], Shown::Always, contained_fraction),
    figure("NEES (4)", "nees_mean", true, [2, 2], Shown::WhereAny, nees_mean),
    figure("polarization", "polarization", false, [3, 3], Shown::Always, |run| Some(run.flock.polarization)),
    figure("separation (m)", "min_separation_m", false, [2, 2], Shown::Always, |run| {
        run.flock.min_separation_m
    }),
    figure("body collisions", "body_collisions", true, [0, 1], Shown::WhereAny, |run| {
        Some(run.flock.collisions as f64)
    }),
    figure("connectivity", "connectivity", false, [4, 4], Shown::Never, |run| Some(run.flock.connectivity)),
    figure("algebraic", "algebraic_connectivity", false, [3, 3], Shown::Always, |run| {
        run.flock.algebraic_connectivity
    }),
    figure("components", "components", true, [0, 1], Shown::Always, |run| {
        Some(f64::from(run.flock.components))
    }),
    figure("AUVs lost", "auvs_lost", true, [0, 1], Shown::WhereAny, |run| Some(run.agents.lost.len() as f64)),
    figure("misled", "misled", true, [0, 1], Shown::WhereAny, |run| {
        Some(run.containment.misled.violations as f64)
    }),
    figure("violations", "violations", true, [0, 1], Shown::Always, |run| {
        Some(run.containment.violations as f64)
    }),
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
    /// The best of them.
    pub best: f64,
    /// The worst of them.
    pub worst: f64,
}

impl Figures {
    /// Of these runs; `None` when no run has the figure.
    pub fn over<'a>(figure: &Figure, runs: impl Iterator<Item = &'a Summary>) -> Option<Self> {
        let values: Vec<f64> = runs.filter_map(figure.of).collect();
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
        let spread = (values.len() > 1).then(|| (squares / (count - 1.0)).sqrt());
        let least = values.iter().copied().reduce(f64::min)?;
        let greatest = values.iter().copied().reduce(f64::max)?;
        let (best, worst) = if figure.more_is_worse { (least, greatest) } else { (greatest, least) };
        Some(Self { mean, spread, best, worst })
    }
}
