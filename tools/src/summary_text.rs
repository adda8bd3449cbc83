//! The summary for people.

use std::fmt::Write;

use shoal_bus::summary::{Assumption, EstimatorLine, FreeRun, Kidnapped, Summary, ViolationLine};

/// A dozen lines that say what a run amounts to.
pub fn render(summary: &Summary) -> String {
    let mut text = String::new();
    // Writing to a string does not fail.
    let _infallible = write_all(&mut text, summary);
    text
}

fn write_all(text: &mut String, summary: &Summary) -> std::fmt::Result {
    let Summary { containment, position_width_m: position, clock_width_s: clock, pings, flock, .. } = summary;
    let bus = summary.bus.as_deref().unwrap_or("-");
    let processes = summary.processes.unwrap_or(0);
    let auvs = counted(summary.auvs, "AUV", "AUVs");
    let processes = counted(processes, "process", "processes");
    writeln!(text, "{}, seed {}: {auvs}, {processes} on {bus}", summary.scenario, summary.seed)?;
    writeln!(
        text,
        "  time          {} s simulated in {:.2} s, {:.1} times real time ({:.2} s to start)",
        number(summary.sim_s),
        summary.wall_s.unwrap_or(0.0),
        summary.real_time_factor.unwrap_or(0.0),
        summary.startup_s.unwrap_or(0.0),
    )?;
    let verdict = match (containment.checks, containment.violations) {
        (0, _) => "nothing was checked",
        (_, 0) => "no enclosure lost the truth",
        _ => "THE TRUTH WAS LOST",
    };
    writeln!(
        text,
        "  containment   {} checks, {} violations: {verdict}",
        grouped(containment.checks),
        grouped(containment.violations)
    )?;
    for violation in &containment.first {
        writeln!(text, "    {}", describe(violation))?;
    }
    let misled = &containment.misled;
    if misled.auvs > 0 {
        let auvs = if misled.auvs == 1 {
            "1 AUV".to_owned()
        } else {
            format!("{} AUVs", grouped(misled.auvs.into()))
        };
        writeln!(
            text,
            "                counted apart: {auvs} misled by what they heard, {} enclosures without the truth",
            grouped(misled.violations)
        )?;
    }
    if let Some(kidnapped) = &containment.kidnapped {
        writeln!(text, "                counted apart: {}", of_kidnapped(kidnapped))?;
    }
    for assumed in &containment.assumptions {
        writeln!(text, "                {}", of_assumption(assumed))?;
    }
    if is_comparison(&summary.estimators) {
        write_estimators(text, &summary.estimators)?;
    }
    writeln!(
        text,
        "  position      width {:.2} m at first, {:.2} m at last in the median, {:.2} m at most",
        position.start_median, position.end_median, position.end_max
    )?;
    writeln!(
        text,
        "  clock         width {} at first, {} at last in the median, {} at most",
        seconds(clock.start_median),
        seconds(clock.end_median),
        seconds(clock.end_max)
    )?;
    if let Some(off) = &summary.off_station_m {
        writeln!(
            text,
            "  station       {:.2} m off at first, {:.2} m at last in the median, {:.2} m at most",
            off.start_median, off.end_median, off.end_max
        )?;
    }
    let lost = &pings.lost;
    let outliers = match pings.outliers {
        0 => String::new(),
        count => format!(", {} of them the long way round (outliers)", grouped(count)),
    };
    writeln!(
        text,
        "  pings         {} emitted, {} heard{outliers}",
        grouped(pings.emitted),
        grouped(pings.heard)
    )?;
    let reasons = [
        ("range", lost.range),
        ("noise", lost.noise),
        ("collision", lost.collision),
        ("half duplex", lost.half_duplex),
        ("shadow", lost.shadow),
        ("asleep", lost.asleep),
        ("band", lost.band),
        ("late", lost.late),
        ("dead", lost.dead),
        ("held back", lost.busy),
        ("unsent", lost.unsent),
    ];
    let lost: Vec<String> = reasons
        .iter()
        .filter(|(_, count)| *count > 0)
        .map(|(reason, count)| format!("{} {reason}", grouped(*count)))
        .collect();
    let lost = if lost.is_empty() { "none".to_owned() } else { lost.join(", ") };
    writeln!(text, "                lost: {lost}; still under way: {}", grouped(pings.in_flight))?;
    let components = if flock.components == 1 { "component" } else { "components" };
    let separation = flock.min_separation_m.map_or("-".to_owned(), |metres| format!("{metres:.2} m"));
    writeln!(
        text,
        "  flock         polarization {:.2}, least separation {separation}, {} collisions, {} {components}",
        flock.polarization,
        flock.collisions,
        grouped(u64::from(flock.components))
    )?;
    for lost in &summary.agents.lost {
        writeln!(
            text,
            "  lost          {} (AUV {}) at {} s: {}",
            lost.name,
            lost.auv,
            number(lost.time_s),
            lost.reason
        )?;
    }
    for again in &summary.agents.restarted {
        writeln!(text, "  born again    {} (AUV {}) at {} s", again.name, again.auv, number(again.time_s))?;
    }
    if let Some(free_run) = &summary.free_run {
        write_deadlines(text, free_run)?;
    }
    if let Some(memory) = &summary.memory {
        write!(text, "  memory        channel {:.1} MiB", memory.channel_rss_kib as f64 / 1024.0)?;
        if memory.auv_pss_kib_median > 0 {
            write!(text, ", AUV {:.2} MiB in the median", memory.auv_pss_kib_median as f64 / 1024.0)?;
        }
        writeln!(text)?;
    }
    let reproducible = if summary.reproducible { "reproducible" } else { "NOT reproducible" };
    writeln!(text, "  digest        {} ({reproducible})", summary.digest)
}

