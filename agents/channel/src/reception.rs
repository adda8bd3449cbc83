//! Reception at level `sea`.
use shoal_bus::message::AuvId;
use shoal_bus::time::SimTime;
use shoal_bus::traffic::{LossReason, Reception, SoundPath};
use shoal_scenario::model::{Fading, PhysicalLayer};

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

/// One receiver.
pub struct Ear {
    settings: EarSettings,
    draws: Draws,
}

impl Ear {
    /// A receiver that draws from its own stream ([`Purpose::Reception`](crate::draw::Purpose::Reception)).
    pub fn new(settings: EarSettings, draws: Draws) -> Self {
        Self { settings, draws }
    }

    /// Tells of an arrival, before [`settle`](Self::settle) passes its start; in any order.
    pub fn expect(&mut self, arrival: Arrival) {
        let _ = (arrival, &self.settings, &mut self.draws);
        todo!()
    }

    /// Tells of an own emission, before [`settle`](Self::settle) passes its start.
    pub fn emit(&mut self, start: SimTime, end: SimTime) {
        let _ = (start, end);
        todo!()
    }

    /// Decides all that is decided before `until`, in order of time.
    pub fn settle(&mut self, until: SimTime, outcomes: &mut Vec<Outcome>) {
        let _ = (until, outcomes);
        todo!()
    }

    /// Whether sound of others or the own emission is noticeable between, after `settle(until)`.
    pub fn busy(&self, since: SimTime, until: SimTime) -> bool {
        let _ = (since, until);
        todo!()
    }

    /// Packets expected here and not decided.
    pub fn pending(&self) -> usize {
        todo!()
    }
}
