//! Whether the truth was inside: what the channel counted, and what the record shows again.

use serde_json::Value;

use super::gather::Run;
use super::page::{Block, Table};
use crate::summary_text::grouped;

/// The one sentence to know.
pub fn verdict(run: &Run) -> Block {
    let is_good = run.number("/containment/violations") == Some(0.0);
    Block::Verdict { is_good, text: counted(run) }
}

/// What the channel counted.
fn counted(run: &Run) -> String {
    let count = |pointer: &str| run.number(pointer).map(|count| count as u64);
    match (count("/containment/checks"), count("/containment/violations")) {
        (Some(0), Some(_)) => "Nothing was checked.".to_owned(),
        (Some(checks), Some(0)) => format!("No enclosure lost the truth in {} checks.", grouped(checks)),
        (Some(checks), Some(1)) => format!("1 enclosure lost the truth in {} checks.", grouped(checks)),
        (Some(checks), Some(violations)) => {
            format!("{} enclosures lost the truth in {} checks.", grouped(violations), grouped(checks))
        }
        _ => "The record ends before the run does: nothing is proven about its end.".to_owned(),
    }
}

/// The section.
pub fn blocks(run: &Run) -> Vec<Block> {
    let (outside, compared) = run.margins.outside();
    let mut blocks = vec![
        Block::Heading("Containment".to_owned()),
        Block::Text(
            "While the simulation ran, the channel, which alone knows the truth, compared it with every enclosure that an AUV \
             stated: its box and clock interval at each tick, its slice since the tick before at a moment in it, and the box, \
             velocities and emission time that each ping carries. An enclosure that emptied counts as one that lost the truth. \
             Kalman filters promise nothing and are not counted."
                .to_owned(),
        ),
        Block::Text(counted(run)),
    ];
    blocks.extend(counted_apart(run));
    let first = run.rows("/containment/first");
    if !first.is_empty() {
        blocks.push(Block::Table(violations(first)));
    }
    blocks.push(Block::Text(format!(
        "The same, found again for this report from the truth and the reports in the record: {} comparisons, {}. The margin is how \
         far the truth is from the nearer bound, negative outside. Slices are compared at both of their ends here; what pings carry, and \
         moments between ticks, are not in the record as truth and were checked by the channel alone. What the channel counts apart \
         is counted here like the rest.",
        grouped(compared),
        match outside {
            0 => "the truth was inside in all".to_owned(),
            count => format!("the truth was outside in {}", grouped(count)),
        }
    )));
    blocks.push(Block::Table(run.margins.table(|auv| run.name(auv))));
    blocks
}

/// Losses of the truth that no promise covers.
fn counted_apart(run: &Run) -> Option<Block> {
    let mut parts = Vec::new();
    let count = |pointer: &str| run.number(pointer).unwrap_or(0.0) as u64;
    let misled = count("/containment/misled/auvs");
    if misled > 0 {
        parts.push(format!(
            "{} misled by what they heard, whose enclosures lost the truth {} times",
            auvs(misled),
            grouped(count("/containment/misled/violations"))
        ));
    }
    if run.summary.pointer("/containment/kidnapped").is_some_and(|value| !value.is_null()) {
        parts.push(format!(
            "{} of {} kidnappings noticed, with {} enclosures without the truth until then",
            count("/containment/kidnapped/noticed"),
            count("/containment/kidnapped/kidnappings"),
            grouped(count("/containment/kidnapped/violations"))
        ));
    }
    (!parts.is_empty()).then(|| Block::Text(format!("Counted apart: {}.", parts.join("; "))))
}

fn auvs(count: u64) -> String {
    if count == 1 { "1 AUV".to_owned() } else { format!("{} AUVs", grouped(count)) }
}

fn violations(lines: &[Value]) -> Table {
    let mut table = Table::new(&["AUV", "at", "enclosure", "coordinate", "outside by"]);
    let text = |line: &Value, key: &str| line[key].as_str().unwrap_or("–").to_owned();
    for line in lines {
        let margin = match line["margin"].as_f64() {
            Some(margin) => format!("{margin:.6} {}", text(line, "unit")),
            None => "–".to_owned(),
        };
        let at = format!("{:.3} s", line["time_s"].as_f64().unwrap_or(f64::NAN));
        table.row([text(line, "name"), at, text(line, "enclosure"), text(line, "coordinate"), margin]);
    }
    table
}
