//! What the messages of a record say against each other.

use std::collections::BTreeMap;

use mcap::records::MessageHeader;
use serde::Deserialize;

use super::super::frames::Frame;
use super::super::{
    Damage, METADATA_OUTCOME, METADATA_RECOVERED, METADATA_RUN, Row, Topic, auvs_of, rows_of,
};
use super::Fault;

/// Who says what.
#[derive(Default)]
pub(super) struct Meaning {
    run: BTreeMap<String, String>,
    outcome: BTreeMap<String, String>,
    /// What was lost, when the record was recovered.
    pub(super) recovered: Option<String>,
    has_scenario: bool,
    auvs: Option<usize>,
    summary: Option<Told>,
    /// Number that the next message must have.
    sequence: u32,
    /// Where the first message with another number stands.
    skipped: Option<(u64, u64)>,
}

/// What the summary tells of the run.
#[derive(Deserialize)]
struct Told {
    scenario: String,
    seed: u64,
    digest: String,
    reproducible: bool,
    auvs: usize,
    containment: super::super::Containment,
}

impl Meaning {
    /// Version of the record's layout.
    pub(super) fn format(&self) -> Option<u32> {
        self.run.get("format").and_then(|format| format.parse().ok())
    }

    /// The digest, and whether scenario and seed determine it.
    pub(super) fn digest(&self) -> Option<(String, bool)> {
        self.summary.as_ref().map(|told| (told.digest.clone(), told.reproducible))
    }

    pub(super) fn take_metadata(&mut self, name: &str, entries: BTreeMap<String, String>) {
        match name {
            METADATA_RUN => self.run = entries,
            METADATA_OUTCOME => self.outcome = entries,
            METADATA_RECOVERED => self.recovered = entries.get("lost").cloned(),
            _ => {}
        }
    }

    pub(super) fn take_attachment(&mut self, name: &str, data: &[u8]) {
        self.has_scenario |= name == "scenario.toml" && std::str::from_utf8(data).is_ok();
    }

    pub(super) fn take_message(
        &mut self,
        topic: &str,
        header: &MessageHeader,
        data: &[u8],
        frame: &Frame,
        visit: &mut dyn FnMut(Row),
    ) -> Result<(), Damage> {
        if header.sequence != self.sequence || header.publish_time != header.log_time {
            self.skipped.get_or_insert((frame.offset, frame.end));
        }
        self.sequence = header.sequence.wrapping_add(1);
        match Topic::named(topic) {
            Some(Topic::Auvs) => self.auvs = Some(auvs_of(data)?.len()),
            Some(Topic::Summary) => {
                self.summary = Some(serde_json::from_slice(data).map_err(Damage::Summary)?);
            }
            Some(topic @ (Topic::Poses | Topic::Log)) => {
                serde_json::from_slice::<serde::de::IgnoredAny>(data)
                    .map_err(|source| Damage::Rows { topic: topic.name(), source })?;
            }
            Some(topic) => rows_of(topic, data, visit)?,
            None => {}
        }
        Ok(())
    }

    /// What does not agree, in a file of so many bytes whose bytes do.
    pub(super) fn faults(&self, size: u64, is_complete: bool) -> Vec<Fault> {
        let mut faults = Vec::new();
        let mut check = |is_true: bool, what: &'static str, says: &'static str| {
            if !is_true {
                faults.push(Fault::at(0, size, "run", Damage::Untrue { what, says }));
            }
        };
        let is_intact = self.recovered.is_none();
        let says =
            |of: &BTreeMap<String, String>, key: &str, value: &str| of.get(key).is_some_and(|it| it == value);
        if is_complete && is_intact {
            check(self.has_scenario, "attachment `scenario.toml`", "is missing");
            check(self.auvs.is_some(), "list of AUVs", "is missing");
            check(
                self.outcome.is_empty() == self.summary.is_none(),
                "outcome",
                "comes without its summary, or the other way round",
            );
        }
        if let Some(auvs) = self.auvs {
            check(says(&self.run, "auvs", &auvs.to_string()), "number of AUVs", "is not that of the list");
        }
        if let Some(told) = &self.summary {
            let Told { scenario, seed, digest, reproducible, auvs, containment } = told;
            check(says(&self.run, "scenario", scenario), "scenario", "is another in the summary");
            check(says(&self.run, "seed", &seed.to_string()), "seed", "is another in the summary");
            check(says(&self.run, "auvs", &auvs.to_string()), "number of AUVs", "is another in the summary");
            if !self.outcome.is_empty() {
                check(says(&self.outcome, "digest", digest), "digest", "is another in the summary");
                let text = reproducible.to_string();
                check(
                    says(&self.outcome, "reproducible", &text),
                    "word `reproducible`",
                    "is another in the summary",
                );
                let is_same = says(&self.outcome, "checks", &containment.checks.to_string())
                    && says(&self.outcome, "violations", &containment.violations.to_string());
                check(is_same, "outcome of the checks", "is another in the summary");
            }
        }
        if let (Some((from, to)), true) = (self.skipped, is_intact) {
            let damage = Damage::Untrue { what: "number of a message", says: "is not the next one" };
            faults.push(Fault::at(from, to, "chunk", damage));
        }
        faults
    }
}
