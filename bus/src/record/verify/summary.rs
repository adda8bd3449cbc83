//! The summary section against what was read.

use std::io::{Read, Seek};

use mcap::parse_record;
use mcap::records::{Record, op};

use super::super::frames::{Frame, Frames};
use super::super::{Damage, layout};
use super::Fault;
use super::data::{Data, of_attachment, of_channel, of_chunk, of_metadata, of_schema};
use super::flip::{Checksum, checksum_of};

/// Bytes of the footer that its checksum covers, with opcode and length.
const FOOTER_COVERED_BYTES: u64 = 9 + 16;

/// What was read of the summary section.
pub(super) struct SummarySection {
    start: u64,
    /// Whether the data section is damaged, so that statistics and indexes may be right and not agree.
    is_data_damaged: bool,
    /// Kinds of records, where the first of each begins, and the byte after the last.
    groups: Vec<(u8, u64, u64)>,
    offsets_start: Option<u64>,
    /// How many of the groups a summary offset has told of.
    told: usize,
    /// How many entries of the indexes, schemas and channels have come.
    indexed: usize,
    described: usize,
    has_statistics: bool,
    /// Faults in this section.
    faults: usize,
}

impl SummarySection {
    pub(super) fn new(start: u64, is_data_damaged: bool) -> Self {
        Self {
            start,
            is_data_damaged,
            groups: Vec::new(),
            offsets_start: None,
            told: 0,
            indexed: 0,
            described: 0,
            has_statistics: false,
            faults: 0,
        }
    }

    /// Takes one record.
    pub(super) fn take(&mut self, frame: &Frame, body: &[u8], data: &Data, faults: &mut Vec<Fault>) {
        if frame.opcode != op::SUMMARY_OFFSET {
            match self.groups.last_mut() {
                Some((opcode, _, end)) if *opcode == frame.opcode => *end = frame.end,
                _ => self.groups.push((frame.opcode, frame.offset, frame.end)),
            }
        }
        let is_true = match parse_record(frame.opcode, body) {
            Ok(record) => self.agrees(frame, record, data),
            Err(error) => {
                self.faults += 1;
                faults.push(Fault::new(frame, error.into()));
                return;
            }
        };
        let damage = match is_true {
            Some(true) => return,
            Some(false) => {
                Damage::Untrue { what: layout::name(frame.opcode), says: "is not of what was read" }
            }
            None => Damage::Misplaced { kind: layout::name(frame.opcode) },
        };
        self.faults += 1;
        faults.push(Fault::new(frame, damage));
    }

    /// Whether a record tells what was read; `None` when its kind does not belong here.
    fn agrees(&mut self, frame: &Frame, record: Record<'_>, data: &Data) -> Option<bool> {
        // Where the data is damaged, what is missing from it cannot be compared.
        let unless_damaged = |agrees: bool| Some(agrees || self.is_data_damaged);
        let entry = |offset: u64, sum: u32| {
            let found = data.indexed.binary_search_by_key(&offset, |(offset, _)| *offset).ok();
            // One that is damaged may well have been as the index says.
            found.is_some_and(|found| data.indexed[found].1.is_none_or(|expected| expected == sum))
        };
        match record {
            Record::Schema { header, data: text } => {
                self.described += 1;
                let sum = of_schema(&header.name, &header.encoding, &text);
                unless_damaged(data.described.get(&(op::SCHEMA, header.id)) == Some(&sum))
            }
            Record::Channel(channel) => {
                self.described += 1;
                unless_damaged(data.described.get(&(op::CHANNEL, channel.id)) == Some(&of_channel(&channel)))
            }
            Record::Statistics(statistics) => {
                self.has_statistics = true;
                unless_damaged(statistics == data.statistics)
            }
            Record::ChunkIndex(index) => {
                self.indexed += 1;
                unless_damaged(entry(index.chunk_start_offset, of_chunk(&index)))
            }
            Record::AttachmentIndex(index) => {
                self.indexed += 1;
                let times = [index.log_time, index.create_time];
                let sum = of_attachment(
                    index.offset,
                    index.length,
                    times,
                    index.data_size,
                    &index.name,
                    &index.media_type,
                );
                unless_damaged(entry(index.offset, sum))
            }
            Record::MetadataIndex(index) => {
                self.indexed += 1;
                unless_damaged(entry(index.offset, of_metadata(index.offset, index.length, &index.name)))
            }
            Record::SummaryOffset(offset) => {
                self.offsets_start.get_or_insert(frame.offset);
                self.told += 1;
                let group = (
                    offset.group_opcode,
                    offset.group_start,
                    offset.group_start.saturating_add(offset.group_length),
                );
                Some(self.groups.contains(&group) || self.faults > 0)
            }
            _ => None,
        }
    }

    /// The footer ends the section.
    pub(super) fn end<R: Read + Seek>(
        &self,
        frame: &Frame,
        frames: &mut Frames<R>,
        data: &Data,
        faults: &mut Vec<Fault>,
    ) -> std::io::Result<()> {
        let body: Vec<u8> = frames.body().to_vec();
        let is_complete = self.has_statistics
            && self.indexed == data.indexed.len()
            && self.described == data.described.len()
            && self.told == self.groups.len();
        let known = faults.iter().any(|fault| fault.from >= self.start);
        if !is_complete && !known && !self.is_data_damaged {
            let damage = Damage::Untrue { what: "summary section", says: "does not tell of everything" };
            faults.push(Fault::at(self.start, frame.end, "summary section", damage));
        }
        match parse_record(op::FOOTER, &body) {
            Ok(Record::Footer(footer)) => {
                let is_true = footer.summary_start == self.start
                    && footer.summary_offset_start == self.offsets_start.unwrap_or(0);
                if !is_true && !known {
                    let damage =
                        Damage::Untrue { what: "footer", says: "does not lead to the summary section" };
                    faults.push(Fault::new(frame, damage));
                }
            }
            Ok(_) => {}
            Err(error) => faults.push(Fault::new(frame, error.into())),
        }
        let over = self.start..frame.offset + FOOTER_COVERED_BYTES;
        Checksum::new(checksum_of(&body), over).check(frames, "summary section", frame.end, &[], faults)
    }
}
