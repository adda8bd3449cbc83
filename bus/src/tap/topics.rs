//! What a live run publishes.

use crate::chronicle::What;
use crate::record::Topic;

/// A topic that has a service of its own while a run is live. The other topics of a record follow from these and the
/// [`Cast`](super::Cast).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum LiveTopic {
    /// [`Topic::Ticks`].
    Ticks,
    /// [`Topic::Reports`].
    Reports,
    /// [`Topic::Pings`].
    Pings,
    /// [`Topic::Sensed`].
    Sensed,
    /// [`Topic::Log`].
    Log,
    /// [`Topic::Flock`].
    Flock,
}

impl LiveTopic {
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::Ticks, Self::Reports, Self::Pings, Self::Sensed, Self::Log, Self::Flock];

    /// The same in a record.
    ///
    /// ```
    /// use shoal_bus::record::Topic;
    /// use shoal_bus::tap::LiveTopic;
    /// assert_eq!(LiveTopic::Pings.topic(), Topic::Pings);
    /// ```
    pub fn topic(self) -> Topic {
        match self {
            Self::Ticks => Topic::Ticks,
            Self::Reports => Topic::Reports,
            Self::Pings => Topic::Pings,
            Self::Sensed => Topic::Sensed,
            Self::Log => Topic::Log,
            Self::Flock => Topic::Flock,
        }
    }

    /// The topic that the rows of `topic` are made from; `None` for one that needs no service.
    pub fn source_of(topic: Topic) -> Option<Self> {
        match topic {
            Topic::Ticks | Topic::Poses => Some(Self::Ticks),
            Topic::Reports => Some(Self::Reports),
            Topic::Pings => Some(Self::Pings),
            Topic::Sensed => Some(Self::Sensed),
            Topic::Log => Some(Self::Log),
            Topic::Flock => Some(Self::Flock),
            Topic::Auvs | Topic::Born | Topic::Summary | Topic::Offline => None,
        }
    }

    /// The topic that tells of `what`.
    pub(super) fn of(what: &What) -> Self {
        match what {
            What::Truth(_) => Self::Ticks,
            What::Acted(_) => Self::Reports,
            What::Traffic(_) => Self::Pings,
            What::Sensed(_) => Self::Sensed,
            What::Violation(_) | What::Ended(_) => Self::Log,
            What::Flock(_) => Self::Flock,
        }
    }

    /// Name of its service.
    pub(super) fn service(self) -> &'static str {
        self.topic().name().trim_start_matches('/')
    }
}
