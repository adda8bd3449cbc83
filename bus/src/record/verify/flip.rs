//! Which byte was changed, from a checksum that does not match.
//!
//! A CRC is linear: the difference between the checksum stated and the one found depends on the changed bits and their distance
//! from the end alone. A change within one byte, `d` bytes before the end, is what running the register backwards over `d` zero
//! bytes leads to a state of eight bits for. Several places can explain one checksum, the more the longer the file (one in
//! 2^24 by chance; for a single bit, one in 2^29 or so), so what is named must lie where something else is wrong, or be the only one.

use std::io::{Read, Seek};
use std::ops::Range;

use super::super::Damage;
use super::super::frames::Frames;
use super::Fault;

/// One changed byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Flip {
    /// Where it stands in the file.
    pub at: u64,
    /// Which of its bits are the other way round.
    pub bits: u8,
}

/// A checksum over a part of the file.
pub(super) struct Checksum {
    stated: u32,
    over: Range<u64>,
}

/// The last four bytes of a body: where a checksum stands.
pub(super) fn checksum_of(body: &[u8]) -> u32 {
    body.last_chunk().map_or(0, |bytes| u32::from_le_bytes(*bytes))
}

impl Checksum {
    pub(super) fn new(stated: u32, over: Range<u64>) -> Self {
        Self { stated, over }
    }

    /// Compares it with the bytes. When it does not match, tells which byte was changed: of a fault that is known to lie there, or of a
    /// fault of its own when none is. `end` is the byte after the checksum; in the parts `sound`, sorted, nothing was changed.
    pub(super) fn check<R: Read + Seek>(
        &self,
        frames: &mut Frames<R>,
        part: &'static str,
        end: u64,
        sound: &[(u64, u64)],
        faults: &mut Vec<Fault>,
    ) -> std::io::Result<()> {
        let mut hasher = crc32fast::Hasher::new();
        frames.pieces(self.over.start, self.over.end, |piece| hasher.update(piece))?;
        let found = hasher.finalize();
        // Records of ours always have one, so zero is no excuse.
        if found == self.stated {
            return Ok(());
        }
        let mut candidates = candidates(self.stated ^ found, &self.over);
        candidates.retain(|flip| {
            let before = sound.partition_point(|(from, _)| *from <= flip.at);
            before.checked_sub(1).and_then(|last| sound.get(last)).is_none_or(|(_, to)| flip.at >= *to)
        });
        let inside: Vec<&mut Fault> = faults
            .iter_mut()
            .filter(|fault| self.over.start <= fault.from && fault.from < self.over.end)
            .collect();
        if inside.is_empty() {
            let flip = only(&candidates);
            // The checksum itself may be what was changed: then no byte, or only one by chance, explains it.
            let mut fault = Fault::at(self.over.start, end, part, Damage::Checksum { part });
            fault.flip = flip;
            faults.push(fault);
            return Ok(());
        }
        for fault in inside {
            let there: Vec<Flip> = candidates
                .iter()
                .copied()
                .filter(|flip| fault.from <= flip.at && flip.at < fault.to)
                .collect();
            fault.flip = only(&there);
        }
        Ok(())
    }
}

/// The only place that explains it, or the only one with a single bit.
fn only(candidates: &[Flip]) -> Option<Flip> {
    let mut single = candidates.iter().filter(|flip| flip.bits.is_power_of_two());
    match (single.next(), single.next(), candidates) {
        (Some(flip), None, _) | (None, _, [flip]) => Some(*flip),
        _ => None,
    }
}

/// What one zero byte does to a register whose low byte is the index.
const TABLE: [u32; 256] = table();

const fn table() -> [u32; 256] {
    /// The polynomial of CRC-32, reflected.
    const POLYNOMIAL: u32 = 0xedb8_8320;
    let mut table = [0; 256];
    let mut index = 0;
    while index < 256 {
        let mut register = index as u32;
        let mut bit = 0;
        while bit < 8 {
            register = (register >> 1) ^ (POLYNOMIAL * (register & 1));
            bit += 1;
        }
        table[index] = register;
        index += 1;
    }
    table
}

/// The index of the entry of [`TABLE`] with this high byte: all are different.
const BACK: [u8; 256] = back();

const fn back() -> [u8; 256] {
    let mut back = [0; 256];
    let mut index = 0;
    while index < 256 {
        back[(TABLE[index] >> 24) as usize] = index as u8;
        index += 1;
    }
    back
}

/// The bytes each of which, changed alone, explains the difference of two checksums, from the last to the first.
fn candidates(difference: u32, over: &Range<u64>) -> Vec<Flip> {
    /// More explain nothing.
    const ENOUGH: usize = 4096;
    let mut found = Vec::new();
    let mut register = difference;
    for at in over.clone().rev() {
        let index = BACK[(register >> 24) as usize];
        register = (register ^ TABLE[usize::from(index)]) << 8 | u32::from(index);
        if let bits @ 1..=255 = register
            && found.len() < ENOUGH
        {
            found.push(Flip { at, bits: bits as u8 });
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_changed_byte_is_found() {
        let bytes: Vec<u8> = (0..5_000_u32).map(|index| ((index * index) >> 3) as u8).collect();
        let stated = crc32fast::hash(&bytes);
        for (at, bits) in [(0, 1), (1, 0x80), (2_500, 0x10), (4_999, 0xa5), (4_998, 0xff)] {
            let mut bad = bytes.clone();
            bad[at] ^= bits;
            let found = candidates(stated ^ crc32fast::hash(&bad), &(0..5_000));
            assert_eq!(only(&found), Some(Flip { at: at as u64, bits }));
        }
        assert_eq!(only(&candidates(0x1234_5678, &(0..5_000))), None);
    }
}
