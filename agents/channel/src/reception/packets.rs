//! The fate of each packet, gathered from its copies: told once.

use shoal_bus::message::AuvId;
use shoal_bus::time::SimTime;
use shoal_bus::traffic::{LossReason, Reception};

use super::{Arrival, Outcome, Verdict};

/// One packet, whatever the path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct PacketId {
    pub from: AuvId,
    pub sequence: u32,
}

impl Arrival {
    pub(super) fn packet(&self) -> PacketId {
        PacketId { from: self.from, sequence: self.sequence }
    }
}

/// How a copy was lost.
#[derive(Debug)]
pub(super) struct LostCopy {
    pub arrival: Arrival,
    pub reception: Reception,
    pub hope: Hope,
    pub reason: LossReason,
    pub colliding: Vec<AuvId>,
}

/// How near a copy came to being decoded; the greatest tells the fate of its packet.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub(super) struct Hope {
    /// No other copy of the same packet kept the receiver from it.
    pub followed: bool,
    /// It would have been decoded had it been alone and the receiver listening.
    pub alone: bool,
    /// It came directly.
    pub direct: bool,
    /// Received power.
    pub power: f64,
}

/// Packets of which copies are still expected, sorted.
#[derive(Debug, Default)]
pub(super) struct Packets {
    open: Vec<Open>,
}

#[derive(Debug)]
struct Open {
    packet: PacketId,
    copies_left: u8,
    heard: bool,
    best: Option<LostCopy>,
}

impl Packets {
    /// One of `copies` copies is expected.
    pub(super) fn expect(&mut self, packet: PacketId, copies: u8) {
        if let Err(place) = self.place(packet) {
            self.open.insert(place, Open { packet, copies_left: copies.max(1), heard: false, best: None });
        }
    }

    /// How many are neither heard nor lost yet.
    pub(super) fn undecided(&self) -> usize {
        self.open.iter().filter(|open| !open.heard).count()
    }

    /// A copy was decoded; `true` for the first one.
    pub(super) fn heard(&mut self, packet: PacketId) -> bool {
        let Ok(place) = self.place(packet) else { return false };
        let open = &mut self.open[place];
        let is_first = !std::mem::replace(&mut open.heard, true);
        self.count_down(place);
        is_first
    }

    /// A copy was lost at `at`; the fate of its packet if that was the last hope.
    pub(super) fn lost(&mut self, at: SimTime, copy: LostCopy) -> Option<Outcome> {
        let place = self.place(copy.arrival.packet()).ok()?;
        let open = &mut self.open[place];
        if open.best.as_ref().is_none_or(|best| copy.hope > best.hope) {
            open.best = Some(copy);
        }
        let open = self.count_down(place)?;
        let LostCopy { arrival, reception, reason, colliding, .. } = open.best.filter(|_| !open.heard)?;
        Some(Outcome { arrival, at, reception, verdict: Verdict::Lost { reason, colliding } })
    }

    /// One copy less is expected; the packet itself after its last. There is at least one as long as the packet is open.
    fn count_down(&mut self, place: usize) -> Option<Open> {
        self.open[place].copies_left -= 1;
        (self.open[place].copies_left == 0).then(|| self.open.remove(place))
    }

    fn place(&self, packet: PacketId) -> Result<usize, usize> {
        self.open.binary_search_by_key(&packet, |open| open.packet)
    }
}
