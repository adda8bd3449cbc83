//! The bodies of messages: tags, and lists of messages of AUVs, which a host passes on as they are.

use crate::lockstep::Loss;
use crate::message::AuvId;

/// Tags of messages to a host.
pub(super) mod to_host {
    pub(in super::super) const ASSIGNMENT: u8 = 0;
    pub(in super::super) const WINDOW: u8 = 1;
    pub(in super::super) const END: u8 = 2;
}

/// Tags of messages from a host.
pub(super) mod from_host {
    pub(in super::super) const BORN: u8 = 0;
    pub(in super::super) const ANSWERS: u8 = 1;
    pub(in super::super) const GOODBYE: u8 = 2;
}

/// Writes a list of (AUV, bytes): their count, then for each the AUV, the length and the bytes. All numbers are `u32`,
/// little-endian.
pub(super) struct ListWriter<'a> {
    bytes: &'a mut Vec<u8>,
    /// Where the count stands.
    start: usize,
    count: u32,
}

impl<'a> ListWriter<'a> {
    /// A list at the end of `bytes`, empty so far.
    pub(super) fn new(bytes: &'a mut Vec<u8>) -> Self {
        let start = bytes.len();
        bytes.extend(0_u32.to_le_bytes());
        Self { bytes, start, count: 0 }
    }

    /// Adds one; `write` writes its bytes.
    pub(super) fn push<E>(
        &mut self,
        auv: AuvId,
        write: impl FnOnce(&mut Vec<u8>) -> Result<(), E>,
    ) -> Result<(), E> {
        self.bytes.extend(auv.0.to_le_bytes());
        let at = self.bytes.len();
        self.bytes.extend(0_u32.to_le_bytes());
        write(self.bytes)?;
        // No message is longer than 64 MiB, see the codec.
        let length = (self.bytes.len() - at - size_of::<u32>()) as u32;
        put(self.bytes, at, length);
        self.count += 1;
        put(self.bytes, self.start, self.count);
        Ok(())
    }

    /// Adds one whose bytes are there.
    pub(super) fn push_bytes(&mut self, auv: AuvId, message: &[u8]) {
        let Ok(()) = self.push(auv, |bytes| {
            bytes.extend_from_slice(message);
            Ok::<(), std::convert::Infallible>(())
        });
    }
}

fn put(bytes: &mut [u8], at: usize, value: u32) {
    if let Some(place) = bytes.get_mut(at..).and_then(<[u8]>::first_chunk_mut) {
        *place = value.to_le_bytes();
    }
}

/// Writes losses as a list.
pub(super) fn write_losses(losses: &[Loss], bytes: &mut Vec<u8>) {
    let mut list = ListWriter::new(bytes);
    losses.iter().for_each(|loss| list.push_bytes(loss.auv, loss.reason.as_bytes()));
}

/// What is left to read of a body.
pub(super) struct Reader<'a>(pub(super) &'a [u8]);

impl<'a> Reader<'a> {
    /// The next number.
    pub(super) fn number(&mut self) -> Option<u32> {
        let (word, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(u32::from_le_bytes(*word))
    }

    /// The next `length` bytes.
    pub(super) fn bytes(&mut self, length: usize) -> Option<&'a [u8]> {
        let (bytes, rest) = self.0.split_at_checked(length)?;
        self.0 = rest;
        Some(bytes)
    }

    /// The next list.
    pub(super) fn list(&mut self) -> Option<Vec<(AuvId, &'a [u8])>> {
        let count = self.number()?;
        // Each takes eight bytes at least: what a faulty sender claims allocates no more than what it sent.
        let mut list = Vec::with_capacity((count as usize).min(self.0.len() / 8));
        for _ in 0..count {
            let auv = AuvId(self.number()?);
            let length = self.number()? as usize;
            list.push((auv, self.bytes(length)?));
        }
        Some(list)
    }

    /// The next list, of losses.
    pub(super) fn losses(&mut self) -> Option<Vec<Loss>> {
        let loss = |(auv, reason)| Loss { auv, reason: String::from_utf8_lossy(reason).into_owned() };
        Some(self.list()?.into_iter().map(loss).collect())
    }

    /// Something, if it was the last.
    pub(super) fn ending<T>(&self, with: T) -> Option<T> {
        self.0.is_empty().then_some(with)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_come_back_and_damaged_ones_do_not() {
        let mut bytes = Vec::new();
        let mut list = ListWriter::new(&mut bytes);
        list.push_bytes(AuvId(3), b"three");
        list.push_bytes(AuvId(70_000), b"");
        let losses = [Loss { auv: AuvId(4), reason: "its process ended".into() }];
        write_losses(&losses, &mut bytes);
        let mut reader = Reader(&bytes);
        assert_eq!(reader.list().unwrap(), [(AuvId(3), &b"three"[..]), (AuvId(70_000), &b""[..])]);
        assert_eq!(reader.losses().unwrap(), losses);
        assert_eq!(reader.ending(()), Some(()));
        for length in 0..bytes.len() {
            let mut cut = Reader(&bytes[..length]);
            assert_eq!(cut.list().and_then(|_| cut.losses()), None);
        }
        assert_eq!(Reader(&[0xff; 64]).list(), None);
    }
}
