//! Which events are wanted.

use clap::Args;
use shoal_bus::record::Topic;
use shoal_bus::time::{NS_PER_S, SimTime};

use super::events::{Event, is_about};
use super::source::Record;
use crate::failure::Failure;
use crate::filter::{Fields, Filter, FilterError, similar};

/// Which events are wanted.
#[derive(Debug, Args)]
pub struct Selection {
    /// Only this topic, such as `/pings`; can be given many times
    #[arg(long = "topic", value_name = "TOPIC", value_parser = parse_topic)]
    pub topics: Vec<Topic>,
    /// Only what happened from this simulated second on
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = parse_time)]
    pub from_s: Option<SimTime>,
    /// Only what happened before this simulated second, or at it
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = parse_time)]
    pub to_s: Option<SimTime>,
    /// Only what is about this AUV, by number or name: its own, and pings to and from it
    #[arg(long, value_name = "N")]
    pub auv: Option<String>,
    /// Only events that satisfy this, such as `range_m > 400 and fate == lost`, with the fields of the topic's schema: as `shoal tap`
    #[arg(long, value_name = "EXPR", value_parser = Filter::parse)]
    pub filter: Option<Filter>,
    /// No more than so many
    #[arg(long, value_name = "N")]
    pub count: Option<u64>,
}

/// A selection in a record whose AUVs are known.
pub struct Selected<'a> {
    of: &'a Selection,
    auv: Option<(u32, String)>,
}

impl Selection {
    /// Whether messages of this topic are wanted.
    pub fn wants(&self, topic: Topic) -> bool {
        self.topics.is_empty() || self.topics.contains(&topic)
    }

    /// Whether no message with this log time or a later one holds anything that is wanted.
    pub fn is_past(&self, at: SimTime, topic: Topic) -> bool {
        // What was found out after the run stands behind it, and begins anew.
        topic != Topic::Offline
            && !self.wants(Topic::Offline)
            && self.to_s.is_some_and(|to| at - to > shoal_bus::record::BATCH_NS)
    }

    /// Refuses a filter for a field that messages of none of the topics have.
    pub fn check(&self) -> Result<(), Failure> {
        let Some(filter) = &self.filter else { return Ok(()) };
        let topics = if self.topics.is_empty() { &Topic::ALL[..] } else { &self.topics };
        let checked: Vec<Result<(), FilterError>> =
            topics.iter().map(|topic| filter.check(&Fields::of(*topic))).collect();
        match checked.into_iter().reduce(Result::or) {
            Some(Err(error)) => Err(Failure::usage(error)),
            _ => Ok(()),
        }
    }

    /// The selection in this record.
    pub fn in_record(&self, record: &Record) -> Result<Selected<'_>, Failure> {
        let named = |named: &String| {
            let auv = record.auv(named)?;
            Ok((auv, record.names.get(auv as usize).cloned().unwrap_or_default()))
        };
        Ok(Selected { of: self, auv: self.auv.as_ref().map(named).transpose()? })
    }
}

impl Selected<'_> {
    /// Whether an event is wanted.
    pub fn takes(&self, topic: Topic, event: &Event) -> bool {
        self.of.from_s.is_none_or(|from| event.at >= from)
            && self.of.to_s.is_none_or(|to| event.at <= to)
            && self.of.filter.as_ref().is_none_or(|filter| filter.matches(&event.value))
            && self.auv.as_ref().is_none_or(|(auv, name)| is_about(topic, &event.value, *auv, name))
    }
}

/// A topic by its name, with or without the slash.
pub fn parse_topic(text: &str) -> Result<Topic, String> {
    let name = format!("/{}", text.trim_start_matches('/'));
    let names = || Topic::ALL.iter().map(|topic| topic.name());
    Topic::named(&name).ok_or_else(|| match similar(&name, names()) {
        Some(similar) => format!("no such topic; did you mean `{similar}`?"),
        None => format!("no such topic; there are {}", names().collect::<Vec<_>>().join(", ")),
    })
}

/// Simulated seconds.
pub fn parse_time(text: &str) -> Result<SimTime, String> {
    let seconds: Option<f64> = text.parse().ok().filter(|seconds: &f64| seconds.abs() <= 1e9);
    seconds
        .map(|seconds| SimTime::from_ns((seconds * NS_PER_S as f64).round() as i64))
        .ok_or_else(|| "give simulated seconds, such as `12.5`".to_owned())
}
