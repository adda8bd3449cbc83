//! Reception at level `sea`: which packets one receiver decodes, and why it loses the others.
//!
//! An [`Ear`] is told when which packet arrives by which path and how loud, and when its own modem emits. In the order of true
//! time it then does what a modem with one receiver does:
//! - Each copy of a packet (one path) gets its fading gain at its beginning. Its signal-to-interference-and-noise ratio (SINR)
//!   counts ambient noise and *all other packets* that sound at that moment. Copies of one packet do not disturb each other:
//!   the guard interval or equaliser of the modem takes care of them.
//! - A receiver that follows no packet, does not emit and is awake begins to follow a copy whose SINR at its beginning reaches the
//!   detection threshold. One that follows a packet ignores all others, but for a detectable copy that is louder by the capture
//!   ratio: that one it follows from then on (the capture effect).
//! - Bits fail independently with the bit error rate of their SINR, so that a copy followed to its end is decoded with probability
//!   P = Π (1 - BER(SINR))^bits over the stretches of constant interference; Eb/N0 = SINR · bandwidth / bit rate · coding gain.
//!   One uniform draw per copy decides.
//! - The own emission deafens: whatever overlaps with it is lost, and what was followed is followed no more.
//!
//! A packet's fate is told once: heard, at the end of the first copy decoded, or lost, at the end of its last copy. The reason is
//! what would have had to be otherwise, asked in this order: `band` and `asleep` are given; `noise`, when the same draws in the
//! same noise without anybody else would not have been enough; `half_duplex`, when the receiver was emitting; else `collision`.
//!
//! What comes out does not depend on the order of telling, nor on how time is cut into [`settle`](Ear::settle)s.
//!
//! | file | idea |
//! |---|---|
//! | `fading.rs` | gains of whole packets |
//! | `overlap.rs` | what sounds together |
//! | `decoder.rs` | probability of decoding |
//! | `packets.rs` | one fate per packet |
//! | `carrier.rs` | listen before talk |

mod carrier;
mod decoder;
mod fading;
mod overlap;
mod packets;
#[cfg(test)]
mod tests;

use std::cmp::{Ordering, Reverse};
use std::collections::{BinaryHeap, VecDeque};

use shoal_bus::message::AuvId;
use shoal_bus::time::SimTime;
use shoal_bus::traffic::{LossReason, Reception, SoundPath};
use shoal_scenario::model::{Fading, PhysicalLayer};

use self::carrier::Carrier;
use self::decoder::{Decoder, Stretch};
use self::fading::Gain;
use self::overlap::{Overlaps, Sound, Standing};
use self::packets::{Hope, LostCopy, PacketId, Packets};
use crate::acoustics::decibel::{db_from_power, power_from_db};
use crate::draw::Draws;

/// One packet by one path at this receiver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrival {
    /// Who emitted it.
    pub from: AuvId,
    /// The emitter's sequence number.
    pub sequence: u32,
    /// Which way it came.
    pub path: SoundPath,
    /// When its beginning arrives.
    pub start: SimTime,
    /// When its end arrives; taken as at least a nanosecond later.
    pub end: SimTime,
    /// Mean received level in the receiver's band, before fading, in dB re 1 µPa.
    pub level_db: f64,
    /// Handed back in the outcome's [`Reception`].
    pub doppler: f64,
    /// The caller's own number for this arrival: handed back, never looked at.
    pub flight: u32,
    /// What it is to this receiver.
    pub kind: ArrivalKind,
}

/// What an arrival is to a receiver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ArrivalKind {
    /// One that may be decoded.
    Packet {
        /// How many paths of this packet are expected here as packets in all, this one included.
        copies: u8,
        /// Bits of its frame.
        bits: u32,
        /// Whether the receiver's modem sleeps when it begins.
        asleep: bool,
        /// Whether the receiver's modem knows its band and modulation.
        known: bool,
    },
    /// Too faint to be noticed: energy only, without outcome.
    Interference,
}

/// What a receiver is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EarSettings {
    /// Ambient noise in the band, in dB re 1 µPa.
    pub noise_db: f64,
    /// The modem.
    pub physical: PhysicalLayer,
    /// How packets fade.
    pub fading: Fading,
    /// How far back [`Ear::busy`] may be asked, in nanoseconds; zero for one that never asks.
    pub sense_ns: i64,
}

