//! Which messages are wanted.

use serde_json::Value;
use shoal_bus::record::rows::PingRow;
use shoal_bus::record::{Row, Topic};
use shoal_bus::traffic::LossReason;

use super::args::{ChoiceArgs, Kind};
use crate::failure::Failure;
use crate::filter::{Fields, Filter, similar};

/// Chooses messages of one topic.
pub struct Choice {
    kinds: Vec<Kind>,
    reasons: Vec<LossReason>,
    filter: Option<Filter>,
}

const REASONS: [LossReason; 10] = [
    LossReason::Range,
    LossReason::Noise,
    LossReason::Collision,
    LossReason::HalfDuplex,
    LossReason::Shadow,
    LossReason::Asleep,
    LossReason::Band,
    LossReason::Busy,
    LossReason::Late,
    LossReason::Dead,
];

impl Choice {
    /// What `args` choose among messages of `topic`.
    pub fn new(args: &ChoiceArgs, topic: Topic) -> Result<Self, Failure> {
        if topic != Topic::Pings && (!args.kind.is_empty() || args.lost.is_some()) {
            let sentence = "--kind and --lost choose pings; choose other messages with --filter";
            return Err(Failure::usage(sentence));
        }
        let mut kinds = args.kind.clone();
        let mut reasons = Vec::new();
        if let Some(names) = &args.lost {
            if kinds.iter().any(|kind| *kind != Kind::Lost) {
                return Err(Failure::usage("--lost shows lost pings only: leave --kind out, or --lost"));
            }
            kinds = vec![Kind::Lost];
            reasons = names.iter().map(|name| reason(name)).collect::<Result<_, _>>()?;
        }
        let parsed = |text: &String| {
            let filter = Filter::parse(text).map_err(Failure::usage)?;
            filter.check(&Fields::of(topic)).map_err(Failure::usage)?;
            Ok(filter)
        };
        Ok(Self { kinds, reasons, filter: args.filter.as_ref().map(parsed).transpose()? })
    }

    /// Whether everything is wanted.
    pub fn is_all(&self) -> bool {
        self.kinds.is_empty() && self.reasons.is_empty() && self.filter.is_none()
    }

    /// Whether `row` is wanted; with its JSON, where that was needed to find out.
    pub fn takes(&self, row: &Row) -> Option<Option<Value>> {
        if let Row::Ping(ping) = row {
            let (kind, reason) = match ping {
                PingRow::Emitted { .. } => (Kind::Emitted, None),
                PingRow::Heard { .. } => (Kind::Heard, None),
                PingRow::Lost { reason, .. } => (Kind::Lost, Some(reason)),
            };
            if !self.kinds.is_empty() && !self.kinds.contains(&kind) {
                return None;
            }
            if !self.reasons.is_empty() && reason.is_none_or(|reason| !self.reasons.contains(reason)) {
                return None;
            }
        }
        let Some(filter) = &self.filter else { return Some(None) };
        let json = serde_json::to_value(row).ok()?;
        filter.matches(&json).then_some(Some(json))
    }
}

fn reason(name: &str) -> Result<LossReason, Failure> {
    REASONS.into_iter().find(|reason| reason.name() == name).ok_or_else(|| {
        let names = || REASONS.iter().map(|reason| reason.name());
        let fix = match similar(name, names()) {
            Some(similar) => format!("did you mean `{similar}`?"),
            None => format!("reasons are {}", names().collect::<Vec<_>>().join(", ")),
        };
        Failure::usage(format!("--lost={name}: pings are not lost for this reason; {fix}"))
    })
}
