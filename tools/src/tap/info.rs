//! `shoal tap info`: what the messages of a topic hold.

use serde_json::{Value, json};
use shoal_bus::record::Topic;
use shoal_bus::tap::LiveTopic;

use super::args::TapArgs;
use super::source::{Heard, Source};
use super::{say, topic, warn};
use crate::exit::Exit;
use crate::failure::Failure;

/// Prints schema, fields and how many messages there were.
pub fn info(args: &TapArgs, topic: Topic) -> Result<Exit, Failure> {
    let is_live = args.origin.read.is_none();
    let heard: &[Topic] = if is_live { &[] } else { &[topic] };
    let mut source = Source::open(&args.origin, heard)?;
    let messages = count(&mut source, topic, is_live)?;
    let fields = fields(topic);
    let text = if args.form.json {
        let fields: Vec<Value> = fields
            .iter()
            .map(|field| json!({ "name": field.name, "of": field.of, "description": field.description }))
            .collect();
        let line = json!({ "format": "shoal.tap.info/1", "topic": topic.name(), "schema": topic.schema_name(),
            "encoding": topic.message_encoding(), "messages": messages, "fields": fields });
        format!("{line}\n")
    } else {
        let count = messages.map_or("follow from /ticks".to_owned(), |messages| messages.to_string());
        let mut text = format!(
            "topic     {}\nmeaning   {}\nschema    {}\nencoding  {}\nmessages  {count}\n",
            topic.name(),
            topic::meaning(topic),
            topic.schema_name(),
            topic.message_encoding(),
        );
        let mut of = None;
        for field in &fields {
            if of != Some(&field.of) {
                text += &format!("\n{}\n", if field.of.is_empty() { "fields" } else { &field.of });
                of = Some(&field.of);
            }
            text += &format!("  {:22}  {}\n", field.name, field.description);
        }
        if fields.is_empty() {
            text += &format!("\n{}\n", topic.schema_text().trim_end());
        }
        text
    };
    say(&text)?;
    Ok(warn(&source))
}

/// How many messages there were; `None` for a live topic that follows from another.
fn count(source: &mut Source, topic: Topic, is_live: bool) -> Result<Option<u64>, Failure> {
    let mut counted = 0;
    loop {
        match source.next()? {
            Heard::Window(window) => match window.counts {
                Some(counts) => {
                    let of_live = LiveTopic::ALL.into_iter().find(|live| live.topic() == topic);
                    if let Some(live) = of_live {
                        return Ok(Some(counts.of(live)));
                    }
                    break;
                }
                None => counted += window.rows.iter().filter(|row| row.topic() == topic).count() as u64,
            },
            Heard::Nothing => {}
            Heard::End => break,
        }
    }
    Ok(match (topic, source.cast()) {
        (Topic::Auvs, Some(_)) => Some(1),
        (Topic::Born, Some(cast)) => Some(cast.born.len() as u64),
        (Topic::Poses, _) if is_live => None,
        _ => Some(counted),
    })
}

/// One field of a topic's messages.
struct Field {
    name: String,
    /// What kind of message has it, in words of the schema, when there are several.
    of: String,
    description: String,
}

/// The fields of one row, from the schema; none where that is in words.
fn fields(topic: Topic) -> Vec<Field> {
    let Ok(schema) = serde_json::from_str::<Value>(topic.schema_text()) else { return Vec::new() };
    // A batch has a list of rows beside its borders; other messages are one.
    let list = schema["properties"].as_object().and_then(|properties| {
        let is_batch = properties.contains_key("from_ns");
        properties
            .values()
            .find(|property| is_batch && property["type"] == "array")
            .map(|list| &list["items"])
    });
    let row = list.unwrap_or(&schema);
    let kinds = row["oneOf"].as_array().map_or(std::slice::from_ref(row), Vec::as_slice);
    kinds
        .iter()
        .flat_map(|kind| {
            let of = if kinds.len() > 1 { text(&kind["description"]) } else { String::new() };
            let properties = kind["properties"].as_object().into_iter().flatten();
            properties.map(move |(name, property)| Field {
                name: name.clone(),
                of: of.clone(),
                description: described(property),
            })
        })
        .collect()
}

fn described(property: &Value) -> String {
    match &property["const"] {
        Value::String(only) => format!("always `{only}`"),
        _ => text(&property["description"]),
    }
}

fn text(value: &Value) -> String {
    value.as_str().unwrap_or_default().to_owned()
}