impl EarSettings {
    /// Mean level in dB re 1 µPa below which no packet is ever noticed, however lucky its fading: as
    /// [`ArrivalKind::Interference`] it disturbs the same, but for its own fading.
    pub fn noticeable_db(&self) -> f64 {
        let luck_db = db_from_power(Gain::new(self.fading).greatest());
        // A hair lower, for the rounding of decibels.
        self.noise_db + self.physical.detection_threshold_db - luck_db - 1e-6
    }
}

/// What became of one packet at one receiver.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The copy that decided: the one decoded, or the most hopeful one.
    pub arrival: Arrival,
    /// When it was decided: the end of the copy decoded, or of the packet's last copy.
    pub at: SimTime,
    /// How that copy arrived: level after fading, SINR over its whole length.
    pub reception: Reception,
    /// Heard or lost.
    pub verdict: Verdict,
}

/// Whether a packet was decoded.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// It was.
    Heard,
    /// It was not.
    Lost {
        /// Why: `Band`, `Asleep`, `Noise`, `HalfDuplex` or `Collision`.
        reason: LossReason,
        /// Whose packets it collided with, sorted; empty unless the reason is `Collision`.
        colliding: Vec<AuvId>,
    },
}

/// One receiver of one modem.
///
/// ```
/// use shoal_bus::message::AuvId;
/// use shoal_bus::time::SimTime;
/// use shoal_bus::traffic::SoundPath;
/// use shoal_channel::draw::{Draws, Purpose};
/// use shoal_channel::reception::{Arrival, ArrivalKind, Ear, EarSettings, Verdict};
/// use shoal_scenario::model::{Fading, FadingKind, FadingPer, Modulation, Noise, PhysicalLayer};
///
/// let physical = PhysicalLayer {
///     source_level_db: 185.0,
///     centre_hz: 25_000.0,
///     bandwidth_hz: 1_000.0,
///     bit_rate_bit_s: 1_000.0,
///     preamble_s: 0.05,
///     modulation: Modulation::Bpsk,
///     coding_gain_db: 0.0,
///     detection_threshold_db: 3.0,
///     capture_db: 6.0,
/// };
/// let fading = Fading { kind: FadingKind::Gaussian, per: FadingPer::Packet };
/// let settings = EarSettings { noise_db: 75.0, physical, fading, sense_ns: 0 };
/// let mut ear = Ear::new(settings, Draws::new(1, Purpose::Reception, AuvId(0), Noise::Uniform));
///
/// // Two packets of 256 bits, equally loud, one half a packet after the other.
/// let arrival = |from, start_ns| Arrival {
///     from: AuvId(from),
///     sequence: 0,
///     path: SoundPath::Direct,
///     start: SimTime::from_ns(start_ns),
///     end: SimTime::from_ns(start_ns + 306_000_000),
///     level_db: 105.0,
///     doppler: 1.0,
///     flight: 0,
///     kind: ArrivalKind::Packet { copies: 1, bits: 256, asleep: false, known: true },
/// };
/// ear.expect(arrival(1, 0));
/// ear.expect(arrival(2, 153_000_000));
/// let mut outcomes = Vec::new();
/// ear.settle(SimTime::from_ns(1_000_000_000), &mut outcomes);
/// let Verdict::Lost { reason, colliding } = &outcomes[0].verdict else { panic!("it collided") };
/// assert_eq!((reason.name(), colliding.as_slice()), ("collision", [AuvId(2)].as_slice()));
/// ```
pub struct Ear {
    noise: f64,
    detection_sinr: f64,
    capture_ratio: f64,
    gain: Gain,
    decoder: Decoder,
    draws: Draws,
    /// Arrivals that have not begun.
    awaited: BinaryHeap<Reverse<Awaited>>,
    /// Own emissions that have not begun, sorted.
    emissions: VecDeque<(SimTime, SimTime)>,
    emits_until: SimTime,
    overlaps: Overlaps,
    /// The copy that is being received.
    followed: Option<Followed>,
    /// Interference with it so far.
    stretches: Vec<Stretch>,
    packets: Packets,
    carrier: Carrier,
}

/// The copy that a receiver follows.
#[derive(Clone, Copy)]
struct Followed {
    packet: PacketId,
    path: SoundPath,
    start: SimTime,
    power: f64,
}

/// What happens next; at the same moment, in this order.
enum Event {
    End,
    Emission,
    Start,
}

