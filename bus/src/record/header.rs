//! What stands at the beginning of a record.

use serde::{Deserialize, Serialize};

/// What stands at the beginning of a record.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RecordHeader {
    /// Name of the scenario.
    pub scenario_name: String,
    /// Seed of every random draw.
    pub seed: u64,
    /// The scenario as it was run, in TOML.
    pub scenario_text: String,
    /// Who takes part: an AUV's id is its index here.
    pub auvs: Vec<RecordedAuv>,
}

/// One AUV of a record: an element of `auvs` in `shoal.Auvs/1`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RecordedAuv {
    /// Display name, such as `green-17`.
    pub name: String,
    /// Index of its group.
    pub group: u16,
    /// Name of its group.
    pub group_name: String,
    /// Length of its body, in metres.
    pub length_m: f64,
}

/// The message of `/auvs`.
#[derive(Serialize)]
pub(super) struct Auvs<'a> {
    pub(super) auvs: &'a [RecordedAuv],
}
