//! Finds out whether a record is what was written: every byte of it.
//!
//! The checksums of an MCAP file cover the unpacked chunks, the attachments, the data section and the summary section. What none of
//! them covers, or what a checksum alone cannot place, is compared with what was read: lengths with what is in them, times of chunks
//! and message indexes with the messages, the chunk, attachment and metadata indexes, statistics and summary offsets with the
//! records they tell of, the footer with where the summary is, and the marks at both ends. Then the record itself: messages
//! are numbered without a gap and parse, and metadata, header and summary agree on scenario, seed, AUVs and digest.
//!
//! | file | idea |
//! |---|---|
//! | `data.rs` | the data section: chunks and their message indexes |
//! | `summary.rs` | the summary section against what was read |
//! | `meaning.rs` | what the messages say against each other |
//! | `flip.rs` | which byte it was, from a checksum that does not match |

mod data;
mod flip;
mod meaning;
mod summary;

use std::io::{Read, Seek};

use mcap::records::op;

use super::frames::{Frame, Frames, Step};
use super::{Damage, Ending, RecordReadError, Row, layout};
use data::Data;
use meaning::Meaning;
use summary::SummarySection;

pub use flip::Flip;

/// What [`verify`] found.
#[derive(Debug)]
pub struct Verification {
    /// Length of the file.
    pub file_bytes: u64,
    /// How the file ends.
    pub ending: Ending,
    /// Chunks whose checksums match.
    pub chunks: u64,
    /// Messages in them.
    pub messages: u64,
    /// Log time of the last message, in simulated seconds.
    pub until_s: Option<f64>,
    /// What it lost, in its own words, when it was [recovered](super::recover) from a damaged record.
    pub recovered: Option<String>,
    /// The digest that the record states, and whether scenario and seed determine it; `None` when the run did not end.
    pub digest: Option<(String, bool)>,
    /// What is damaged, in the order of the file; empty when nothing is.
    pub faults: Vec<Fault>,
}

/// A part of a record that is not what was written.
#[derive(Debug)]
pub struct Fault {
    /// First byte of the part.
    pub from: u64,
    /// Byte after the part.
    pub to: u64,
    /// What stands there: a kind of MCAP record, `magic`, `data section`, `summary section`, or `run` for what is wrong in what it tells.
    pub part: &'static str,
    /// Topics of the messages that are lost with it, as far as they are known.
    pub topics: Vec<String>,
    /// Simulated seconds of the messages that are lost with it, from and to, as far as they are known.
    pub time_s: Option<[f64; 2]>,
    /// How it shows.
    pub damage: Damage,
    /// The byte that was changed, if it was only one.
    pub flip: Option<Flip>,
}

impl Fault {
    fn new(frame: &Frame, damage: Damage) -> Self {
        Self::at(frame.offset, frame.end, layout::name(frame.opcode), damage)
    }

    fn at(from: u64, to: u64, part: &'static str, damage: Damage) -> Self {
        Self { from, to, part, topics: Vec::new(), time_s: None, damage, flip: None }
    }
}

impl Verification {
    /// Whether nothing is damaged and nothing is missing.
    pub fn is_whole(&self) -> bool {
        self.faults.is_empty() && self.ending == Ending::Complete
    }
}

