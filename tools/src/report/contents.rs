//! The report of one run.

use serde_json::Value;

use super::gather::{KINDS, Run};
use super::margins::{in_unit, significant};
use super::page::{Block, Page, Table};
use super::proof;
use crate::plot::{Kind, run_of};
use crate::summary_text::grouped;

/// Lost pings by reason: where the summary has it, and what a reader calls it.
pub const REASONS: [(&str, &str); 11] = [
    ("range", "out of range"),
    ("noise", "lost in noise"),
    ("collision", "lost by collision"),
    ("half_duplex", "receiver emitting"),
    ("shadow", "in a shadow zone"),
    ("asleep", "receiver asleep"),
    ("band", "other band"),
    ("dead", "receiver dead"),
    ("busy", "never left: held back, others heard"),
    ("unsent", "never left: modem still emitting"),
    ("late", "never left: booked too late"),
];

/// The report of one run.
pub fn page(run: Run) -> Page {
    let mut blocks = vec![proof::verdict(&run), Block::Table(facts(&run))];
    blocks.extend(figures(&run, &[Kind::Map, Kind::Widths]));
    blocks.extend(proof::blocks(&run));
    blocks.extend(figures(&run, &[Kind::Tubes]));
    blocks.push(Block::Heading("Groups".to_owned()));
    blocks.extend(groups(&run));
    blocks.extend(figures(&run, &[Kind::Estimators]));
    blocks.push(Block::Heading("Pings".to_owned()));
    blocks.extend(pings(&run));
    blocks.extend(figures(
        &run,
        &[Kind::Losses, Kind::Links, Kind::Reach, Kind::Ranges, Kind::Sinr, Kind::Rays],
    ));
    blocks.push(Block::Heading("Swarm".to_owned()));
    blocks.extend(figures(&run, &[Kind::Flock]));
    blocks.push(Block::Heading("Lost AUVs".to_owned()));
    blocks.extend(lost(&run));
    blocks.push(Block::Heading("Scenario".to_owned()));
    blocks.push(scenario(&run, "The scenario as it was run"));
    blocks.extend(absent(&run));
    blocks.push(made());
    Page { title: format!("Report of {}", run.header.scenario_name), subtitle: run_of(&run.header), blocks }
}

/// The figures of these kinds that there are, one below the other.
fn figures(run: &Run, kinds: &[Kind]) -> Vec<Block> {
    let named = |kind: &Kind| {
        let name = KINDS.iter().find(|(_, known)| known == kind).map(|(name, _)| *name)?;
        Some(Block::Figures(vec![(format!("{name}.svg"), run.figure(*kind)?.clone())]))
    };
    kinds.iter().filter_map(named).collect()
}

/// Why figures are missing.
fn absent(run: &Run) -> Option<Block> {
    let missing = KINDS.iter().zip(&run.figures).filter_map(|((name, _), figure)| match figure {
        Ok(_) => None,
        Err(why) => Some(format!("{name} ({})", why.trim_start_matches("nothing to show: "))),
    });
    let missing: Vec<String> = missing.collect();
    (!missing.is_empty()).then(|| Block::Text(format!("Figures that are not here: {}.", missing.join("; "))))
}

/// What made the page: nothing of when or where, so that the same records have the same report.
pub fn made() -> Block {
    Block::Text(format!("Made by shoal report, version {}.", env!("CARGO_PKG_VERSION")))
}

/// The scenario's text, to be opened.
pub fn scenario(run: &Run, title: &str) -> Block {
    Block::Listing { title: title.to_owned(), text: run.header.scenario_text.clone() }
}

fn facts(run: &Run) -> Table {
    let mut table = Table::new(&["", ""]);
    table.row(["scenario", &run.header.scenario_name]);
    table.row(["seed".to_owned(), run.header.seed.to_string()]);
    table.row(["AUVs".to_owned(), grouped(run.header.auvs.len() as u64)]);
    for (what, text) in figures_of_merit(run) {
        table.row([what.to_owned(), text]);
    }
    let digest = run.summary["digest"].as_str().unwrap_or("none: the run did not finish");
    table.row(["digest", digest]);
    let reproducible = match run.summary["reproducible"].as_bool() {
        Some(true) => "yes: scenario and seed determine the digest",
        Some(false) => "no: an AUV died, the run was interrupted, or AUVs ran freely",
        None => "unknown",
    };
    table.row(["reproducible", reproducible]);
    table
}

/// Numbers of the summary: label, place, factor, unit; those that count have no unit.
pub const MEASURES: [(&str, &str, f64, &str); 15] = [
    ("simulated time", "/sim_s", 1.0, "s"),
    ("control ticks", "/wakes", 1.0, ""),
    ("containment checks", "/containment/checks", 1.0, ""),
    ("violations", "/containment/violations", 1.0, ""),
    ("width of the position box, median at the start", "/position_width_m/start_median", 1.0, "m"),
    ("width of the position box, median at the end", "/position_width_m/end_median", 1.0, "m"),
    ("width of the position box, greatest at the end", "/position_width_m/end_max", 1.0, "m"),
    ("width of the clock interval, median at the end", "/clock_width_s/end_median", 1.0, "s"),
    ("width of the clock interval, greatest at the end", "/clock_width_s/end_max", 1.0, "s"),
    ("off station, median at the end", "/off_station_m/end_median", 1.0, "m"),
    ("polarization at the end", "/flock/polarization", 100.0, "%"),
    ("least separation of two bodies", "/flock/min_separation_m", 1.0, "m"),
    ("collisions", "/flock/collisions", 1.0, ""),
    ("pairs in range at the end", "/flock/connectivity", 100.0, "%"),
    ("connected components at the end", "/flock/components", 1.0, ""),
];