/// Who was late how often; the first ten of them.
fn write_deadlines(text: &mut String, free_run: &FreeRun) -> std::fmt::Result {
    let FreeRun { deadline_misses, worst_s, late, lag_max_s } = free_run;
    let lag = seconds(*lag_max_s);
    if *deadline_misses == 0 {
        return writeln!(text, "  deadlines     none missed; {lag} behind the wall clock at most");
    }
    writeln!(
        text,
        "  deadlines     {} missed by {}, {} at worst; {lag} behind the wall clock at most",
        grouped(*deadline_misses),
        counted(late.len() as u32, "AUV", "AUVs"),
        seconds(*worst_s),
    )?;
    for auv in late.iter().take(10) {
        let (misses, worst) = (grouped(auv.misses), seconds(auv.worst_s));
        writeln!(text, "                {} (AUV {}): {misses} missed, {worst} at worst", auv.name, auv.auv)?;
    }
    Ok(())
}

/// Whether there is something to compare, or an estimator whose boxes nobody promises to hold the truth.
fn is_comparison(estimators: &[EstimatorLine]) -> bool {
    let kind = |line: &EstimatorLine| (line.estimator.clone(), line.fusion.clone());
    let differ = estimators.iter().zip(estimators.iter().skip(1)).any(|(one, next)| kind(one) != kind(next));
    differ || estimators.iter().any(|line| line.estimator == "ekf")
}

/// A line for each group; NEES is the mean over position and clock, 4 for an honest Gaussian.
fn write_estimators(text: &mut String, estimators: &[EstimatorLine]) -> std::fmt::Result {
    let name = |line: &EstimatorLine| match line.fusion.as_deref() {
        Some("covariance-intersection") => format!("{} (CI)", line.estimator),
        _ => line.estimator.clone(),
    };
    writeln!(
        text,
        "  estimators    {:<14} {:<14} {:>6} {:>13} {:>10} {:>12} {:>10}",
        "group", "", "AUVs", "truth inside", "NEES (4)", "RMS error", "width"
    )?;
    for line in estimators {
        let nees = line.nees_mean.map_or("-".to_owned(), |nees| bounded(nees, ""));
        writeln!(
            text,
            "                {:<14} {:<14} {:>6} {:>11.3} % {nees:>10} {:>12} {:>10}",
            line.group,
            name(line),
            grouped(line.auvs.into()),
            // Cut off, so that 100 % is all of them.
            (line.contained_fraction * 1e5).floor() / 1e3,
            bounded(line.centre_rms_m, " m"),
            bounded(line.width_median_m, " m"),
        )?;
    }
    Ok(())
}

/// What became of AUVs that were carried elsewhere.
fn of_kidnapped(kidnapped: &Kidnapped) -> String {
    let noticed = match kidnapped.noticed_after_s {
        Some(after_s) => {
            format!("{} noticed it, after {after_s:.2} s at most", grouped(kidnapped.noticed.into()))
        }
        None => "nobody noticed".to_owned(),
    };
    let kidnappings = counted(kidnapped.kidnappings, "kidnapping", "kidnappings");
    let without = grouped(kidnapped.violations);
    format!("{kidnappings}, {noticed}; {without} enclosures without the truth until then")
}

/// What it was worth to assume so many wrong pings.
fn of_assumption(assumed: &Assumption) -> String {
    let Assumption { group, window, tolerated, inlier_probability, pings, holds, .. } = assumed;
    let Assumption { windows_kept_fraction, contained_fraction, .. } = assumed;
    format!(
        "{group}: if each ping is right with probability {inlier_probability}, at most {tolerated} of {window} are wrong in all {pings} windows \
         with {holds:.3} or more; {windows_kept_fraction:.4} of all windows were so, and {contained_fraction:.4} of all reports held the truth"
    )
}

/// With two digits after the point; summaries tell what has no bound as the largest number there is.
fn bounded(value: f64, unit: &str) -> String {
    if value < 1e9 { format!("{value:.2}{unit}") } else { "unbounded".to_owned() }
}

fn describe(violation: &ViolationLine) -> String {
    let ViolationLine { auv, name, time_s, enclosure, coordinate, margin, unit } = violation;
    let what = match enclosure.as_str() {
        "emptied" => "reported an empty set, though no fault was declared".to_owned(),
        _ => match margin {
            Some(margin) => format!("{enclosure}: {coordinate} is {margin:.3e} {unit} outside"),
            None => format!("{enclosure}: holds nothing or cannot be read"),
        },
    };
    format!("{name} (AUV {auv}) at {time_s:.3} s, {what}")
}

/// How many of what.
fn counted(count: u32, one: &str, many: &str) -> String {
    format!("{} {}", grouped(count.into()), if count == 1 { one } else { many })
}

/// With three digits after the point at most.
fn number(value: f64) -> String {
    let text = format!("{value:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Seconds with a prefix that suits.
fn seconds(value: f64) -> String {
    match value {
        _ if value >= 1.0 => format!("{value:.2} s"),
        _ if value >= 1e-3 => format!("{:.2} ms", value * 1e3),
        _ => format!("{:.2} us", value * 1e6),
    }
}

/// Thousands apart.
pub fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        assert_eq!(grouped(0), "0");
        assert_eq!(grouped(999), "999");
        assert_eq!(grouped(1_234_567), "1,234,567");
        assert_eq!((number(30.0), number(1.25)), ("30".to_owned(), "1.25".to_owned()));
        assert_eq!((seconds(2.0), seconds(0.0125)), ("2.00 s".to_owned(), "12.50 ms".to_owned()));
    }
}
