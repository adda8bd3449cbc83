//! A record with what was found out after the run.

use std::collections::BTreeMap;
use std::io::{Read, Seek, Write};

use thiserror::Error;

use super::{METADATA_OUTCOME, RecordWriter, metadata_of};
use crate::record::batch::offline_messages;
use crate::record::rows::OfflineRow;
use crate::record::{Ending, Item, RecordReadError, RecordWriteError, Row, Topic, read_rows, scan};
use crate::time::SimTime;

/// Why a record cannot be appended to.
#[derive(Debug, Error)]
pub enum AppendError {
    /// The record cannot be read.
    #[error(transparent)]
    Read(#[from] RecordReadError),
    /// The record ends before it names its AUVs.
    #[error("the record was cut before anything happened")]
    Headless,
    /// The new record cannot be written.
    #[error(transparent)]
    Write(#[from] RecordWriteError),
}

/// Copies the record in `source` to `writer`, with `rows`, sorted by time, behind everything else: the trajectories reconstructed
/// after the run. Those of an earlier reconstruction are left out, and so are messages of topics that no record of ours has. Tells how
/// `source` ended; the copy is a complete file, without an outcome when `source` has none.
///
/// Memory: the rows as text, and what reading takes.
///
/// # Errors
/// When `source` is not a record or is damaged, or `writer` does not take the bytes.
pub fn append_offline<R: Read + Seek, W: Write>(
    mut source: R,
    writer: W,
    rows: &[OfflineRow],
) -> Result<Ending, AppendError> {
    let mut header = None;
    read_rows(&mut source, &[], &mut |row| {
        if let Row::Header(found) = row {
            header = Some(found);
        }
    })?;
    let mut copy = RecordWriter::create(writer, &header.ok_or(AppendError::Headless)?)?;
    let mut outcome: BTreeMap<String, String> = BTreeMap::new();
    let mut refused = None;
    let ending = scan(source, &mut |item| {
        match item {
            Item::Metadata { name: METADATA_OUTCOME, entries } => outcome.clone_from(entries),
            Item::Message { source, at, data } if refused.is_none() => {
                let is_it =
                    |topic: &Topic| source.topic == topic.name() && source.schema == topic.schema_name();
                if let Some(topic) = Topic::ALL.into_iter().find(is_it)
                    && !matches!(topic, Topic::Auvs | Topic::Offline)
                {
                    refused = copy.flush_second(at).and_then(|()| copy.write(topic, at, data)).err();
                }
            }
            _ => {}
        }
        Ok(())
    })?;
    if let Some(error) = refused {
        return Err(error.into());
    }
    copy.mcap.flush().map_err(RecordWriteError::from)?;
    // Behind the end, so every second of rows begins a chunk of its own.
    copy.written = SimTime::ZERO;
    for (at, message) in offline_messages(rows)? {
        copy.flush_second(at)?;
        copy.write(Topic::Offline, at, &message)?;
    }
    if !outcome.is_empty() {
        copy.mcap.write_metadata(&metadata_of(METADATA_OUTCOME, outcome)).map_err(RecordWriteError::from)?;
    }
    copy.mcap.finish().map_err(RecordWriteError::from)?;
    copy.mcap.into_inner().into_inner().flush().map_err(RecordWriteError::from)?;
    Ok(ending)
}
