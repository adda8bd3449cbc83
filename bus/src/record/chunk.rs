//! One chunk: unpacked, its checksum verified, its records one by one.

use std::io::Read;

use mcap::parse_record;
use mcap::records::{ChunkHeader, Record};

use super::scan::{RECORD_HEAD_BYTES, RECORD_LIMIT_BYTES};
use super::{Damage, layout};

/// The records of a chunk, unpacked. Can be filled again and again.
#[derive(Default)]
pub(super) struct Chunk {
    content: Vec<u8>,
}

/// One record of a chunk.
pub(super) struct Within<'a> {
    /// Where it begins in the unpacked chunk.
    pub(super) offset: usize,
    /// The byte after it.
    pub(super) end: usize,
    /// What it says.
    pub(super) record: Record<'a>,
}

impl Chunk {
    /// Unpacks the body of a chunk's record.
    ///
    /// Memory: what is really in it, at most [`RECORD_LIMIT_BYTES`], whatever its header claims.
    pub(super) fn open(&mut self, body: &[u8]) -> Result<ChunkHeader, Damage> {
        self.content.clear();
        let Record::Chunk { header, data } = parse_record(mcap::records::op::CHUNK, body)? else {
            return Err(Damage::Misplaced { kind: "chunk" });
        };
        if header.uncompressed_size > RECORD_LIMIT_BYTES as u64 {
            return Err(Damage::TooLarge);
        }
        match header.compression.as_str() {
            "" => self.content.extend_from_slice(&data),
            "zstd" => {
                let mut unpacked = zstd::Decoder::with_buffer(&*data)
                    .map_err(Damage::Unpack)?
                    // One more, so that too much is noticed.
                    .take(header.uncompressed_size + 1);
                unpacked.read_to_end(&mut self.content).map_err(Damage::Unpack)?;
            }
            other => return Err(Damage::Compression(other.to_owned())),
        }
        if self.content.len() as u64 != header.uncompressed_size {
            return Err(Damage::UnpackedLength {
                stated: header.uncompressed_size,
                found: self.content.len() as u64,
            });
        }
        // Records of ours always have one.
        if header.uncompressed_crc != crc32fast::hash(&self.content) {
            return Err(Damage::Checksum { part: "chunk" });
        }
        Ok(header)
    }

    /// The record at `at`, `None` at the end.
    pub(super) fn record_at(&self, at: usize) -> Result<Option<Within<'_>>, Damage> {
        let rest = self.content.get(at..).unwrap_or_default();
        if rest.is_empty() {
            return Ok(None);
        }
        let (Some(&opcode), Some(length)) = (rest.first(), rest.get(1..RECORD_HEAD_BYTES as usize)) else {
            return Err(Damage::Overlong);
        };
        let length = length.iter().rev().fold(0_u64, |sum, byte| sum << 8 | u64::from(*byte));
        let room = (rest.len() - RECORD_HEAD_BYTES as usize) as u64;
        if length > room {
            return Err(Damage::Overlong);
        }
        let end = RECORD_HEAD_BYTES as usize + length as usize;
        let body = &rest[RECORD_HEAD_BYTES as usize..end];
        let record = match parse_record(opcode, body)? {
            record @ (Record::Schema { .. } | Record::Channel(_) | Record::Message { .. }) => record,
            Record::Chunk { .. } => return Err(Damage::NestedChunk),
            other => return Err(Damage::Misplaced { kind: layout::name(other.opcode()) }),
        };
        Ok(Some(Within { offset: at, end: at + end, record }))
    }
}
