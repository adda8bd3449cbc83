//! The key `estimator` of a group: by name, or as a table with a `name`.

use toml::de::{DeTable, DeValue};

use crate::model::{EkfSettings, Estimator, Fusion, Outliers, Recovery, TubeSettings};
use crate::number::Rule;
use crate::reader::Table;

const NAMES: [&str; 3] = ["tube", "ekf", "dead-reckoning"];
pub(crate) const RECOVERIES: &[(&str, Recovery)] =
    &[("drop", Recovery::Drop), ("relax", Recovery::Relax), ("restart", Recovery::Restart)];
pub(crate) const FUSIONS: &[(&str, Fusion)] =
    &[("independent", Fusion::Independent), ("covariance-intersection", Fusion::CovarianceIntersection)];
const HORIZON_DEFAULT_NS: i64 = 10_000_000_000;
/// More rings cost more than they tell: the older ones have been worn wide by odometry.
pub(crate) const RINGS_MAX: u64 = 256;

/// What a group that says nothing estimates with.
const TUBE: TubeSettings = TubeSettings {
    horizon_ns: HORIZON_DEFAULT_NS,
    // Measured on the library: more tell nothing that these do not, and cost more (BENCHMARKS.md).
    rings: 6,
    stopping_ratio: 0.05,
    outliers: None,
    on_empty: Recovery::Drop,
};

pub(crate) fn estimator(group: &Table<'_>) -> Option<Estimator> {
    if !group.has("estimator") {
        group.get("estimator");
        return Some(Estimator::Tube(TUBE));
    }
    let (name, table) = group.name_or_table("estimator", "[group.estimator]")?;
    let empty = DeTable::new();
    let written = table.is_some();
    let table = table
        .unwrap_or_else(|| Table::new(&empty, group.span("estimator"), "[group.estimator]", group.findings));
    let read = match name {
        "tube" => tube(&table).map(Estimator::Tube),
        "ekf" => ekf(&table).map(Estimator::Ekf),
        "dead-reckoning" => Some(Estimator::DeadReckoning),
        _ => {
            let span = if written { table.span("name") } else { group.span("estimator") };
            group.unknown_name(span, "estimator", name, NAMES.into_iter());
            return None;
        }
    };
    table.finish();
    read
}

fn tube(table: &Table<'_>) -> Option<TubeSettings> {
    let horizon_ns = table.time_ns("horizon_s", Some(TUBE.horizon_ns), 1);
    let rings = table.whole("rings", Some(TUBE.rings.into()), 0, RINGS_MAX);
    let stopping_ratio = table.number("stopping_ratio", Some(TUBE.stopping_ratio), Rule::Within(0.001, 1.0));
    let outliers = match table.get("outliers").map(toml::Spanned::get_ref) {
        None | Some(DeValue::Boolean(false)) => Some(None),
        Some(_) => table.table("outliers", "[group.estimator.outliers]").and_then(outliers).map(Some),
    };
    let on_empty = table.choice("on_empty", RECOVERIES, TUBE.on_empty);
    Some(TubeSettings {
        horizon_ns: horizon_ns?,
        rings: rings? as u16,
        stopping_ratio: stopping_ratio?,
        outliers: outliers?,
        on_empty: on_empty?,
    })
}

fn outliers(table: Table<'_>) -> Option<Outliers> {
    let window = table.whole("window", Some(10), 1, RINGS_MAX);
    let tolerated = table.whole("tolerated", None, 0, RINGS_MAX);
    let margin = match table.has("margin") {
        true => table.whole("margin", None, 0, RINGS_MAX).map(Some),
        false => {
            table.get("margin");
            Some(None)
        }
    };
    let inlier_probability = match table.get("inlier_probability") {
        None => Some(None),
        Some(value) => table.number_in("inlier_probability", value, Rule::Within(0.0, 1.0)).map(Some),
    };
    let (window_value, tolerated_value) = (window.unwrap_or(RINGS_MAX), tolerated.unwrap_or(0));
    if tolerated_value >= window_value {
        table.refuse(
            "tolerated",
            format!(
                "of {window_value} pings, {tolerated_value} may be wrong: nothing would be left to believe"
            ),
            "not fewer than the `window`",
            format!("write `tolerated = {}` or less, or a larger `window`", window_value - 1),
        );
        return None;
    }
    table.finish();
    Some(Outliers {
        window: window? as u16,
        tolerated: tolerated? as u16,
        margin: margin?.map(|margin| margin as u16),
        inlier_probability: inlier_probability?,
    })
}

fn ekf(table: &Table<'_>) -> Option<EkfSettings> {
    let gate_sigma = match table.get("gate_sigma") {
        None => Some(3.0),
        Some(value) if matches!(value.get_ref(), DeValue::Boolean(false)) => Some(f64::INFINITY),
        Some(value) => table.number_in("gate_sigma", value, Rule::Positive),
    };
    let fusion = table.choice("fusion", FUSIONS, Fusion::Independent);
    Some(EkfSettings { gate_sigma: gate_sigma?, fusion: fusion? })
}
