//! The records of a file one by one, over damage and up to a cut: what verifying and recovering are made of.

use std::io::{self, BufReader, Read, Seek, SeekFrom};

use mcap::MAGIC;
use mcap::records::op;

use super::layout;
use super::scan::{RECORD_HEAD_BYTES, RECORD_LIMIT_BYTES};

/// Bytes asked of the source at a time.
const READ_BYTES: usize = 256 << 10;

/// Bytes looked at together in search of the next record.
const SEARCH_BYTES: usize = 64 << 10;

const MAGIC_BYTES: u64 = MAGIC.len() as u64;

/// A record, not opened yet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Frame {
    /// Where it begins.
    pub(super) offset: u64,
    /// Its kind.
    pub(super) opcode: u8,
    /// The byte after it.
    pub(super) end: u64,
    /// Whether its length had to be told from what is in it, because the stated one is wrong.
    pub(super) is_bent: bool,
}

/// What comes next in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Step {
    /// A record; its body is [`Frames::body`].
    Frame(Frame),
    /// Bytes in which no record can be found.
    Gap {
        /// The first of them.
        from: u64,
        /// The byte after them.
        to: u64,
    },
    /// The file ends in the middle of a record, or before its footer.
    Cut {
        /// Whole records reach up to this byte.
        at: u64,
    },
    /// The file ends with its mark.
    End,
}

/// Reads a file record by record. Where a record is damaged so that its end is unknown, it goes on with the next one it finds.
///
/// Memory: the body of one record, never longer than the rest of the file and [`RECORD_LIMIT_BYTES`].
pub(super) struct Frames<R> {
    source: BufReader<R>,
    /// Where the source stands.
    position: u64,
    size: u64,
    has_end_mark: bool,
    /// Where the next record begins.
    offset: u64,
    is_past_footer: bool,
    is_over: bool,
    body: Vec<u8>,
}

impl<R: Read + Seek> Frames<R> {
    /// Looks at both ends of a file.
    pub(super) fn new(source: R) -> io::Result<Self> {
        let mut source = BufReader::with_capacity(READ_BYTES, source);
        let size = source.seek(SeekFrom::End(0))?;
        let mut frames = Self {
            source,
            position: size,
            size,
            has_end_mark: false,
            offset: 0,
            is_past_footer: false,
            is_over: false,
            body: Vec::new(),
        };
        frames.has_end_mark =
            size >= 2 * MAGIC_BYTES && frames.bytes::<{ MAGIC.len() }>(size - MAGIC_BYTES)? == MAGIC;
        Ok(frames)
    }

    /// Length of the file.
    pub(super) fn size(&self) -> u64 {
        self.size
    }

    /// Whether this is an MCAP file, whatever was done to it: it has one of the marks at its ends, or begins with a header.
    pub(super) fn is_mcap(&mut self) -> io::Result<bool> {
        let is_marked = self.size >= MAGIC_BYTES && self.bytes::<{ MAGIC.len() }>(0)? == MAGIC;
        Ok(is_marked
            || self.has_end_mark
            || self.frame_at(MAGIC_BYTES, false)?.is_some_and(|frame| frame.opcode == op::HEADER))
    }

    /// The body of the frame that came last.
    pub(super) fn body(&self) -> &[u8] {
        &self.body
    }

    /// The next record or gap. After [`Step::Cut`] and [`Step::End`] it is the end for ever.
    pub(super) fn next(&mut self) -> io::Result<Step> {
        if self.is_over {
            return Ok(Step::End);
        }
        if self.offset == 0 {
            self.offset = MAGIC_BYTES.min(self.size);
            if self.size < MAGIC_BYTES || self.bytes::<{ MAGIC.len() }>(0)? != MAGIC {
                return Ok(Step::Gap { from: 0, to: self.offset });
            }
        }
        if self.is_past_footer {
            return self.end();
        }
        if let Some(frame) = self.frame_at(self.offset, true)? {
            self.load(frame)?;
            return Ok(Step::Frame(frame));
        }
        let from = self.offset;
        if let Some(next) = self.search(from + 1)? {
            self.offset = next;
            return Ok(Step::Gap { from, to: next });
        }
        self.is_over = true;
        self.offset = self.size;
        Ok(if self.has_end_mark { Step::Gap { from, to: self.size } } else { Step::Cut { at: from } })
    }

    /// The end mark, and nothing behind it.
    fn end(&mut self) -> io::Result<Step> {
        let from = self.offset;
        (self.is_over, self.offset) = (true, self.size);
        let is_marked = from + MAGIC_BYTES <= self.size && self.bytes::<{ MAGIC.len() }>(from)? == MAGIC;
        Ok(match is_marked {
            true if from + MAGIC_BYTES == self.size => Step::End,
            true => Step::Gap { from: from + MAGIC_BYTES, to: self.size },
            // Part of the mark is what a cut leaves.
            false if self.size < from + MAGIC_BYTES => Step::Cut { at: from },
            false => Step::Gap { from, to: self.size },
        })
    }

