//! The digest: one hash of everything that happened, independent of how the run was executed.

use shoal_bus::chronicle::{Entry, What};
use shoal_bus::codec::{self, CodecError};

/// Hashes entries in their canonical order: truth, `Sensed`, `Acted` and `Traffic`; nothing else is part of it.
#[derive(Default)]
pub struct Digest {
    hasher: blake3::Hasher,
    bytes: Vec<u8>,
}

impl Digest {
    /// Adds entries, which follow all earlier ones in (true time, vehicle, kind, index).
    pub fn update(&mut self, entries: &[Entry]) -> Result<(), CodecError> {
        self.bytes.clear();
        for entry in entries {
            match entry.what {
                What::Truth(_) | What::Sensed(_) | What::Acted(_) | What::Traffic(_) => {
                    codec::encode_bare_into(entry, &mut self.bytes)?;
                }
                What::Violation(_) | What::Ended(_) | What::Flock(_) => {}
            }
        }
        // At once: many blocks are hashed side by side.
        self.hasher.update(&self.bytes);
        Ok(())
    }

    /// The digest of everything so far, as it stands in summaries.
    pub fn text(&self) -> String {
        format!("blake3:{}", self.hasher.finalize().to_hex())
    }
}
