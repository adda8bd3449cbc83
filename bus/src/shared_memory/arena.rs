//! The samples: down, one arena with the messages of a whole group; up, those of a process, each behind a short header.

use crate::message::AuvId;

const HEADER: usize = 12;
const ENTRY: usize = 12;
const UP_HEADER: usize = 12;

/// Builds one group's sample: `sequence`, `window`, count, then (AUV, offset, length) for each message, then the messages.
/// All of them `u32`, little-endian.
#[derive(Debug, Default)]
pub(super) struct ArenaWriter {
    index: Vec<(AuvId, usize)>,
    messages: Vec<u8>,
    sample: Vec<u8>,
}

impl ArenaWriter {
    pub(super) fn clear(&mut self) {
        self.index.clear();
        self.messages.clear();
    }

    /// Adds the message of `auv`; ascending.
    pub(super) fn push(&mut self, auv: AuvId, message: &[u8]) {
        self.index.push((auv, message.len()));
        self.messages.extend_from_slice(message);
    }

    /// The sample; `None` when it would be longer than its offsets can say.
    pub(super) fn finish(&mut self, sequence: u32, window: u32) -> Option<&[u8]> {
        let mut offset = HEADER + ENTRY * self.index.len();
        u32::try_from(offset + self.messages.len()).ok()?;
        self.sample.clear();
        for word in [sequence, window, self.index.len() as u32] {
            self.sample.extend(word.to_le_bytes());
        }
        for (auv, length) in &self.index {
            for word in [auv.0, offset as u32, *length as u32] {
                self.sample.extend(word.to_le_bytes());
            }
            offset += length;
        }
        self.sample.extend_from_slice(&self.messages);
        Some(&self.sample)
    }
}

/// A sample down, as one AUV reads it.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Arena<'a> {
    pub(super) sequence: u32,
    pub(super) window: u32,
    /// The AUV's own message, if it has one.
    pub(super) message: Option<&'a [u8]>,
}

impl<'a> Arena<'a> {
    /// Reads what concerns `auv`; `None` for bytes that are no arena.
    pub(super) fn read(sample: &'a [u8], auv: AuvId) -> Option<Self> {
        let count = word(sample, 8)? as usize;
        let index = sample.get(HEADER..HEADER.checked_add(count.checked_mul(ENTRY)?)?)?;
        let (entries, _) = index.as_chunks::<ENTRY>();
        let message = match entries.binary_search_by_key(&Some(auv.0), |entry| word(entry, 0)) {
            Ok(at) => {
                let (offset, length) = (word(&entries[at], 4)? as usize, word(&entries[at], 8)? as usize);
                Some(sample.get(offset..offset.checked_add(length)?)?)
            }
            Err(_) => None,
        };
        Some(Self { sequence: word(sample, 0)?, window: word(sample, 4)?, message })
    }
}

/// Adds to a sample up: whose, answer to which sequence number, and the message.
pub(super) fn write_answer(sample: &mut Vec<u8>, auv: AuvId, sequence: u32, message: &[u8]) {
    for word in [auv.0, sequence, message.len() as u32] {
        sample.extend(word.to_le_bytes());
    }
    sample.extend_from_slice(message);
}

/// Takes the first answer off a sample up; `None` when it is cut off.
pub(super) fn read_answer<'a>(sample: &mut &'a [u8]) -> Option<(AuvId, u32, &'a [u8])> {
    let (auv, sequence, length) = (word(sample, 0)?, word(sample, 4)?, word(sample, 8)? as usize);
    let (message, rest) = sample.get(UP_HEADER..)?.split_at_checked(length)?;
    *sample = rest;
    Some((AuvId(auv), sequence, message))
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    bytes.get(at..)?.first_chunk().map(|bytes| u32::from_le_bytes(*bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everyone_finds_its_own_message() {
        let mut writer = ArenaWriter::default();
        writer.push(AuvId(3), b"three");
        writer.push(AuvId(70_000), b"");
        let sample = writer.finish(9, 5).unwrap().to_vec();
        let read = |auv| Arena::read(&sample, AuvId(auv)).unwrap();
        assert_eq!(read(3), Arena { sequence: 9, window: 5, message: Some(b"three") });
        assert_eq!(read(70_000).message, Some(&b""[..]));
        assert_eq!(read(4).message, None);
        for length in 0..sample.len() {
            let _no_panic = Arena::read(&sample[..length], AuvId(3));
        }
        assert_eq!(Arena::read(&[0xff; 40], AuvId(3)), None);
        let mut up = Vec::new();
        write_answer(&mut up, AuvId(1), 2, b"x");
        write_answer(&mut up, AuvId(3), 2, b"");
        let mut rest = &up[..];
        assert_eq!(read_answer(&mut rest), Some((AuvId(1), 2, &b"x"[..])));
        assert_eq!(read_answer(&mut rest), Some((AuvId(3), 2, &b""[..])));
        assert_eq!((read_answer(&mut rest), rest), (None, &b""[..]));
        assert_eq!(read_answer(&mut &b"short"[..]), None);
        assert_eq!(read_answer(&mut &up[..12]), None);
    }
}