impl Ear {
    /// A receiver that draws from its own stream ([`Purpose::Reception`](crate::draw::Purpose::Reception)).
    pub fn new(settings: EarSettings, draws: Draws) -> Self {
        let EarSettings { noise_db, physical, fading, sense_ns } = settings;
        let noise = power_from_db(noise_db);
        let detection_sinr = power_from_db(physical.detection_threshold_db);
        Self {
            noise,
            detection_sinr,
            capture_ratio: power_from_db(physical.capture_db),
            gain: Gain::new(fading),
            decoder: Decoder::new(&physical, fading, noise),
            draws,
            awaited: BinaryHeap::new(),
            emissions: VecDeque::new(),
            emits_until: SimTime::from_ns(i64::MIN),
            overlaps: Overlaps::default(),
            followed: None,
            stretches: Vec::new(),
            packets: Packets::default(),
            carrier: Carrier::new(detection_sinr * noise, sense_ns),
        }
    }

    /// Tells of an arrival, before [`settle`](Self::settle) passes its start; in any order.
    pub fn expect(&mut self, mut arrival: Arrival) {
        arrival.end = arrival.end.max(arrival.start + 1);
        if let ArrivalKind::Packet { copies, .. } = arrival.kind {
            self.packets.expect(arrival.packet(), copies);
        }
        self.awaited.push(Reverse(Awaited(arrival)));
    }

    /// Tells of an own emission, before [`settle`](Self::settle) passes its start; in any order.
    pub fn emit(&mut self, start: SimTime, end: SimTime) {
        if end > start {
            let place = self.emissions.partition_point(|&emission| emission < (start, end));
            self.emissions.insert(place, (start, end));
        }
    }

    /// Appends what is decided before `until`, in order of time. Every arrival and own emission that starts before `until` must
    /// be known; later ones may be told later.
    pub fn settle(&mut self, until: SimTime, outcomes: &mut Vec<Outcome>) {
        while let Some((at, event)) = self.next_event().filter(|&(at, _)| at < until) {
            match event {
                Event::End => self.end(outcomes),
                Event::Emission => self.fall_deaf(),
                Event::Start => self.start(),
            }
            self.listen(at);
        }
        self.carrier.forget(until);
    }

    /// Carrier sense: whether at any moment of `[since, until)` others together were received at the detection threshold or
    /// above, or the own modem emitted. To be asked after `settle(until)`, for `since` no more than
    /// [`sense_ns`](EarSettings::sense_ns) earlier. A modem that sleeps otherwise is taken to be awake for this.
    pub fn busy(&self, since: SimTime, until: SimTime) -> bool {
        self.carrier.busy(since, until)
    }

    /// How many packets are expected here of which neither is told yet, heard or lost; each counts once.
    pub fn pending(&self) -> usize {
        self.packets.undecided()
    }

    fn next_event(&self) -> Option<(SimTime, Event)> {
        let end = self.overlaps.next_end().map(|at| (at, Event::End));
        let emission = self.emissions.front().map(|&(at, _)| (at, Event::Emission));
        let start = self.awaited.peek().map(|Reverse(Awaited(arrival))| (arrival.start, Event::Start));
        // Of equals, the first.
        [end, emission, start].into_iter().flatten().min_by_key(|&(at, _)| at)
    }

    /// The next arrival begins.
    fn start(&mut self) {
        let Some(Reverse(Awaited(arrival))) = self.awaited.pop() else { return };
        let mean_power = power_from_db(arrival.level_db);
        let mut sound =
            Sound { arrival, power: mean_power, gain: 1.0, chance: 1.0, standing: Standing::Missed };
        if let ArrivalKind::Packet { asleep, known, .. } = arrival.kind {
            sound.gain = self.gain.draw(&mut self.draws);
            sound.power = mean_power * sound.gain;
            sound.chance = self.draws.unit();
            if self.emits_until > arrival.start {
                sound.standing = Standing::Deaf;
            } else if known && !asleep {
                sound.standing = self.notice(&sound);
            }
        }
        self.overlaps.begin(sound);
    }

    /// Whether the receiver follows a copy that begins.
    fn notice(&mut self, sound: &Sound) -> Standing {
        let packet = sound.arrival.packet();
        let is_detectable = |interference| sound.power >= self.detection_sinr * (self.noise + interference);
        // Without a sum where that is enough.
        if !is_detectable(0.0) || !is_detectable(self.overlaps.interference(packet)) {
            return Standing::Missed;
        }
        if let Some(followed) = self.followed {
            if sound.power < followed.power * self.capture_ratio {
                return Standing::Displaced(followed.packet);
            }
            if let Some(loser) = self.overlaps.sounding_mut().find(|other| followed.is(&other.arrival)) {
                loser.standing = Standing::Displaced(packet);
            }
        }
        let Arrival { path, start, .. } = sound.arrival;
        self.followed = Some(Followed { packet, path, start, power: sound.power });
        self.stretches.clear();
        Standing::Followed
    }

