//! The whole document: the keys at the top, the groups, and what must hold between them.

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use crate::body::Catalogues;
use crate::current::fastest_current_m_s;
use crate::diagnostics::{Findings, ScenarioErrors};
use crate::environment::{environment, norm};
use crate::fault::{faults, whom_and_when};
use crate::group::{GroupRead, auvs_written, group, group_names, name_is_good};
use crate::model::{Environment, Level, Noise, OnCrash, Scenario, SoundSpeed, WaterSabotage};
use crate::reader::Table;
use crate::sound_speed::slowest_m_s;
use crate::time::ms_text;
use crate::{AUVS_MAX, TABLES_MAX};

const ON_CRASH: &[(&str, OnCrash)] = &[("drift", OnCrash::Drift), ("abort", OnCrash::Abort)];
const WINDOW_DEFAULT_NS: i64 = 90_000_000;
const KNOT_DEFAULT_NS: i64 = 10_000_000;
/// Below this, the rounding of a step would no longer be small beside the step.
const KNOT_MIN_NS: i64 = 100_000;
const MS_NS: i64 = 1_000_000;
/// Sound must be faster than this many times the fastest body: the reception of a ping is then unique, and soon found.
const SOUND_OVER_BODY: f64 = 2.0;

/// Reads and validates a scenario: TOML text to plain data with every default filled in.
///
/// `source_name` is what errors call the text, usually the path of its file.
///
/// # Errors
/// [`ScenarioErrors`] with every error that was found, each with its place, cause and fix.
///
/// # Example
/// ```
/// let text = r#"
/// name = "pair"
/// duration_s = 10
/// environment.area_m = [[0, 100], [0, 100], [-50, 0]]
/// [[group]]
/// name = "a"
/// count = 2
/// "#;
/// let scenario = shoal_scenario::parse("pair.toml", text)?;
/// assert_eq!(scenario.auv_count(), 2);
/// assert_eq!(scenario.window_ns, 90_000_000);
/// # Ok::<(), shoal_scenario::ScenarioErrors>(())
/// ```
pub fn parse(source_name: &str, text: &str) -> Result<Scenario, ScenarioErrors> {
    let findings = Findings::new(text);
    let (document, syntax_errors) = DeTable::parse_recoverable(text);
    for error in syntax_errors {
        let span = error.span().unwrap_or(0..0);
        findings.add(
            span,
            format!("not valid TOML: {}", error.message()),
            "",
            "correct the syntax; https://toml.io shows every form",
        );
    }
    // A document that is only half understood would raise errors that are none.
    if !findings.is_empty() {
        return Err(findings.into_errors(source_name));
    }
    let first_line = 0..text.lines().next().map_or(0, str::len);
    let scenario = read(Table::new(document.get_ref(), first_line, "the scenario", &findings));
    match scenario {
        Some(scenario) if findings.is_empty() => Ok(scenario),
        _ => Err(findings.into_errors(source_name)),
    }
}

fn read(table: Table<'_>) -> Option<Scenario> {
    let name = table.text("name", None).filter(|name| name_is_good(&table, "name", name));
    let summary = table.text("summary", Some(""));
    let source = table.text("source", Some(""));
    let seed = table.whole("seed", Some(1), 0, u64::MAX);
    let duration_ns = table.time_ns("duration_s", None, 1);
    let knot_ns = table.time_ns("knot_ms", Some(KNOT_DEFAULT_NS), KNOT_MIN_NS);
    let noise = table.choice("noise", Noise::NAMES, Noise::Uniform);
    let on_crash = table.choice("on_crash", ON_CRASH, OnCrash::Drift);
    let environment = environment(&table);
    let groups = groups(&table, environment.as_ref());
    let auvs = auv_count(&table, &groups);
    sound_outruns_bodies(&table, environment.as_ref(), &groups);
    let window_ns = window(&table, &groups);
    let sabotage = sabotage(&table, auvs, duration_ns);
    let faults = faults(&table, auvs, duration_ns, environment.as_ref());
    table.finish();
    Some(Scenario {
        name: name?.to_string(),
        summary: summary?.to_string(),
        source: source?.to_string(),
        seed: seed?,
        duration_ns: duration_ns?,
        window_ns: window_ns?,
        knot_ns: knot_ns?,
        noise: noise?,
        on_crash: on_crash?,
        environment: environment?,
        groups: groups.into_iter().map(|read| read.group).collect::<Option<_>>()?,
        sabotage: sabotage?,
        faults: faults?,
    })
}