/// A number as a page shows it.
pub fn shown(value: f64, factor: f64, unit: &str) -> String {
    match unit {
        "" => grouped(value as u64),
        "m" | "s" => in_unit(value * factor, unit),
        unit => format!("{} {unit}", significant(value * factor)),
    }
}

fn figures_of_merit(run: &Run) -> impl Iterator<Item = (&'static str, String)> + '_ {
    MEASURES
        .iter()
        .filter_map(|(what, pointer, factor, unit)| Some((*what, shown(run.number(pointer)?, *factor, unit))))
}

fn groups(run: &Run) -> Option<Block> {
    let lines = run.rows("/estimators");
    if lines.is_empty() {
        return Some(Block::Text("The record says nothing of groups.".to_owned()));
    }
    let mut table = Table::new(&[
        "group",
        "AUVs",
        "estimator",
        "truth inside",
        "NEES, 4 when honest",
        "error of the centre, RMS",
        "width, median of means",
    ]);
    for line in lines {
        let text = |key: &str| line[key].as_str().unwrap_or("–").to_owned();
        let length =
            |key: &str| line[key].as_f64().map_or_else(|| "–".to_owned(), |value| in_unit(value, "m"));
        let estimator = match line["fusion"].as_str() {
            Some(fusion) => format!("{}, {fusion}", text("estimator")),
            None => text("estimator"),
        };
        let inside = line["contained_fraction"].as_f64();
        table.row([
            text("group"),
            grouped(line["auvs"].as_u64().unwrap_or(0)),
            estimator,
            inside.map_or_else(|| "–".to_owned(), percent),
            line["nees_mean"].as_f64().map_or_else(|| "–".to_owned(), significant),
            length("centre_rms_m"),
            length("width_median_m"),
        ]);
    }
    Some(Block::Table(table))
}

/// Never rounded up to the whole.
fn percent(part: f64) -> String {
    if part >= 1.0 { "100 %".to_owned() } else { format!("{:.2} %", (part * 1e4).floor() / 100.0) }
}

fn pings(run: &Run) -> Vec<Block> {
    let count = |pointer: &str| run.number(pointer).map(|count| count as u64);
    let (Some(emitted), Some(heard)) = (count("/pings/emitted"), count("/pings/heard")) else {
        return vec![Block::Text("The record has no summary: pings are in the figures alone.".to_owned())];
    };
    let lost = |key: &str| count(&format!("/pings/lost/{key}")).unwrap_or(0);
    let others = run.header.auvs.len().saturating_sub(1);
    let all = emitted * others as u64;
    let mut table = Table::new(&["what became of them", "receptions", "of all", "of those in range"]);
    let in_range = all.saturating_sub(lost("range"));
    let part = |count: u64, of: u64| match of {
        0 => "–".to_owned(),
        of => format!("{:.2} %", 100.0 * count as f64 / of as f64),
    };
    table.row(["heard".to_owned(), grouped(heard), part(heard, all), part(heard, in_range)]);
    for (key, name) in REASONS {
        let count = lost(key);
        let never_left = name.starts_with("never left");
        if count > 0 {
            let parts = match (never_left, key) {
                (true, _) => ["–".to_owned(), "–".to_owned()],
                (_, "range") => [part(count, all), "–".to_owned()],
                _ => [part(count, all), part(count, in_range)],
            };
            let [of_all, of_reached] = parts;
            table.row([name.to_owned(), grouped(count), of_all, of_reached]);
        }
    }
    let in_flight = count("/pings/in_flight").unwrap_or(0);
    if in_flight > 0 {
        table.row([
            "under way at the end".to_owned(),
            grouped(in_flight),
            part(in_flight, all),
            part(in_flight, in_range),
        ]);
    }
    let outliers = count("/pings/outliers").unwrap_or(0);
    let echoes = match outliers {
        0 => String::new(),
        count => format!(" {} of those heard came the long way round, after bounces.", grouped(count)),
    };
    let mut blocks = vec![
        Block::Text(format!(
            "{} pings left a modem, each on its way to {others} others.{echoes}",
            grouped(emitted)
        )),
        Block::Table(table),
    ];
    if let Some(by_range) = run.fates.table() {
        blocks.push(Block::Text("By range, what came to a receiver or should have:".to_owned()));
        blocks.push(Block::Table(by_range));
    }
    blocks
}

fn lost(run: &Run) -> Vec<Block> {
    let lines = |pointer: &str, what: &str| -> Vec<[String; 4]> {
        let row = |line: &Value| {
            [
                line["name"].as_str().unwrap_or("–").to_owned(),
                what.to_owned(),
                format!("{:.3} s", line["time_s"].as_f64().unwrap_or(f64::NAN)),
                line["reason"].as_str().unwrap_or("–").to_owned(),
            ]
        };
        run.rows(pointer).iter().map(row).collect()
    };
    let mut table = Table::new(&["AUV", "what happened", "at", "how it ended"]);
    lines("/agents/lost", "lost").into_iter().for_each(|row| table.row(row));
    lines("/agents/restarted", "born again").into_iter().for_each(|row| table.row(row));
    match table.rows.is_empty() {
        true if run.summary.is_null() => vec![Block::Text("Unknown: the run did not finish.".to_owned())],
        true => vec![Block::Text("None.".to_owned())],
        false => vec![Block::Table(table)],
    }
}