    /// The own modem begins to emit.
    fn fall_deaf(&mut self) {
        let Some((start, end)) = self.emissions.pop_front() else { return };
        self.emits_until = self.emits_until.max(end);
        self.followed = None;
        self.overlaps.sounding_mut().for_each(|sound| sound.standing = Standing::Deaf);
        if self.carrier.is_on() {
            self.carrier.own(start, end);
        }
    }

    /// Takes note of what sounds from `at` on.
    fn listen(&mut self, at: SimTime) {
        if let Some(followed) = self.followed {
            let interference = self.overlaps.interference(followed.packet);
            if self.stretches.last().is_some_and(|last| last.since == at) {
                self.stretches.pop();
            }
            if self.stretches.last().is_none_or(|last| last.interference != interference) {
                self.stretches.push(Stretch { since: at, interference });
            }
        }
        if self.carrier.is_on() {
            self.carrier.others(at, self.overlaps.power());
        }
    }

    /// The next arrival to end does.
    fn end(&mut self, outcomes: &mut Vec<Outcome>) {
        let Some(sound) = self.overlaps.end() else { return };
        if let ArrivalKind::Packet { bits, asleep, known, .. } = sound.arrival.kind {
            let given = match (known, asleep) {
                (false, _) => Some(LossReason::Band),
                (_, true) => Some(LossReason::Asleep),
                _ => None,
            };
            outcomes.extend(self.judge(&sound, bits, given));
            if self.followed.is_some_and(|followed| followed.is(&sound.arrival)) {
                self.followed = None;
            }
        }
        self.overlaps.keep(sound);
    }

    /// Whether a copy that has just ended is decoded, and what that means for its packet.
    fn judge(&mut self, sound: &Sound, bits: u32, given: Option<LossReason>) -> Option<Outcome> {
        let &Sound { arrival, power, gain, chance, standing } = sound;
        let at = arrival.end;
        let sinr = power / (self.noise + self.overlaps.mean_interference(sound));
        let reception = Reception {
            path: arrival.path,
            level_db: arrival.level_db + db_from_power(gain),
            sinr_db: db_from_power(sinr),
            doppler: arrival.doppler,
        };
        if standing == Standing::Followed
            && chance < self.decoder.success(&arrival, bits, power, &self.stretches)
        {
            let outcome = Outcome { arrival, at, reception, verdict: Verdict::Heard };
            return self.packets.heard(arrival.packet()).then_some(outcome);
        }
        let alone = given.is_none()
            && power >= self.detection_sinr * self.noise
            && chance < self.decoder.success_alone(&arrival, bits, power);
        let reason = match (given, alone, standing) {
            (Some(reason), ..) => reason,
            (_, false, _) => LossReason::Noise,
            (.., Standing::Deaf) => LossReason::HalfDuplex,
            _ => LossReason::Collision,
        };
        let colliding = match reason {
            LossReason::Collision => self.overlaps.colliding(sound),
            _ => Vec::new(),
        };
        let followed = standing != Standing::Displaced(arrival.packet());
        let hope = Hope { followed, alone, direct: arrival.path == SoundPath::Direct, power };
        self.packets.lost(at, LostCopy { arrival, reception, hope, reason, colliding })
    }
}

impl Followed {
    fn is(&self, arrival: &Arrival) -> bool {
        (self.packet, self.path, self.start) == (arrival.packet(), arrival.path, arrival.start)
    }
}

/// An arrival in the order of beginnings.
#[derive(Clone, Copy, PartialEq)]
struct Awaited(Arrival);

impl Eq for Awaited {}

impl Ord for Awaited {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.start.cmp(&other.0.start).then_with(|| self.0.tie_order(&other.0))
    }
}

impl PartialOrd for Awaited {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Arrival {
    /// In the order of ends.
    fn end_order(&self, other: &Self) -> Ordering {
        self.end.cmp(&other.end).then_with(|| self.tie_order(other)).then(self.start.cmp(&other.start))
    }

    /// What is simultaneous has an order all the same, up to arrivals that differ in nothing that counts.
    fn tie_order(&self, other: &Self) -> Ordering {
        let order = |arrival: &Self| (arrival.from, arrival.sequence, arrival.path, arrival.end);
        order(self).cmp(&order(other)).then(self.level_db.total_cmp(&other.level_db))
    }
}
