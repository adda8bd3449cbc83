//! The report of two runs: what differs in what they were told to do, and in what came of it.

use std::collections::{BTreeMap, BTreeSet};

use toml_edit::{DocumentMut, Item, Value};

use super::contents::{MEASURES, REASONS, made, scenario, shown};
use super::gather::{KINDS, Run};
use super::margins::in_unit;
use super::page::{Block, Page, Table};
use super::proof;
use crate::figure::Figure;
use crate::plot::{Kind, run_of};
use crate::summary_text::grouped;

/// The report of two runs.
pub fn page(first: Run, second: Run) -> Page {
    let runs = [&first, &second];
    let [a, b] = runs.map(|run| run_of(&run.header));
    let mut blocks = Vec::new();
    for (letter, run) in ["A", "B"].iter().zip(runs) {
        if let Block::Verdict { is_good, text } = proof::verdict(run) {
            blocks.push(Block::Verdict { is_good, text: format!("{letter}: {text}") });
        }
    }
    blocks.push(Block::Heading("What differs in the scenario".to_owned()));
    blocks.push(differences(runs));
    blocks.push(Block::Heading("What came of it".to_owned()));
    blocks.push(Block::Text(same_digest(runs)));
    blocks.push(Block::Table(measures(runs)));
    blocks.push(Block::Heading("Groups".to_owned()));
    blocks.push(Block::Table(groups(runs)));
    blocks.push(Block::Heading("Figures".to_owned()));
    blocks.push(Block::Text(
        "A comes first, B beside it where the screen is wide enough; axes are the same, but for maps."
            .to_owned(),
    ));
    for (name, kind) in KINDS {
        let figures: Vec<(&str, &Figure)> = ["a", "b"]
            .into_iter()
            .zip(runs)
            .filter_map(|(letter, run)| Some((letter, run.figure(kind)?)))
            .collect();
        let named = |(letter, figure): (&str, Figure)| (format!("{name}-{letter}.svg"), figure);
        let shown: Vec<(&str, Figure)> = match figures[..] {
            [(_, a), (_, b)] if kind != Kind::Map && kind != Kind::Links => {
                let [left, right] = Figure::on_the_same_axes(a.clone(), b.clone());
                vec![("a", left), ("b", right)]
            }
            _ => figures.into_iter().map(|(letter, figure)| (letter, figure.clone())).collect(),
        };
        if !shown.is_empty() {
            blocks.push(Block::Figures(shown.into_iter().map(named).collect()));
        }
    }
    blocks.push(Block::Heading("Scenarios".to_owned()));
    blocks.push(scenario(&first, "A as it was run"));
    blocks.push(scenario(&second, "B as it was run"));
    blocks.push(made());
    Page {
        title: format!("{} beside {}", first.header.scenario_name, second.header.scenario_name),
        subtitle: format!("A: {a}. B: {b}."),
        blocks,
    }
}

fn same_digest(runs: [&Run; 2]) -> String {
    let [a, b] = runs.map(|run| run.summary["digest"].as_str());
    match (a, b) {
        (Some(a), Some(b)) if a == b => format!("Both have the digest {a}: all that happened is the same."),
        (Some(a), Some(b)) => format!("A has the digest {a}, B has {b}."),
        _ => "One of them did not finish: it has no digest.".to_owned(),
    }
}

/// Numbers of both beside each other.
fn measures(runs: [&Run; 2]) -> Table {
    let mut table = Table::new(&["", "A", "B", "B − A", "B − A, of A"]);
    let mut line = |what: &str, values: [Option<f64>; 2], factor: f64, unit: &str| {
        if values.iter().all(|value| value.is_none_or(|value| value == 0.0))
            && unit.is_empty()
            && what != "violations"
        {
            return;
        }
        let text =
            |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |value| shown(value, factor, unit));
        let [a, b] = values.map(text);
        let (difference, part) = match values {
            [Some(from), Some(to)] => (signed(to - from, factor, unit), relative(from, to)),
            _ => ("–".to_owned(), "–".to_owned()),
        };
        if (&a, &b) != (&"–".to_owned(), &"–".to_owned()) {
            table.row([what.to_owned(), a, b, difference, part]);
        }
    };
    for (what, pointer, factor, unit) in MEASURES {
        line(what, runs.map(|run| run.number(pointer)), factor, unit);
    }
    for (what, pointer) in [("pings emitted", "/pings/emitted"), ("pings heard", "/pings/heard")] {
        line(what, runs.map(|run| run.number(pointer)), 1.0, "");
    }
    for (key, name) in REASONS {
        let pointer = format!("/pings/lost/{key}");
        line(&format!("pings {name}"), runs.map(|run| run.number(&pointer)), 1.0, "");
    }
    table
}

