//! The messages of a record that belong to one moment.

use shoal_bus::record::Topic;
use shoal_bus::time::SimTime;

use super::events::{events, subject};
use super::source::Record;
use crate::failure::Failure;

/// What happened, or was told, in one batch.
#[derive(Debug, PartialEq)]
pub struct Batch {
    /// Whether it was found out after the run.
    pub is_offline: bool,
    /// Log time of its messages.
    pub at: SimTime,
    /// They, in the order of the file.
    pub messages: Vec<(Topic, Vec<u8>)>,
}

impl Batch {
    /// Where it comes in a record.
    pub fn place(&self) -> (bool, SimTime) {
        (self.is_offline, self.at)
    }

    /// How many messages are of a topic.
    pub fn count(&self, topic: Topic) -> u64 {
        self.messages.iter().filter(|(of, _)| *of == topic).count() as u64
    }

    /// Its events, in the order in which the digest has them: by time, AUV and kind.
    pub fn events(&self, record: &Record) -> Result<Vec<Told>, Failure> {
        let mut told = Vec::new();
        for (topic, data) in &self.messages {
            // Poses follow from the truth at the ticks.
            if *topic == Topic::Poses {
                continue;
            }
            let found = events(*topic, self.at, data).map_err(|error| record.wrong(&error))?;
            told.extend(found.into_iter().map(|event| Told {
                at: event.at,
                auv: subject(*topic, &event.value),
                topic: *topic,
                event: event.value,
            }));
        }
        // Stable: events of one kind keep their order.
        told.sort_by_key(|told| told.key());
        Ok(told)
    }
}

/// An event with what it is sorted by.
#[derive(Debug)]
pub struct Told {
    pub at: SimTime,
    /// Whom it happened to.
    pub auv: Option<u32>,
    pub topic: Topic,
    pub event: serde_json::Value,
}

impl Told {
    /// What tells it from others: what was told at birth comes first, what is about the swarm as a whole last.
    pub fn key(&self) -> (SimTime, u8, Option<u32>, u8) {
        let (class, rank) = match self.topic {
            Topic::Auvs => (0, 0),
            Topic::Born => (0, 1),
            Topic::Ticks => (1, 0),
            Topic::Sensed => (1, 1),
            Topic::Reports => (1, 2),
            Topic::Pings => (1, 3),
            Topic::Log => (1, 4),
            Topic::Offline => (1, 5),
            Topic::Flock => (2, 0),
            Topic::Poses => (2, 1),
            Topic::Summary => (2, 2),
        };
        (self.at, class, self.auv, rank)
    }
}

/// Reads a record batch by batch.
pub struct Batches {
    pub record: Record,
    /// The message that begins the next batch.
    ahead: Option<Batch>,
}

impl Batches {
    pub fn new(record: Record) -> Self {
        Self { record, ahead: None }
    }

    /// The next one; `None` at the end. Memory: that batch.
    pub fn next(&mut self) -> Result<Option<Batch>, Failure> {
        let mut batch = self.ahead.take();
        loop {
            let Some(message) = self.record.next()? else { return Ok(batch) };
            let Some(topic) = message.topic else { continue };
            let one = Batch {
                is_offline: topic == Topic::Offline,
                at: message.at,
                messages: vec![(topic, message.data.to_vec())],
            };
            match &mut batch {
                Some(batch) if batch.place() == one.place() => batch.messages.extend(one.messages),
                Some(_) => {
                    self.ahead = Some(one);
                    return Ok(batch);
                }
                None => batch = Some(one),
            }
        }
    }
}
