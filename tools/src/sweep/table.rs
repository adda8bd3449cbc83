//! The table of a sweep, for people and for programs.

use super::figures::{FIGURES, Figure};
use super::{Figures, Outcome, Row};
use crate::set::Setting;

/// Three lines for each combination: mean, spread and worst case over the seeds.
pub fn text(scenario: &str, seeds: usize, keys: &[&str], rows: &[Row]) -> String {
    let mut lines = vec![
        keys.iter().copied().chain(["over seeds"]).chain(FIGURES.iter().map(|figure| figure.title)).collect(),
    ];
    let mut owned: Vec<Vec<String>> = Vec::new();
    let mut refusals = Vec::new();
    for row in rows {
        match &row.outcome {
            Outcome::Ran(summaries) => {
                let figures = FIGURES.each_ref().map(|figure| Figures::over(figure, summaries));
                owned.extend(three_lines(row, figures));
            }
            Outcome::Stopped(_, reason) => {
                let values = row.settings.iter().map(Setting::shown);
                owned.push(values.chain(["not run".to_owned()]).collect());
                refusals.push(format!("not run: {}: {reason}\n", super::describe(&row.settings)));
            }
        }
    }
    lines.extend(owned.iter().map(|line| line.iter().map(String::as_str).collect::<Vec<_>>()));
    let plural = |count: usize| if count == 1 { "" } else { "s" };
    let (runs, of_them) = (plural(seeds), plural(rows.len()));
    format!(
        "{scenario}: {seeds} seed{runs} for each of {} combination{of_them}; the spread is the standard deviation\n{}{}",
        rows.len(),
        aligned(&lines, keys.len() + 1),
        refusals.concat()
    )
}

fn three_lines(row: &Row, figures: [Option<Figures>; FIGURES.len()]) -> [Vec<String>; 3] {
    let line = |name: &str, pick: &dyn Fn(&Figure, &Figures) -> Option<String>| {
        let is_first = name == "mean";
        let values =
            row.settings.iter().map(|setting| if is_first { setting.shown() } else { String::new() });
        let cells = FIGURES.iter().zip(&figures).map(|(figure, found)| {
            found.as_ref().and_then(|found| pick(figure, found)).unwrap_or_else(|| "-".to_owned())
        });
        values.chain([name.to_owned()]).chain(cells).collect()
    };
    [
        line("mean", &|figure, found| Some(number(found.mean, figure.decimals[1]))),
        line("spread", &|figure, found| found.spread.map(|spread| number(spread, figure.decimals[1]))),
        line("worst", &|figure, found| Some(number(found.worst, figure.decimals[0]))),
    ]
}

fn number(value: f64, decimals: usize) -> String {
    // Summaries tell an unbounded width as the widest number there is.
    if value.abs() < 1e15 { format!("{value:.decimals$}") } else { "unbounded".to_owned() }
}

/// The first `words` columns to the left, the others to the right.
fn aligned(lines: &[Vec<&str>], words: usize) -> String {
    let columns = lines.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        lines.iter().filter_map(|line| line.get(column)).map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut text = String::new();
    for line in lines {
        let cells: Vec<String> = line
            .iter()
            .zip(&widths)
            .enumerate()
            .map(
                |(column, (cell, &width))| {
                    if column < words { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
                },
            )
            .collect();
        text += cells.join("  ").trim_end();
        text.push('\n');
    }
    text
}

/// One line for each combination, behind a line of names; what is missing is empty.
pub fn csv(keys: &[&str], rows: &[Row]) -> String {
    let mut names: Vec<String> = keys.iter().map(|key| quoted(key)).collect();
    names.push("runs".to_owned());
    for figure in &FIGURES {
        names.extend(["mean", "spread", "worst"].map(|what| format!("{}_{what}", figure.name)));
    }
    names.push("not_run".to_owned());
    let mut text = names.join(",") + "\n";
    for row in rows {
        let (summaries, reason) = match &row.outcome {
            Outcome::Ran(summaries) => (&summaries[..], ""),
            Outcome::Stopped(_, reason) => (&[][..], &**reason),
        };
        let mut cells: Vec<String> = row.settings.iter().map(|setting| quoted(&setting.shown())).collect();
        cells.push(summaries.len().to_string());
        for figure in &FIGURES {
            let found = Figures::over(figure, summaries);
            let parts = [found.map(|it| it.mean), found.and_then(|it| it.spread), found.map(|it| it.worst)];
            cells.extend(parts.map(|part| part.map_or_else(String::new, |part| part.to_string())));
        }
        cells.push(quoted(reason));
        text += &(cells.join(",") + "\n");
    }
    text
}

/// A field of comma-separated values (RFC 4180).
fn quoted(field: &str) -> String {
    if field.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", field.replace('"', "\"\""))
    } else {
        field.to_owned()
    }
}