fn groups(document: &Table<'_>, environment: Option<&Environment>) -> Vec<GroupRead> {
    let named = Catalogues::read(document);
    let listed: Option<&DeArray<'_>> = match document.get("group").map(Spanned::get_ref) {
        Some(DeValue::Array(listed)) if listed.len() > TABLES_MAX => {
            document.refuse(
                "group",
                format!("{} groups; a scenario has at most {TABLES_MAX}", listed.len()),
                "too many groups",
                "put like AUVs into one group with a larger `count`",
            );
            None
        }
        Some(DeValue::Array(listed)) if !listed.is_empty() => Some(listed),
        Some(DeValue::Table(_)) => {
            document.refuse(
                "group",
                "`group` must be a list of tables",
                "only one pair of brackets",
                "write `[[group]]`",
            );
            None
        }
        Some(_) => {
            document.refuse(
                "group",
                "`group` must be a list of tables",
                "expected tables",
                "write `[[group]]`",
            );
            None
        }
        None => {
            document.missing_as("group", "[[group]]` with a `name` and a `count");
            None
        }
    };
    let mut tables = Vec::new();
    for value in listed.into_iter().flat_map(|listed| listed.iter()) {
        match value.get_ref() {
            DeValue::Table(entries) => {
                tables.push(Table::new(entries, value.span(), "[[group]]", document.findings));
            }
            _ => document.wrong_type_as("group", value, "a list of tables", "[[group]]"),
        }
    }
    let names = group_names(&tables);
    let auvs = auvs_written(&tables);
    tables.into_iter().map(|table| group(table, &named, environment, &names, auvs)).collect()
}

/// The number of AUVs, when all groups have one and the sum is not too large.
fn auv_count(table: &Table<'_>, groups: &[GroupRead]) -> Option<u32> {
    let counts: Option<Vec<u32>> = groups.iter().map(|read| read.count).collect();
    let auvs: u64 = counts?.into_iter().map(u64::from).sum();
    if auvs > u64::from(AUVS_MAX) {
        table.refuse(
            "group",
            format!("{auvs} AUVs in all; a run has at most {AUVS_MAX}"),
            "the groups together are too many",
            "lower the groups' `count`",
        );
        return None;
    }
    u32::try_from(auvs).ok()
}

fn sound_outruns_bodies(table: &Table<'_>, environment: Option<&Environment>, groups: &[GroupRead]) {
    let Some(environment) = environment else { return };
    let fastest = groups.iter().filter_map(|read| read.fastest_m_s).fold(0.0, f64::max);
    let body_m_s = fastest + fastest_current_m_s(environment) + norm(environment.current_error_m_s);
    let profile = match &environment.level {
        Level::Sea(sea) if sea.sound_speed != SoundSpeed::Uniform => Some(&sea.sound_speed),
        _ => None,
    };
    let uniform_m_s = environment.sound_speed_m_s;
    let slowest_m_s = profile.map_or(uniform_m_s, |profile| slowest_m_s(profile, uniform_m_s));
    let sound_m_s = slowest_m_s - environment.sound_speed_error_m_s;
    if sound_m_s < SOUND_OVER_BODY * body_m_s {
        let said = table.table("environment", "[environment]").and_then(|environment| match profile {
            Some(_) => Some(environment.table("sea", "[environment.sea]")?.span("sound_speed")),
            None => Some(environment.span("sound_speed_m_s")),
        });
        let least_m_s = (SOUND_OVER_BODY * body_m_s).ceil();
        table.findings.add(
            said.unwrap_or(table.header()),
            format!(
                "sound at {sound_m_s} m/s is slower than twice the fastest body, {body_m_s:.3} m/s with current and \
                 disturbance"
            ),
            "too slow for these bodies",
            match profile {
                Some(_) => "slow the bodies, the current or the disturbance down".to_string(),
                None => format!("write {least_m_s} or more, or slow the bodies down"),
            },
        );
    }
}

fn window(table: &Table<'_>, groups: &[GroupRead]) -> Option<i64> {
    let limits = groups.iter().filter_map(|read| Some((read.window_limit_ns?, read.name.as_str())));
    let (limit_ns, group) = limits.min().unwrap_or((i64::MAX, ""));
    if !table.has("window_ms") {
        table.get("window_ms");
        let whole_ns = if limit_ns >= MS_NS { limit_ns - limit_ns % MS_NS } else { limit_ns };
        return Some(WINDOW_DEFAULT_NS.min(whole_ns));
    }
    let window_ns = table.time_ns("window_ms", None, 1)?;
    if window_ns > limit_ns {
        table.refuse(
            "window_ms",
            "a window must end before any AUV can act on what happens in it",
            format!("group `{group}` can act after {:.3} ms", limit_ns as f64 / 1e6),
            format!(
                "the largest allowed is `window_ms = {}`, from (reaction_s - 2 ns) / (1 + drift_bound)",
                ms_text(limit_ns)
            ),
        );
        return None;
    }
    Some(window_ns)
}

/// `[sabotage]`: promises broken on purpose, to prove that the checker notices.
fn sabotage(table: &Table<'_>, auvs: Option<u32>, duration_ns: Option<i64>) -> Option<Option<WaterSabotage>> {
    if !table.has("sabotage") {
        table.get("sabotage");
        return Some(None);
    }
    let sabotage = table.table("sabotage", "[sabotage]")?;
    if !sabotage.has("shifted_truth") {
        sabotage.missing("shifted_truth");
    }
    let shift = sabotage.table("shifted_truth", "[sabotage.shifted_truth]");
    sabotage.finish();
    let shift = shift?;
    let (auv, at_ns) =
        whom_and_when(&shift, auvs, duration_ns, "the truth would be shifted after the run has ended");
    shift.finish();
    Some(Some(WaterSabotage::ShiftedTruth { auv: auv?, at_ns: at_ns? }))
}
