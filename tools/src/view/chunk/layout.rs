//! The bytes of a second: little-endian, arrays side by side so that the page views them in place.
//!
//! **Scene.** `u32`: second, AUVs `n`, rows `m`, emissions `e`, links `l`; then `u32[n + 1]` where the rows of each AUV begin. The first row of
//! an AUV is its last one before this second, if there was one. Then `f32[m]` each: time since the second's beginning; x, y, z;
//! heading; pitch; lower and upper end of the box in x, y, z (NaN without an answer); width of the clock interval. Then
//! `u32[m]` flags. Then `f32[e]` each: time, x, y, z; `u32[e]` who emitted. Then `f32[l]` time, `u32[l]` emitter, `u32[l]` receiver of the last
//! ping heard between two.
//!
//! **Tracks.** `u32[n + 1]` where the rows of each AUV begin, without earlier ones; [`FATES`] counts `u32` of each AUV as a receiver; then the
//! rows, [`ROW_BYTES`] each: `f64` time; `f32` x, y, z, box (6), clock offset, its ends (2), box since the tick before (6), ends of the clock
//! offset since then (2); `u32` flags; `u16` neighbours, contractions.
//!
//! Times are true, in seconds; lengths in metres. `f32` is for the eye: whether the truth is inside was found before
//! rounding, and stands in the flags.

use serde_json::json;
use shoal_bus::time::NS_PER_S;

use super::{Belief, Chunk, Open, Sample};

/// Fates of a ping at a receiver: heard, then the reasons of losses in their order.
pub const FATES: usize = 11;

/// Bytes of a row of a track.
pub const ROW_BYTES: usize = 8 + 4 * 20 + 4 + 4;

/// The AUV answered at this tick.
const ANSWERED: u32 = 1;
/// What it believed holds the truth.
const HOLDS: u32 = 2;
/// Its enclosure emptied.
const EMPTIED: u32 = 4;

/// What a second's tracks hold of one AUV.
#[derive(Clone, Debug, PartialEq)]
pub struct TrackPart {
    /// Counts of fates.
    pub fates: Vec<u8>,
    /// Its rows.
    pub rows: Vec<u8>,
}

impl TrackPart {
    /// Of `auv`, one of `auvs`, from the tracks of a second that `read` gives pieces of: where from, how long.
    pub fn read(
        auv: usize,
        auvs: usize,
        read: &dyn Fn(usize, usize) -> std::io::Result<Vec<u8>>,
    ) -> std::io::Result<Self> {
        let begins = read(4 * auv, 8)?;
        let number = |at: usize| {
            let bytes = begins.get(at..at + 4).and_then(|bytes| bytes.try_into().ok());
            bytes.map_or(0, u32::from_le_bytes) as usize
        };
        let (first, end) = (number(0), number(4));
        let fates_at = 4 * (auvs + 1);
        let rows_at = fates_at + 4 * FATES * auvs;
        Ok(Self {
            fates: read(fates_at + 4 * FATES * auv, 4 * FATES)?,
            rows: read(rows_at + ROW_BYTES * first, ROW_BYTES * end.saturating_sub(first))?,
        })
    }
}

/// The second, with the last sample of each AUV `before` it.
pub(super) fn chunk(second: u32, open: &Open, before: &[Option<Sample>], receptions: bool) -> Chunk {
    Chunk {
        second,
        scene: scene(second, open, before, receptions),
        tracks: tracks(open),
        figures: figures(second, open, before),
    }
}

fn scene(second: u32, open: &Open, before: &[Option<Sample>], receptions: bool) -> Vec<u8> {
    let begin_ns = i64::from(second) * NS_PER_S;
    let since = |t_ns: i64| (t_ns - begin_ns) as f64 * 1e-9;
    let mut begins = vec![0];
    let mut rows: Vec<&Sample> = Vec::new();
    for (samples, before) in open.samples.iter().zip(before) {
        rows.extend(before.iter().chain(samples));
        begins.push(count(rows.len()));
    }
    let heard: Vec<_> = if receptions { open.heard.iter().collect() } else { Vec::new() };
    let mut bytes = Bytes::default();
    let lengths = [open.samples.len(), rows.len(), open.emissions.len(), heard.len()];
    bytes.words([second].into_iter().chain(lengths.map(count)));
    bytes.words(begins);
    bytes.floats(rows.iter().map(|row| since(row.t_ns)));
    for axis in 0..3 {
        bytes.floats(rows.iter().map(|row| row.position_m[axis]));
    }
    bytes.floats(rows.iter().map(|row| row.heading_rad));
    bytes.floats(rows.iter().map(|row| row.pitch_rad));
    for axis in 0..3 {
        for end in 0..2 {
            bytes.floats(rows.iter().map(|row| of(row, |belief| belief.position_m[axis][end])));
        }
    }
    bytes
        .floats(rows.iter().map(|row| of(row, |belief| belief.clock_offset_s[1] - belief.clock_offset_s[0])));
    bytes.words(rows.iter().map(|row| flags(row)));
    bytes.floats(open.emissions.iter().map(|emission| since(emission.t_ns)));
    for axis in 0..3 {
        bytes.floats(open.emissions.iter().map(|emission| emission.position_m[axis]));
    }
    bytes.words(open.emissions.iter().map(|emission| emission.from));
    bytes.floats(heard.iter().map(|(_, t_ns)| since(**t_ns)));
    bytes.words(heard.iter().map(|((from, _), _)| *from));
    bytes.words(heard.iter().map(|((_, to), _)| *to));
    bytes.0
}

