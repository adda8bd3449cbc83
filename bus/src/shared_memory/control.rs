//! The control block: the words on which channel and AUVs sleep, and the little that they must know before they can talk.

use std::io;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;

use crate::codec::FORMAT;
use crate::message::AuvId;
use crate::os::{SharedWords, sleep_on, wake_all};
use crate::run_dir::RunDir;

/// `shoal` in a word.
const MAGIC: u32 = 0x5348_4f4c;

/// Words per cache line: what different processes write stays on different lines.
const LINE: usize = 16;

const BELL: usize = LINE;
const GROUPS: usize = 2 * LINE;
/// Words of one group: the bell that wakes its members, and on a line of its own what they count down.
const GROUP: usize = 2 * LINE;
const PENDING: usize = LINE;
/// Words of one AUV.
const SLOT: usize = 8;

/// Bits of [`Control::begin_window`]'s word that count answers; the others hold the window.
const COUNT_BITS: u32 = 20;

/// The control block of a run.
#[derive(Debug)]
pub(super) struct Control {
    shared: SharedWords,
    groups: usize,
    auvs: usize,
}

/// One AUV's part of the control block.
#[derive(Clone, Copy)]
pub(super) struct Slot<'a> {
    /// Process of the AUV that has joined; zero before.
    pub(super) pid: &'a AtomicU32,
    /// Sequence number of the last sample that it has dealt with.
    pub(super) acknowledged: &'a AtomicU32,
    /// Not zero when the channel wants nothing more from it.
    pub(super) dismissed: &'a AtomicU32,
}

impl Control {
    /// Makes the block of `run`. `members` is (AUV, index of its group), sorted by AUV.
    pub(super) fn create(run: &RunDir, members: &[(AuvId, usize)], groups: usize) -> io::Result<Self> {
        let words = GROUPS + groups * GROUP + members.len() * SLOT;
        let block =
            Self { shared: SharedWords::create(&run.control_block(), words)?, groups, auvs: members.len() };
        for (index, (auv, group)) in members.iter().enumerate() {
            let start = block.slot_start(index);
            block.word(start).store(auv.0, Ordering::Relaxed);
            block.word(start + 1).store(*group as u32, Ordering::Relaxed);
        }
        let header = [u32::from(FORMAT), members.len() as u32, groups as u32, std::process::id()];
        for (at, value) in header.into_iter().enumerate() {
            block.word(1 + at).store(value, Ordering::Relaxed);
        }
        // Last: who sees it sees the rest.
        block.word(0).store(MAGIC, Ordering::Release);
        Ok(block)
    }

    /// Opens the block of `run`.
    pub(super) fn open(run: &RunDir) -> io::Result<Self> {
        let invalid = |what: String| io::Error::new(io::ErrorKind::InvalidData, what);
        let shared = SharedWords::open(&run.control_block())?;
        let header: Option<[u32; 4]> = match shared.words() {
            [magic, rest @ ..] if magic.load(Ordering::Acquire) == MAGIC => {
                rest.first_chunk::<4>().map(|words| words.each_ref().map(|word| word.load(Ordering::Relaxed)))
            }
            _ => None,
        };
        let [format, auvs, groups, _] = header.ok_or_else(|| invalid("it is no control block".into()))?;
        if format != u32::from(FORMAT) {
            return Err(invalid(format!("the channel speaks format {format}, this build {FORMAT}")));
        }
        let block = Self { shared, groups: groups as usize, auvs: auvs as usize };
        match block.slot_start(block.auvs) == block.shared.words().len() {
            true => Ok(block),
            false => Err(invalid("the control block has a wrong length".into())),
        }
    }

    /// Process of the channel.
    pub(super) fn channel_pid(&self) -> u32 {
        self.word(4).load(Ordering::Relaxed)
    }

    /// Not zero when the run is over.
    pub(super) fn ended(&self) -> &AtomicU32 {
        self.word(5)
    }

    /// Index of the slot of `auv`, and of its group.
    pub(super) fn find(&self, auv: AuvId) -> Option<(usize, usize)> {
        let (mut low, mut high) = (0, self.auvs);
        while low < high {
            let middle = low.midpoint(high);
            match self.word(self.slot_start(middle)).load(Ordering::Relaxed).cmp(&auv.0) {
                std::cmp::Ordering::Less => low = middle + 1,
                std::cmp::Ordering::Greater => high = middle,
                std::cmp::Ordering::Equal => {
                    let group = self.word(self.slot_start(middle) + 1).load(Ordering::Relaxed) as usize;
                    return (group < self.groups).then_some((middle, group));
                }
            }
        }
        None
    }

    pub(super) fn slot(&self, index: usize) -> Slot<'_> {
        let start = self.slot_start(index);
        Slot {
            pid: self.word(start + 2),
            acknowledged: self.word(start + 3),
            dismissed: self.word(start + 4),
        }
    }

    /// Sequence number of a group's last sample; its members sleep on it.
    pub(super) fn group_bell(&self, group: usize) -> &AtomicU32 {
        self.word(GROUPS + group * GROUP)
    }

    /// Moves a group's bell to `value` and wakes its members.
    pub(super) fn ring_group(&self, group: usize, value: u32) -> io::Result<()> {
        self.group_bell(group).store(value, Ordering::Release);
        wake_all(self.group_bell(group))
    }

    /// The channel's bell as it is now, for [`await_channel_bell`](Self::await_channel_bell).
    pub(super) fn channel_bell(&self) -> u32 {
        self.word(BELL).load(Ordering::Acquire)
    }

    /// Sleeps until the channel's bell is rung after it was `seen`, or for `limit`.
    pub(super) fn await_channel_bell(&self, seen: u32, limit: Duration) -> io::Result<()> {
        sleep_on(self.word(BELL), seen, limit)
    }

    /// Wakes the channel.
    pub(super) fn ring_channel(&self) -> io::Result<()> {
        self.word(BELL).fetch_add(1, Ordering::Release);
        wake_all(self.word(BELL))
    }

    /// Says how many acknowledgements of a group the window needs.
    pub(super) fn begin_window(&self, group: usize, window: u32, answers: usize) {
        self.pending(group).store(window << COUNT_BITS | answers as u32, Ordering::Release);
    }

    /// Acknowledges sample `sequence`, and wakes the channel when this was the group's last of the window. A hint only: a
    /// process may die between the two, so the channel looks again by itself.
    pub(super) fn acknowledge(
        &self,
        slot: usize,
        group: usize,
        sequence: u32,
        window: u32,
    ) -> io::Result<()> {
        self.slot(slot).acknowledged.store(sequence, Ordering::Release);
        let left = self.pending(group).try_update(Ordering::AcqRel, Ordering::Acquire, |pending| {
            let (of, count) = (pending >> COUNT_BITS, pending & ((1 << COUNT_BITS) - 1));
            (of == window << COUNT_BITS >> COUNT_BITS && count > 0).then(|| pending - 1)
        });
        match left {
            Ok(before) if before & ((1 << COUNT_BITS) - 1) == 1 => self.ring_channel(),
            _ => Ok(()),
        }
    }

    fn pending(&self, group: usize) -> &AtomicU32 {
        self.word(GROUPS + group * GROUP + PENDING)
    }

    fn slot_start(&self, index: usize) -> usize {
        GROUPS + self.groups * GROUP + index * SLOT
    }

    fn word(&self, at: usize) -> &AtomicU32 {
        &self.shared.words()[at]
    }
}