fn signed(difference: f64, factor: f64, unit: &str) -> String {
    let sign = if difference > 0.0 {
        "+"
    } else if difference < 0.0 {
        "−"
    } else {
        ""
    };
    format!("{sign}{}", shown(difference.abs(), factor, unit))
}

fn relative(from: f64, to: f64) -> String {
    if from == 0.0 || from == to {
        return if from == to { "0 %".to_owned() } else { "–".to_owned() };
    }
    let part = 100.0 * (to - from) / from;
    format!("{}{:.1} %", if part < 0.0 { "−" } else { "+" }, part.abs())
}

/// The groups of both by name.
fn groups(runs: [&Run; 2]) -> Table {
    let mut table = Table::new(&[
        "group",
        "AUVs, A",
        "AUVs, B",
        "width, A",
        "width, B",
        "error, A",
        "error, B",
        "truth inside, A",
        "truth inside, B",
    ]);
    let lines = runs.map(|run| {
        let named = |line: &serde_json::Value| Some((line["group"].as_str()?.to_owned(), line.clone()));
        run.rows("/estimators").iter().filter_map(named).collect::<BTreeMap<_, _>>()
    });
    let names: BTreeSet<&String> = lines.iter().flat_map(BTreeMap::keys).collect();
    for name in names {
        let both = |key: &str, text: fn(f64) -> String| {
            lines.each_ref().map(|lines| {
                let value = lines.get(name).and_then(|line| line[key].as_f64());
                value.map_or_else(|| "–".to_owned(), text)
            })
        };
        let metres = |value: f64| in_unit(value, "m");
        let cells = [
            both("auvs", |count| grouped(count as u64)),
            both("width_median_m", metres),
            both("centre_rms_m", metres),
            both("contained_fraction", |part| format!("{:.2} %", (part * 1e4).floor() / 100.0)),
        ];
        table.row([name.clone()].into_iter().chain(cells.into_iter().flatten()));
    }
    table
}

/// Keys that differ, as `shoal run --set` names them.
fn differences(runs: [&Run; 2]) -> Block {
    let [a, b] = runs.map(|run| {
        let mut keys = BTreeMap::new();
        if let Ok(document) = run.header.scenario_text.parse::<DocumentMut>() {
            flatten(String::new(), document.as_item(), &mut keys);
        }
        // A seed that the command line gives is not in the text.
        keys.insert("seed".to_owned(), run.header.seed.to_string());
        keys
    });
    let all: BTreeSet<&String> = a.keys().chain(b.keys()).collect();
    let mut table = Table::new(&["key", "A", "B"]);
    for key in all {
        let [in_a, in_b] = [&a, &b].map(|keys| keys.get(key).cloned());
        if in_a != in_b {
            let text = |value: Option<String>| value.unwrap_or_else(|| "not said".to_owned());
            table.row([key.clone(), text(in_a), text(in_b)]);
        }
    }
    if table.rows.is_empty() {
        return Block::Text("Nothing: scenario and seed are the same.".to_owned());
    }
    Block::Table(table)
}

/// Every value of a document by its key with dots; tables of a list by their index.
fn flatten(key: String, item: &Item, into: &mut BTreeMap<String, String>) {
    let below = |name: &str| if key.is_empty() { name.to_owned() } else { format!("{key}.{name}") };
    match item {
        Item::None => {}
        Item::Table(table) => table.iter().for_each(|(name, item)| flatten(below(name), item, into)),
        Item::ArrayOfTables(tables) => {
            for (index, table) in tables.iter().enumerate() {
                let key = below(&index.to_string());
                table.iter().for_each(|(name, item)| flatten(format!("{key}.{name}"), item, into));
            }
        }
        Item::Value(Value::InlineTable(table)) => {
            table.iter().for_each(|(name, value)| flatten(below(name), &Item::Value(value.clone()), into));
        }
        Item::Value(value) => {
            let mut value = value.clone();
            // Without comments and blanks around it.
            value.decor_mut().clear();
            into.insert(key, value.to_string());
        }
    }
}
