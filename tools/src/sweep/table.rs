//! The table of a sweep, for people and for programs.

use shoal_bus::summary::Summary;

use super::figures::{FIGURES, Figure, Shown};
use super::{Figures, Outcome, Row, RunOutcome};
use crate::set::Setting;

impl Row {
    /// What the runs that got to their end amount to.
    fn summaries(&self) -> impl Iterator<Item = &Summary> + Clone {
        self.runs().iter().filter_map(|(_, outcome)| outcome.summary())
    }

    fn runs(&self) -> &[(u64, RunOutcome)] {
        match &self.outcome {
            Outcome::Ran(runs) => runs,
            Outcome::Refused(_) => &[],
        }
    }

    /// What went wrong, run by run.
    fn troubles(&self) -> impl Iterator<Item = (u64, String)> {
        self.runs().iter().filter_map(|(seed, outcome)| Some((*seed, outcome.trouble()?)))
    }
}

/// Four lines for each combination: mean, spread, best and worst case over the seeds; then what went wrong, a line each.
pub fn text(scenario: &str, keys: &[&str], rows: &[Row]) -> String {
    let is_shown = |figure: &&Figure| {
        let mut values = rows.iter().flat_map(Row::summaries).filter_map(figure.of);
        figure.shown == Shown::Always || figure.shown == Shown::WhereAny && values.any(|value| value != 0.0)
    };
    let figures: Vec<&Figure> = FIGURES.iter().filter(is_shown).collect();
    let titles = keys.iter().copied().chain(["over seeds"]).chain(figures.iter().map(|figure| figure.title));
    let mut lines: Vec<Vec<String>> = vec![titles.map(str::to_owned).collect()];
    let mut troubles = String::new();
    for row in rows {
        match &row.outcome {
            Outcome::Ran(_) => lines.extend(four_lines(row, &figures)),
            Outcome::Refused(reason) => {
                let values = row.settings.iter().map(Setting::shown);
                lines.push(values.chain(["not run".to_owned()]).collect());
                troubles += &format!("not run: {}: {reason}\n", super::describe(&row.settings));
            }
        }
        for (seed, trouble) in row.troubles() {
            let values = row.settings.iter().map(Setting::to_string).chain([format!("seed {seed}")]);
            troubles += &format!("{}: {trouble}\n", values.collect::<Vec<_>>().join(" "));
        }
    }
    let seeds = rows.iter().map(|row| row.runs().len()).max().unwrap_or(0);
    let plural = |count: usize| if count == 1 { "" } else { "s" };
    let (runs, of_them) = (plural(seeds), plural(rows.len()));
    format!(
        "{scenario}: {seeds} seed{runs} for each of {} combination{of_them}; the spread is the standard deviation\n{}{troubles}",
        rows.len(),
        aligned(&lines, keys.len() + 1),
    )
}

fn four_lines(row: &Row, figures: &[&Figure]) -> [Vec<String>; 4] {
    let found: Vec<_> = figures.iter().map(|figure| Figures::over(figure, row.summaries())).collect();
    let line = |name: &str, decimals: usize, pick: &dyn Fn(&Figures) -> Option<f64>| {
        let is_first = name == "mean";
        let values =
            row.settings.iter().map(|setting| if is_first { setting.shown() } else { String::new() });
        let cells = figures.iter().zip(&found).map(|(figure, found)| {
            let value = found.as_ref().and_then(pick);
            value.map_or_else(|| "-".to_owned(), |value| number(value, figure.decimals[decimals]))
        });
        values.chain([name.to_owned()]).chain(cells).collect()
    };
    [
        line("mean", 1, &|found| Some(found.mean)),
        line("spread", 1, &|found| found.spread),
        line("best", 0, &|found| Some(found.best)),
        line("worst", 0, &|found| Some(found.worst)),
    ]
}

fn number(value: f64, decimals: usize) -> String {
    // Summaries tell an unbounded width as the widest number there is.
    if value.abs() < 1e15 { format!("{value:.decimals$}") } else { "unbounded".to_owned() }
}

/// The first `words` columns to the left, the others to the right.
fn aligned(lines: &[Vec<String>], words: usize) -> String {
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

/// One line for each combination, behind a line of names, and one for each run in which something went wrong, with its seed; what is
/// missing is empty.
pub fn csv(keys: &[&str], rows: &[Row]) -> String {
    let mut names: Vec<String> = keys.iter().map(|key| quoted(key)).collect();
    names.extend(["seed", "runs", "failed"].map(str::to_owned));
    for figure in &FIGURES {
        names.extend(["mean", "spread", "best", "worst"].map(|what| format!("{}_{what}", figure.name)));
    }
    names.push("reason".to_owned());
    let mut text = names.join(",") + "\n";
    for row in rows {
        let values: Vec<String> = row.settings.iter().map(|setting| quoted(&setting.shown())).collect();
        let ran = row.summaries().count();
        let mut cells = values.clone();
        cells.extend([String::new(), ran.to_string(), (row.runs().len() - ran).to_string()]);
        for figure in &FIGURES {
            let found = Figures::over(figure, row.summaries());
            let parts = [
                found.map(|it| it.mean),
                found.and_then(|it| it.spread),
                found.map(|it| it.best),
                found.map(|it| it.worst),
            ];
            cells.extend(parts.map(|part| part.map_or_else(String::new, |part| part.to_string())));
        }
        cells.push(if let Outcome::Refused(reason) = &row.outcome { quoted(reason) } else { String::new() });
        text += &(cells.join(",") + "\n");
        for (seed, trouble) in row.troubles() {
            let empty = ",".repeat(2 + 4 * FIGURES.len());
            let cells = values.iter().cloned().chain([seed.to_string(), empty + &quoted(&trouble)]);
            text += &(cells.collect::<Vec<_>>().join(",") + "\n");
        }
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
