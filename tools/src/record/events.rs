//! The events of a message, as JSON.

use serde_json::{Value, json};
use shoal_bus::record::{Damage, Topic, rows_of};
use shoal_bus::time::SimTime;

/// Something that a record tells: an element of a message of a topic that has elements, or the message.
pub struct Event {
    /// When, in true time.
    pub at: SimTime,
    /// As the topic's schema describes it. What AUVs were told, which is binary there, has the names of `Sensed` and `Born`.
    pub value: Value,
}

/// The events of a message with log time `at`.
pub fn events(topic: Topic, at: SimTime, data: &[u8]) -> Result<Vec<Event>, Damage> {
    let elements = match topic {
        Topic::Ticks => "ticks",
        Topic::Reports => "reports",
        Topic::Pings => "pings",
        Topic::Offline => "offline",
        Topic::Sensed | Topic::Born => {
            let mut events = Vec::new();
            rows_of(topic, data, &mut |row| {
                // Rows are plain data with text keys: they can be put into JSON.
                let value = serde_json::to_value(&row).unwrap_or_default();
                events.push(Event { at: row.at(), value });
            })?;
            return Ok(events);
        }
        Topic::Auvs | Topic::Poses | Topic::Log | Topic::Flock | Topic::Summary => {
            return Ok(vec![Event { at, value: parse(topic, data)? }]);
        }
    };
    let Value::Array(found) = parse(topic, data)?[elements].take() else { return Ok(Vec::new()) };
    let event = |value: Value| Event { at: value["t_ns"].as_i64().map_or(at, SimTime::from_ns), value };
    Ok(found.into_iter().map(event).collect())
}

fn parse(topic: Topic, data: &[u8]) -> Result<Value, Damage> {
    serde_json::from_slice(data).map_err(|source| Damage::Rows { topic: topic.name(), source })
}

/// Whether an event is about an AUV: it happened to it, or it sent or was to hear the ping.
pub fn is_about(topic: Topic, event: &Value, auv: u32, name: &str) -> bool {
    let is = |key: &str| event[key] == json!(auv);
    match topic {
        Topic::Pings => is("from") || is("to"),
        Topic::Log => event["name"] == name,
        Topic::Ticks | Topic::Reports | Topic::Sensed | Topic::Born | Topic::Offline => is("auv"),
        Topic::Auvs | Topic::Poses | Topic::Flock | Topic::Summary => false,
    }
}

/// Whom an event happened to, as the digest sorts events; `None` for the swarm as a whole.
pub fn subject(topic: Topic, event: &Value) -> Option<u32> {
    let key = match topic {
        Topic::Pings if event["fate"] == "emitted" || event["to"].is_null() => "from",
        Topic::Pings => "to",
        _ => "auv",
    };
    event[key].as_u64().and_then(|auv| u32::try_from(auv).ok())
}
