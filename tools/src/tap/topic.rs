//! Topics by name.

use shoal_bus::record::Topic;

use crate::failure::Failure;
use crate::filter::similar;

/// The topic called `name`; the slash may be left out.
pub fn by_name(name: &str) -> Result<Topic, Failure> {
    let bare = name.trim_start_matches('/');
    let found = Topic::ALL.into_iter().find(|topic| topic.name().trim_start_matches('/') == bare);
    found.ok_or_else(|| {
        let names = || Topic::ALL.into_iter().map(Topic::name);
        let fix = match similar(&format!("/{bare}"), names()) {
            Some(similar) => format!("did you mean `{similar}`?"),
            None => format!("topics are {}", names().collect::<Vec<_>>().join(", ")),
        };
        Failure::usage(format!("no such topic: `{name}`; {fix}"))
    })
}

/// What a message of `topic` is, in a few words.
pub fn meaning(topic: Topic) -> &'static str {
    match topic {
        Topic::Auvs => "who takes part",
        Topic::Poses => "where all AUVs truly are, for viewers",
        Topic::Log => "a violated enclosure or a lost AUV",
        Topic::Ticks => "the truth about an AUV at its tick",
        Topic::Reports => "what an AUV answered and believes",
        Topic::Pings => "a ping emitted, heard or lost",
        Topic::Sensed => "what an AUV was told at its tick",
        Topic::Summary => "the outcome, at the end",
        Topic::Born => "what an AUV was told at birth",
        Topic::Offline => "a trajectory found after the run",
        Topic::Flock => "how the swarm holds together",
    }
}
