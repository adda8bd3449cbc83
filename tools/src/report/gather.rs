//! Reads a record: figures, margins, pings by range, the summary.

use std::collections::BTreeSet;
use std::fs::File;
use std::path::Path;

use serde_json::Value;
use shoal_bus::message::AuvId;
use shoal_bus::record::{Ending, Item, RecordHeader, Topic, scan};
use shoal_scenario::Estimator;

use super::fates::Fates;
use super::margins::Margins;
use crate::failure::Failure;
use crate::figure::Figure;
use crate::plot::{Kind, Of, draw, plot_of};

/// What a report shows, in this order.
pub const KINDS: [(&str, Kind); 11] = [
    ("widths", Kind::Widths),
    ("tubes", Kind::Tubes),
    ("map", Kind::Map),
    ("links", Kind::Links),
    ("losses", Kind::Losses),
    ("reach", Kind::Reach),
    ("ranges", Kind::Ranges),
    ("sinr", Kind::Sinr),
    ("rays", Kind::Rays),
    ("flock", Kind::Flock),
    ("estimators", Kind::Estimators),
];

/// So many points of a line, or marks of a kind, a page shows: `shoal plot` shows more.
const POINTS_MAX: usize = 1_200;

/// All that a report says of one run.
pub struct Run {
    /// What stands at the beginning.
    pub header: RecordHeader,
    /// The record's `/summary`; null for a run that did not finish.
    pub summary: Value,
    /// As many as [`KINDS`]: the figure, or why there is none.
    pub figures: Vec<Result<Figure, String>>,
    /// How far inside its enclosures the truth is.
    pub margins: Margins,
    /// What became of pings by range.
    pub fates: Fates,
    /// The record ends before the run does.
    pub is_cut: bool,
}

impl Run {
    /// The figure of a kind.
    pub fn figure(&self, kind: Kind) -> Option<&Figure> {
        let index = KINDS.iter().position(|(_, known)| *known == kind)?;
        self.figures.get(index)?.as_ref().ok()
    }

    /// The number at a place of the summary, such as `/pings/heard`.
    pub fn number(&self, pointer: &str) -> Option<f64> {
        self.summary.pointer(pointer)?.as_f64()
    }

    /// The rows at a place of the summary.
    pub fn rows(&self, pointer: &str) -> &[Value] {
        self.summary.pointer(pointer).and_then(Value::as_array).map_or(&[], Vec::as_slice)
    }

    /// What an AUV is called.
    pub fn name(&self, auv: AuvId) -> String {
        self.header.auvs.get(auv.0 as usize).map_or_else(|| auv.to_string(), |told| told.name.clone())
    }
}

/// Reads the record twice: for its summary, and for its rows. Memory does not grow with the record, but for what figures keep.
pub fn gather(path: &Path, auv: u32) -> Result<Run, Failure> {
    let wrong = |error: &dyn std::fmt::Display| Failure::failed(format!("{}: {error}", path.display()));
    let open = || File::open(path).map_err(|error| wrong(&error));
    let (mut summary, mut auvs, mut text) = (Value::Null, Value::Null, String::new());
    scan(open()?, &mut |item| {
        match item {
            // What cannot be read is damage that the second pass reports.
            Item::Message { source, data, .. } if source.topic == Topic::Summary.name() => {
                summary = serde_json::from_slice(data).unwrap_or_default();
            }
            Item::Message { source, data, .. } if source.topic == Topic::Auvs.name() => {
                auvs = serde_json::from_slice(data).unwrap_or_default();
            }
            Item::Attachment { name: "scenario.toml", data, .. } => {
                text = String::from_utf8_lossy(data).into_owned();
            }
            _ => {}
        }
        Ok(())
    })
    .map_err(|error| wrong(&error))?;
    let mut margins = Margins::new(exempt(&text, &auvs));
    let mut fates = Fates::default();
    let of = Of { auv: Some(auv), ..Of::default() };
    let plots = KINDS.iter().map(|(_, kind)| plot_of(*kind, &of)).collect();
    let topics = [Topic::Ticks, Topic::Reports, Topic::Pings];
    let drawn = draw(open()?, plots, &topics, &mut |row| {
        margins.take(row);
        fates.take(row);
    })
    .map_err(|error| wrong(&error))?;
    if auv as usize >= drawn.header.auvs.len() {
        let auvs = drawn.header.auvs.len();
        return Err(Failure::usage(format!("there is no AUV {auv}: the record has {auvs}, counted from 0")));
    }
    let few = |figure: Result<Figure, String>| figure.map(|figure| figure.with_at_most(POINTS_MAX));
    Ok(Run {
        header: drawn.header,
        summary,
        figures: drawn.figures.into_iter().map(few).collect(),
        margins,
        fates,
        is_cut: matches!(drawn.ending, Ending::Truncated { .. }),
    })
}

/// AUVs whose estimator promises nothing: Kalman filters. None where the scenario is one of another version.
fn exempt(scenario_text: &str, auvs: &Value) -> BTreeSet<AuvId> {
    let Ok(scenario) = shoal_scenario::parse("scenario.toml of the record", scenario_text) else {
        return BTreeSet::new();
    };
    let auvs = auvs["auvs"].as_array().map_or(&[][..], Vec::as_slice);
    let is_kalman = |told: &Value| {
        let group = told["group"].as_u64().and_then(|group| scenario.groups.get(group as usize));
        group.is_some_and(|group| matches!(group.estimator, Estimator::Ekf(_)))
    };
    (0_u32..).zip(auvs).filter(|(_, told)| is_kalman(told)).map(|(index, _)| AuvId(index)).collect()
}
