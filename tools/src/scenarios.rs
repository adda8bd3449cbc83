//! `shoal scenarios` and `shoal check`.

use std::io::Write;

use serde_json::json;
use shoal_scenario::{library, load, parse};

use crate::exit::Exit;
use crate::failure::Failure;
use crate::terminal;

/// Lists the library, or prints the text of one scenario.
pub fn list(name: Option<&str>, as_json: bool) -> Result<Exit, Failure> {
    let mut text = String::new();
    if let Some(name) = name {
        text = load(name).map_err(Failure::usage)?.1;
    } else {
        for entry in library() {
            let scenario =
                parse(entry.name, entry.text).map_err(|errors| Failure::rendered(errors.render(false)))?;
            let (auvs, duration_s) = (scenario.auv_count(), scenario.duration_ns as f64 / 1e9);
            text += &if as_json {
                let line = json!({
                    "format": "shoal.scenario/1",
                    "name": scenario.name,
                    "summary": scenario.summary,
                    "source": scenario.source,
                    "auvs": auvs,
                    "duration_s": duration_s,
                });
                format!("{line}\n")
            } else {
                format!(
                    "{:<17} {auvs:>5} AUVs {duration_s:>5} s  {:<16} {}\n",
                    scenario.name, scenario.source, scenario.summary
                )
            };
        }
    }
    // A reader that has enough closes the pipe.
    let _closed = std::io::stdout().lock().write_all(text.as_bytes());
    Ok(Exit::Good)
}

/// Checks scenarios; all are checked before the first error ends it.
pub fn check(names: &[String]) -> Result<Exit, Failure> {
    let mut refused = Vec::new();
    for name in names {
        match load(name) {
            Err(error) => refused.push(format!("error: {error}")),
            Ok((source_name, text)) => match parse(&source_name, &text) {
                Err(errors) => refused.push(errors.render(terminal::stderr_has_colour())),
                Ok(scenario) => {
                    let (auvs, groups) = (scenario.auv_count(), scenario.groups.len());
                    let plural = if groups == 1 { "" } else { "s" };
                    println!(
                        "{source_name}: good: {auvs} AUVs in {groups} group{plural}, {} s",
                        scenario.duration_ns as f64 / 1e9
                    );
                    for warning in scenario.warnings() {
                        eprintln!("warning: {source_name}: {warning}");
                    }
                }
            },
        }
    }
    if refused.is_empty() { Ok(Exit::Good) } else { Err(Failure::rendered(refused.join("\n"))) }
}