/// Reads all of `source` and tells everything that is not as it was written. `visit` gets its rows, for checks of what they say; those of
/// damaged chunks are not among them.
///
/// Memory: one chunk, and a few bytes for each.
///
/// ```
/// use shoal_bus::record::{RecordHeader, RecordWriter, verify};
/// let header = RecordHeader { scenario_name: "a".into(), seed: 1, scenario_text: "b".into(), auvs: vec![] };
/// let mut file = Vec::new();
/// drop(RecordWriter::create(&mut file, &header)?);
/// assert!(verify(std::io::Cursor::new(&file), &mut |_| {}).unwrap().is_whole());
/// file[50] ^= 1;
/// let found = verify(std::io::Cursor::new(&file), &mut |_| {}).unwrap();
/// assert_eq!(found.faults[0].flip.map(|flip| flip.at), Some(50));
/// # Ok::<(), shoal_bus::record::RecordWriteError>(())
/// ```
///
/// # Errors
/// When the source cannot be read, is no MCAP file, or is an undamaged one that is no record, or of another version.
pub fn verify<R: Read + Seek>(
    source: R,
    visit: &mut dyn FnMut(Row),
) -> Result<Verification, RecordReadError> {
    let io = |source| RecordReadError::Io { offset: 0, source };
    let mut frames = Frames::new(source).map_err(io)?;
    if !frames.is_mcap().map_err(io)? {
        return Err(RecordReadError::NotMcap);
    }
    let mut verifier = Verifier { faults: Vec::new(), data: Data::default(), section: Section::Data, visit };
    let ending = verifier.walk(&mut frames).map_err(io)?;
    let Verifier { mut faults, data, .. } = verifier;
    if faults.is_empty() {
        match data.meaning.format() {
            None => return Err(RecordReadError::NotARecord),
            Some(found) if found != super::RECORD_FORMAT => {
                return Err(RecordReadError::UnknownFormat { found });
            }
            Some(_) => {}
        }
        faults.extend(data.meaning.faults(frames.size(), ending == Ending::Complete));
    }
    faults.sort_by_key(|fault| fault.from);
    Ok(Verification {
        file_bytes: frames.size(),
        ending,
        chunks: data.chunks,
        messages: data.messages,
        until_s: data.until_s(),
        digest: data.meaning.digest(),
        recovered: data.meaning.recovered,
        faults,
    })
}

/// Which part of the file is being read.
enum Section {
    Data,
    Summary(SummarySection),
    Over,
}

struct Verifier<'a> {
    faults: Vec<Fault>,
    data: Data,
    section: Section,
    visit: &'a mut dyn FnMut(Row),
}

impl Verifier<'_> {
    fn walk<R: Read + Seek>(&mut self, frames: &mut Frames<R>) -> std::io::Result<Ending> {
        loop {
            match frames.next()? {
                Step::Frame(frame) => self.frame(&frame, frames)?,
                Step::Gap { from, to } => {
                    self.data.end_chunk(&mut self.faults);
                    let part =
                        if from == 0 || matches!(self.section, Section::Over) { "magic" } else { "unknown" };
                    self.faults.push(Fault::at(from, to, part, Damage::NoRecord));
                }
                Step::Cut { at } => {
                    // The indexes of the last chunk may be what was cut off.
                    return Ok(Ending::Truncated { readable_bytes: at });
                }
                Step::End => {
                    self.data.end_chunk(&mut self.faults);
                    if !matches!(self.section, Section::Over) && self.faults.is_empty() {
                        let size = frames.size();
                        let damage =
                            Damage::Untrue { what: "end mark", says: "comes without a footer before it" };
                        self.faults.push(Fault::at(size, size, "magic", damage));
                    }
                    return Ok(Ending::Complete);
                }
            }
        }
    }

    fn frame<R: Read + Seek>(&mut self, frame: &Frame, frames: &mut Frames<R>) -> std::io::Result<()> {
        let known = self.faults.len();
        if frame.is_bent {
            let kind = layout::name(frame.opcode);
            self.faults.push(Fault::new(frame, Damage::Length { kind }));
        }
        match (&mut self.section, frame.opcode) {
            (Section::Data, op::DATA_END) => {
                self.data.end_chunk(&mut self.faults);
                let stated = flip::checksum_of(frames.body());
                let found = flip::Checksum::new(stated, 0..frame.offset);
                found.check(frames, "data section", frame.end, &self.data.sound, &mut self.faults)?;
                self.section = Section::Summary(SummarySection::new(frame.end, !self.faults.is_empty()));
            }
            (Section::Data, op::FOOTER) => {
                // The record before it, which ends the data, is gone.
                self.data.end_chunk(&mut self.faults);
                let damage = Damage::Misplaced { kind: layout::name(frame.opcode) };
                self.faults.push(Fault::new(frame, damage));
                self.section = Section::Over;
            }
            (Section::Data, _) => self.data.take(frame, frames.body(), &mut self.faults, self.visit),
            (Section::Summary(summary), op::FOOTER) => {
                summary.end(frame, frames, &self.data, &mut self.faults)?;
                self.section = Section::Over;
            }
            (Section::Summary(summary), _) => {
                summary.take(frame, frames.body(), &self.data, &mut self.faults);
            }
            (Section::Over, _) => {
                self.faults.push(Fault::new(frame, Damage::Misplaced { kind: layout::name(frame.opcode) }));
            }
        }
        // One wrong length shows in more than one way.
        if frame.is_bent {
            self.faults.truncate(known + 1);
        }
        Ok(())
    }
}
