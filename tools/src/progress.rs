//! The progress bar, with the real-time factor achieved.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use shoal_scenario::Scenario;

/// A bar on stderr; hidden where nobody looks.
pub struct Bar(ProgressBar);

impl Bar {
    /// A bar for a run of this scenario.
    pub fn new(scenario: &Scenario, hidden: bool) -> Self {
        let target = if hidden { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let bar = ProgressBar::with_draw_target(Some((scenario.duration_ns / 1_000_000) as u64), target);
        bar.set_message(format!("{}: starting {} AUVs", scenario.name, scenario.auv_count()));
        bar.tick();
        let style = ProgressStyle::with_template("{msg} {bar:32} {percent:>3} % {elapsed_precise}");
        if let Ok(style) = style {
            bar.set_style(style);
        }
        Self(bar)
    }

    /// The first window begins.
    pub fn start(&self) {
        self.0.reset_elapsed();
    }

    /// So many simulated seconds are done.
    pub fn advance(&self, sim_s: f64) {
        self.0.set_position((sim_s * 1e3) as u64);
        let wall_s = self.0.elapsed().as_secs_f64();
        self.0.set_message(format!("{sim_s:.1} s, {:.1} x real time", sim_s / wall_s.max(1e-9)));
    }

    /// Something that the user should know.
    pub fn note(&self, note: &str) {
        self.0.suspend(|| eprintln!("warning: {note}"));
    }

    /// What somebody else said.
    pub fn log(&self, text: &str) {
        self.0.suspend(|| eprintln!("{text}"));
    }

    /// The run is over.
    pub fn finish(&self) {
        self.0.finish_and_clear();
    }
}
