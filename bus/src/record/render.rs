//! A record's contents as people read them.

use std::fmt::{self, Display, Formatter};

use super::{RecordInfo, TopicInfo};

/// A missing value.
const UNKNOWN: &str = "unknown";

impl Display for RecordInfo {
    /// One fact a line, then the topics as a table.
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        if self.record_format.is_none() {
            writeln!(f, "an MCAP file, but not a record of Shoal")?;
        }
        writeln!(f, "scenario     {}", self.scenario.as_deref().unwrap_or(UNKNOWN))?;
        writeln!(f, "seed         {}", known(self.seed))?;
        writeln!(f, "auvs         {}", known(self.auvs))?;
        match (self.first_s, self.last_s) {
            (Some(first), Some(last)) => writeln!(f, "time         {first:.3} s to {last:.3} s")?,
            _ => writeln!(f, "time         no messages")?,
        }
        writeln!(f, "file         {}", size(self.file_bytes))?;
        if let Some(cut) = &self.truncated {
            match cut.readable_until_s {
                Some(until) => writeln!(f, "truncated    no footer, readable up to {until:.3} s")?,
                None => writeln!(f, "truncated    no footer, no messages readable")?,
            }
        }
        let chunks = &self.chunks;
        match chunks.compression_ratio {
            Some(ratio) => {
                let (from, to) = (size(chunks.uncompressed_bytes), size(chunks.compressed_bytes));
                writeln!(f, "chunks       {}, {from} in {to} ({ratio:.1} to 1)", chunks.count)?;
            }
            None => writeln!(f, "chunks       none")?,
        }
        for file in &self.attachments {
            writeln!(f, "attached     {} ({})", file.name, size(file.bytes))?;
        }
        match (&self.digest, &self.containment) {
            (Some(digest), Some(containment)) => {
                writeln!(f, "digest       {digest}")?;
                if self.reproducible == Some(false) {
                    writeln!(f, "             not reproducible: scenario and seed do not determine it")?;
                }
                let (violations, checks) = (containment.violations, containment.checks);
                writeln!(f, "containment  {violations} violations in {checks} checks")?;
            }
            _ => writeln!(f, "digest       none: the run did not finish")?,
        }
        table(&self.topics, f)
    }
}

fn table(topics: &[TopicInfo], f: &mut Formatter<'_>) -> fmt::Result {
    let width = |column: fn(&TopicInfo) -> &str, title: &str| {
        topics.iter().map(|topic| column(topic).chars().count()).fold(title.len(), usize::max)
    };
    let (name, schema) = (width(|topic| &topic.topic, "topic"), width(|topic| &topic.schema, "schema"));
    writeln!(f, "\n{:name$}  {:schema$}  {:>10}  {:>12}", "topic", "schema", "messages", "size")?;
    for topic in topics {
        let (messages, bytes) = (topic.messages, size(topic.bytes));
        writeln!(f, "{:name$}  {:schema$}  {messages:>10}  {bytes:>12}", topic.topic, topic.schema)?;
    }
    Ok(())
}

fn known<T: ToString>(value: Option<T>) -> String {
    value.map_or_else(|| UNKNOWN.to_owned(), |value| value.to_string())
}

fn size(bytes: u64) -> String {
    const UNITS: [(u64, &str); 3] = [(1 << 30, "GiB"), (1 << 20, "MiB"), (1 << 10, "KiB")];
    UNITS.iter().find(|(unit, _)| bytes >= *unit).map_or_else(
        || format!("{bytes} B"),
        |(unit, name)| format!("{:.1} {name}", bytes as f64 / *unit as f64),
    )
}
