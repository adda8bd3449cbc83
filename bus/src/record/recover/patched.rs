//! A source with one byte put right.

use std::io::{Read, Result, Seek, SeekFrom};

use crate::record::Flip;

/// Reads as `source` would if one byte of it were another.
pub(super) struct Patched<R> {
    source: R,
    flip: Flip,
    /// Where the source stands; known after the first seek.
    position: u64,
}

impl<R> Patched<R> {
    /// `source` must be sought before it is read.
    pub(super) fn new(source: R, flip: Flip) -> Self {
        Self { source, flip, position: u64::MAX }
    }
}

impl<R: Read> Read for Patched<R> {
    fn read(&mut self, into: &mut [u8]) -> Result<usize> {
        let read = self.source.read(into)?;
        let place = self.flip.at.checked_sub(self.position).and_then(|place| usize::try_from(place).ok());
        if let Some(byte) = place.and_then(|place| into[..read].get_mut(place)) {
            *byte ^= self.flip.bits;
        }
        self.position = self.position.saturating_add(read as u64);
        Ok(read)
    }
}

impl<R: Seek> Seek for Patched<R> {
    fn seek(&mut self, to: SeekFrom) -> Result<u64> {
        self.position = self.source.seek(to)?;
        Ok(self.position)
    }
}
