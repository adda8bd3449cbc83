//! What travels in zenoh's payloads.

const SEQUENCE: usize = 8;
const UP_HEADER: usize = 1 + SEQUENCE;

/// What a frame up is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// The AUV's subscription is declared; the message is a [`Hello`](crate::protocol::Hello).
    Hello,
    /// Birth or end has arrived.
    Received,
    /// The answers to a batch.
    Answer,
}

/// A frame up.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Up<'a> {
    pub(crate) kind: Kind,
    /// Of the frame down that it answers.
    pub(crate) sequence: u64,
    pub(crate) message: &'a [u8],
}

impl<'a> Up<'a> {
    pub(crate) fn write(&self) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(UP_HEADER + self.message.len());
        bytes.push(self.kind as u8);
        bytes.extend(self.sequence.to_le_bytes());
        bytes.extend_from_slice(self.message);
        bytes
    }

    /// Takes a frame apart; `None` for bytes that are none.
    pub(crate) fn read(bytes: &'a [u8]) -> Option<Self> {
        let (kind, rest) = bytes.split_first()?;
        let (sequence, message) = rest.split_first_chunk()?;
        let kind = match kind {
            0 => Kind::Hello,
            1 => Kind::Received,
            2 => Kind::Answer,
            _ => return None,
        };
        Some(Self { kind, sequence: u64::from_le_bytes(*sequence), message })
    }
}

/// A frame down.
pub(crate) fn write_down(sequence: u64, message: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(SEQUENCE + message.len());
    bytes.extend(sequence.to_le_bytes());
    bytes.extend_from_slice(message);
    bytes
}

/// Takes a frame down apart; `None` when it is too short.
pub(crate) fn read_down(bytes: &[u8]) -> Option<(u64, &[u8])> {
    let (sequence, message) = bytes.split_first_chunk()?;
    Some((u64::from_le_bytes(*sequence), message))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_come_back() {
        let up = Up { kind: Kind::Answer, sequence: 1 << 40, message: b"m" };
        let bytes = up.write();
        assert_eq!(Up::read(&bytes), Some(up));
        for length in 0..UP_HEADER {
            assert_eq!(Up::read(&bytes[..length]), None);
        }
        assert_eq!(Up::read(&[9; 40]), None);
        assert_eq!(read_down(&write_down(3, b"x")), Some((3, &b"x"[..])));
        assert_eq!(read_down(b"short"), None);
    }
}