fn tracks(open: &Open) -> Vec<u8> {
    let mut begins = vec![0];
    let mut rows = 0;
    for samples in &open.samples {
        rows += samples.len();
        begins.push(count(rows));
    }
    let mut bytes = Bytes::default();
    bytes.words(begins);
    bytes.words(open.fates.iter().flatten().copied());
    bytes.0.reserve(rows * ROW_BYTES);
    for row in open.samples.iter().flatten() {
        bytes.0.extend((row.t_ns as f64 * 1e-9).to_le_bytes());
        bytes.floats(row.position_m);
        bytes.floats((0..6).map(|side| of(row, |belief| belief.position_m[side / 2][side % 2])));
        bytes.floats([row.clock_offset_s]);
        bytes.floats((0..2).map(|end| of(row, |belief| belief.clock_offset_s[end])));
        bytes.floats((0..6).map(|side| of(row, |belief| belief.slice_position_m[side / 2][side % 2])));
        bytes.floats((0..2).map(|end| of(row, |belief| belief.slice_clock_offset_s[end])));
        bytes.words([flags(row)]);
        let counts = row.belief.as_ref().map_or([0; 2], |belief| [belief.neighbours, belief.contractions]);
        bytes.0.extend(counts.into_iter().flat_map(u16::to_le_bytes));
    }
    bytes.0
}

/// What the charts of the swarm show of this second: `null` stands for what is unknown.
fn figures(second: u32, open: &Open, before: &[Option<Sample>]) -> String {
    let samples = open.samples.iter().zip(before);
    let last: Vec<&Belief> = samples
        .filter_map(|(samples, before)| {
            before.iter().chain(samples).rev().find_map(|row| row.belief.as_ref())
        })
        .collect();
    let [width_m, width_max_m] = median_and_most(last.iter().map(|belief| belief.width_m()).collect());
    let clock_widths =
        last.iter().map(|belief| belief.clock_offset_s[1] - belief.clock_offset_s[0]).collect();
    let [clock_s, clock_max_s] = median_and_most(clock_widths);
    let misses = open.samples.iter().flatten().filter_map(|row| row.belief.as_ref());
    let misses = misses.filter(|belief| !belief.holds).count();
    let flock = open.flock.as_ref().map(|row| &row.flock);
    json!({
        "second": second,
        "width_m": width_m,
        "width_max_m": width_max_m,
        "clock_s": clock_s,
        "clock_max_s": clock_max_s,
        "misses": misses,
        "emitted": open.emissions.len(),
        "fates": open.totals,
        "polarization": flock.map(|flock| flock.polarization),
        "separation_m": flock.and_then(|flock| flock.min_separation_m),
        "components": flock.map(|flock| flock.components),
    })
    .to_string()
}

fn median_and_most(mut of: Vec<f64>) -> [Option<f64>; 2] {
    of.retain(|value| value.is_finite());
    of.sort_by(f64::total_cmp);
    [of.get(of.len() / 2).copied(), of.last().copied()]
}

fn of(row: &Sample, value: impl Fn(&Belief) -> f64) -> f64 {
    row.belief.as_ref().map_or(f64::NAN, value)
}

fn flags(row: &Sample) -> u32 {
    let Some(belief) = &row.belief else { return 0 };
    ANSWERED | if belief.holds { HOLDS } else { 0 } | if belief.emptied { EMPTIED } else { 0 }
}

fn count(of: usize) -> u32 {
    u32::try_from(of).unwrap_or(u32::MAX)
}

/// Little-endian numbers one after the other.
#[derive(Default)]
struct Bytes(Vec<u8>);

impl Bytes {
    fn words(&mut self, of: impl IntoIterator<Item = u32>) {
        self.0.extend(of.into_iter().flat_map(u32::to_le_bytes));
    }

    fn floats(&mut self, of: impl IntoIterator<Item = f64>) {
        self.0.extend(of.into_iter().flat_map(|value| (value as f32).to_le_bytes()));
    }
}
