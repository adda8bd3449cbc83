//! The topics of a record: their names, schemas and encodings.

use super::Source;

/// Message encoding of `/sensed` and `/born`: [`codec::encode`](crate::codec::encode) of `Vec<(SimTime, AuvId, Sensed)>` and of
/// `Vec<Born>`.
pub const SENSED_ENCODING: &str = "application/x-shoal-bincode";

/// One topic of a record.
///
/// ```
/// use shoal_bus::record::Topic;
/// assert_eq!((Topic::Pings.name(), Topic::Pings.schema_name()), ("/pings", "shoal.Pings/1"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Topic {
    /// Who takes part.
    Auvs,
    /// Poses for viewers.
    Poses,
    /// Violations and lost AUVs, for people.
    Log,
    /// Exact truth at the ticks.
    Ticks,
    /// What the AUVs answered and believed.
    Reports,
    /// What crossed the water.
    Pings,
    /// What the AUVs were told.
    Sensed,
    /// The outcome.
    Summary,
    /// What the AUVs were told at birth.
    Born,
    /// Trajectories reconstructed after the run.
    Offline,
    /// How the swarm moves and holds together.
    Flock,
}

impl Topic {
    /// All topics, in the order of their channels.
    pub const ALL: [Self; 11] = [
        Self::Auvs,
        Self::Poses,
        Self::Log,
        Self::Ticks,
        Self::Reports,
        Self::Pings,
        Self::Sensed,
        Self::Summary,
        Self::Born,
        Self::Offline,
        Self::Flock,
    ];

    /// The topic whose messages come from `source`; `None` for topics of others, and of other versions.
    pub fn of(source: &Source) -> Option<Self> {
        let is_it = |topic: &Self| source.topic == topic.name() && source.schema == topic.schema_name();
        Self::ALL.into_iter().find(is_it)
    }

    /// The topic of this name.
    ///
    /// ```
    /// use shoal_bus::record::Topic;
    /// assert_eq!(Topic::named("/pings"), Some(Topic::Pings));
    /// ```
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|topic| topic.name() == name)
    }

    /// The topic's name in the file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auvs => "/auvs",
            Self::Poses => "/truth",
            Self::Log => "/log",
            Self::Ticks => "/ticks",
            Self::Reports => "/reports",
            Self::Pings => "/pings",
            Self::Sensed => "/sensed",
            Self::Summary => "/summary",
            Self::Born => "/born",
            Self::Offline => "/offline",
            Self::Flock => "/flock",
        }
    }

    /// Name of its schema, with the version behind a slash.
    pub fn schema_name(self) -> &'static str {
        match self {
            Self::Auvs => "shoal.Auvs/1",
            Self::Poses => "foxglove.PosesInFrame",
            Self::Log => "foxglove.Log",
            Self::Ticks => "shoal.Truth/1",
            Self::Reports => "shoal.Reports/1",
            Self::Pings => "shoal.Pings/1",
            Self::Sensed => "shoal.Sensed/1",
            Self::Summary => "shoal.Summary/1",
            Self::Born => "shoal.Born/1",
            Self::Offline => "shoal.Offline/1",
            Self::Flock => "shoal.Flock/1",
        }
    }

    /// The schema: JSON Schema, except for `/sensed` and `/born`, whose layout is described in words.
    pub fn schema_text(self) -> &'static str {
        match self {
            Self::Auvs => include_str!("../../schemas/shoal.Auvs.1.json"),
            Self::Poses => include_str!("../../schemas/foxglove.PosesInFrame.json"),
            Self::Log => include_str!("../../schemas/foxglove.Log.json"),
            Self::Ticks => include_str!("../../schemas/shoal.Truth.1.json"),
            Self::Reports => include_str!("../../schemas/shoal.Reports.1.json"),
            Self::Pings => include_str!("../../schemas/shoal.Pings.1.json"),
            Self::Sensed => include_str!("../../schemas/shoal.Sensed.1.txt"),
            Self::Summary => include_str!("../../schemas/shoal.Summary.1.json"),
            Self::Born => include_str!("../../schemas/shoal.Born.1.txt"),
            Self::Offline => include_str!("../../schemas/shoal.Offline.1.json"),
            Self::Flock => include_str!("../../schemas/shoal.Flock.1.json"),
        }
    }

    /// Encoding of its schema.
    pub fn schema_encoding(self) -> &'static str {
        match self {
            Self::Sensed | Self::Born => "text/plain",
            _ => "jsonschema",
        }
    }

    /// Encoding of its messages.
    pub fn message_encoding(self) -> &'static str {
        match self {
            Self::Sensed | Self::Born => SENSED_ENCODING,
            _ => "json",
        }
    }
}