    /// The record at `at`, if there is one. `trusting`: one that only its kind speaks for, and one whose stated length is wrong.
    fn frame_at(&mut self, at: u64, trusting: bool) -> io::Result<Option<Frame>> {
        let Some(room) = self.size.checked_sub(at).and_then(|room| room.checked_sub(RECORD_HEAD_BYTES))
        else {
            return Ok(None);
        };
        let head: [u8; RECORD_HEAD_BYTES as usize] = self.bytes(at)?;
        let [opcode, stated @ ..] = head;
        let stated = u64::from_le_bytes(stated);
        let body_at = at + RECORD_HEAD_BYTES;
        let frame = |length: u64, is_bent| Frame { offset: at, opcode, end: body_at + length, is_bent };
        if !layout::is_known(opcode) {
            // A message outside of a chunk, or a kind of others.
            let is_theirs = opcode == op::MESSAGE || opcode >= 0x80;
            let may_be = trusting && is_theirs && stated <= room.min(RECORD_LIMIT_BYTES as u64);
            return Ok(may_be.then(|| frame(stated, false)));
        }
        if !trusting && (stated > room || stated > RECORD_LIMIT_BYTES as u64) {
            return Ok(None);
        }
        let length = layout::length(opcode, room, |place, bytes| {
            let number = self.bytes::<8>(body_at + place)?;
            // A number of four bytes is followed by others.
            let mask = if bytes == 4 { u64::from(u32::MAX) } else { u64::MAX };
            io::Result::Ok(u64::from_le_bytes(number) & mask)
        })?;
        Ok(match length.filter(|length| *length <= RECORD_LIMIT_BYTES as u64) {
            Some(length) if length == stated => Some(frame(length, false)),
            Some(length) if trusting && self.begins_at(body_at + length)? => Some(frame(length, true)),
            _ => None,
        })
    }

    /// Whether a record begins at `at`, or the end mark.
    fn begins_at(&mut self, at: u64) -> io::Result<bool> {
        let is_mark = at + MAGIC_BYTES == self.size && self.has_end_mark;
        Ok(is_mark || self.frame_at(at, false)?.is_some())
    }

    /// Where the next record at or after `from` begins.
    fn search(&mut self, from: u64) -> io::Result<Option<u64>> {
        let mut window = Vec::with_capacity(SEARCH_BYTES);
        let mut at = from;
        while at + RECORD_HEAD_BYTES <= self.size {
            let length = (self.size - at).min(SEARCH_BYTES as u64) as usize;
            window.resize(length, 0);
            self.seek(at)?;
            self.source.read_exact(&mut window)?;
            self.position += length as u64;
            // A length below 2^40 has three zeros in front: few places are worth a closer look.
            for (place, head) in window.windows(RECORD_HEAD_BYTES as usize).enumerate() {
                if matches!(head, [opcode, .., 0, 0, 0] if layout::is_known(*opcode))
                    && self.frame_at(at + place as u64, false)?.is_some()
                {
                    return Ok(Some(at + place as u64));
                }
            }
            at += (length as u64).saturating_sub(RECORD_HEAD_BYTES - 1).max(1);
        }
        Ok(None)
    }

    fn load(&mut self, frame: Frame) -> io::Result<()> {
        self.seek(frame.offset + RECORD_HEAD_BYTES)?;
        let length = frame.end - frame.offset - RECORD_HEAD_BYTES;
        self.body.clear();
        let read = self.source.by_ref().take(length).read_to_end(&mut self.body)?;
        self.position += read as u64;
        if (read as u64) < length {
            // The file has become shorter meanwhile.
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        self.offset = frame.end;
        self.is_past_footer = frame.opcode == op::FOOTER;
        Ok(())
    }

    /// Bytes at `at`; zeros beyond the end of the file.
    fn bytes<const N: usize>(&mut self, at: u64) -> io::Result<[u8; N]> {
        self.seek(at)?;
        let mut bytes = [0; N];
        let length = self.size.saturating_sub(at).min(N as u64) as usize;
        self.source.read_exact(&mut bytes[..length])?;
        self.position += length as u64;
        Ok(bytes)
    }

    fn seek(&mut self, at: u64) -> io::Result<()> {
        if at != self.position {
            // Inside the buffer this reads nothing anew.
            self.source.seek_relative(at as i64 - self.position as i64)?;
            self.position = at;
        }
        Ok(())
    }

    /// Hands over all bytes from `from` to `to`, piece by piece.
    pub(super) fn pieces(&mut self, from: u64, to: u64, mut each: impl FnMut(&[u8])) -> io::Result<()> {
        let mut piece = vec![0; SEARCH_BYTES];
        let mut at = from;
        while at < to {
            let length = (to - at).min(SEARCH_BYTES as u64) as usize;
            self.seek(at)?;
            self.source.read_exact(&mut piece[..length])?;
            self.position += length as u64;
            each(&piece[..length]);
            at += length as u64;
        }
        Ok(())
    }
}
