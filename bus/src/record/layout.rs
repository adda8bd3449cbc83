//! How long a record of each kind is, by the lengths inside it: what tells a record from bytes that only look like one.
//!
//! Source: the MCAP specification, section "Records".

use mcap::records::op;

/// One part of a record.
enum Part {
    /// So many bytes.
    Bytes(u64),
    /// A string, map or array behind its length in bytes, of four bytes.
    Short,
    /// Bytes behind their length, of eight bytes.
    Long,
}

use Part::{Bytes, Long, Short};

/// The parts of a record of this kind; `None` where they say nothing: private kinds, and messages, which are all that is left.
fn parts(opcode: u8) -> Option<&'static [Part]> {
    Some(match opcode {
        op::HEADER => &[Short, Short],
        op::FOOTER => &[Bytes(8 + 8 + 4)],
        op::SCHEMA => &[Bytes(2), Short, Short, Short],
        op::CHANNEL => &[Bytes(2 + 2), Short, Short, Short],
        op::CHUNK => &[Bytes(8 + 8 + 8 + 4), Short, Long],
        op::MESSAGE_INDEX => &[Bytes(2), Short],
        op::CHUNK_INDEX => &[Bytes(4 * 8), Short, Bytes(8), Short, Bytes(8 + 8)],
        op::ATTACHMENT => &[Bytes(8 + 8), Short, Short, Long, Bytes(4)],
        op::ATTACHMENT_INDEX => &[Bytes(5 * 8), Short, Short],
        op::STATISTICS => &[Bytes(8 + 2 + 4 * 4 + 8 + 8), Short],
        op::METADATA => &[Short, Short],
        op::METADATA_INDEX => &[Bytes(8 + 8), Short],
        op::SUMMARY_OFFSET => &[Bytes(1 + 8 + 8)],
        op::DATA_END => &[Bytes(4)],
        _ => return None,
    })
}

/// Whether records of this kind tell their length by what is in them.
pub(super) fn is_known(opcode: u8) -> bool {
    parts(opcode).is_some()
}

/// The name of a kind, for people.
pub(super) fn name(opcode: u8) -> &'static str {
    match opcode {
        op::HEADER => "header",
        op::FOOTER => "footer",
        op::SCHEMA => "schema",
        op::CHANNEL => "channel",
        op::MESSAGE => "message",
        op::CHUNK => "chunk",
        op::MESSAGE_INDEX => "message index",
        op::CHUNK_INDEX => "chunk index",
        op::ATTACHMENT => "attachment",
        op::ATTACHMENT_INDEX => "attachment index",
        op::STATISTICS => "statistics",
        op::METADATA => "metadata",
        op::METADATA_INDEX => "metadata index",
        op::SUMMARY_OFFSET => "summary offset",
        op::DATA_END => "end of data",
        _ => "unknown",
    }
}

/// The length of the body of a record, by the lengths inside it; `None` when they lead beyond `room` bytes, or the kind has none.
/// `read` gives the little-endian number of so many bytes at a place in the body.
pub(super) fn length<E>(
    opcode: u8,
    room: u64,
    mut read: impl FnMut(u64, usize) -> Result<u64, E>,
) -> Result<Option<u64>, E> {
    let Some(parts) = parts(opcode) else { return Ok(None) };
    let mut at = 0_u64;
    for part in parts {
        let (head, body) = match part {
            Bytes(bytes) => (0, *bytes),
            Short if at + 4 <= room => (4, read(at, 4)?),
            Long if at + 8 <= room => (8, read(at, 8)?),
            Short | Long => return Ok(None),
        };
        at = match at.checked_add(head).and_then(|at| at.checked_add(body)) {
            Some(next) if next <= room => next,
            _ => return Ok(None),
        };
    }
    Ok(Some(at))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn length_of(opcode: u8, body: &[u8]) -> Option<u64> {
        let read = |at: u64, bytes: usize| {
            let at = at as usize;
            let mut number = [0; 8];
            number[..bytes].copy_from_slice(&body[at..at + bytes]);
            Ok::<_, ()>(u64::from_le_bytes(number))
        };
        length(opcode, body.len() as u64, read).unwrap()
    }

    #[test]
    fn lengths_inside_tell_where_a_record_ends() {
        let header = b"\x02\0\0\0ab\x03\0\0\0cdewhat follows";
        assert_eq!(length_of(op::HEADER, header), Some(13));
        assert_eq!(length_of(op::HEADER, &header[..12]), None);
        assert_eq!(length_of(op::DATA_END, header), Some(4));
        assert_eq!(length_of(op::FOOTER, &header[..19]), None);
        let mut attachment = vec![0; 16 + 4 + 4];
        attachment.extend(u64::MAX.to_le_bytes());
        assert_eq!(length_of(op::ATTACHMENT, &attachment), None);
        assert_eq!((length_of(op::MESSAGE, header), length_of(0x42, header)), (None, None));
    }
}
