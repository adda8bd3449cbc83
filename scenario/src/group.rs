//! One `[[group]]`: a number of like AUVs.

use std::collections::BTreeMap;

use toml::de::DeValue;

use crate::body::Catalogues;
use crate::command::command;
use crate::environment::norm;
use crate::estimating::estimator;
use crate::model::{AuvSabotage, Environment, Estimator, Group, Level, Modem};
use crate::modem::{Surroundings as ModemSurroundings, in_seconds, modem, packet_arithmetic, packet_ns};
use crate::reader::Table;
use crate::relative::relative;
use crate::sensing::{PERIOD_MAX_NS, PERIOD_MIN_NS};
use crate::start::start;
use crate::steering::{Surroundings, controller};
use crate::{AUVS_MAX, window_limit_ns};

const SABOTAGES: &[(&str, Option<AuvSabotage>)] = &[
    ("halved-clock", Some(AuvSabotage::HalvedClock)),
    ("lying-ping", Some(AuvSabotage::LyingPing)),
    ("empty-set", Some(AuvSabotage::EmptySet)),
];
const TENTH_NS: i64 = 100_000_000;

/// What was read of a group: `group` only when all of it is good, the rest as far as it is.
pub(crate) struct GroupRead {
    /// Its name as written, or nothing.
    pub(crate) name: String,
    pub(crate) group: Option<Group>,
    pub(crate) count: Option<u32>,
    /// Longest window that this group allows.
    pub(crate) window_limit_ns: Option<i64>,
    /// Greatest speed through the still water in m/s.
    pub(crate) fastest_m_s: Option<f64>,
}

pub(crate) fn group(
    table: Table<'_>,
    named: &Catalogues,
    environment: Option<&Environment>,
    group_names: &[&str],
    auvs: Option<u32>,
) -> GroupRead {
    let name = table.text("name", None).filter(|name| name_is_good(&table, "name", name));
    let count =
        table.whole("count", None, 1, u64::from(AUVS_MAX)).and_then(|count| u32::try_from(count).ok());
    let kind = named.kinds.of_group(&table);
    let clock = named.clocks.of_group(&table);
    let control_period_ns = control_period(&table);
    let reaction_ns = table.time_ns("reaction_s", Some(TENTH_NS), PERIOD_MIN_NS);
    let sensors = named.sensors.of_group(&table);
    let modem = modem(&table, &ModemSurroundings { environment, auvs });
    let estimator = estimator(&table);
    let relative = relative(&table, modem.as_ref());
    let controller = controller(&table, &Surroundings { kind: kind.as_ref(), environment, group_names });
    let start = start(&table, environment, kind.as_ref(), controller.as_ref(), count);
    let sabotage = table.choice("sabotage", SABOTAGES, None);
    let command = command(&table);
    if let (Some(estimator), Some(modem)) = (&estimator, &modem) {
        remembers_a_packet(&table, environment, estimator, modem);
    }
    table.finish();
    let window_limit_ns = match (reaction_ns, &clock) {
        (Some(reaction_ns), Some(clock)) => Some(window_limit_ns(reaction_ns, clock.drift_bound)),
        _ => None,
    };
    let fastest_m_s = kind.as_ref().map(|kind| kind.speed_max_m_s + norm(kind.disturbance_m_s));
    let assemble = || {
        Some(Group {
            name: name?.to_string(),
            count: count?,
            kind: kind?,
            clock: clock?,
            sensors: sensors?,
            modem: modem?,
            start: start?,
            control_period_ns: control_period_ns?,
            reaction_ns: reaction_ns?,
            estimator: estimator?,
            relative: relative?,
            controller: controller?,
            sabotage: sabotage?,
            command: command?,
        })
    };
    let written = name.unwrap_or_default().to_string();
    GroupRead { name: written, group: assemble(), count, window_limit_ns, fastest_m_s }
}

/// A ping is told at its end and stamped at its beginning, which the tube must still remember.
fn remembers_a_packet(
    table: &Table<'_>,
    environment: Option<&Environment>,
    estimator: &Estimator,
    modem: &Modem,
) {
    let (Estimator::Tube(tube), Some(layer)) = (estimator, &modem.physical) else { return };
    let takes_time = matches!(environment.map(|environment| &environment.level), Some(Level::Sea(_)));
    if !takes_time || tube.horizon_ns > packet_ns(layer) {
        return;
    }
    table.refuse(
        "estimator",
        format!(
            "the tube remembers {} s, but a packet takes {}: all that is heard would come too late",
            in_seconds(tube.horizon_ns),
            packet_arithmetic(layer)
        ),
        "forgets a packet's beginning before its end",
        "write a `horizon_s` of twice that or more",
    );
}

fn control_period(table: &Table<'_>) -> Option<i64> {
    let period_ns = table.time_ns("control_period_s", Some(TENTH_NS), 1)?;
    if period_ns < PERIOD_MIN_NS {
        table.refuse(
            "control_period_s",
            "an AUV wakes at most a thousand times a second",
            "shorter than 0.001 s",
            "write `control_period_s = 0.001` or more",
        );
        return None;
    }
    if period_ns > PERIOD_MAX_NS {
        table.refuse(
            "control_period_s",
            "an AUV wakes at least every 1000 s",
            "longer than 1000 s",
            "write `control_period_s = 1000` or less",
        );
        return None;
    }
    Some(period_ns)
}

/// Whether a name can be part of file names and of `NAME-0`.
pub(crate) fn name_is_good(table: &Table<'_>, key: &str, name: &str) -> bool {
    let good = (1..=64).contains(&name.len())
        && name.bytes().all(|byte| byte.is_ascii_alphanumeric() || matches!(byte, b'-' | b'_'));
    if !good {
        table.refuse(
            key,
            "a name has 1 to 64 letters, digits, `-` and `_`",
            "not usable as a name",
            "write for example `swarm-3`",
        );
    }
    good
}

/// The names of all groups, empty for those without one, and errors for those that come twice.
pub(crate) fn group_names<'t>(tables: &[Table<'t>]) -> Vec<&'t str> {
    let mut first_by_name = BTreeMap::new();
    let mut names = Vec::new();
    for table in tables {
        let name = table.get("name").and_then(|value| value.get_ref().as_str()).unwrap_or_default();
        names.push(name);
        if name.is_empty() {
            continue;
        }
        let span = table.span("name");
        let first = first_by_name.entry(name).or_insert_with(|| span.clone());
        if *first != span {
            table.findings.add_related(
                span,
                format!("two groups are called `{}`", name.escape_debug()),
                "second one",
                Some((first.clone(), "first one".into())),
                "give each group a name of its own",
            );
        }
    }
    names
}

/// The number of AUVs of all groups, as far as it can be told before they are read; wrong counts are reported with their
/// group.
pub(crate) fn auvs_written(tables: &[Table<'_>]) -> Option<u32> {
    let mut counts = tables.iter().map(|table| match table.get("count")?.get_ref() {
        DeValue::Integer(integer) => u32::from_str_radix(integer.as_str(), integer.radix()).ok(),
        _ => None,
    });
    counts.try_fold(0_u32, |auvs, count| auvs.checked_add(count?))
}
