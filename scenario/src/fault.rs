//! The tables `[[fault]]`: what goes wrong on purpose, beyond what any AUV is told.

use toml::de::DeValue;

use crate::environment::contains;
use crate::model::{Environment, Fault};
use crate::number::Rule;
use crate::reader::Table;
use crate::{AUVS_MAX, TABLES_MAX};

/// The kinds by their names in scenario files.
const KINDS: &[(&str, ())] = &[("kidnap", ())];

pub(crate) fn faults(
    document: &Table<'_>,
    auvs: Option<u32>,
    duration_ns: Option<i64>,
    environment: Option<&Environment>,
) -> Option<Vec<Fault>> {
    let listed = match document.get("fault").map(toml::Spanned::get_ref) {
        None => return Some(Vec::new()),
        Some(DeValue::Array(listed)) if listed.len() <= TABLES_MAX => listed,
        Some(DeValue::Array(listed)) => {
            document.refuse(
                "fault",
                format!("{} faults; a scenario has at most {TABLES_MAX}", listed.len()),
                "too many faults",
                "leave some out",
            );
            return None;
        }
        Some(_) => {
            document.refuse(
                "fault",
                "`fault` must be a list of tables",
                "expected tables",
                "write `[[fault]]`",
            );
            return None;
        }
    };
    let mut faults = Vec::new();
    for value in listed.iter() {
        match value.get_ref() {
            DeValue::Table(entries) => {
                let table = Table::new(entries, value.span(), "[[fault]]", document.findings);
                faults.push(kidnap(table, auvs, duration_ns, environment));
            }
            _ => document.wrong_type_as("fault", value, "a list of tables", "[[fault]]"),
        }
    }
    faults.into_iter().collect()
}

fn kidnap(
    table: Table<'_>,
    auvs: Option<u32>,
    duration_ns: Option<i64>,
    environment: Option<&Environment>,
) -> Option<Fault> {
    if !table.has("kind") {
        table.missing("kind");
    }
    let kind = table.choice("kind", KINDS, ());
    let (auv, at_ns) =
        whom_and_when(&table, auvs, duration_ns, "the AUV would be kidnapped after the run has ended");
    let to_m = table.vec3("to_m", None, Rule::Finite);
    if let (Some(to_m), Some(environment)) = (to_m, environment)
        && !contains(&environment.area_m, to_m)
    {
        table.refuse(
            "to_m",
            "the AUV would be left outside the area, where it never looks for itself",
            "not inside `area_m`",
            "move it inside, or make `area_m` larger; z is up and 0 at the surface",
        );
    }
    table.finish();
    kind?;
    Some(Fault::Kidnap { auv: auv?, at_ns: at_ns?, to_m: to_m? })
}

/// `auv` and `at_s`: something happens to one AUV, which must exist, while the run lasts; else `too_late`.
pub(crate) fn whom_and_when(
    table: &Table<'_>,
    auvs: Option<u32>,
    duration_ns: Option<i64>,
    too_late: &str,
) -> (Option<u32>, Option<i64>) {
    let auv = table.whole("auv", None, 0, u64::from(AUVS_MAX)).and_then(|auv| u32::try_from(auv).ok());
    let at_ns = table.time_ns("at_s", None, 0);
    if let (Some(auv), Some(auvs)) = (auv, auvs)
        && auv >= auvs
    {
        table.refuse(
            "auv",
            format!("there is no AUV {auv}"),
            format!("the {auvs} AUVs are counted from 0"),
            format!("write a number from 0 to {}", auvs.saturating_sub(1)),
        );
    }
    if let (Some(at_ns), Some(duration_ns)) = (at_ns, duration_ns)
        && at_ns >= duration_ns
    {
        table.refuse(
            "at_s",
            too_late,
            "not before `duration_s`",
            "write an earlier time, or a longer `duration_s`",
        );
    }
    (auv, at_ns)
}
