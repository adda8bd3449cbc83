//! All seconds of a run gathered so far: on disk, since a record may be larger than the memory, or the last of them in memory.

use std::collections::BTreeMap;
use std::fs::File;
use std::io;
use std::os::unix::fs::FileExt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::chunk::{Chunk, TrackPart};

/// What is known of how far the store has come.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Reached {
    /// Lines about the seconds asked for, as JSON.
    pub figures: Vec<String>,
    /// First second that is kept.
    pub first: u32,
    /// One behind the last.
    pub end: u32,
    /// Nothing more will come.
    pub done: bool,
    /// What the user must know, such as that the record was cut.
    pub note: String,
}

/// Seconds by their number, shared between who gathers them and who shows them.
pub struct Store {
    kept: Mutex<Kept>,
    /// Where the seconds are; in memory when absent.
    file: Option<File>,
    /// In memory: bytes that are kept at most.
    limit_bytes: usize,
}

#[derive(Default)]
struct Kept {
    seconds: BTreeMap<u32, Second>,
    /// Bytes written, or kept in memory.
    bytes: u64,
    done: bool,
    note: String,
}

struct Second {
    scene: Bytes,
    tracks: Bytes,
    figures: String,
}

#[derive(Clone)]
enum Bytes {
    OnDisk { at: u64, length: usize },
    InMemory(Arc<[u8]>),
}

impl Store {
    /// Keeps everything in a temporary file without a name, which goes with the process.
    ///
    /// # Errors
    /// When there is no place for one.
    pub fn on_disk() -> io::Result<Self> {
        Ok(Self { kept: Mutex::default(), file: Some(tempfile::tempfile()?), limit_bytes: usize::MAX })
    }

    /// Keeps the last seconds, so many bytes of them.
    pub fn in_memory(limit_bytes: usize) -> Self {
        Self { kept: Mutex::default(), file: None, limit_bytes }
    }

    /// Adds a second.
    ///
    /// # Errors
    /// When the disk does not take it.
    pub fn put(&self, chunk: Chunk) -> io::Result<()> {
        let mut kept = self.kept();
        let Chunk { second, scene, tracks, figures } = chunk;
        let length = (scene.len() + tracks.len()) as u64;
        let second_kept = match &self.file {
            Some(file) => {
                let (at, scene_length) = (kept.bytes, scene.len());
                let tracks_at = at + scene_length as u64;
                file.write_all_at(&scene, at)?;
                file.write_all_at(&tracks, tracks_at)?;
                let scene = Bytes::OnDisk { at, length: scene_length };
                Second { scene, tracks: Bytes::OnDisk { at: tracks_at, length: tracks.len() }, figures }
            }
            None => {
                let [scene, tracks] = [scene, tracks].map(|bytes| Bytes::InMemory(bytes.into()));
                Second { scene, tracks, figures }
            }
        };
        kept.bytes += length;
        kept.seconds.insert(second, second_kept);
        while self.file.is_none() && kept.bytes > self.limit_bytes as u64 && kept.seconds.len() > 1 {
            let Some((_, oldest)) = kept.seconds.pop_first() else { break };
            kept.bytes -= (oldest.scene.length() + oldest.tracks.length()) as u64;
        }
        Ok(())
    }

    /// Tells what the user must know by now.
    pub fn warn(&self, note: String) {
        self.kept().note = note;
    }

    /// Tells that nothing more will come, with what the user must know.
    pub fn finish(&self, note: String) {
        let mut kept = self.kept();
        kept.done = true;
        kept.note = note;
    }

    /// How far it has come, with the lines about the seconds from `from` on.
    pub fn reached(&self, from: u32) -> Reached {
        let kept = self.kept();
        Reached {
            figures: kept.seconds.range(from..).map(|(_, second)| second.figures.clone()).collect(),
            first: kept.seconds.keys().next().copied().unwrap_or(0),
            end: kept.seconds.keys().next_back().map_or(0, |last| last + 1),
            done: kept.done,
            note: kept.note.clone(),
        }
    }

    /// The scene of `second`, or of the last one before it; `None` when there is none.
    ///
    /// # Errors
    /// When the disk does not give it back.
    pub fn scene(&self, second: u32) -> io::Result<Option<Vec<u8>>> {
        let found = self.kept().seconds.range(..=second).next_back().map(|(_, kept)| kept.scene.clone());
        found.map(|bytes| self.read(&bytes, 0, bytes.length())).transpose()
    }

    /// All tracks of `second`.
    ///
    /// # Errors
    /// When the disk does not give them back.
    pub fn tracks(&self, second: u32) -> io::Result<Option<Vec<u8>>> {
        let found = self.kept().seconds.get(&second).map(|kept| kept.tracks.clone());
        found.map(|bytes| self.read(&bytes, 0, bytes.length())).transpose()
    }

    /// Bytes that are kept.
    pub fn bytes(&self) -> u64 {
        self.kept().bytes
    }

    /// The seconds that are kept.
    pub fn seconds(&self) -> Vec<u32> {
        self.kept().seconds.keys().copied().collect()
    }

    /// What the seconds from `from` on hold of `auv`, one of `auvs`.
    ///
    /// # Errors
    /// When the disk does not give it back.
    pub fn track(&self, auv: usize, auvs: usize, from: u32) -> io::Result<Vec<(u32, TrackPart)>> {
        let found: Vec<(u32, Bytes)> =
            self.kept().seconds.range(from..).map(|(second, kept)| (*second, kept.tracks.clone())).collect();
        found
            .into_iter()
            .map(|(second, bytes)| {
                let read = |at, length| self.read(&bytes, at, length);
                Ok((second, TrackPart::read(auv, auvs, &read)?))
            })
            .collect()
    }

    fn read(&self, from: &Bytes, at: usize, length: usize) -> io::Result<Vec<u8>> {
        let beyond = || io::Error::new(io::ErrorKind::UnexpectedEof, "beyond the end of a second");
        if at.checked_add(length).is_none_or(|end| end > from.length()) {
            return Err(beyond());
        }
        match (from, &self.file) {
            (Bytes::OnDisk { at: begin, .. }, Some(file)) => {
                let mut bytes = vec![0; length];
                file.read_exact_at(&mut bytes, begin + at as u64)?;
                Ok(bytes)
            }
            (Bytes::InMemory(bytes), _) => Ok(bytes.get(at..at + length).ok_or_else(beyond)?.to_vec()),
            (Bytes::OnDisk { .. }, None) => Err(beyond()),
        }
    }

    fn kept(&self) -> MutexGuard<'_, Kept> {
        // Whoever panicked has not left a second half put: the map is changed last.
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Bytes {
    fn length(&self) -> usize {
        match self {
            Self::OnDisk { length, .. } => *length,
            Self::InMemory(bytes) => bytes.len(),
        }
    }
}

#[cfg(test)]
mod tests;
