//! Swarms of any size in water that they fill, with any of the clocks by name: what the nightly suite runs.

use std::fmt::Write;

use shoal_scenario::model::Noise;

/// Which swarm.
#[derive(Clone, Copy, Debug)]
pub struct Swarm {
    /// Level `sea` rather than `ideal`.
    pub at_sea: bool,
    /// The mood of all errors.
    pub noise: Noise,
    /// One of the clocks that have a name.
    pub clock: &'static str,
    /// AUVs, two at least.
    pub count: u32,
    /// Simulated seconds.
    pub duration_s: f64,
    /// The seed.
    pub seed: u64,
}

impl Swarm {
    /// Its scenario file: half of the AUVs contract anchored rings together, up to sixty of the others tolerate outliers, which their
    /// modems yield, and the rest are plain tubes. All are told fifty times a second what they sense.
    pub fn text(&self) -> String {
        let mut text = String::new();
        // Writing to a string does not fail.
        let _infallible = self.write(&mut text);
        text
    }

    fn write(&self, text: &mut String) -> std::fmt::Result {
        let Self { at_sea, noise, clock, count, duration_s, seed } = *self;
        let noise = match noise {
            Noise::Uniform => "uniform",
            Noise::Adversarial => "adversarial",
        };
        // Some twenty neighbours within 250 m, however many there are.
        let side_m = match count {
            0..10 => 150,
            10..40 => 300,
            40..200 => 600,
            200..600 => 1_000,
            _ => 1_500,
        };
        writeln!(
            text,
            "name = \"nightly\"\nseed = {seed}\nduration_s = {duration_s}\nnoise = \"{noise}\"\nwindow_ms = 99"
        )?;
        writeln!(
            text,
            "[environment]\narea_m = [[0, {side_m}], [0, {side_m}], [-{side_m}, 0]]\ncurrent_m_s = [0.2, -0.1, 0]"
        )?;
        writeln!(text, "current_error_m_s = [0.05, 0.05, 0.01]")?;
        if at_sea {
            writeln!(
                text,
                "level = \"sea\"\n[environment.sea]\nsound_speed = \"summer-thermocline\"\nbounces_max = 1"
            )?;
        }
        let modem = if at_sea {
            "like = \"evologics-18-34\"\nping_period_s = 12"
        } else {
            "range_m = 250\nping_period_s = 1"
        };
        let anchored = count.div_ceil(2);
        let robust = (count - anchored).min(60);
        let plain = count - anchored - robust;
        for (name, count, estimator, outliers) in [
            ("anchored", anchored, "{ name = \"tube\", rings = 16 }", 0.0),
            ("robust", robust, "{ name = \"tube\", outliers = { window = 8, tolerated = 3 } }", 0.05),
            ("plain", plain, "{ name = \"tube\" }", 0.0),
        ] {
            if count == 0 {
                continue;
            }
            writeln!(text, "[[group]]\nname = \"{name}\"\ncount = {count}\nestimator = {estimator}")?;
            writeln!(text, "clock = \"{clock}\"\ncontrol_period_s = 0.02\nreaction_s = 0.1")?;
            writeln!(text, "controller = {{ name = \"reynolds\", speed_m_s = 1.5 }}")?;
            writeln!(text, "[group.sensors.gnss]\ndepth_max_m = 20\nperiod_s = 1")?;
            writeln!(text, "[group.modem]\n{modem}\noutlier_rate = {outliers}")?;
            writeln!(
                text,
                "[group.start]\nregion_m = [[0, {side_m}], [0, {side_m}], [-{side_m}, 0]]\nbox_width_m = [1, 20]"
            )?;
        }
        Ok(())
    }
}
