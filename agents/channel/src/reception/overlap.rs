//! Which packets overlapped with which, how much, and who is to blame.

use shoal_bus::message::AuvId;
use shoal_bus::time::SimTime;

use super::packets::PacketId;
use super::{Arrival, ArrivalKind};

/// Of the interference, at most this part goes unnamed.
const UNNAMED: f64 = 0.1;

/// An arrival that has begun.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sound {
    pub arrival: Arrival,
    /// Received power after fading, in µPa².
    pub power: f64,
    /// The fading gain in `power`.
    pub gain: f64,
    /// The copy is decoded when this draw is less than the probability.
    pub chance: f64,
    pub standing: Standing,
}

/// What the receiver makes of a copy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Standing {
    /// It did not notice its beginning.
    Missed,
    /// It follows another packet, since this one's beginning or from later on.
    Displaced(PacketId),
    /// It follows this one.
    Followed,
    /// It emits itself meanwhile.
    Deaf,
}

/// What sounds here, and what has sounded as long as that matters.
///
/// Powers span so many orders of magnitude that a running sum would keep the rounding of a loud packet long after it is
/// over: each sum is taken anew, in the order of the lists, which only the order of events determines.
#[derive(Debug, Default)]
pub(super) struct Overlaps {
    /// Sorted by end, the next to end last.
    sounding: Vec<Sound>,
    /// In the order of their ends.
    ended: Vec<Sound>,
    /// `ended` is sifted when it grows this long.
    sift_at: usize,
    weights: Vec<(f64, AuvId)>,
}

impl Overlaps {
    /// A new arrival sounds.
    pub(super) fn begin(&mut self, sound: Sound) {
        let later = |other: &Sound| other.arrival.end_order(&sound.arrival).is_gt();
        let place = self.sounding.partition_point(later);
        self.sounding.insert(place, sound);
    }

    /// When the next one ends.
    pub(super) fn next_end(&self) -> Option<SimTime> {
        self.sounding.last().map(|sound| sound.arrival.end)
    }

    /// Takes out the next one to end; pass it to [`keep`](Self::keep) when it is judged.
    pub(super) fn end(&mut self) -> Option<Sound> {
        self.sounding.pop()
    }

    /// Remembers a sound that has ended for those that it overlapped with.
    pub(super) fn keep(&mut self, sound: Sound) {
        self.ended.push(sound);
        if self.ended.len() >= self.sift_at {
            let oldest = self.copies().map(|copy| copy.arrival.start).min();
            self.ended.retain(|sound| oldest.is_some_and(|start| sound.arrival.end > start));
            self.sift_at = 2 * self.ended.len() + 8;
        }
    }

    /// What sounds now and may be decoded.
    fn copies(&self) -> impl Iterator<Item = &Sound> {
        self.sounding.iter().filter(|sound| matches!(sound.arrival.kind, ArrivalKind::Packet { .. }))
    }

    /// What sounds now.
    pub(super) fn sounding_mut(&mut self) -> impl Iterator<Item = &mut Sound> {
        self.sounding.iter_mut()
    }

    /// Power of all that sounds now.
    pub(super) fn power(&self) -> f64 {
        self.sounding.iter().map(|sound| sound.power).sum()
    }

    /// Power of all that sounds now but for copies of `packet`.
    pub(super) fn interference(&self, packet: PacketId) -> f64 {
        self.sounding.iter().filter(|sound| sound.arrival.packet() != packet).map(|sound| sound.power).sum()
    }

    /// Power of all other packets, averaged over the length of `copy`, which has just ended.
    pub(super) fn mean_interference(&self, copy: &Sound) -> f64 {
        let energy: f64 = self.others(copy).map(|(other, overlap_ns)| other.power * overlap_ns).sum();
        energy / (copy.arrival.end - copy.arrival.start) as f64
    }

    /// Whose packets cost `copy`, which has just ended, sorted: the one that the receiver followed instead, and the loudest of
    /// all that overlapped, which carry nine tenths of the energy, or of the power at its beginning if that went unnoticed.
    pub(super) fn colliding(&mut self, copy: &Sound) -> Vec<AuvId> {
        let mut named = Vec::new();
        let mut weights = std::mem::take(&mut self.weights);
        weights.clear();
        weights.extend(
            self.others(copy).map(|(other, overlap_ns)| (other.power * overlap_ns, other.arrival.from)),
        );
        name_loudest(&weights, &mut named);
        match copy.standing {
            Standing::Missed => {
                let start = copy.arrival.start;
                let at_start = self.others(copy).filter(|(other, _)| other.arrival.start <= start);
                weights.clear();
                weights.extend(at_start.map(|(other, _)| (other.power, other.arrival.from)));
                name_loudest(&weights, &mut named);
            }
            Standing::Displaced(packet) => named.push(packet.from),
            Standing::Followed | Standing::Deaf => {}
        }
        self.weights = weights;
        named.sort_unstable();
        named.dedup();
        named
    }

    /// All that overlapped with `copy`, and for how many nanoseconds.
    fn others<'a>(&'a self, copy: &'a Sound) -> impl Iterator<Item = (&'a Sound, f64)> {
        let own = copy.arrival;
        self.ended.iter().chain(&self.sounding).filter_map(move |other| {
            let overlap_ns = other.arrival.end.min(own.end) - other.arrival.start.max(own.start);
            (overlap_ns > 0 && other.arrival.packet() != own.packet()).then_some((other, overlap_ns as f64))
        })
    }
}

/// Names the loudest: in classes of a factor of two, all but the faintest classes that together make at most [`UNNAMED`] of the
/// whole. Classes spare a sort, and treat equals alike.
fn name_loudest(weights: &[(f64, AuvId)], named: &mut Vec<AuvId>) {
    const CLASSES: usize = 64;
    let exponent = |weight: f64| weight.to_bits() >> 52;
    let loudest = weights.iter().map(|&(weight, _)| exponent(weight)).max().unwrap_or(0);
    let class = |weight| CLASSES.min((loudest - exponent(weight)) as usize + 1) - 1;
    let mut sums = [0.0; CLASSES];
    for &(weight, _) in weights {
        sums[class(weight)] += weight;
    }
    let unnamed = UNNAMED * sums.iter().sum::<f64>();
    let mut faint = 0.0;
    let is_named = |sum: &f64| {
        faint += sum;
        faint > unnamed
    };
    let least = sums.iter().rposition(is_named);
    let is_loud = |weight| least.is_some_and(|least| class(weight) <= least);
    named.extend(weights.iter().filter(|&&(weight, _)| is_loud(weight)).map(|&(_, from)| from));
}
