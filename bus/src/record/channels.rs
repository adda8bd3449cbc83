//! The records of a data section, chunks opened, as items.

use std::collections::BTreeMap;

use mcap::parse_record;
use mcap::records::Record;
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};

use super::scan::RECORD_HEAD_BYTES;
use super::{Damage, Item, RECORD_LIMIT_BYTES, Source};
use crate::time::SimTime;

/// The schemas and channels seen so far.
#[derive(Default)]
pub(super) struct Channels {
    schemas: BTreeMap<u16, String>,
    sources: BTreeMap<u16, Source>,
}

impl Channels {
    /// Takes one record of the data section.
    pub(super) fn take(
        &mut self,
        record: Record<'_>,
        opcode: u8,
        raw: &[u8],
        visit: &mut dyn FnMut(Item<'_>) -> Result<(), Damage>,
    ) -> Result<(), Damage> {
        match record {
            Record::Header(header) => visit(Item::Header { library: &header.library }),
            Record::Metadata(metadata) => {
                visit(Item::Metadata { name: &metadata.name, entries: &metadata.metadata })
            }
            Record::Attachment { header, data, .. } => {
                let (name, media_type) = (&header.name, &header.media_type);
                visit(Item::Attachment { name, media_type, data: &data })
            }
            Record::Schema { header, .. } => {
                self.schemas.insert(header.id, header.name);
                Ok(())
            }
            Record::Channel(channel) => {
                let schema = self.schemas.get(&channel.schema_id).cloned().unwrap_or_default();
                let source = Source { topic: channel.topic, schema, encoding: channel.message_encoding };
                visit(Item::Channel(&source))?;
                self.sources.insert(channel.id, source);
                Ok(())
            }
            Record::Message { header, data } => {
                let id = header.channel_id;
                let source = self.sources.get(&id).ok_or(Damage::UnknownChannel(id))?;
                let at = SimTime::from_ns(i64::try_from(header.log_time).unwrap_or(i64::MAX));
                visit(Item::Message { source, at, data: &data })
            }
            Record::Chunk { header, .. } => self.open_chunk(opcode, raw, |channels, item| match item {
                None => visit(Item::Chunk {
                    compressed_bytes: header.compressed_size,
                    uncompressed_bytes: header.uncompressed_size,
                }),
                Some((opcode, raw)) => match parse_record(opcode, raw)? {
                    Record::Chunk { .. } => Err(Damage::NestedChunk),
                    record => channels.take(record, opcode, raw, visit),
                },
            }),
            _ => Ok(()),
        }
    }

    /// Decompresses and verifies a chunk, then hands over `None` and each record in it.
    fn open_chunk(
        &mut self,
        opcode: u8,
        raw: &[u8],
        mut each: impl FnMut(&mut Self, Option<(u8, &[u8])>) -> Result<(), Damage>,
    ) -> Result<(), Damage> {
        let mut reader = LinearReader::new_with_options(
            LinearReaderOptions::default()
                .with_skip_start_magic(true)
                .with_skip_end_magic(true)
                .with_prevalidate_chunk_crcs(true)
                .with_record_length_limit(RECORD_LIMIT_BYTES),
        );
        let mut given = false;
        let mut opened = false;
        while let Some(event) = reader.next_event() {
            match event? {
                LinearReadEvent::ReadRequest(_) if !given => {
                    given = true;
                    let room = reader.insert(RECORD_HEAD_BYTES as usize + raw.len());
                    let (head, body) = room.split_at_mut(RECORD_HEAD_BYTES as usize);
                    head[0] = opcode;
                    head[1..].copy_from_slice(&(raw.len() as u64).to_le_bytes());
                    body[..raw.len()].copy_from_slice(raw);
                    reader.notify_read(RECORD_HEAD_BYTES as usize + raw.len());
                }
                // All has been given: this tells the reader so, and it either is at the chunk's end or says what is missing.
                LinearReadEvent::ReadRequest(_) => reader.notify_read(0),
                LinearReadEvent::Record { opcode, data } => {
                    if !std::mem::replace(&mut opened, true) {
                        each(self, None)?;
                    }
                    each(self, Some((opcode, data)))?;
                }
            }
        }
        if opened { Ok(()) } else { each(self, None) }
    }
}
