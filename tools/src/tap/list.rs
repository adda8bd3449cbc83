//! `shoal tap list`: the topics, with how many messages they had and have a second.

use std::time::{Duration, Instant};

use serde_json::json;
use shoal_bus::record::{BATCH_NS, Row, Topic};
use shoal_bus::tap::{Counts, LiveTopic};
use shoal_bus::time::SimTime;

use super::args::TapArgs;
use super::source::{Heard, Source};
use super::{say, topic, warn};
use crate::exit::Exit;
use crate::failure::Failure;
use crate::table::Table;

/// How long it counts in a live run.
const LOOK: Duration = Duration::from_secs(1);

/// One line of the list.
struct Listed {
    topic: Topic,
    messages: u64,
    /// Messages a simulated second, and a second of wall clock.
    sim_hz: Option<f64>,
    wall_hz: Option<f64>,
}

/// Prints the topics and what is known of the run.
pub fn list(args: &TapArgs) -> Result<Exit, Failure> {
    let is_live = args.origin.read.is_none();
    let topics: &[Topic] = if is_live { &[] } else { &Topic::ALL };
    let mut source = Source::open(&args.origin, topics)?;
    let (at, listed) = if is_live { live(&mut source)? } else { recorded(&mut source)? };
    let Some(cast) = source.cast().cloned() else {
        return Err(Failure::failed("the run ended before it told who takes part"));
    };
    let text = if args.form.json {
        let line = |of: &Listed| {
            let Listed { topic, messages, sim_hz, wall_hz } = of;
            let line = json!({ "format": "shoal.tap.list/1", "topic": topic.name(), "schema": topic.schema_name(),
                "messages": messages, "sim_hz": sim_hz, "wall_hz": wall_hz });
            format!("{line}\n")
        };
        listed.iter().map(line).collect()
    } else {
        let name = source.run().map_or(String::new(), |run| format!("run {}: ", run.id()));
        let (header, auvs) = (&cast.header, cast.header.auvs.len());
        let mut text = format!(
            "{name}{}, seed {}, {auvs} AUVs, at {:.1} s\n\n",
            header.scenario_name,
            header.seed,
            at.as_s()
        );
        let mut table = Table::new(&["topic", ">messages", ">per sim. s", ">per s", "one message is"]);
        let rate = |rate: Option<f64>| rate.map_or("-".to_owned(), |rate| format!("{rate:.1}"));
        for Listed { topic, messages, sim_hz, wall_hz } in &listed {
            let meaning = topic::meaning(*topic).to_owned();
            table.push([
                topic.name().to_owned(),
                messages.to_string(),
                rate(*sim_hz),
                rate(*wall_hz),
                meaning,
            ]);
        }
        text += &table.render(crate::terminal::stdout_columns());
        text
    };
    say(&text)?;
    Ok(warn(&source))
}

/// Counts for a second what the run publishes, which it tells without publishing it.
fn live(source: &mut Source) -> Result<(SimTime, Vec<Listed>), Failure> {
    let mut first: Option<(Instant, SimTime, Counts)> = None;
    let mut last = None;
    while first.is_none_or(|(since, ..)| since.elapsed() < LOOK) {
        match source.next()? {
            Heard::Window(window) => {
                source.taken();
                if let Some(counts) = window.counts {
                    first.get_or_insert((Instant::now(), window.to, counts));
                    last = Some((Instant::now(), window.to, counts));
                }
            }
            Heard::Nothing => {}
            Heard::End => break,
        }
    }
    let (Some((since, from, before)), Some((until, to, after))) = (first, last) else {
        return Err(Failure::failed("the run ended before it was counted"));
    };
    let rate = |more: u64, seconds: f64| (seconds > 0.0).then(|| more as f64 / seconds);
    let of = |topic: LiveTopic| {
        let more = after.of(topic) - before.of(topic);
        Listed {
            topic: topic.topic(),
            messages: after.of(topic),
            sim_hz: rate(more, (to - from) as f64 / 1e9),
            wall_hz: rate(more, (until - since).as_secs_f64()),
        }
    };
    let auvs = source.cast().map_or(0, |cast| cast.header.auvs.len() as u64);
    let once = |topic, messages| Listed { topic, messages, sim_hz: None, wall_hz: None };
    let born = source.cast().map_or(0, |cast| cast.born.len() as u64);
    let mut listed = vec![once(Topic::Auvs, u64::from(auvs > 0)), once(Topic::Born, born)];
    listed.extend(LiveTopic::ALL.map(of));
    Ok((to, listed))
}

/// Counts what stands in the record.
fn recorded(source: &mut Source) -> Result<(SimTime, Vec<Listed>), Failure> {
    let mut counts = Topic::ALL.map(|topic| (topic, 0_u64));
    let (mut from, mut to) = (None, SimTime::ZERO);
    let mut add = |topic: Topic, more: u64| {
        if let Some((_, count)) = counts.iter_mut().find(|(counted, _)| *counted == topic) {
            *count += more;
        }
    };
    loop {
        match source.next()? {
            Heard::Window(window) => {
                source.taken();
                from.get_or_insert(window.to.ns() - BATCH_NS);
                to = to.max(window.to);
                window.rows.iter().for_each(|row: &Row| add(row.topic(), 1));
            }
            Heard::Nothing => {}
            Heard::End => break,
        }
    }
    if let Some(cast) = source.cast() {
        add(Topic::Auvs, 1);
        add(Topic::Born, cast.born.len() as u64);
    }
    let seconds = (to.ns() - from.unwrap_or(0).max(0)) as f64 / 1e9;
    let listed = counts.into_iter().filter(|(_, messages)| *messages > 0).map(|(topic, messages)| {
        let is_stream = !matches!(topic, Topic::Auvs | Topic::Born | Topic::Summary | Topic::Offline);
        let sim_hz = (is_stream && seconds > 0.0).then(|| messages as f64 / seconds);
        Listed { topic, messages, sim_hz, wall_hz: None }
    });
    Ok((to, listed.collect()))
}
